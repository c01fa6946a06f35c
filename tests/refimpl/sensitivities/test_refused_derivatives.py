"""Derivatives where there may be none: refused states and names, peaks that tie, steps kept in range."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.scene.parameters import with_parameter
from refimpl.sensitivities.budget import budget
from refimpl.sensitivities.fixed_contact import FixedContact, LinearResponse
from refimpl.sensitivities.sensitivity import Sensitivity, grid_sensitivity, sensitivity
from tests.changed import changed

STEEL = rf.Material(E=200e9, nu=0.3)
COPPER = rf.Material(118e9, 0.2)
ROUGH = replace(
    rf.read_scene("table1-smooth"),
    lower=rf.Body(COPPER, rf.GaussianRoughness(rms=8e-6, correlation_length=200e-6, seed=2)),
    friction=rf.Friction(tau=15e6, beta=0.2),
)


@pytest.fixture(scope="module")
def solution() -> rf.Solution:
    return rf.solve(ROUGH, 32)


@pytest.fixture(scope="module")
def found(solution: rf.Solution) -> Sensitivity:
    return sensitivity(ROUGH, solution)


@pytest.mark.parametrize(
    "other",
    [
        replace(ROUGH, friction=rf.Friction(tau=15e6, beta=0.1)),
        replace(ROUGH, upper=rf.Body(COPPER, ROUGH.upper.surface)),
        replace(ROUGH, sliding_direction=0.1),
        replace(ROUGH, side=1.6e-3),
        replace(ROUGH, load=70.01),
    ],
)
def test_a_solution_is_its_own_scenes(other: rf.Scene, solution: rf.Solution) -> None:
    with pytest.raises(rf.InputError, match="the scene's"):
        sensitivity(other, solution)


def test_states_without_derivatives_are_refused(solution: rf.Solution) -> None:
    flat_on_flat = replace(
        ROUGH, upper=rf.Body(STEEL, rf.Flat()), lower=rf.Body(COPPER, rf.Flat()), periodic=True
    )
    for scene, state, words in (
        (ROUGH, rf.solve(ROUGH, 32, approach=solution.approach), "load of 70 N"),
        (ROUGH, rf.solve(ROUGH, 16, approach=-1e-6), "contact"),
        (ROUGH, changed(solution, tolerance=1e-300), "certificate"),
        (flat_on_flat, rf.solve(flat_on_flat, 8), "solution = "),
        (ROUGH, 3, "solution = 3"),
        ("hertz", solution, "scene = "),
    ):
        with pytest.raises(rf.InputError, match=words):
            sensitivity(scene, state)  # type: ignore[arg-type]  # on purpose


def test_an_accuracy_that_was_not_reached_leaves_derivatives(solution: rf.Solution) -> None:
    """The state is as good as its certificate says, and what makes it uncertain is asked for all the more."""
    reached = changed(solution, status=rf.Status.ITERATION_LIMIT)
    assert not reached.converged
    assert reached.details.certified
    one, other = (sensitivity(ROUGH, s, ["friction.beta"]).derivatives for s in (reached, solution))
    assert one == other
    again = rf.solve(ROUGH, 48, start=reached)
    assert again.converged


def test_solves_that_do_not_converge_are_not_compared(
    solution: rf.Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = changed(solution, status=rf.Status.STAGNATED)
    monkeypatch.setattr(
        sys.modules["refimpl.sensitivities.difference_quotients"], "solve", lambda *args, **options: ended
    )
    with pytest.raises(ArithmeticError, match=r"load changed by 0\.1 ended as stagnated"):
        sensitivity(ROUGH, solution)


def test_a_linear_solve_that_fails_says_so(solution: rf.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    plain = FixedContact.response

    def unsolved(self: FixedContact, change: Any) -> LinearResponse:
        return plain(self, change)._replace(residual=0.1)

    monkeypatch.setattr(FixedContact, "response", unsolved)
    with pytest.raises(ArithmeticError, match=r"load is not found: 1\.0e-01"):
        sensitivity(ROUGH, solution)


def test_names_that_are_none_are_refused(found: Sensitivity) -> None:
    for number, parameter, named in (("mu", "load", "number"), ("contact_area_corrected", "P", "parameter")):
        with pytest.raises(rf.InputError) as refused:
            found.relative(number, parameter)
        assert refused.value.field == named


@pytest.mark.parametrize(
    ("tolerances", "sampling", "named"),
    [
        (["load"], None, "tolerances"),
        ({"lower.material.G": 0.02}, None, "tolerances.'lower.material.G'"),
        ({"load": 1.0}, None, "tolerances.'load'"),
        (None, 3.0, "sampling"),
        (None, {"mu": 1.0}, "sampling.'mu'"),
        (None, {"contact_area_corrected": -1.0}, "sampling.'contact_area_corrected'"),
        (None, {"friction_coefficient_corrected": "a"}, "sampling.'friction_coefficient_corrected'"),
    ],
)
def test_budgets_check_what_they_are_given(
    tolerances: Any, sampling: Any, named: str, solution: rf.Solution
) -> None:
    with pytest.raises(rf.InputError) as refused:
        budget(ROUGH, solution, tolerances, sampling)
    assert refused.value.field == named


def test_of_peaks_that_tie_the_middle_answers() -> None:
    """Four elements share the peak while shear displaces nothing; as it begins to, two rise and two fall."""
    lower = rf.Body(rf.Material(5e9, 0.5), rf.Flat())
    scene = replace(ROUGH, lower=lower, upper=rf.Body(rf.Material(1e100, 0.3), rf.Sphere(0.14)), load=5.0)
    name, step = "lower.material.nu", 1e-4
    below, at = (
        rf.solve(with_parameter(scene, name, 0.5 * s), 32, coupled=True, oblique=False, tolerance=1e-12)
        for s in (1 - step, 1)
    )
    assert np.count_nonzero(at.pressure > (1 - 1e-9) * at.max_pressure) == 4
    found, expected = grid_sensitivity(scene, at), (at.max_pressure - below.max_pressure) / (0.5 * step)
    middle, torn = (part["max_pressure"][name] for part in (found.derivatives, found.scatter))
    assert 0 < torn < 1.01 * abs(expected - middle) < 1.03 * torn  # from below the lowest of the answers


HARD = rf.Material(5e9, 0.3, hardness=1e9)


@pytest.mark.parametrize(
    "scene",
    [
        *(
            replace(ROUGH, lower=rf.Body(material, rf.Flat()))
            for material in (
                rf.Material(1e100, 0.3),
                rf.Material(5e9, -0.99995),
                rf.Material(5e9, 0.3, hardness=1e30),
            )
        ),
        rf.Scene(
            upper=rf.Body(STEEL, rf.Flat()),
            lower=rf.Body(HARD, rf.GaussianRoughness(2e-6, 4e-4, seed=3)),
            friction=rf.Friction(beta=0.2),
            load=0.95 * 1e9 * 1.6e-3**2,
            side=1.6e-3,
        ),
        replace(ROUGH, lower=rf.Body(COPPER, rf.GaussianRoughness(1e-7, ROUGH.side, seed=3, normalise=True))),
        replace(ROUGH, lower=rf.Body(COPPER, rf.GaussianRoughness(1e-30, 4e-4, seed=3))),
    ],
    ids=["E", "nu", "hardness", "load", "length", "rms"],
)
def test_steps_stay_within_what_is_allowed(scene: rf.Scene) -> None:
    found = sensitivity(scene, rf.solve(scene, 8))
    assert all(np.isfinite(value) for values in found.derivatives.values() for value in values.values())
