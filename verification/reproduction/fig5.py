"""Fig. 5: pressure and traction of the smooth sliding sphere, along and across the sliding direction."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.reproduction.table1 import SMOOTH, hertz


@dataclass(frozen=True)
class Profiles:
    """Lines through the centre (m, Pa); ``shift`` is the pressure's centroid from the axis over the Hertz
    radius, along sliding and across; ``edge_traction`` that of the contact elements beside free ones.
    """

    x: Array
    pressure: tuple[Array, Array]
    traction: tuple[Array, Array]
    shift: tuple[float, float]
    edge_traction: Array
    solution: rf.Solution


@cache
def profiles(grid: int) -> Profiles:
    """Return Table 1, smooth, P = 70 N; the upper ball slides along +x."""
    found = rf.solve(SMOOTH, grid)
    x = found.grid.x - SMOOTH.lengths[0] / 2
    middle = grid // 2  # upper one of the two middle lines
    total = found.pressure.sum()
    contact = found.contact
    inner = np.zeros_like(contact)
    inner[1:-1, 1:-1] = contact[2:, 1:-1] & contact[:-2, 1:-1] & contact[1:-1, 2:] & contact[1:-1, :-2]
    lawful = contact & ~inner & ~found.details.excluded
    return Profiles(
        x=x,
        pressure=(found.pressure[:, middle], found.pressure[middle]),
        traction=(found.traction[:, middle], found.traction[middle]),
        shift=(
            float(found.pressure.sum(axis=1) @ x / total / hertz().contact_radius),
            float(found.pressure.sum(axis=0) @ x / total / hertz().contact_radius),
        ),
        edge_traction=found.traction[lawful],
        solution=found,
    )
