"""Warning of a solution whose undeformed surfaces are too steep for a half-space."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from refimpl.grid import Grid
from refimpl.half_space.model_form import SECOND_ORDER, ModelForm, model_form, steepness
from refimpl.model.certificate import State
from refimpl.model.problem import Problem

_REST = 0.25  # N times tan^2: with 0.2, which is stated, the largest left by 24 finite-element contacts
ALLOWED = 0.05  # stated error of N at a given approach
_FIRST = 0.7  # N's error over the slope's tangent for nu = 0: 0.53 to 0.68 measured at 15 to 2.5 degrees
_MARGIN = 1.5  # margin of the bound: 79 of 80 random contacts stay below it, the other states 0.6 %
_AROUND = 32  # least margin of the window around the contact, elements


def expected_error(problem: Problem) -> tuple[float, float]:
    """Return the steepest slope (rad) and the error of N at an approach that it lets expect.

    ``0.7 tan(slope)`` times (1 - 2 nu) / (1 - nu) by compliances: what a wave under a rigid flat loses.
    """
    tangent = math.sqrt(steepness(problem, np.ones(problem.grid.shape, dtype=bool)))
    return math.atan(tangent), _first_order(problem, tangent)


def _first_order(problem: Problem, tangent: float) -> float:
    shares = 1 - problem.pair.upper_share, problem.pair.upper_share
    bodies = problem.pair.lower, problem.pair.upper
    coupled = sum(s * (1 - 2 * b.nu) / (1 - b.nu) for s, b in zip(shares, bodies, strict=True) if s)
    return _FIRST * tangent * coupled


def half_space_excess(problem: Problem, state: State) -> tuple[float, str] | None:
    """Return the stated error of N and the warning's text where it exceeds `ALLOWED`; else None.

    A bound by the slopes alone comes first. What exceeds it is computed in a window twice as wide as the
    contact, which gives 0.99 to 1.01 of the whole grid's number.
    """
    steep = steepness(problem, state.contact)
    bound = _MARGIN * _first_order(problem, math.sqrt(steep)) + (_REST + SECOND_ORDER["normal_force"]) * steep
    if bound <= ALLOWED:
        return None
    error = _near_contact(problem, state)
    largest = error.normal_force + _REST * steep
    if largest <= ALLOWED:
        return None
    degrees = math.degrees(math.atan(math.sqrt(steep)))
    text = (
        f"undeformed surfaces have slopes of {degrees:.2g} degrees: the half-space misstates N at a given "
        f"approach by up to {largest:.1%}, above 5 %, and the approach under a load by "
        f"{error.approach:.1%}; see rough-friction appendix-a surface"
    )
    return largest, text


def _near_contact(problem: Problem, state: State) -> ModelForm:
    grid = problem.grid
    size = max(grid.window_around(state.contact, margin=0).shape)
    near = grid.window_around(state.contact, margin=max(size // 2, _AROUND))
    seen = problem.windowed(near)
    if near.shape != grid.shape:
        lengths = near.shape[0] * grid.spacings[0], near.shape[1] * grid.spacings[1]
        seen = replace(seen, grid=Grid(near.shape, lengths))
    moved = state.displacement_lower[near.slices], state.displacement_upper[near.slices]
    return model_form(seen, state.pressure[near.slices], state.traction[near.slices], moved, state.approach)
