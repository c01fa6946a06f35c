"""Nested grids: the problem on halved grids, and pressures carried from one to the next."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from refimpl.contact.projected_cg import FIRST_LENGTH, Apply
from refimpl.friction import Mask
from refimpl.grid import Array, Grid
from refimpl.problem import Problem

_COARSEST = 32  # elements per side where nesting starts


def levels(problem: Problem) -> list[Problem]:
    """The problem on halved grids, coarsest first; each coarse height is the mean of four."""
    nested = [problem]
    while nested[0].grid.M % 2 == 0 and nested[0].grid.M // 2 >= _COARSEST:
        nested.insert(0, coarsened(nested[0]))
    return nested


def coarsened(fine: Problem) -> Problem:
    """The problem on half as many elements per side."""
    grid = Grid(fine.grid.side, fine.grid.M // 2)
    return replace(fine, grid=grid, gap=_halved(fine.gap), mean_surface=_halved(fine.mean_surface))


def prolonged(coarse: Array) -> Array:
    """Bilinear interpolation from element centres to those of the twice finer grid.

    >>> prolonged(np.ones((2, 2))).shape
    (4, 4)
    """
    for _ in range(2):
        padded = np.pad(coarse, ((1, 1), (0, 0)), mode="edge")
        fine = np.empty((2 * len(coarse), coarse.shape[1]))
        fine[::2] = 0.75 * coarse + 0.25 * padded[:-2]
        fine[1::2] = 0.75 * coarse + 0.25 * padded[2:]
        coarse = fine.T
    return coarse


def foundation_pressure(problem: Problem) -> Array:
    """A pressure to start from: springs under the interference at a guessed approach, at the load."""
    depth = problem.approach if problem.approach is not None else float(np.quantile(problem.gap, 0.3))
    interference = np.maximum(depth - problem.gap, 0.0)
    if not interference.any():
        interference = (problem.gap <= problem.gap.min()).astype(np.float64)
    pressure: Array = interference / (problem.pair.normal_compliance * problem.grid.side)
    if problem.load is not None:
        pressure *= problem.load / (problem.grid.element_area * pressure.sum())
    return pressure


def touching(pressure: Array, v: Array, approach: float, problem: Problem) -> Mask:
    """Elements in contact after a damped Jacobi step from a prolonged pressure; no operator is applied.

    ``v`` is the prolonged displacement plus the grid's gap; what it misses of the approach is of the grid's
    highest frequency ``q = pi / spacing``, where ``a`` is ``2 compliance spacing``.
    """
    stiffness = 1 / (2 * problem.pair.normal_compliance * problem.grid.spacing)
    found: Mask = pressure + 0.5 * stiffness * (approach - v) > 0
    return found


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


def _halved(values: Array) -> Array:
    return 0.25 * (values[::2, ::2] + values[1::2, ::2] + values[::2, 1::2] + values[1::2, 1::2])
