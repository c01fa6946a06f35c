"""Budgets after V&V 20: what each part is, how parts add, by solutions and made-up derivatives; heights."""

from __future__ import annotations

import importlib
import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

import refimpl as rf
from refimpl.model.forces import facet_resultants
from refimpl.scene.parameters import check_tolerances
from refimpl.scene.scene_file import read_tolerances, scene_to_toml
from refimpl.sensitivities.budget import Budget, Budgets, budget
from refimpl.sensitivities.difference_quotients import NUMBERS
from refimpl.sensitivities.sensitivity import Sensitivity
from tests import plate
from tests.changed import changed

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)
SCENE = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(radius=0.02)),
    lower=rf.Body(COPPER, rf.GaussianRoughness(rms=2e-6, correlation_length=400e-6, seed=3)),
    friction=rf.Friction(tau=40e6, beta=0.1),
    load=100.0,
    side=1.61e-3,
)
TOLERANCES = {"lower.material.E": 0.02, "friction.tau": 0.1, "load": 0.01, "lower.surface[0].rms": 0.05}


@pytest.fixture(scope="module")
def solution() -> rf.Solution:
    return rf.solve(SCENE, 64)


@pytest.fixture(scope="module")
def found(solution: rf.Solution) -> Budgets:
    return budget(SCENE, solution, TOLERANCES, sampling={"contact_area_corrected": 1e-9})


def test_cosines_are_those_of_the_exact_facets(found: Budgets, solution: rf.Solution) -> None:
    exact = facet_resultants(
        solution.pressure, solution.traction, solution.slopes, solution.grid.element_area
    )
    mu = found.numbers["friction_coefficient_corrected"]
    change = abs(exact.friction / exact.normal - solution.friction_coefficient)
    assert mu.sources["cosines"] == pytest.approx(change)
    # second order in the slope: about its square, times mu
    assert 0 < mu.sources["cosines"] < 3 * solution.details.slope_error.max_slope**2
    across = found.numbers["binormal_force"]
    assert across.sources["cosines"] == pytest.approx(abs(exact.binormal - across.value))


def test_cosines_misjudge_the_load(found: Budgets, solution: rf.Solution) -> None:
    """The peak and the area are those of another load; the peak, by solving for it."""
    exact = facet_resultants(
        solution.pressure, solution.traction, solution.slopes, solution.grid.element_area
    )
    tight = [rf.solve(replace(SCENE, load=load), 64, tolerance=1e-11) for load in (100.0, exact.normal)]
    change = abs(tight[1].max_pressure - tight[0].max_pressure)
    assert found.numbers["max_pressure"].sources["cosines"] == pytest.approx(change, rel=0.02)
    share = found.derivatives.relative("contact_area_corrected", "load") * abs(
        exact.normal / solution.normal_force - 1
    )
    area = found.numbers["contact_area_corrected"]
    assert area.sources["cosines"] == pytest.approx(share * area.value, rel=1e-6, abs=0)


def test_parts_add_in_squares_and_model_form_as_it_is() -> None:
    part = Budget(1.0, numerical=3.0, inputs={"a": 4.0}, sources={"x": 1.0, "y": 0.5}, sampling=12.0)
    assert part.total == pytest.approx(1.5 + 13.0)
    assert Budget(1.0, 3.0, {}, {}).total == 3.0


