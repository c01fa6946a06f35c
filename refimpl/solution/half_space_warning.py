"""Warning of a solution whose undeformed surfaces are too steep for a half-space."""

from __future__ import annotations

import math

from refimpl.model.certificate import State
from refimpl.model.problem import Problem
from refimpl.solution.model_form import model_form, steepness

ALLOWED = 0.05  # stated error of N at a given approach
GENTLE = 1e-3  # tan^2 of the steepest slopes (1.8 degrees): N is off by 0.7 times the tangent at most (nu 0)


def half_space_excess(problem: Problem, state: State) -> tuple[float, str] | None:
    """Return the stated error of N and the warning's text where it exceeds `ALLOWED`; else None.

    Surfaces below `GENTLE` are not computed: they stay below half of `ALLOWED`.
    """
    steep = steepness(problem, state.contact)
    if steep < GENTLE:
        return None
    moved = state.displacement_lower, state.displacement_upper
    error = model_form(problem, state.pressure, state.traction, moved, state.approach)
    if error.normal_force <= ALLOWED:
        return None
    degrees = math.degrees(math.atan(math.sqrt(steep)))
    text = (
        f"undeformed surfaces have slopes of {degrees:.2g} degrees: the half-space misstates N at a given "
        f"approach by {error.normal_force:.1%}, above 5 %, and the approach under a load by "
        f"{error.approach:.1%}; see rough-friction appendix-a surface"
    )
    return error.normal_force, text
