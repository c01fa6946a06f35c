"""Invariance of solutions to orientation, place, units and surroundings.

Two answers of one claim differ by at most four claims: twice the error in the energy norm, squared.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import MODULUS, Check, Entrant, Judge
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.residuals import wavy
from verification.solver_suite.gaps import rough_bump

TWICE = "in claims: two answers, each within one of squared energy-norm error (proven), differ by four"
LOAD, LIGHT = 0.05 * MODULUS, 0.02 * MODULUS
"""Load (N) of bumps, and of periodic planes."""
M = 20
SMALL, SOFT = 2.0**-20, 2.0**-30
SHIFT = 7, -9
Map = Callable[[Array], Array]


class Image(NamedTuple):
    """Another problem with the same answer, but for a map: of the gap, of the pressures, and what changes."""

    of_gap: Map
    of_pressure: Map
    how: dict[str, Any] = {}  # noqa: RUF012  # never changed


def same(of: Map, **how: Any) -> Image:
    """Return the image whose gap and pressures are mapped alike."""
    return Image(of, of, how)


def images(gap: Array, *others: Image, **how: Any) -> Judge:
    """Return the judge of a gap and its images: their pressures are images of those of the gap."""

    def judge(entrant: Entrant) -> Measured:
        first = entrant.press(gap, **{"side": 1.0} | how)
        found = [entrant.press(each.of_gap(gap), **{"side": 1.0} | how | each.how) for each in others]
        pairs = zip(found, others, strict=True)
        return entrant.against(*((one, each.of_pressure(first.pressure)) for one, each in pairs))

    return judge


def there_and_back(gap: Array, load: float, **how: Any) -> Judge:
    """Return the judge of a gap under a load, and at the approach that its pressures say the load takes.

    It is the misfit of the second answer, or the square of its load's relative error if that is more.
    """

    def judge(entrant: Entrant) -> Measured:
        first = entrant.press(gap, 1.0, load=load, **how)
        touch = reference_solution.approach_of(first.problem, first.pressure)
        approach = touch if first.problem.periodic else touch + float(gap.min())
        second = entrant.press(gap, 1.0, approach=approach, **how)
        found, off = entrant.against((second, first.pressure)), second.load / load - 1
        return replace(found, value=max(found.value, off**2 / entrant.claim))

    return judge


def _within(around: float) -> Map:
    def map_(field: Array) -> Array:
        n = len(field)
        wide = np.full((2 * n, 2 * n), around)
        wide[3 : n + 3, 7 : n + 7] = field
        return wide

    return map_


def _invariant(slug: str, title: str, claim: str, source: str, fault: F | None, judge: Judge) -> Check:
    return Check(slug, title, claim, source, 4.1, TWICE, () if fault is None else (fault,), judge)


# fmt: off
CHECKS = (
    _invariant("mirrors", "Mirrored along x, and along y", "The mirrored gap has the mirrored pressure",
               "isotropy of the half-space", F.HALF_ELEMENT,
               images(rough_bump(M, 41), same(np.flipud), same(np.fliplr), load=LOAD)),
    _invariant("transposition", "Axes exchanged on purpose",
               "The transposed gap has the transposed pressure: no axis is treated unlike the other",
               "isotropy of the half-space", F.HALF_ELEMENT,
               images(rough_bump(M, 43), same(np.transpose), load=LOAD)),
    _invariant("units", "um and Pa, m and GPa",
               "A square a million times smaller of a material 2^30 times softer has proportional pressures",
               "dimensional analysis", F.ABSOLUTE_THRESHOLD,
               images(rough_bump(M, 44), Image(lambda gap: SMALL * gap, lambda f: SOFT * f, {
                   "side": SMALL, "load": SOFT * SMALL**2 * LOAD, "modulus": SOFT * MODULUS}), load=LOAD)),
    _invariant("surroundings", "Free surroundings",
               "The same bump in a square twice as wide, all else out of reach, has the same pressures: "
               "nothing is repeated beyond the square",
               "a half-space is free outside; a code that keeps its periodic operator silently fails here",
               F.PERIODIC_FOR_APERIODIC,
               images(rough_bump(16, 46), Image(_within(1.5), _within(0.0), {"side": 2.0}), load=LOAD)),
    Check("there-and-back", "Load to approach and back",
          "Pressed to the approach that its pressures say a load takes, the bump carries that load again",
          "the contact problem has one solution", 10.0,
          "in claims: two answers (four), and the approach recomputed from the first, which a gap "
          "of one claim leaves uncertain by as much",
          (F.MEAN_DISPLACEMENT_LOST, F.MEAN_PRESSURE_LOST), there_and_back(rough_bump(M, 47), LOAD)),
    Check("periodic-there-and-back", "Load to approach and back, periodic",
          "An approach counts from the mean planes, and takes a periodic plane back to its load",
          "the contact problem has one solution", 10.0, "as there-and-back",
          (F.MEAN_PLANES_LOST, F.MEAN_PRESSURE_LOST), there_and_back(wavy(24, 48), LIGHT, periodic=True)),
    _invariant("periodic-shift", "A periodic plane shifted by whole elements",
               "The shifted gap has the shifted pressure, across the square's border as well",
               "translation of a periodic problem", F.APERIODIC_FOR_PERIODIC,
               images(wavy(24, 49), same(lambda field: np.roll(field, SHIFT, (0, 1))),
                      load=LIGHT, periodic=True)),
    _invariant("periodic-tiling", "Four periods in one square",
               "Two by two copies of a periodic gap have two by two copies of its pressure",
               "a periodic problem has all multiples of its period", F.APERIODIC_FOR_PERIODIC,
               images(wavy(16, 50), same(lambda field: np.tile(field, (2, 2)), side=2.0, load=4 * LIGHT),
                      load=LIGHT, periodic=True)),
)
# fmt: on
