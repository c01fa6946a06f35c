"""Table 3: contact area, friction coefficient and peak pressure, four roughnesses on three meshes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product

import refimpl as rf
from verification.reproduction.ensemble import Estimate, column, estimate
from verification.reproduction.printed import MESHES, TABLE3, Column
from verification.reproduction.table1 import SMOOTH
from verification.sweep.run import Row

QUANTITIES = ("contact_area", "friction_coefficient", "max_pressure")


@dataclass(frozen=True)
class Cell:
    """One number of the table: printed and ours. Smooth surfaces have no realisations, and no interval."""

    column: Column
    mesh: int
    printed: float
    ours: Estimate

    @property
    def deviation(self) -> float:
        """Ours over printed, less 1."""
        return self.ours.mean / self.printed - 1

    @property
    def within(self) -> bool:
        """True if the deviation is within u, 95 %: the sampling of two such ensembles, and half a digit."""
        return abs(self.ours.mean - self.printed) <= self.uncertainty

    @property
    def uncertainty(self) -> float:
        """u, 95 %."""
        return math.hypot(math.sqrt(2) * self.ours.half_width, half_digit(self.printed))


def half_digit(printed: float) -> float:
    """Return half the last printed digit: two decimals of mu and A (0.1 mm^2), three digits of f.

    >>> half_digit(0.218), half_digit(4.4e-8), half_digit(1.64e8), half_digit(1.91e9)
    (0.0005, 5e-10, 500000.0, 5000000.0)
    """
    if printed < 1.0:
        return 5e-10 if printed < 1e-3 else 5e-4
    return 5e5 if printed < 1e9 else 5e6


@cache
def smooth(mesh: int) -> rf.Solution:
    """Return the smooth column's contact."""
    return rf.solve(SMOOTH, mesh)


def cells(found: Sequence[Row], quantity: str, meshes: Sequence[int] = MESHES) -> list[Cell]:
    """Return the table's row of one quantity: all columns, mesh after mesh."""
    table = []
    for row, mesh in product(TABLE3, meshes):
        if row.flat_rms == 0:
            ours = Estimate(float(getattr(smooth(mesh), quantity)), 0.0, 0.0, 1)
        else:
            ours = estimate(column(found, quantity, lower_rms=row.flat_rms, grid=mesh))
        table.append(Cell(row, mesh, getattr(row, quantity)[MESHES.index(mesh)], ours))
    return table


def series(table: Sequence[Cell]) -> dict[str, list[float]]:
    """Return the cells as flat series for the report."""
    return {
        "sigma_e (um)": [cell.column.equivalent_rms * 1e6 for cell in table],
        "mesh": [cell.mesh for cell in table],
        "printed": [cell.printed for cell in table],
        "ours": [cell.ours.mean for cell in table],
        "half width 95 %": [cell.ours.half_width for cell in table],
        "u 95 %": [cell.uncertainty for cell in table],
        "realisations": [cell.ours.n for cell in table],
        "deviation": [cell.deviation for cell in table],
    }
