"""Made-up solves on several grids, whose numbers and references are known."""

from __future__ import annotations

from typing import Any

import numpy as np
from verification.coverage.store import GridSolve

from refimpl.accuracy.contact_edge import NO_FACES
from refimpl.accuracy.grid_features import EXCESS, GridFeatures
from refimpl.accuracy.peak import NO_PEAK, Peak
from refimpl.grid import Grid
from refimpl.model.forces import EDGE_SHARE
from refimpl.solution.quantities import REPORTED
from tests.refimpl.accuracy.made_up import KIND
from verification.coverage.drawing import SIDE

GRIDS = (32, 64, 96, 128, 192, 256, 512)


def grid_solve(M: int, *, wrong: float = 0.0, seed: int = 3, **other: Any) -> GridSolve:
    """A disc on a grid, with an area wrong by a share; the finest grid of `GRIDS` is never wrong."""
    h, radius = SIDE / M, 0.2 * SIDE
    edge, limit = EDGE_SHARE * 8 * radius * h, np.pi * radius**2
    numbers = dict.fromkeys(REPORTED, 1.0) | {"plastic_area": 0.0}
    area = (limit + EXCESS[KIND] / EDGE_SHARE * edge) * (1 + (wrong if M in GRIDS[:-1] else 0.0))
    numbers |= {"contact_area": area, "contact_area_corrected": area - edge, "max_pressure": 1 - 1e-3 / M}
    numbers["friction_coefficient"] = 0.1 + 1e5 * area
    result = GridFeatures(
        grid=Grid.square(SIDE, M),
        numbers=numbers,
        edge=edge,
        symmetry_multiplicity=1.0,
        peak=Peak(1.0, 1e-3, 0.0),
        first_contact=NO_PEAK,
        slope_sampling_error=0.0,
        faces=tuple(8 * radius / h if k == KIND else 0.0 for k in range(len(NO_FACES))),
        dmu_dA=1e5,
        parts={name: {"iteration": 0.0} for name in REPORTED},
    )
    ended = {"status": "converged", "worst": 1e-8, "point_logs": float(M**2), "seconds": 0.1}
    carried = 0.75 * M**2 if GRIDS[0] < M else None
    return GridSolve(seed=seed, result=result, **{**ended, "carried": carried, **other})


def refinement(**other: Any) -> list[GridSolve]:
    """The disc on all `GRIDS`."""
    return [grid_solve(M, **other) for M in GRIDS]
