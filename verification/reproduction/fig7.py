"""Fig. 7: a cross-section of ball and flat before contact and in contact, with and without local friction."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.reproduction.fig6 import NO_FRICTION
from verification.reproduction.table1 import rough

FLAT_RMS, BALL_RMS = 0.504e-6, 0.084e-6  # sigma_e = 0.511 um, as in the figure


@dataclass(frozen=True)
class Section:
    """Heights (m) on the line through the centre: at first contact, and deformed with and without friction.

    ``mean_plane`` is the half-space's deformed mean plane, with friction. ``difference`` is the largest
    change of the flat's deformed surface by friction anywhere on the contact, ``approach`` the ball's (m).
    """

    x: Array
    before: tuple[Array, Array]
    deformed: tuple[Array, Array]
    frictionless: Array
    mean_plane: Array
    difference: float
    approach: float
    mean_contact_displacement: float
    area_change: float


@cache
def section(grid: int) -> Section:
    """Solve one realisation at P = 70 N."""
    scene = rough(FLAT_RMS, BALL_RMS)
    with_friction = rf.solve(scene, grid)
    without = rf.solve(rough(FLAT_RMS, BALL_RMS, friction=NO_FRICTION), grid)
    lower, upper = scene.heights(with_friction.grid)
    upper = upper - float((upper - lower).min())  # first contact
    displacement = lower - with_friction.surfaces[0]
    middle = grid // 2
    contact = with_friction.contact
    change = np.abs(with_friction.surfaces[0] - without.surfaces[0])
    return Section(
        x=with_friction.grid.x - scene.lengths[0] / 2,
        before=(lower[:, middle], upper[:, middle]),
        deformed=(with_friction.surfaces[0][:, middle], with_friction.surfaces[1][:, middle]),
        frictionless=without.surfaces[0][:, middle],
        mean_plane=-displacement[:, middle],
        difference=float(change[contact].max()),
        approach=with_friction.approach,
        mean_contact_displacement=float(displacement[contact].mean()),
        area_change=with_friction.contact_area / without.contact_area - 1,
    )
