"""Deformed surfaces of a solution, its numbers in notes, and the ends of the limits that warn."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.options import Options
from refimpl.planning import plan
from refimpl.planning.terms import RequestedTerms
from refimpl.solution.limits import Limit, ModelWarning

SOFT, HARD = rf.Material(2e9, 0.35), rf.Material(7e9, 0.2)
SCENE = rf.Scene(
    upper=rf.Body(HARD, rf.Sphere(0.05)),
    lower=rf.Body(SOFT, rf.Flat()),
    friction=rf.Friction(tau=1e6, beta=0.2),
    load=5.0,
    side=4e-3,
)
STEEP = replace(  # the harder body's roughness bends the softer one
    SCENE,
    upper=rf.Body(HARD, rf.Sphere(0.05) + rf.GaussianRoughness(3e-5, 4e-4, seed=4)),
    lower=rf.Body(rf.Material(0.05e9, 0.35), rf.Flat()),
)


def warned(s: rf.Solution, limit: Limit) -> ModelWarning:
    (found,) = (w for w in s.warnings if isinstance(w, ModelWarning) and w.limit is limit)
    return found


def test_both_bodies_deform_into_themselves_and_meet() -> None:
    """At the middle both give way; the surfaces touch where there is pressure, and leave a gap beside it."""
    s = rf.solve(SCENE, 32, oblique=False)
    contact = s.contact
    assert np.abs(s.separation[contact]).max() < 1e-8 * s.approach
    assert s.separation[~contact].min() > 0
    assert np.allclose(s.separation, s.surface_upper - s.surface_lower, rtol=0, atol=1e-18)
    lower, upper = s.problem.heights
    middle = 16, 16
    into_lower, into_upper = (
        lower[middle] - s.surface_lower[middle],
        s.surface_upper[middle] - upper[middle] + s.approach,
    )
    # each by its compliance (1 - nu^2) / E
    ratio = ((1 - 0.35**2) / 2e9) / ((1 - 0.2**2) / 7e9)
    assert into_upper > 0
    assert into_lower / into_upper == pytest.approx(ratio, rel=0.02)  # shear adds a little to both


def test_where_slopes_are_excluded_they_are_those_of_the_deformed_surface() -> None:
    """The mean of both surfaces of the solution, by NumPy's gradient, on its contact."""
    s = rf.solve(STEEP, 48, oblique=False)
    gradient = np.gradient(0.5 * (s.surface_lower + s.surface_upper), 4e-3 / 48)
    steepest = math.degrees(math.atan(float(np.hypot(*gradient)[s.contact].max())))
    text = str(warned(s, Limit.MAX_SLOPE))
    assert float(re.findall(r"slope ([0-9.]+) degrees", text)[0]) == pytest.approx(steepest, rel=0.01)


def test_without_a_hardness_the_note_states_the_load_over_the_contact() -> None:
    s = rf.solve(SCENE, 32, oblique=False)
    (note,) = (w for w in s.warnings if "no hardness" in w)
    mean, largest = (float(x) for x in re.findall(r"([0-9.]+) MPa", note))
    assert mean == pytest.approx(5.0 / s.contact_area / 1e6, rel=1e-3)
    assert largest == pytest.approx(s.max_pressure / 1e6, rel=1e-3)


@pytest.mark.filterwarnings("ignore::refimpl.surfaces.surface.SurfaceWarning")
@pytest.mark.parametrize("bodies", [("lower", "upper"), ("upper", "lower")])
def test_points_of_the_finer_data_count(bodies: tuple[str, str]) -> None:
    """Elements of 0.25 mm over pixels of 0.1 mm on one body and of 0.2 mm on the other: 2.5 points."""
    fine, coarse = bodies
    surfaces = {
        fine: rf.Body(SOFT, rf.ArraySurface(np.zeros((40, 40)), pixel=(1e-4, 1e-4))),
        coarse: rf.Body(HARD, rf.ArraySurface(np.zeros((20, 20)), pixel=(2e-4, 2e-4)) + rf.Sphere(
            0.05 if coarse == "upper" else -0.05
        )),
    }  # fmt: skip
    s = rf.solve(replace(SCENE, **surfaces), 16)
    assert warned(s, Limit.DATA).number == pytest.approx(2.5)


def test_notes_of_the_surfaces_stay_where_a_refinement_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "free_memory", lambda: plan.estimated_memory("fft", SCENE.grid(64)))
    heights = rf.Body(SOFT, 1e-7 * np.random.default_rng(1).normal(size=(12, 12)))
    s = rf.solve(replace(SCENE, lower=heights), accuracy=1e-5)
    assert s.status is rf.Status.ACCURACY_NOT_REACHED
    texts = [str(w) for w in s.warnings]
    assert sum("finer than the array" in text for text in texts) == 1
    assert sum("is known to" in text for text in texts) == 1
    assert any("no hardness" in text for text in texts)


# E* = 1 / (0.8775 / 2e9 + 0.96 / 7e9) Pa on 16 mm^2
MODULUS = 1 / (0.8775 / 2e9 + 0.96 / 7e9)


@pytest.mark.parametrize(
    ("field", "end", "beyond"),
    [
        ("load", 1e-30 * MODULUS * 16e-6, 0.999),
        ("load", 1e6 * MODULUS * 16e-6, 1.001),
        ("friction.tau", 1e6 * MODULUS, 1.001),
        ("approach", 1e6 * 4e-3, 1.001),
        ("approach", -1e6 * 4e-3, 1.001),
    ],
)
def test_strains_from_1e_minus_30_to_1e6_are_accepted(field: str, end: float, beyond: float) -> None:
    def options(number: float) -> Options:
        if field == "approach":
            return Options(scene=SCENE, grid=8, approach=number)
        changes = {"load": number} if field == "load" else {"friction": rf.Friction(tau=number)}
        return Options(scene=replace(SCENE, **changes), grid=8)  # type: ignore[arg-type]  # one of two fields

    options(end / beyond)
    with pytest.raises(rf.InputError) as refused:
        options(end * beyond)
    assert refused.value.field == field


@pytest.mark.parametrize("size", [(2e-3, 1e-3), (1e-3, 2e-3)])
def test_loads_under_a_cap_end_at_the_hardness_times_the_rectangle(size: tuple[float, float]) -> None:
    """0.3 GPa on 2 mm^2: 600 N."""
    lower = rf.Body(rf.Material(2e9, 0.35, hardness=0.3e9), rf.Flat())
    scene = rf.Scene(SCENE.upper, lower, rf.Friction(), 599.0, size=size)
    Options(scene=scene, grid=8)
    with pytest.raises(rf.InputError) as refused:
        Options(scene=replace(scene, load=601.0), grid=8)
    assert refused.value.field == "load"
    Options(scene=replace(scene, load=601.0), grid=8, requested=RequestedTerms(plastic=False))
