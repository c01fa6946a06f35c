"""The half-space's error: local errors from the table, parts of each number, advice, one's own surface."""

from __future__ import annotations

import json
import math
from importlib import resources
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.half_space.influence_error import coefficient_error
from refimpl.half_space.influence_error_3d import element_error
from refimpl.half_space.local_error import local_error, share_above, short_wave_share
from refimpl.model.elasticity import Elasticity
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.scene.discretise import discretise
from refimpl.sensitivities import half_space
from refimpl.sensitivities.half_space import HalfSpaceError, advice, half_space_error
from refimpl.sensitivities.surface_verdict import pressed_on_a_flat, surface_verdict

SIZE, ELEMENTS = (3e-3, 2e-3), (9, 6)
# compliances 0.91 / 3 and 1 / 45: 91 to 20/3
SOFT, STIFF = rf.Material(E=3e9, nu=0.3), rf.Material(E=45e9, nu=0.0)
RIGID, AUXETIC = rf.Material(E=math.inf, nu=0.3), rf.Material(E=3e9, nu=-0.2)
NUMBERS = (
    "approach",
    "normal_force",
    "friction_coefficient",
    "contact_area",
    "max_pressure",
    "binormal_force",
    "friction_coefficient_corrected",
)


def largest_in_the_table(degrees: float, nu: float) -> float:
    """Of crest, flank and valley of the standard ridge: the largest error of all ten coefficients."""
    text = resources.files("refimpl").joinpath("data", "coefficient_error_3d.json").read_text("utf-8")
    asked = {"slope_deg": degrees, "nu": nu, "wavelength": 20.0, "kind": "ridge", "width": "projected"}
    found = [p["error"] for p in json.loads(text)["points"] if all(p[k] == v for k, v in asked.items())]
    return max(abs(float(error)) for errors in found for error in errors)


def inclined(degrees: float, towards: float) -> Array:
    """A plane that rises by the angle, towards a direction (rad) from x."""
    grid = rf.Grid(ELEMENTS, SIZE)
    along = math.cos(towards) * grid.x[:, None] + math.sin(towards) * grid.y[None, :]
    return math.tan(math.radians(degrees)) * along


def scene(upper: Any, lower: Any, *, of_upper: rf.Material = STIFF, of_lower: rf.Material = SOFT) -> rf.Scene:
    law = rf.Friction(tau=4e5, beta=0.12)
    bodies = rf.Body(of_upper, upper), rf.Body(of_lower, lower)
    return rf.Scene(*bodies, law, load=6.0, size=SIZE, sliding_direction=0.4)


def test_each_body_counts_by_its_slope_and_its_share_of_the_compliance() -> None:
    """91 / (91 + 20/3) = 0.93174 of the lower body's error at 10 degrees, the rest of the upper's at 15."""
    problem = discretise(scene(inclined(15.0, 2.0), inclined(10.0, 0.7)), rf.Grid(ELEMENTS, SIZE))
    expected = 0.93174 * largest_in_the_table(10.0, 0.3) + 0.06826 * largest_in_the_table(15.0, 0.0)
    assert local_error(problem) == pytest.approx(np.full(ELEMENTS, expected), rel=1e-4)


@pytest.mark.parametrize(
    ("degrees", "bodies", "expected"),
    [
        ((31.0, 0.0), (STIFF, SOFT), math.inf),  # beyond the table
        ((31.0, 10.0), (RIGID, SOFT), largest_in_the_table(10.0, 0.3)),
        # the table of square elements has no negative ratio of Poisson: strips
        ((0.0, 10.0), (RIGID, AUXETIC), coefficient_error(math.radians(10.0), AUXETIC)),
    ],
)
def test_bodies_beyond_the_table_and_without_error(
    degrees: tuple[float, float], bodies: tuple[rf.Material, rf.Material], expected: float
) -> None:
    upper, lower = (inclined(angle, 0.7) for angle in degrees)
    problem = discretise(scene(upper, lower, of_upper=bodies[0], of_lower=bodies[1]), rf.Grid(ELEMENTS, SIZE))
    assert local_error(problem) == pytest.approx(np.full(ELEMENTS, expected))


def rough() -> rf.Scene:
    heights = np.random.default_rng(5).uniform(0, 4e-5, (2, *ELEMENTS))
    return scene(heights[0], heights[1])


