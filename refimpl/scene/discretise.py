"""From a scene and a grid to the problem that solvers solve: heights are sampled once a grid."""

from __future__ import annotations

import math

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.model.elasticity import Elasticity
from refimpl.model.problem import Problem, Terms
from refimpl.scene.scene import Scene

_DIGITS = 10  # units in the last place of the mean gap that an approach from the mean planes must have


def discretise(
    scene: Scene, grid: Grid, terms: Terms | None = None, approach: float | None = None
) -> Problem:
    """Return the scene's problem on a grid, with all terms but the slope correction by default.

    ``approach`` (m), from first contact or the mean planes, replaces the load; the datum, the difference of
    both, is defined here. Raises `InputError` for an approach that is rounding of the datum.
    """
    lower, upper = scene.sampled(grid)
    gap = upper - lower
    gap -= gap.min()
    datum = float(gap.mean()) if grid.periodic else 0.0
    if approach is not None and datum and abs(approach) < _DIGITS * math.ulp(datum):
        least = f"at least {_DIGITS * math.ulp(datum):.1e} m below 0, where contact is full"
        raise InputError("approach", approach, f"an approach that has digits beside the mean gap: {least}")
    return Problem(
        grid=grid,
        gap=gap,
        mean_surface=_raised(lower, gap, upper),
        elasticity=Elasticity(scene.materials),
        friction=scene.friction,
        direction=scene.sliding_direction,
        terms=Terms(),
        load=scene.load if approach is None else None,
        approach=None if approach is None else approach + datum,
        datum=datum,
    ).with_terms(terms or Terms())


def _raised(lower: Array, gap: Array, spent: Array) -> Array:
    """Return ``lower + gap / 2``, in the memory of heights that are no longer needed."""
    np.multiply(gap, 0.5, out=spent)
    spent += lower
    return spent


class Discretiser:
    """Problems of one scene under its load or at an approach (m).

    The grid on which terms are decided is mostly the grid to solve on: its heights are sampled once.
    """

    def __init__(self, scene: Scene, approach: float | None) -> None:
        self.scene, self._approach = scene, approach
        self._last: Problem | None = None

    def with_all_terms(self, grid: Grid) -> Problem:
        """Return the problem with all terms, for planning, and keep it."""
        self._last = self._problem(grid)
        return self._last

    def problem(self, grid: Grid, terms: Terms) -> Problem:
        """Return the problem with these terms; heights kept from the same grid are used, and then dropped."""
        kept, self._last = self._last, None
        problem = kept if kept and kept.grid == grid else self._problem(grid)
        return problem.with_terms(terms)

    def _problem(self, grid: Grid) -> Problem:
        return discretise(self.scene, grid, approach=self._approach)