def test_tolerances_stand_in_the_scenes_file(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    stated = '\n[tolerances]\n"lower.material.E" = 0.02\n"lower.surface[0].rms" = 0.05\n'
    file.write_text(scene_to_toml(SCENE) + stated)
    assert read_tolerances(file) == {"lower.material.E": 0.02, "lower.surface[0].rms": 0.05}
    assert rf.read_scene(file).load == SCENE.load


# by its module's name: the package has a function of the same name
module = importlib.import_module("refimpl.sensitivities.budget")
BALL = rf.Scene(
    upper=rf.Body(rf.Material(7e9, 0.2), rf.Sphere(0.05)),
    lower=rf.Body(rf.Material(2e9, 0.35, hardness=6e6), rf.Flat()),
    friction=rf.Friction(tau=1e6, beta=0.2),
    load=5.0,
    side=4e-3,
)


@pytest.fixture(scope="module")
def pressed() -> rf.Solution:
    return rf.solve(BALL, 24, plastic=False)


def made_up(scene: rf.Scene, solution: rf.Solution) -> Sensitivity:
    """Derivatives -2 / p and 3 / p by the moduli, -0.5 by the load, of each number."""
    values = {"upper.material.E": 7e9, "lower.material.E": 2e9, "load": 5.0, "friction.tau": 1e6}
    slopes = {
        "upper.material.E": -2 / 7e9, "lower.material.E": 3 / 2e9, "load": -0.5, "friction.tau": 4e-6
    }  # fmt: skip
    found = {number: float(getattr(solution, number)) for number in NUMBERS}
    every = {number: dict(slopes) for number in NUMBERS}
    return Sensitivity(found, values, every, {number: dict.fromkeys(slopes, 0.0) for number in NUMBERS}, 0.0)


@pytest.mark.parametrize(("along", "across"), [(0.03, None), (0.03, 0.02), (0.01, 0.03)])
def test_no_source_shortens_the_total(
    along: float, across: float | None, pressed: rf.Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Tolerances of 10 % of E and of tau: |-2| 0.1, 4 0.1; moduli wrong by 3 %, the worst: |3 - 2| 0.03."""
    monkeypatch.setattr(module, "sensitivity", made_up)
    bars = {name: {"iteration": 0.25, "discretisation": 0.5} for name in NUMBERS}
    wrong = replace(pressed.details.slope_error, at_rms=along, across_at_rms=across)
    given = changed(pressed, uncertainty=bars, slope_error=wrong)
    found = budget(
        BALL, given, {"upper.material.E": 0.1, "friction.tau": 0.1}, {"contact_area_corrected": 2.0}
    )
    assert set(found.numbers) == set(NUMBERS)
    for number, part in found.numbers.items():
        assert part.inputs == pytest.approx({"upper.material.E": 0.2, "friction.tau": 0.4})
        assert part.input == pytest.approx(math.sqrt(0.2))
        assert part.numerical == pytest.approx(0.75)
        assert part.sources["coefficients"] == pytest.approx(0.03)
        assert min(part.sources.values()) >= 0
        assert part.sampling == (2.0 if number == "contact_area_corrected" else None)
        sampled = 4.0 if number == "contact_area_corrected" else 0.0
        model = sum(part.sources.values())
        assert part.total == pytest.approx(model + math.sqrt(0.75**2 + 0.2 + sampled))
    assert {name: part.value for name, part in found.numbers.items()} == {
        name: getattr(pressed, name) for name in NUMBERS
    }


def test_slopes_beyond_the_table_have_no_bound(pressed: rf.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "sensitivity", made_up)
    steep = changed(pressed, slope_error=replace(pressed.details.slope_error, at_rms=None))
    for part in budget(BALL, steep).numbers.values():
        assert part.sources["coefficients"] == math.inf == part.total


def test_the_half_space_counts_beyond_what_coefficients_count(
    pressed: rf.Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Moduli wrong by 3 % change each number by |3 - 2| 0.03; what is stated beyond that counts."""
    names = "friction_coefficient", "contact_area", *NUMBERS[2:]
    stated = dict(zip(names, (0.05, 0.02, 7.0, 0.03), strict=True))
    monkeypatch.setattr(module, "sensitivity", made_up)
    monkeypatch.setattr(module, "half_space_error", lambda *_: SimpleNamespace(stated=stated.__getitem__))
    given = changed(
        pressed, slope_error=replace(pressed.details.slope_error, at_rms=0.03, across_at_rms=None)
    )
    found = [part.sources["half-space"] for part in budget(BALL, given).numbers.values()]
    assert found == pytest.approx([0.02, 0.0, 6.97, 0.0])

    def fails(*_: object) -> None:
        raise rf.NotConverged

    monkeypatch.setattr(module, "half_space_error", fails)
    assert {part.sources["half-space"] for part in budget(BALL, given).numbers.values()} == {math.inf}


def test_a_load_that_no_hardness_bears_has_no_bound_and_a_capped_one_no_difference(
    pressed: rf.Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    """6 MPa on 4 x 4 mm bear 96 N."""
    monkeypatch.setattr(module, "solved_again", lambda *_, **__: pressed)
    for load, change in ((96.1, math.inf), (95.9, 0.0)):
        assert module._plasticity(replace(BALL, load=load), pressed) == dict.fromkeys(NUMBERS, change)
    terms = replace(pressed.details.problem.terms, plastic=True)
    assert module._plasticity(BALL, changed(pressed, problem=pressed.details.problem.with_terms(terms))) == {}


@pytest.mark.parametrize("status", list(rf.Status))
def test_a_capped_solve_that_fails_bounds_nothing(
    pressed: rf.Solution, monkeypatch: pytest.MonkeyPatch, status: rf.Status
) -> None:
    """The peak of 10 MPa exceeds the hardness, 6 MPa: the capped pressed's difference counts."""
    assert pressed.max_pressure > 6e6
    area = pressed.contact_area_corrected + 3e-7
    capped = changed(pressed, status=status, contact_area_corrected=area, max_pressure=6e6)
    monkeypatch.setattr(module, "sensitivity", made_up)
    monkeypatch.setattr(module, "solved_again", lambda *_, **__: capped)
    parts = {name: part.sources["plasticity"] for name, part in budget(BALL, pressed).numbers.items()}
    if status in (rf.Status.CONVERGED, rf.Status.CYCLED):
        assert parts["contact_area_corrected"] == pytest.approx(3e-7)
        assert parts["max_pressure"] == pytest.approx(pressed.max_pressure - 6e6)
    else:
        assert set(parts.values()) == {math.inf}


NAME = "lower.surface[0].height_scale"


def on_map(path: Path, scale: float = 1.0) -> rf.Scene:
    """The ball on a small plate read from a file."""
    scene = plate.scene(plate.worn(), load=1.0, points=(100, 75))
    return replace(scene, lower=rf.Body(plate.STEEL, plate.measured(path, height_scale=scale)))


def test_a_tolerance_of_the_height_scale_moves_mu_as_another_solve_does(tmp_path: Path) -> None:
    path = plate.write(plate.sampled(plate.worn(), plate.CLEAN, (100, 75)), tmp_path / "map.txt")
    scene = on_map(path)
    low, solution, high = (rf.solve(on_map(path, scale), 48) for scale in (0.9, 1.0, 1.1))
    check_tolerances(scene, {NAME: 0.1})
    derived = rf.sensitivity(scene, solution, [NAME])
    slope = derived.derivatives["friction_coefficient_corrected"][NAME]
    change = (high.friction_coefficient_corrected - low.friction_coefficient_corrected) / 0.2
    assert slope < 0  # rougher: less area under tau
    assert slope == pytest.approx(change, rel=0.15)  # quotients over 5 and 10 % differ by 13 %


def test_the_factor_is_of_heights_and_positive(tmp_path: Path) -> None:
    path = plate.write(plate.sampled(plate.worn(), plate.CLEAN, (40, 30)), tmp_path / "map.txt")
    one, two = (plate.measured(path, height_scale=scale).levelled((64e-6, 48e-6))[1] for scale in (1.0, 2.0))
    assert two == pytest.approx(2 * one)
    with pytest.raises(rf.InputError, match="height_scale"):
        plate.measured(path, height_scale=0.0)
