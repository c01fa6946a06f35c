"""The half-space's warning looks at the contact's surroundings, and finds what the whole grid has."""

from __future__ import annotations

import pytest

import refimpl as rf
from refimpl.half_space.model_form import steepness

SHARP = rf.Body(rf.Material(E=210e9, nu=0.3), rf.Sphere(4e-3))


def warned(rms: float) -> tuple[rf.Solution, list[float]]:
    """A ball on a rough soft body, and the numbers of its half-space warnings."""
    rough = rf.GaussianRoughness(rms=rms, correlation_length=40e-6, seed=3)
    soft = rf.Body(rf.Material(E=3e9, nu=0.1), rough)
    scene = rf.Scene(SHARP, soft, friction=rf.Friction(tau=1e6, beta=0.1), load=0.3, side=1e-3)
    solution = rf.solve(scene, 160)
    found = [text.number for text in solution.warnings if text.limit == "half-space"]
    return solution, [number for number in found if number is not None]


def test_steep_surfaces_are_warned_of_with_the_number_of_the_whole_grid() -> None:
    solution, (number,) = warned(8e-6)
    details = solution.details
    whole = details.model_form.normal_force + 0.25 * steepness(details.problem, solution.contact)
    assert number > 0.05
    assert number == pytest.approx(whole, rel=0.05)


def test_gentle_surfaces_are_not() -> None:
    assert warned(0.2e-6)[1] == []
