"""Warning of a solution whose undeformed surfaces are too steep for a half-space."""

from __future__ import annotations

import math

import numpy as np

from refimpl.half_space.model_form import model_form, steepness
from refimpl.model.certificate import State
from refimpl.model.problem import Problem

_REST = 0.25  # N times tan^2: with 0.2, which is stated, the largest left by 24 finite-element contacts
ALLOWED = 0.05  # stated error of N at a given approach
_FIRST = 0.7  # N's error over the slope's tangent for nu = 0: 0.53 to 0.68 measured at 15 to 2.5 degrees
GENTLE = 1e-3  # tan^2 of the steepest slopes (1.8 degrees), where N is off by 2.2 % at most


def expected_error(problem: Problem) -> tuple[float, float]:
    """Return the steepest slope (rad) and the error of N at a given approach that it lets expect, unsolved.

    ``0.7 tan(slope)`` times the sum of ``(1 - 2 nu) / (1 - nu)``, weighted by the bodies' compliances: what a
    wave under a rigid flat loses.
    """
    tangent = math.sqrt(steepness(problem, np.ones(problem.grid.shape, dtype=bool)))
    shares = 1 - problem.pair.upper_share, problem.pair.upper_share
    bodies = problem.pair.lower, problem.pair.upper
    coupled = sum(s * (1 - 2 * b.nu) / (1 - b.nu) for s, b in zip(shares, bodies, strict=True) if s)
    return math.atan(tangent), _FIRST * tangent * coupled


def half_space_excess(problem: Problem, state: State) -> tuple[float, str] | None:
    """Return the stated error of N and the warning's text where it exceeds `ALLOWED`; else None.

    Surfaces below `GENTLE` are not computed: they stay below half of `ALLOWED`.
    """
    steep = steepness(problem, state.contact)
    if steep < GENTLE:
        return None
    moved = state.displacement_lower, state.displacement_upper
    error = model_form(problem, state.pressure, state.traction, moved, state.approach)
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
