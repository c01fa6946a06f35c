"""A budget from derivatives made up by hand, of either sign, and what is kept of the linear solves."""

from __future__ import annotations

import importlib
import math
from dataclasses import replace
from types import SimpleNamespace

import pytest

import refimpl as rf
from refimpl.sensitivities.budget import budget
from refimpl.sensitivities.sensitivity import NUMBERS, Sensitivity

# by its module's name: the package has a function of the same name
module = importlib.import_module("refimpl.sensitivities.budget")
SCENE = rf.Scene(
    upper=rf.Body(rf.Material(7e9, 0.2), rf.Sphere(0.05)),
    lower=rf.Body(rf.Material(2e9, 0.35, hardness=6e6), rf.Flat()),
    friction=rf.Friction(tau=1e6, beta=0.2),
    load=5.0,
    side=4e-3,
)


@pytest.fixture(scope="module")
def solution() -> rf.Solution:
    return rf.solve(SCENE, 24, plastic=False)


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
    along: float, across: float | None, solution: rf.Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Tolerances of 10 % of E and of tau: |-2| 0.1, 4 0.1; moduli wrong by 3 %, the worst: |3 - 2| 0.03."""
    monkeypatch.setattr(module, "sensitivity", made_up)
    bars = {name: {"iteration": 0.25, "discretisation": 0.5} for name in NUMBERS}
    wrong = replace(solution.slope_error, at_rms=along, across_at_rms=across)
    given = replace(solution, uncertainty=bars, slope_error=wrong)
    found = budget(SCENE, given, {"upper.material.E": 0.1, "friction.tau": 0.1}, {"contact_area": 2.0})
    assert set(found.numbers) == set(NUMBERS)
    for number, part in found.numbers.items():
        assert part.inputs == pytest.approx({"upper.material.E": 0.2, "friction.tau": 0.4})
        assert part.input == pytest.approx(math.sqrt(0.2))
        assert part.numerical == pytest.approx(0.75)
        assert part.sources["coefficients"] == pytest.approx(0.03)
        assert min(part.sources.values()) >= 0
        assert part.sampling == (2.0 if number == "contact_area" else None)
        sampled = 4.0 if number == "contact_area" else 0.0
        model = sum(part.sources.values())
        assert part.total == pytest.approx(model + math.sqrt(0.75**2 + 0.2 + sampled))
    assert {name: part.value for name, part in found.numbers.items()} == {
        name: getattr(solution, name) for name in NUMBERS
    }


def test_slopes_beyond_the_table_have_no_bound(
    solution: rf.Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "sensitivity", made_up)
    steep = replace(solution, slope_error=replace(solution.slope_error, at_rms=None))
    for part in budget(SCENE, steep).numbers.values():
        assert part.sources["coefficients"] == math.inf == part.total


def test_the_half_space_counts_beyond_what_coefficients_count(
    solution: rf.Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Moduli wrong by 3 % change each number by |3 - 2| 0.03; what is stated beyond that counts."""
    stated = dict(zip(NUMBERS, (0.05, 0.02, 7.0, 0.03), strict=True))
    monkeypatch.setattr(module, "sensitivity", made_up)
    monkeypatch.setattr(module, "half_space_error", lambda *_: SimpleNamespace(stated=stated.__getitem__))
    given = replace(solution, slope_error=replace(solution.slope_error, at_rms=0.03, across_at_rms=None))
    found = [part.sources["half-space"] for part in budget(SCENE, given).numbers.values()]
    assert found == pytest.approx([0.02, 0.0, 6.97, 0.0])

    def fails(*_: object) -> None:
        raise ArithmeticError

    monkeypatch.setattr(module, "half_space_error", fails)
    assert {part.sources["half-space"] for part in budget(SCENE, given).numbers.values()} == {math.inf}


def test_a_load_that_no_hardness_bears_has_no_bound_and_a_capped_one_no_difference(
    solution: rf.Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    """6 MPa on 4 x 4 mm bear 96 N."""
    monkeypatch.setattr(module, "solved_again", lambda *_, **__: solution)
    for load, change in ((96.1, math.inf), (95.9, 0.0)):
        assert module._plasticity(replace(SCENE, load=load), solution) == dict.fromkeys(NUMBERS, change)
    terms = replace(solution.problem.terms, plastic=True)
    assert module._plasticity(SCENE, replace(solution, problem=solution.problem.with_terms(terms))) == {}


@pytest.mark.parametrize("status", list(rf.Status))
def test_a_capped_solve_that_fails_bounds_nothing(
    solution: rf.Solution, monkeypatch: pytest.MonkeyPatch, status: rf.Status
) -> None:
    """The peak of 10 MPa exceeds the hardness, 6 MPa: the capped solution's difference counts."""
    assert solution.max_pressure > 6e6
    capped = replace(solution, status=status, contact_area=solution.contact_area + 3e-7, max_pressure=6e6)
    monkeypatch.setattr(module, "sensitivity", made_up)
    monkeypatch.setattr(module, "solved_again", lambda *_, **__: capped)
    parts = {name: part.sources["plasticity"] for name, part in budget(SCENE, solution).numbers.items()}
    if status in (rf.Status.CONVERGED, rf.Status.CYCLED):
        assert parts["contact_area"] == pytest.approx(3e-7)
        assert parts["max_pressure"] == pytest.approx(solution.max_pressure - 6e6)
    else:
        assert set(parts.values()) == {math.inf}