@pytest.mark.parametrize("approach", [None, 1.6e-5])
def test_parts_of_every_number(approach: float | None) -> None:
    """Under a load, numbers change at that load, and N at the approach before; at an approach, all there."""
    solution = rf.solve(rough(), ELEMENTS, method="dense", approach=approach, oblique=False)
    found = half_space_error(rough(), solution)
    first, corrected = found.first_order, found.corrected
    assert set(first) == set(found.second_order) == set(found.finite_strain) == set(NUMBERS)
    for name in ("friction_coefficient", "contact_area", "max_pressure", "binormal_force"):
        assert first[name] == getattr(corrected, name) - getattr(solution, name)
    if approach is None:
        assert corrected.normal_force == pytest.approx(solution.normal_force, rel=1e-8)
        assert first["approach"] * first["normal_force"] < 0  # bodies that recede take less at one approach
        assert abs(first["normal_force"]) > 1e-3 * solution.normal_force
    else:
        assert first["approach"] == pytest.approx(0, abs=1e-12 * solution.approach)
        assert first["normal_force"] == corrected.normal_force - solution.normal_force
    assert found.finite_strain == pytest.approx(
        {name: 0.2 * abs(first[name]) for name in NUMBERS}, rel=1e-6, abs=0
    )
    factors = {name: found.second_order[name] / abs(getattr(solution, name)) for name in NUMBERS[1:5]}
    half = 0.5 * factors["contact_area"]  # 0.5 tan^2 of the steepest slopes, the others 0.2 of them
    assert factors == pytest.approx(
        {"normal_force": 0.8 * half, "friction_coefficient": 0.8 * half, "contact_area": 2 * half,
         "max_pressure": 0.8 * half}
    )  # fmt: skip
    sunk = solution.approach + solution.details.problem.datum
    assert found.second_order["approach"] == pytest.approx(0.4 * half * sunk)
    assert found.second_order["binormal_force"] == pytest.approx(0.8 * half * solution.friction_force)


def made_up(first: float, second: float, strain: float) -> HalfSpaceError:
    """Parts of the contact area; of the other numbers a tenth of them."""

    def parts(value: float) -> dict[str, float]:
        return {name: value if name == "contact_area" else 0.1 * value for name in NUMBERS}

    return HalfSpaceError(parts(first), parts(second), parts(strain), np.zeros(ELEMENTS), None)  # type: ignore[arg-type]


SOLVED: Any = SimpleNamespace(
    friction_coefficient=0.5, contact_area=2.0, max_pressure=7.0, approach=-1.0, normal_force=3.0,
    details=SimpleNamespace(problem=SimpleNamespace(datum=4.0)), contact=None,
)  # fmt: skip


@pytest.fixture
def shallow(monkeypatch: pytest.MonkeyPatch) -> None:
    """Surfaces of 10 degrees."""
    monkeypatch.setattr(half_space, "steepness", lambda problem, contact: math.tan(math.radians(10)) ** 2)


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ((-0.03, 0.008, 0.001), "keep the half-space: no number is off by more than 1.9%"),
        (
            (-0.05, 0.02, 0.01),
            "keep, off by at most 2%: friction coefficient (1.6%), max pressure (0.1%), approach (0.3%), "
            "normal force (0.3%); take the corrected, slope_correction is no substitute: contact area (4.0%, "
            "corrected 1.5%)",
        ),
        (
            (-0.05, 0.03, 0.012),
            "keep, off by at most 2%: friction coefficient (1.8%), max pressure (0.1%), approach (0.3%), "
            "normal force (0.3%); use finite elements: contact area (4.6%, corrected 2.1%)",
        ),
    ],
)
def test_what_to_do(shallow: None, parts: tuple[float, float, float], says: str) -> None:
    """Per cents of an area of 2; 2 % is what the paper accepts."""
    assert advice(made_up(*parts), SOLVED) == says


def test_an_approach_is_judged_from_first_contact(shallow: None) -> None:
    """0.1 + 0.05 of 4 - 1, the mean planes' distance at first contact less that of the solution."""
    zero = dict.fromkeys(NUMBERS, 0.0)
    error = HalfSpaceError(
        zero | {"approach": 0.1}, zero | {"approach": 0.05}, zero, np.zeros(ELEMENTS), None
    )  # type: ignore[arg-type]
    assert advice(error, SOLVED).endswith("no substitute: approach (5.0%, corrected 1.7%)")


