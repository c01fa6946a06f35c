"""Plastic indentation and slopes, each from the other, between two updates of the lagged terms."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from refimpl.grid import Array
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.solvers.production.anderson import AndersonMixing
from refimpl.solvers.production.constants import SETTLED, SETTLING_LIMIT


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
