"""Error of the half-space in a solution's numbers: the scene solved again with its surfaces' recession.

The undeformed surfaces change the displacements at first order in their slopes
(`refimpl.half_space.boundary_perturbation`). That change, taken at the solved tractions, is a change of the
heights: the scene is solved again with it, under the load and at the approach. What is left is of second
order, and bounded by a factor times the mean square slope, fitted to finite elements. Finite strain adds a
share of the first order, from neo-Hookean bodies.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from refimpl.errors import NotConverged
from refimpl.grid import Array
from refimpl.half_space.boundary_perturbation import gap_changes
from refimpl.half_space.model_form import FINITE_STRAIN, SECOND_ORDER, contact_of, steepness
from refimpl.scene.discretise import discretise
from refimpl.scene.scene import Body, Scene
from refimpl.sensitivities.difference_quotients import solved_again
from refimpl.solution.solution import Solution
from refimpl.surfaces import ArraySurface

ACCEPTED = 0.02  # relative: the paper's "less than 2 %"
JUDGED_TO = 20.0  # degrees: the steepest of the 56 contacts that the advice was judged on
UNDER_LOAD = (
    "approach",
    "friction_coefficient_corrected",
    "friction_coefficient",
    "contact_area",
    "max_pressure",
    "binormal_force",
)


@dataclass(frozen=True)
class HalfSpaceError:
    """Model-form error of the half-space in each number, in the number's unit.

    first_order : signed change of the number once the surfaces' own shape enters; the normal force's is at
        the solution's approach, all others' under its load (or at its approach, where that is prescribed)
    second_order, finite_strain : bounds on what the first order leaves, not negative
    gap_change : how far the surfaces recede, both together (m), the grid's shape
    corrected : the scene solved with it
    """

    first_order: Mapping[str, float]
    second_order: Mapping[str, float]
    finite_strain: Mapping[str, float]
    gap_change: Array
    corrected: Solution

    def stated(self, number: str) -> float:
        """Return the stated model-form error of a number: all three parts."""
        return abs(self.first_order[number]) + self.second_order[number] + self.finite_strain[number]


def half_space_error(scene: Scene, solution: Solution) -> HalfSpaceError:
    """Estimate the half-space's error in approach, N, mu, A, p_max and Q of a solution.

    Costs at most two solves on the solution's grid. Raises `NotConverged` where one does not converge.
    """
    problem = solution.details.problem
    z_lower, z_upper = problem.heights
    first = solution.approach + problem.datum  # from the first contact of the scene as given
    moved = z_lower - solution.surfaces[0], solution.surfaces[1] - z_upper + first
    lower, upper = gap_changes(contact_of(problem, solution.pressure, solution.traction, moved))
    receded = replace(
        scene,
        lower=Body(scene.lower.material, _surface(z_lower - lower, solution)),
        upper=Body(scene.upper.material, _surface(z_upper + upper, solution)),
        sliding_offset=0.0,  # the heights were sampled at the scene's
    )
    gap = z_upper - z_lower + lower + upper
    shifted = discretise(receded, solution.grid)
    datum = shifted.datum + float(gap.min())  # approach of the changed scene
    corrected = _solved(receded, solution, None if problem.approach is None else first - datum)
    sunk = corrected.approach + datum
    change = {
        name: getattr(corrected, name) - getattr(solution, name) for name in UNDER_LOAD if name != "approach"
    }
    change["approach"] = sunk - first
    if problem.approach is None:
        there = _solved(receded, solution, first - datum)
        change["normal_force"] = there.normal_force - solution.normal_force
    else:
        change["normal_force"] = corrected.normal_force - solution.normal_force
    size = {name: abs(getattr(solution, name)) for name in change} | {"approach": abs(first)}
    size["binormal_force"] = abs(solution.friction_force)
    second = {name: SECOND_ORDER[name] * steepness(problem, solution.contact) * size[name] for name in change}
    finite = {name: FINITE_STRAIN * abs(change[name]) for name in change}
    return HalfSpaceError(change, second, finite, lower + upper, corrected)


def _surface(heights: Array, solution: Solution) -> ArraySurface:
    return ArraySurface(np.ascontiguousarray(heights), pixel=solution.grid.spacings)


def _solved(scene: Scene, solution: Solution, approach: float | None) -> Solution:
    found = solved_again(scene, solution, plastic=solution.details.problem.terms.plastic, approach=approach)
    if not found.converged:
        raise NotConverged(f"the solve with the surfaces' recession ended as {found.status.value}")
    return found


def advice(error: HalfSpaceError, solution: Solution) -> str:
    """Return advice by the rule of docs/half-space-limits.md for each number: keep, correct, finite elements.

    One sentence where all numbers may be kept, or where slopes are beyond those judged.
    """
    names = "friction_coefficient", "contact_area", "max_pressure", "approach", "normal_force"
    size = {name: abs(getattr(solution, name)) for name in names}
    size["approach"] = abs(solution.approach + solution.details.problem.datum)
    stated = {name: error.stated(name) / value for name, value in size.items() if value}
    slope = math.degrees(math.atan(math.sqrt(steepness(solution.details.problem, solution.contact))))
    if slope > JUDGED_TO:
        return f"slopes of {slope:.2g} degrees, beyond the {JUDGED_TO:g} judged: use finite elements"
    if (worst := max(stated.values())) <= ACCEPTED:
        return f"keep the half-space: no number is off by more than {worst:.1%}"
    kept: list[str] = []
    correct: list[str] = []
    elements: list[str] = []
    for name, share in stated.items():
        left = (error.second_order[name] + error.finite_strain[name]) / size[name]
        said = f"{name.replace('_', ' ')} ({share:.1%}"
        if share <= ACCEPTED:
            kept.append(f"{said})")
        else:
            (correct if left <= ACCEPTED else elements).append(f"{said}, corrected {left:.1%})")
    parts = {
        f"keep, off by at most {ACCEPTED:.0%}: ": kept,
        "take the corrected, slope_correction is no substitute: ": correct,
        "use finite elements: ": elements,
    }
    return "; ".join(words + ", ".join(found) for words, found in parts.items() if found)
