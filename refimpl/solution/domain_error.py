"""Parts of error bars by what a grid does not see: beyond its domain, between points of data, short waves."""

from __future__ import annotations

import math

from refimpl.accuracy.iteration_error import Uncertainty, reported_numbers
from refimpl.model.certificate import State
from refimpl.model.friction import friction_per_area
from refimpl.model.problem import Problem
from refimpl.scene.resolution import unresolved_slope
from refimpl.scene.scene import Scene
from refimpl.solution.data_error import data_error

_MOST_OUTSIDE = 0.5  # share of the contact found


def unseen_parts(problem: Problem, state: State, scene: Scene | None) -> Uncertainty:
    """Return the parts "border", "data" and "short waves" of each number not prescribed, in its unit.

    Without a scene nothing is known of either. A maximum pressure that is the hardness is exact.
    """
    if scene is None or not state.contact.any():
        return {}
    beyond = _outside(problem, state, scene)
    data, waves = (
        _by_area(problem, state, missed(scene, problem.grid)) for missed in (data_error, unresolved_slope)
    )
    exact = "max_pressure" if state.plastic_area else None
    prescribed = "normal_force" if problem.load is not None else "approach"
    return {
        name: {"border": beyond * abs(number), "data": data.get(name, 0.0) * abs(number)}
        | ({"short waves": waves[name] * abs(number)} if waves.get(name) else {})
        for name, number in reported_numbers(problem, state).items()
        if number and name not in (exact, prescribed) and (beyond or data.get(name) or waves.get(name))
    }


def _outside(problem: Problem, state: State, scene: Scene) -> float:
    """Return the share that the domain cuts off, as dense as along the border; infinite from half on."""
    grid = problem.grid
    border = grid.on_border(state.contact) if scene.continues else 0
    outside = border / (2 * sum(grid.shape)) * grid.nominal_area / state.contact_area
    return outside if outside < _MOST_OUTSIDE else math.inf


def _by_area(problem: Problem, state: State, share: float) -> dict[str, float]:
    """Return the shares of the numbers that move with the contact area; of mu tau's part moves."""
    per_area = friction_per_area(problem.friction, state.forces.normal)
    mu = state.friction_coefficient
    of_mu = min(per_area * state.contact_area / mu, 1.0) if mu > 0 else 0.0
    moved = dict.fromkeys(("contact_area", "plastic_area", "approach"), share)
    moved |= dict.fromkeys(("friction_coefficient", "friction_force"), of_mu * share)
    return moved | {"max_pressure": 2 * share}
