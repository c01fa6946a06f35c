"""The paper's silent assumptions, as measures of a solution."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import refimpl as rf
from refimpl.model.forces import facet_resultants, resultants
from verification.reproduction.table1 import rough
from verification.reproduction.tangential import displacements, with_tangential


def kinematic_margin(scene: rf.Scene, found: rf.Solution) -> float:
    """Return the least of ``(approach - h) / approach`` on the contact; negative: no interference."""
    lower, upper = scene.heights(found.grid)
    gap = upper - lower
    gap = gap - gap.min()
    return float((1 - gap[found.contact] / found.approach).min())


def sheared_scene(beta: float) -> rf.Scene:
    """Return a steel ball on a polymer at 10 mN, with a shear of ``beta`` times the pressure."""
    steel, polymer = rf.Material(E=200e9, nu=0.3), rf.Material(E=1e9, nu=0.2)
    bodies = rf.Body(steel, rf.Sphere(radius=0.14)), rf.Body(polymer, rf.Flat())
    return rf.Scene(*bodies, rf.Friction(beta=beta), load=0.01, side=4e-4)


class TangentialEffect(NamedTuple):
    """Effect of tangential displacements: largest displacement and rms change of the gap on the contact over
    the approach, and relative changes of mu, A and f_max when they are put into the surfaces.
    """

    displacement: float
    gap: float
    friction: float
    area: float
    peak: float


def tangential_effect(flat_rms: float, ball_rms: float, realisation: int, grid: int) -> TangentialEffect:
    """Solve, displace, solve again."""
    scene = rough(flat_rms, ball_rms, realisation)
    first = rf.solve(scene, grid)
    moved, contact = displacements(scene, first), first.contact
    second = rf.solve(with_tangential(scene, first), grid)
    relative = np.hypot(*(moved.upper - moved.lower))
    return TangentialEffect(
        displacement=float(relative[contact].max()) / first.approach,
        gap=float(np.sqrt(np.mean(moved.gap_change[contact] ** 2))) / first.approach,
        friction=second.friction_coefficient / first.friction_coefficient - 1,
        area=second.contact_area / first.contact_area - 1,
        peak=second.max_pressure / first.max_pressure - 1,
    )


def facet_effect(flat_rms: float, grid: int) -> tuple[float, float, float, float]:
    """Return the rms slope on the contact, and what exact facet tractions change N, F and F / N by, relative.

    The pressures and slopes of one realisation at P = 70 N are summed both ways.
    """
    found = rf.solve(rough(flat_rms), grid)
    printed, exact = (
        how(found.pressure, found.traction, found.slopes, found.grid.element_area)
        for how in (resultants, facet_resultants)
    )
    contact = found.contact
    slope = np.sqrt(np.mean(found.slopes.tan_x[contact] ** 2 + found.slopes.tan_y[contact] ** 2) / 2)
    normal, friction = exact.normal / printed.normal - 1, exact.friction / printed.friction - 1
    return float(slope), normal, friction, (1 + friction) / (1 + normal) - 1
