"""Result of a FEM run on a rough boundary: displacements beside the flat ones, and their error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WavyResult:
    """Vertical surface displacements at `offsets` (m,) from the load's centre, in units of p a / E.

    Positive into the body.  `wavy` (m,) is on the rough boundary, `flat` (m,) the exact one of the flat
    boundary; in a plane problem both are relative to the centre's own value.  `discretisation_error` is the
    estimated error of `wavy`, hence of `wavy - flat`, in the same units, the largest over the offsets: per
    offset the finest mesh's by Roache's grid convergence index (`mesh_error`) plus the change between the two
    largest of three outer radii (`truncation_error`).  `mesh_values` (3, m) are `wavy`, coarse to fine.
    """

    offsets: Array
    wavy: Array
    flat: Array
    discretisation_error: float
    mesh_error: Array
    truncation_error: Array
    mesh_values: Array

    @classmethod
    def of(cls, offsets: Array, flat: Array, meshes: Sequence[Array], radii: Sequence[Array]) -> Self:
        """Extrapolate from rough minus flat on three meshes and at three outer radii."""
        mesh_error, truncation = _grid_convergence_index(meshes), np.abs(radii[-1] - radii[-2])
        largest = float(np.max(mesh_error + truncation, initial=0.0))
        return cls(offsets, flat + meshes[-1], flat, largest, mesh_error, truncation, flat + np.array(meshes))

    @property
    def percentage_points(self) -> Array:
        """(m,) estimated error as a percentage of the flat coefficient at the same offset; nan where zero."""
        away = self.flat != 0.0
        relative = np.full(self.flat.shape, np.nan)
        relative[away] = 100.0 * (self.mesh_error + self.truncation_error)[away] / np.abs(self.flat[away])
        return relative


def _grid_convergence_index(meshes: Sequence[Array]) -> Array:
    """Return 1.25 |change| q / (1 - q) of the last of three meshes, q the ratio of changes.

    q is kept within [1/4, 1/2], the ratios of fourth and second order for meshes of twice the unknowns each.
    At each offset the change is the last one or half of the one before, whichever is larger: two successive
    meshes may share the surface's edges, and then a single point does not notice the finer one.
    """
    coarse, fine = np.abs(meshes[-2] - meshes[-3]), np.abs(meshes[-1] - meshes[-2])
    largest = float(np.max(coarse, initial=0.0))
    ratio = float(np.clip(np.max(fine, initial=0.0) / largest, 0.25, 0.5)) if largest > 0.0 else 0.5
    return 1.25 * ratio / (1.0 - ratio) * np.maximum(fine, coarse / 2)
