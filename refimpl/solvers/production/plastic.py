"""Plastic indentation between updates, and the state with every element at the hardness."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from refimpl.grid import Array
from refimpl.model.certificate import State, approach_from, certify
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import Counter
from refimpl.operators.influence import whole_grid_influence
from refimpl.solvers.production.anderson import AndersonMixing
from refimpl.solvers.production.constants import SETTLED, SETTLING_LIMIT

_LEAST_SHARE = 0.1  # share of the hardness on the whole domain; slopes of 84 degrees would carry no more
_ROUNDING = 1e-12  # relative, of the load of that state


def at_hardness(problem: Problem, counter: Counter) -> State | None:
    """Return the state with every element at the hardness, or None if it carries more than the load.

    No element is free to balance the load. Of many such states it has the least approach; where it carries
    less its certificate says so.
    """
    most = problem.cap * problem.grid.nominal_area
    if problem.load is None or problem.load <= _LEAST_SHARE * most:
        return None
    operator = whole_grid_influence(problem.grid, problem.direction, problem.grid.window, counter)
    f = np.full(problem.gap.shape, problem.cap)
    r = problem.friction.traction(f, f > 0)
    lower, upper = problem.displacements(operator, f, r, Slopes.flat(f.shape))
    u = lower + upper

    def indentation(slopes: Slopes) -> Array | None:
        approach = approach_from(f, slopes.per_cosine_product(u) + problem.gap, problem.cap)
        return problem.indentation(f, u, slopes.cosine_product, approach)

    depth, slopes = settled_indentation(problem, lower, upper, indentation, Slopes.flat(f.shape))
    state = certify(problem, operator, f, r, slopes, depth)
    return state if state.forces.normal <= problem.load * (1 + _ROUNDING) else None


def settled_indentation(
    problem: Problem,
    lower: Array,
    upper: Array,
    indentation: Callable[[Slopes], Array | None],
    slopes: Slopes,
) -> tuple[Array | None, Slopes]:
    """Return the plastic indentation and the slopes of the surface that it lowers, each from the other.

    On elements smaller than the depth plain updates diverge; they are mixed, which takes no transform.
    """
    found = indentation(slopes)
    slopes = problem.slopes(lower, upper, found)
    if found is None:
        return found, slopes
    mixing, first = AndersonMixing(), math.inf
    for _ in range(SETTLING_LIMIT):
        requested = np.asarray(indentation(slopes))
        change = float(np.abs(requested - found).max())
        first = change if math.isinf(first) else first
        if change <= SETTLED * first or change == 0:
            break
        found = mixing.next(found, requested)
        slopes = problem.slopes(lower, upper, found)
    return found, slopes
