"""The solution: every number that follows from an outcome and its certified state."""

from __future__ import annotations

import math

import numpy as np

from refimpl.accuracy.first_contact import POWERS
from refimpl.accuracy.iteration_error import AREAS, merged
from refimpl.model.certificate import State
from refimpl.model.forces import perimeter_corrected_area
from refimpl.model.problem import Problem
from refimpl.model.state import Outcome, Status, Visited
from refimpl.planning.effects_after import effects_left_out, uncertainty_left_out
from refimpl.planning.plan import Plan
from refimpl.solution.influence_error import slope_error
from refimpl.solution.solution import Cost, Solution


def gathered(
    problem: Problem,
    plan: Plan,
    outcome: Outcome,
    state: State,
    tolerance: float,
    cost: Cost,
) -> Solution:
    """A problem's solution from its outcome and certified state; the status yields to the certificate."""
    grid, contact = problem.grid, state.pressure > 0
    load = problem.load if problem.load is not None else state.forces.normal
    surface_lower, surface_upper = problem.heights
    surface_lower -= state.displacement_lower
    surface_upper += state.displacement_upper
    surface_upper -= state.approach
    found = Visited(
        friction_coefficient=state.forces.friction / load if load else math.nan,
        contact_area=float(np.count_nonzero(contact)) * grid.element_area,
    )
    unlawful = state.certificate.unlawful * problem.friction.tau * grid.element_area / load if load else 0.0
    changes = effects_left_out(plan.left_out, problem, state.pressure, plan.outlook)
    largest = float(state.pressure.max())
    total = float(state.pressure.sum())
    follows = (
        {"approach": state.approach}
        if problem.load is not None
        else {"normal_force": POWERS["normal_force"] * state.forces.normal}
    )
    return Solution(
        status=_final_status(outcome.status, state, tolerance),
        approach=state.approach - (float(problem.gap.mean()) if problem.periodic else 0.0),
        normal_force=state.forces.normal,
        friction_force=state.forces.friction,
        binormal_force=state.forces.binormal,
        friction_coefficient=found.friction_coefficient,
        contact_area=found.contact_area,
        contact_area_corrected=perimeter_corrected_area(contact, grid.spacing, periodic=problem.periodic),
        max_pressure=largest,
        pressure=state.pressure,
        traction=state.traction,
        slopes=state.slopes,
        surface_lower=surface_lower,
        surface_upper=surface_upper,
        separation=surface_upper - surface_lower,
        clearance=state.clearance,
        withheld=outcome.withheld,
        slope_error=slope_error(
            state.slopes.tan_x, state.slopes.tan_y, state.pressure, problem.pair.lower, problem.pair.upper
        ),
        grid=grid,
        friction=problem.friction,
        sliding_direction=problem.direction,
        certificate=state.certificate,
        tolerance=tolerance,
        uncertainty=merged(
            _spread_by_support(outcome, found, unlawful, load),
            uncertainty_left_out(
                changes,
                float(state.traction.sum()) / total if total else 0.0,
                load,
                dict.fromkeys(AREAS, found.contact_area) | {"max_pressure": largest} | follows,
            ),
        ),
        plan=plan,
        left_out=changes,
        problem=problem,
        warnings=(),
        cost=cost,
    )


def _final_status(status: Status, state: State, tolerance: float) -> Status:
    """A loop that ended well still fails on a failed certificate."""
    if status in (Status.CONVERGED, Status.CYCLED) and not state.certificate.meets(tolerance):
        return Status.STAGNATED
    return status


def _spread_by_support(
    outcome: Outcome, found: Visited, unlawful: float, load: float
) -> dict[str, dict[str, float]]:
    """How far mu, F and the areas of the states of tau's cycles lie from the settled ones.

    For mu no less than tau on all elements that have it against the law: where tau comes on with pressure,
    however soon, they bear a share of it (see `verification.cases.sliding.tau_shares`).
    """
    spread = {
        name: max((abs(getattr(v, name) - getattr(found, name)) for v in outcome.visited), default=0.0)
        for name in Visited._fields
    }
    spread["friction_coefficient"] = max(spread["friction_coefficient"], unlawful)
    spread["friction_force"] = spread["friction_coefficient"] * load
    spread |= dict.fromkeys(AREAS, spread["contact_area"])
    return {name: {"tau support": width} for name, width in spread.items() if width > 0}