def test_beyond_the_slopes_that_were_judged_the_advice_is_finite_elements(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """At 21 degrees, whatever the parts say."""
    monkeypatch.setattr(half_space, "steepness", lambda problem, contact: math.tan(math.radians(21)) ** 2)
    said = advice(made_up(-0.03, 0.008, 0.001), SOLVED)
    assert "21 degrees" in said
    assert "finite elements" in said


COPPER = rf.Material(118e9, 0.3)


def problem(grid: Grid, lower: np.ndarray, pair: Pair) -> Problem:
    gap = -lower - (-lower).min()
    return Problem(grid, gap, lower + gap / 2, Elasticity(pair), rf.Friction(), 0.0, Terms(), 1.0, None)


def test_surfaces_that_are_constant_along_an_axis_have_the_errors_of_strips() -> None:
    grid = Grid.square(1.0, 16)
    height = np.repeat(math.tan(math.radians(10.0)) * grid.x[:, None], 16, axis=1)
    found = local_error(problem(grid, height, Pair(COPPER, RIGID)))
    assert found == pytest.approx(coefficient_error(math.radians(10.0), COPPER), rel=1e-9)
    assert found[0, 0] < element_error(math.radians(10.0), COPPER).in_line


def test_the_share_of_the_area_is_counted() -> None:
    grid = Grid.square(1.0, 16)
    # 8 degrees on the right half; central differences leave a quarter of it at column 7, 3/4 at column 8
    height = math.tan(math.radians(8.0)) * np.maximum(grid.x - 0.5, 0.0)[:, None] + 0 * grid.y[None, :]
    height[0, 0] += 1e-15  # not constant along y
    found = local_error(problem(grid, height, Pair(COPPER, RIGID)))
    assert share_above(found, 0.02) == 8 / 16  # 6 degrees: 3.8 %, 2 degrees: 1.3 %
    assert share_above(np.full((2, 2), math.inf), 0.02) == 1.0
    with pytest.raises(rf.InputError):
        share_above(found, 0.0)


def test_two_waves_share_by_the_square_of_their_slopes() -> None:
    grid = Grid((64, 64), (1.0, 1.0), periodic=True)
    x, y = grid.x[:, None], grid.y[None, :]
    # amplitudes 4 and 1 at 4 and 8 waves: slopes 16 to 8, squares 4 to 1
    height = 4 * np.cos(8 * math.pi * x) + np.cos(16 * math.pi * y)
    assert short_wave_share(problem(grid, height, Pair(COPPER, RIGID))) == pytest.approx(0.2, rel=1e-9)


def crossed_waves(rms: float = 0.05) -> rf.ArraySurface:
    x = (np.arange(32) + 0.5) / 32
    height = rms * (np.cos(2 * math.pi * x)[:, None] * np.cos(4 * math.pi * x)[None, :])
    return rf.ArraySurface(height, pixel=1 / 32)


def test_a_surface_alone_is_pressed_by_a_twentieth_of_its_rms_gradient() -> None:
    """Slopes of 0.1 and -0.2 on 1 x 2 m: the gradient is sqrt(0.05). E* of one body: 118 / (1 - 0.16) GPa."""
    x, y = (np.arange(8) + 0.5) / 8, (np.arange(16) + 0.5) / 8
    plane, law = rf.ArraySurface(0.1 * x[:, None] - 0.2 * y[None, :], pixel=1 / 8), rf.Friction(3e6, 0.2)
    scene = pressed_on_a_flat(plane, rf.Material(118e9, 0.4), grid=16, friction=law)
    assert scene.load == pytest.approx(0.05 * 118e9 / 0.84 * math.sqrt(0.05) * 2, rel=1e-9)
    assert (scene.friction, scene.upper.material) == (law, rf.Material(math.inf, 0.4))
    assert pressed_on_a_flat(plane, COPPER, grid=16, pressure=3e6).load == pytest.approx(6e6)


@pytest.mark.parametrize("pressure", [None, -1.0, 0.0, math.inf])
def test_a_flat_surface_or_no_pressure_is_refused(pressure: float | None) -> None:
    surface = rf.ArraySurface(np.zeros((8, 8)), pixel=0.125) if pressure is None else crossed_waves()
    with pytest.raises(rf.InputError):
        pressed_on_a_flat(surface, COPPER, grid=8, pressure=pressure)


def test_the_verdict_has_every_number_its_share_and_its_evidence() -> None:
    scene = pressed_on_a_flat(crossed_waves(), COPPER, grid=32, friction=rf.Friction(beta=0.1))
    verdict = surface_verdict(scene, 32)
    assert verdict.local.shape == (32, 32)
    assert verdict.share_above == float(np.mean(verdict.local > 0.02)) > 0.5
    numbers = verdict.numbers()
    for name in ("friction_coefficient", "contact_area", "max_pressure", "approach", "normal_force"):
        row = numbers[name]
        parts = abs(row["corrected"] - row["value"]) + row["second_order"] + row["finite_strain"]
        assert row["corrected"] == row["value"] + verdict.error.first_order[name]
        assert row["stated"] == pytest.approx(parts)
    # rms gradient of the crossed waves: 0.05 * 2 pi * sqrt(1 + 4) / 2 = 0.351, times sqrt 2: 26.4 degrees
    assert verdict.evidence.startswith("slopes of 26 degrees")
    assert "beyond 20 degrees" in verdict.evidence
    assert verdict.advice.endswith("use finite elements")


def test_a_gentle_surface_keeps_the_half_space() -> None:
    verdict = surface_verdict(pressed_on_a_flat(crossed_waves(5e-4), COPPER, grid=32), 32)
    assert verdict.share_above == 0.0
    assert verdict.advice.startswith("keep the half-space")
    assert "finer grid" not in verdict.evidence
