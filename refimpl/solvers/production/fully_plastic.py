"""The state with every element at the hardness: loads that it shows to be beyond what contact carries."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from refimpl.grid import Array
from refimpl.model.certificate import State, approach_from, certify
from refimpl.model.elasticity import Influence
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.influence import whole_grid_influence
from refimpl.solvers.production.anderson import AndersonMixing
from refimpl.solvers.production.constants import SETTLED, SETTLING_LIMIT

_LEAST_SHARE = 0.1  # share of the hardness on the whole domain; slopes of 84 degrees would carry no more
_ROUNDING = 1e-12  # relative, of the load of that state
_MARGIN = 1e-4  # share of that load; elements below the hardness leave smaller slopes on others, to 6e-6
#                 more was carried in 26 random scenes, each at eight approaches


def at_hardness(problem: Problem) -> State | None:
    """Return the state with every element at the hardness if that carries the load, or less; else None.

    Found before any iteration: its pressure is known, and slopes and plastic indentation take no transforms.
    Where it carries less than the load, its certificate says so.
    """
    most = problem.cap * problem.grid.nominal_area
    if problem.load is None or problem.load <= _LEAST_SHARE * most:
        return None
    operator = whole_grid_influence(problem.grid, problem.direction, problem.grid.window)
    state = fully_plastic(problem, operator)
    excess = problem.load / state.forces.normal - 1
    return state if abs(excess) <= _ROUNDING or excess > _MARGIN else None


def fully_plastic(problem: Problem, operator: Influence) -> State:
    """Return the state with every element at the hardness, at the least approach that it has."""
    f = np.full(problem.gap.shape, problem.cap)
    r = problem.friction.traction(f, f > 0)
    lower, upper = problem.displacements(operator, f, r, Slopes.flat(f.shape))
    u = lower + upper

    def indentation(slopes: Slopes) -> Array | None:
        approach = approach_from(f, slopes.per_cosine_product(u) + problem.gap, problem.cap)
        return problem.indentation(f, u, slopes.cosine_product, approach)

    depth, slopes = settled_indentation(problem, lower, upper, indentation, Slopes.flat(f.shape))
    return certify(problem, operator, f, r, slopes, depth)


def settled_indentation(
    problem: Problem,
    lower: Array,
    upper: Array,
    indentation: Callable[[Slopes], Array | None],
    slopes: Slopes,
) -> tuple[Array | None, Slopes]:
    """Return the plastic indentation and the slopes of the surface that it lowers, each from the other.

    An indentation changes with the cosines by ``approach - h``, and the slopes by its differences: on
    elements smaller than that depth plain updates of one by the other diverge. They are mixed instead, which
    takes no transform. ``slopes`` are a first guess.
    """
    found = indentation(slopes)
    slopes = problem.slopes(lower, upper, found)
    if found is None:
        return found, slopes
    mixing, first = AndersonMixing(), math.inf
    for _ in range(SETTLING_LIMIT):
        requested = np.asarray(indentation(slopes))
        change = float(np.abs(requested - found).max())
        first = min(first, change) if math.isinf(first) else first
        if change <= SETTLED * first or change == 0:
            break
        found = mixing.next(found, requested)
        slopes = problem.slopes(lower, upper, found)
    return found, slopes
