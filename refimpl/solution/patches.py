"""A table of the contact patches: size, load, pressures and place of each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from refimpl.grid import Array, Grid, Mask
from refimpl.grid.contact_patches import patch_centres, patch_labels


@dataclass(frozen=True)
class Patch:
    """One contact patch: elements in contact that touch one another, at corners too.

    label : number in the order of the array, from 1
    elements : number of elements
    area : real contact area (m^2)
    load : ``sum f dA`` (N), the pressure's part of the normal force
    mean_pressure, max_pressure : of its elements (Pa)
    x, y : centre, weighted by pressure, inside the domain (m)
    plastic_share : share of its area at the hardness
    """

    label: int
    elements: int
    area: float
    load: float
    mean_pressure: float
    max_pressure: float
    x: float
    y: float
    plastic_share: float


def patches_of(pressure: Array, plastic: Mask, grid: Grid) -> tuple[Patch, ...]:
    """Return the patches of a pressure (Pa), across a periodic border too; ``plastic`` marks H."""
    labels = patch_labels(pressure > 0, periodic=grid.periodic).ravel()
    f = pressure.ravel()
    count = np.bincount(labels)[1:]
    total = np.bincount(labels, f)[1:]
    largest = np.zeros(len(count) + 1)
    np.maximum.at(largest, labels, f)
    at_hardness = np.bincount(labels, plastic.ravel())[1:]
    X, Y = np.meshgrid(grid.x, grid.y, indexing="ij")
    centres = [
        patch_centres(labels, f, along.ravel(), length, grid.periodic)
        for along, length in zip((X, Y), grid.lengths, strict=True)
    ]
    dA = grid.element_area
    return tuple(
        Patch(
            label=k + 1,
            elements=int(count[k]),
            area=float(count[k]) * dA,
            load=float(total[k]) * dA,
            mean_pressure=float(total[k] / count[k]),
            max_pressure=float(largest[k + 1]),
            x=float(centres[0][k]),
            y=float(centres[1][k]),
            plastic_share=float(at_hardness[k] / count[k]),
        )
        for k in range(len(count))
    )
