"""Table 3: contact area, friction coefficient and peak pressure, four roughnesses on three meshes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import refimpl as rf
from verification.reproduction.ensemble import Estimate, column, estimate, reduced, rows, rows_of
from verification.reproduction.printed import MESHES, TABLE3, Column
from verification.reproduction.table1 import SMOOTH
from verification.sweep.run import Row
from verification.sweep.study_file import read_study

QUANTITIES = ("contact_area", "friction_coefficient", "max_pressure")
UNITS = {"contact_area": "m^2", "friction_coefficient": "", "max_pressure": "Pa"}
QUICK_REALISATIONS, QUICK_MESH = 6, 128


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
    def within_sampling(self) -> bool:
        """Whether the deviation is within the 95 % half width of a difference of two such ensembles."""
        return abs(self.ours.mean - self.printed) <= math.sqrt(2) * self.ours.half_width


@cache
def full_rows() -> tuple[Row, ...]:
    """The ensemble as in the paper: 75 realisations on three meshes."""
    return rows_of("table3")


@cache
def quick_rows() -> tuple[Row, ...]:
    """Six realisations on the coarsest mesh."""
    study = reduced(read_study("table3"), QUICK_REALISATIONS, grid=(QUICK_MESH,))
    return rows(study)


@cache
def smooth(mesh: int) -> rf.Solution:
    """The smooth column's contact."""
    return rf.solve(SMOOTH, mesh)


def cells(found: Sequence[Row], quantity: str, meshes: Sequence[int] = MESHES) -> list[Cell]:
    """The table's row of one quantity: all columns, mesh after mesh."""
    return [
        Cell(
            printed,
            mesh,
            getattr(printed, quantity)[MESHES.index(mesh)],
            _ours(found, printed, quantity, mesh),
        )
        for printed in TABLE3
        for mesh in meshes
    ]


def _ours(found: Sequence[Row], printed: Column, quantity: str, mesh: int) -> Estimate:
    if printed.flat_rms == 0:
        return Estimate(float(getattr(smooth(mesh), quantity)), 0.0, 0.0, 1)
    return estimate(column(found, quantity, lower_rms=printed.flat_rms, grid=mesh))


def series(table: Sequence[Cell]) -> dict[str, list[float]]:
    """The cells as flat series for the report."""
    return {
        "sigma_e (um)": [cell.column.equivalent_rms * 1e6 for cell in table],
        "mesh": [cell.mesh for cell in table],
        "printed": [cell.printed for cell in table],
        "ours": [cell.ours.mean for cell in table],
        "half width 95 %": [cell.ours.half_width for cell in table],
        "scatter of one realisation": [cell.ours.scatter for cell in table],
        "realisations": [cell.ours.n for cell in table],
        "deviation": [cell.deviation for cell in table],
    }
