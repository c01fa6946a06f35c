"""Limits of a refinement: the largest grid, seconds and memory that the user allows."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

from refimpl.errors import InputError, require_number
from refimpl.grid import Grid

_GROWTH = 1.3  # seconds over those of the same work an element: iterations grow with the grid


@dataclass(frozen=True)
class Limits:
    """``max_grid`` elements along the longer side, ``max_seconds`` in all, ``max_memory`` in all (bytes).

    The memory is the estimate of a grid's arrays and what is resident before they are made.
    Raises `InputError` for a limit that is not positive.
    """

    max_grid: int | None = None
    max_seconds: float | None = None
    max_memory: float | None = None

    def __post_init__(self) -> None:
        for name in ("max_grid", "max_seconds", "max_memory"):
            value = getattr(self, name)
            if value is not None:
                require_number(name, value, "a positive number", above=0)

    @property
    def given(self) -> dict[str, float]:
        """The limits that are given, by name."""
        return {name: value for name, value in vars(self).items() if value is not None}


class Allowance:
    """Limits while grids are solved; seconds count from the start."""

    def __init__(self, limits: Limits) -> None:
        self._limits, self._began = limits, time.perf_counter()
        self._last: tuple[int, float] | None = None  # elements, seconds

    def record(self, grid: Grid, seconds: float) -> None:
        """Keep what a grid took."""
        self._last = grid.elements, seconds

    def expected_seconds(self, grid: Grid) -> float:
        """Return the seconds to expect of a grid, from the last one solved; 0 before any."""
        if self._last is None:
            return 0.0
        elements, seconds = self._last
        ratio = grid.elements / max(elements, 2)
        return seconds * ratio * math.log(max(grid.elements, 2)) / math.log(max(elements, 2)) * _GROWTH

    def check(self, grid: Grid, memory: float) -> None:
        """Raise `InputError` for a grid that exceeds a limit; ``memory``: of its arrays (bytes)."""
        limits, size = self._limits, max(grid.shape)
        if limits.max_grid is not None and size > limits.max_grid:
            raise InputError("grid", size, f"at most max_grid = {limits.max_grid} elements a side")
        if limits.max_memory is not None:
            import psutil  # here and not above: importing refimpl is quick

            resident = psutil.Process().memory_info().rss
            if memory + resident > limits.max_memory:
                arrays, process, most = (b / 1e9 for b in (memory, resident, limits.max_memory))
                allowed = f"a grid whose estimated {arrays:.3g} GB, beside {process:.3g} GB in use, "
                raise InputError("grid", size, allowed + f"are at most {most:.3g} GB")
        if limits.max_seconds is not None and self._last is not None:
            needed, spent = self.expected_seconds(grid), time.perf_counter() - self._began
            if spent + needed > limits.max_seconds:
                allowed = f"a grid whose {needed:.3g} s to be expected, after {spent:.3g} s, "
                raise InputError("grid", size, allowed + f"are within max_seconds = {limits.max_seconds:g}")
