"""Nested grids: the problem on halved grids, and pressures carried from one to the next."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from refimpl.grid import Array, Grid, resampled
from refimpl.model.friction import Mask
from refimpl.model.problem import Problem
from refimpl.solvers.production.projected_cg import FIRST_LENGTH, Apply

_COARSEST = 32  # elements per side where nesting starts
_COARSEST_OF_TWO = 16  # the same of grids that would have no coarser one
_QUARTERED = 128  # elements per side up to which a grid of half as many costs more than it spares


class Start(NamedTuple):
    """One grid's answer: pressure (Pa) and the pair's displacement ``v - h`` (m), both ``(M, M)``.

    ``approach`` (m) is None where heights were sampled anew: grids differ in where they see first touch.
    ``strong`` says that updates had to be mixed (`refimpl.solvers.production.level`): finer grids feed back
    even more.
    """

    pressure: Array
    displacement: Array
    approach: float | None
    strong: bool = False

    @property
    def M(self) -> int:
        """Elements per side."""
        return len(self.pressure)


def levels(problem: Problem, above: int) -> list[Problem]:
    """The problem on halved or quartered grids finer than ``above``, coarsest first."""
    nested = [problem]
    lowest = _COARSEST_OF_TWO
    while (M := _coarser(nested[0].grid.M)) >= max(lowest, above + 1):
        coarse = coarsened(nested[0])
        nested.insert(0, coarse if coarse.grid.M == M else coarsened(coarse))
        lowest = _COARSEST
    return nested


def _coarser(M: int) -> int:
    """Half as many elements per side, rounded up; of a small grid a quarter if those are enough."""
    half = (M + 1) // 2
    quarter = (half + 1) // 2
    return quarter if M <= _QUARTERED and quarter >= _COARSEST else half


def coarsened(fine: Problem) -> Problem:
    """The problem on half as many elements per side, rounded up: means of four where that number is even."""
    M = (fine.grid.M + 1) // 2
    seen = fine.terms.oblique  # nothing but slopes looks at the common surface
    return replace(
        fine,
        grid=Grid(fine.grid.side, M),
        gap=resampled(fine.gap, M),
        mean_surface=resampled(fine.mean_surface, M) if seen else np.broadcast_to(0.0, (M, M)),
    )


def foundation_pressure(problem: Problem) -> Array:
    """A pressure to start from: that of springs under the interference at the approach, or at the load.

    At a prescribed approach it may be none at all: a coarse grid's means can lie above it, and touch nothing.
    """
    load, dA = problem.load, problem.grid.element_area
    depth = problem.approach if problem.approach is not None else _bearing(problem)
    interference = np.maximum(depth - problem.gap, 0.0)
    if load is not None and not interference.any():  # flat on flat, in any unit: the load sets the scale
        interference = np.ones_like(problem.gap)
    pressure: Array = interference / (problem.pair.normal_compliance * problem.grid.side)
    if load is not None:
        pressure *= load / (dA * pressure.sum())
    return pressure


def _bearing(problem: Problem) -> float:
    """The least depth at which springs bear the load (m), of all that are as deep as some element.

    Springs are as stiff as a half-space under a load of their width, ``1 / (compliance width)``. On 32 x 32
    elements 0.6 or 2.5 times the width cost CG a sixth more steps (measured), and contact on 3 of 10 whatever
    the load up to twelve times as many (see the tests).
    """
    assert problem.load is not None
    lowest = np.sort(problem.gap, axis=None)
    area = problem.grid.element_area * np.arange(1, lowest.size + 1)
    volume = area * lowest - problem.grid.element_area * np.cumsum(lowest)
    borne = np.maximum.accumulate(volume / (problem.pair.normal_compliance * np.sqrt(area)))
    return float(lowest[min(int(np.searchsorted(borne, problem.load)), lowest.size - 1)])


def touching(pressure: Array, v: Array, approach: float | None, problem: Problem) -> tuple[Mask, float]:
    """Elements in contact after a damped Jacobi step from a prolonged pressure; the approach if not known.

    ``v`` is the prolonged displacement plus the grid's gap; what it misses of the approach is of the grid's
    highest frequency ``q = pi / spacing``, where ``a`` is ``2 compliance spacing``. No operator is applied.
    """
    stiffness = 0.5 / (2 * problem.pair.normal_compliance * problem.grid.spacing)
    freed = pressure - stiffness * v
    if approach is None:
        approach = _balancing(freed, stiffness, float(pressure.sum()))
    found: Mask = freed + stiffness * approach > 0
    return found, approach


def _balancing(freed: Array, stiffness: float, total: float) -> float:
    """The approach at which ``max(freed + stiffness approach, 0)`` adds up to the total.

    Newton's steps, from all elements on: the function is convex with the number of those that press for a
    slope, so steps come from above and this number falls until it stays, which is the solution.
    """
    pressing, fewest = freed, freed.size + 1
    while pressing.size < fewest:
        fewest = pressing.size
        approach = (total - float(pressing.sum())) / (stiffness * fewest)
        pressing = freed[freed > -stiffness * approach]
    return approach


def sharpened(pressure: Array, misfit: Array, contact: Mask, precondition: Apply, *, loaded: bool) -> Array:
    """A prolonged pressure with the grid's own detail: a preconditioned step, no operator applied.

    ``misfit`` is what ``v`` of `touching` lacks of the approach; the step keeps the load if there is one.
    """
    residual = _level(misfit * contact, contact, loaded)
    step = _level(precondition(residual) * contact, contact, loaded)
    raised: Array = (pressure + FIRST_LENGTH * step) * contact
    return np.maximum(raised, 0.0)


def _level(values: Array, contact: Mask, loaded: bool) -> Array:
    return values - values.sum() / np.count_nonzero(contact) * contact if loaded else values
