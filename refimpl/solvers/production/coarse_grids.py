"""Nested grids: the problem on coarser grids, and initial guesses carried from one grid to the next."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from refimpl.grid import Array, Mask, Shape, resampled
from refimpl.model.problem import Problem
from refimpl.operators.preconditioner import Apply
from refimpl.solvers.production.constants import (
    CAPPED_STEP,
    COARSE_SIDE,
    COARSE_TOLERANCE,
    COARSEST,
    COARSEST_OF_TWO,
    FIRST_LENGTH,
    QUARTERED,
)


class InitialGuess(NamedTuple):
    """One grid's solution as an initial guess for a finer grid; arrays of the coarser grid's shape.

    pressure : f (Pa)
    displacement : ``v - h`` of the pair (m)
    approach : m from first contact, or None where heights were sampled anew: grids differ in it
    needs_mixing : whether updates of the lagged terms were mixed; on finer grids they feed back more
    """

    pressure: Array
    displacement: Array
    approach: float | None
    needs_mixing: bool = False

    @property
    def shape(self) -> Shape:
        """Numbers of elements along x and y."""
        return self.pressure.shape[0], self.pressure.shape[1]


def nested_problems(problem: Problem, above: Shape | None) -> list[Problem]:
    """Return the problem on coarser and coarser grids that are finer than ``above``, coarsest first."""
    nested = [problem]
    lowest = COARSEST_OF_TWO
    while True:
        shape = _coarser(nested[0].grid.shape)
        finer = above is None or math.prod(shape) > math.prod(above)
        if min(shape) < lowest or not finer:
            return nested
        nested.insert(0, coarsened(nested[0], shape))
        lowest = COARSEST


def _coarser(shape: Shape) -> Shape:
    """Return half as many elements per axis, rounded up; of a small grid a quarter, if enough."""
    half = tuple((n + 1) // 2 for n in shape)
    quarter = tuple((n + 1) // 2 for n in half)
    n, m = quarter if max(shape) <= QUARTERED and min(quarter) >= COARSEST else half
    return n, m


def coarse_tolerance(shape: Shape) -> float:
    """Return the residual of a coarse grid, below the error of the next start's interpolation.

    >>> coarse_tolerance((256, 256)), coarse_tolerance((1024, 512))
    (0.001, 0.0005)
    """
    return COARSE_TOLERANCE * min(1.0, COARSE_SIDE / max(shape))


def coarsened(fine: Problem, shape: Shape) -> Problem:
    """Return the problem on a coarser grid, halved as often as needed."""
    while fine.grid.shape != shape:
        n, m = fine.grid.shape
        grid = fine.grid.refined(((n + 1) // 2, (m + 1) // 2))
        gap = resampled(fine.gap, grid.shape)
        # only slopes look at the common surface
        surface = (
            resampled(fine.mean_surface, grid.shape)
            if fine.terms.oblique
            else np.broadcast_to(0.0, gap.shape)
        )
        fine = replace(fine, grid=grid, gap=gap, mean_surface=surface)
    return fine


def winkler_pressure(problem: Problem) -> Array:
    """Return a Winkler foundation's pressure at the approach, where it may vanish, or the load (Pa)."""
    load, dA = problem.load, problem.grid.element_area
    depth = problem.approach if problem.approach is not None else _bearing_depth(problem)
    interference = np.maximum(depth - problem.gap, 0.0)
    if load is not None and not interference.any():  # flat on flat: the load alone sets the pressure
        interference = np.ones_like(problem.gap)
    pressure: Array = interference / problem.elasticity.mean_compliance(problem.grid)
    if load is not None:
        pressure *= load / (dA * pressure.sum())
    return pressure


def _bearing_depth(problem: Problem) -> float:
    """Return the least depth of an element at which the foundation bears the load (m).

    Its stiffness is a half-space's under a contact of that width; 0.6 or 2.5 times cost a sixth more steps.
    """
    assert problem.load is not None
    dA = problem.grid.element_area
    lowest = np.sort(problem.gap, axis=None)
    area = dA * np.arange(1, lowest.size + 1)
    volume = area * lowest - dA * np.cumsum(lowest)
    compliance = problem.elasticity.mean_compliance(problem.grid) * np.sqrt(area) / problem.grid.size
    borne = np.maximum.accumulate(volume / compliance)
    return float(lowest[min(int(np.searchsorted(borne, problem.load)), lowest.size - 1)])


def likely_contact(pressure: Array, v: Array, approach: float | None, problem: Problem) -> tuple[Mask, float]:
    """Return the contact after a damped Jacobi step from a prolonged pressure, and the approach (m).

    ``v`` is the prolonged displacement plus the gap (m). Without an approach the load is kept.
    """
    stiffness = 0.5 / problem.elasticity.element_compliance(problem.grid)
    freed = pressure - stiffness * v
    if approach is None:
        approach = _balancing(freed, stiffness, float(pressure.sum()))
    found: Mask = freed + stiffness * approach > 0
    return found, approach


def likely_capped(pressure: Array, misfit: Array, contact: Mask, problem: Problem) -> Mask:
    """Return the likely contact that a Jacobi step takes to the cap; ``misfit``: approach less v (m)."""
    stiffness = CAPPED_STEP / problem.elasticity.element_compliance(problem.grid)
    return contact & (pressure + stiffness * misfit >= problem.cap)


def _balancing(freed: Array, stiffness: float, total: float) -> float:
    """Return the approach at which ``max(freed + stiffness approach, 0)`` adds up to the total.

    Newton's method on a convex function, from above: fewer elements press in every step, to the last.
    """
    pressing, fewest = freed, freed.size + 1
    while pressing.size < fewest:
        fewest = pressing.size
        approach = (total - float(pressing.sum())) / (stiffness * fewest)
        pressing = freed[freed > -stiffness * approach]
    return approach


def sharpened(pressure: Array, misfit: Array, contact: Mask, precondition: Apply, *, loaded: bool) -> Array:
    """Return a prolonged pressure after a preconditioned step from ``misfit`` (m), without an operator."""
    residual = _balanced(misfit * contact, contact, loaded)
    step = _balanced(precondition(residual) * contact, contact, loaded)
    raised: Array = (pressure + FIRST_LENGTH * step) * contact
    return np.maximum(raised, 0.0)


def _balanced(values: Array, contact: Mask, loaded: bool) -> Array:
    elements = max(np.count_nonzero(contact), 1)
    return values - values.sum() / elements * contact if loaded else values
