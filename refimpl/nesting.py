"""Nested grids: the problem on halved grids, and pressures carried from one to the next."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from refimpl.friction import Mask
from refimpl.grid import Array, Grid
from refimpl.problem import Problem

_COARSEST = 64  # elements per side where nesting starts


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


def likely_contact(coarse_displacement: Array, approach: float, fine: Problem) -> Mask:
    """Fine elements that would touch if the coarse displacement held there, judged by the lowest of four.

    ``coarse_displacement`` has half as many elements per side as the fine problem; shape of the
    result is the fine grid's.
    """
    M = len(coarse_displacement)
    lowest = fine.gap.reshape(M, 2, M, 2).min(axis=(1, 3))
    touching = coarse_displacement + lowest < approach
    return np.repeat(np.repeat(touching, 2, axis=0), 2, axis=1)


def _halved(values: Array) -> Array:
    return 0.25 * (values[::2, ::2] + values[1::2, ::2] + values[::2, 1::2] + values[1::2, 1::2])
