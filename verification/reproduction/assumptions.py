"""The paper's silent assumptions, as measures of a solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import refimpl as rf
from refimpl.model.forces import Forces, facet_resultants, resultants
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


@dataclass(frozen=True)
class TangentialEffect:
    """Effect of tangential displacements: largest displacement and rms change of the gap on the contact over
    the approach, and relative changes of mu, A and f_max when they are put into the surfaces.
    """

    displacement: float
    gap: float
    friction: float
    area: float
    peak: float

    @property
    def largest(self) -> float:
        """The largest relative change of mu and A."""
        return max(abs(self.friction), abs(self.area))


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


@dataclass(frozen=True)
class FacetEffect:
    """Printed cosines against facet tractions: rms slope on the contact, relative changes of N and F."""

    slope: float
    normal: float
    friction: float

    @property
    def coefficient(self) -> float:
        """Relative change of F / N."""
        return (1 + self.friction) / (1 + self.normal) - 1


def facet_effect(flat_rms: float, grid: int) -> FacetEffect:
    """Return the pressures and slopes summed both ways, for one realisation at P = 70 N."""
    found = rf.solve(rough(flat_rms), grid)
    sums: list[Forces] = [
        how(found.pressure, found.traction, found.slopes, found.grid.element_area)
        for how in (resultants, facet_resultants)
    ]
    printed, exact = sums
    contact = found.contact
    slope = np.sqrt(np.mean(found.slopes.tan_x[contact] ** 2 + found.slopes.tan_y[contact] ** 2) / 2)
    return FacetEffect(float(slope), exact.normal / printed.normal - 1, exact.friction / printed.friction - 1)
