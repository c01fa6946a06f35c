"""Invariance of solutions to orientation, place, units and surroundings.

Two answers of one claim differ by at most four claims: twice the error in the energy norm, squared.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import MODULUS, Entrant, Fault, Pressed, check
from verification.solver_suite.checks.residuals import wavy
from verification.solver_suite.gaps import rough_bump

TWICE = "in claims: two answers, each within one of squared energy-norm error (proven), differ by four"
LOAD = 0.05 * MODULUS
M = 20


def bump(seed: int) -> Array:
    """The rough bump of these checks."""
    return rough_bump(M, seed)


@check(
    "mirrors",
    title="Mirrored along x, and along y",
    claim="The mirrored gap has the mirrored pressure",
    source="isotropy of the half-space",
    metric="at_most",
    tolerance=4.1,
    tolerance_reason=TWICE,
    catches=(Fault.HALF_ELEMENT,),
)
def mirrors(entrant: Entrant) -> Measured:
    gap = bump(41)
    first = entrant.press(gap, 1.0, load=LOAD)
    flipped = [entrant.press(np.flip(gap, axis), 1.0, load=LOAD) for axis in (0, 1)]
    return entrant.against(*((flipped[axis], np.flip(first.pressure, axis)) for axis in (0, 1)))


@check(
    "transposition",
    title="Axes exchanged on purpose",
    claim="The transposed gap has the transposed pressure: no axis is treated unlike the other",
    source="isotropy of the half-space",
    metric="at_most",
    tolerance=4.1,
    tolerance_reason=TWICE,
    catches=(Fault.HALF_ELEMENT,),
)
def transposition(entrant: Entrant) -> Measured:
    first, second = (entrant.press(gap, 1.0, load=LOAD) for gap in (bump(43), bump(43).T))
    return entrant.against((second, first.pressure.T))


@check(
    "units",
    title="um and Pa, m and GPa",
    claim="A square a million times smaller of a material 2^30 times softer has proportional pressures",
    source="dimensional analysis",
    metric="at_most",
    tolerance=4.1,
    tolerance_reason=TWICE,
    catches=(Fault.ABSOLUTE_THRESHOLD,),
)
def units(entrant: Entrant) -> Measured:
    small, soft = 2.0**-20, 2.0**-30
    first = entrant.press(bump(44), 1.0, load=LOAD)
    second = entrant.press(small * bump(44), small, load=soft * small**2 * LOAD, modulus=soft * MODULUS)
    return entrant.against((second, soft * first.pressure))


@check(
    "surroundings",
    title="Free surroundings",
    claim="The same bump in a square twice as wide, all else out of reach, has the same pressures: nothing "
    "is repeated beyond the square",
    source="a half-space is free outside; a code that keeps its periodic operator silently fails here",
    metric="at_most",
    tolerance=4.1,
    tolerance_reason=TWICE,
    catches=(Fault.PERIODIC_FOR_APERIODIC,),
)
def surroundings(entrant: Entrant) -> Measured:
    n = 16
    gap = rough_bump(n, 46)
    wide = np.full((2 * n, 2 * n), 1.5)
    wide[3 : n + 3, 7 : n + 7] = gap
    small, large = entrant.press(gap, 1.0, load=LOAD), entrant.press(wide, 2.0, load=LOAD)
    again = np.zeros_like(wide)
    again[3 : n + 3, 7 : n + 7] = small.pressure
    return entrant.against((large, again))


def loaded_again(entrant: Entrant, first: Pressed, second: Pressed) -> Measured:
    """Misfit of the second answer, or the square of its load's relative error if that is more."""
    assert first.problem.load is not None
    found, off = entrant.against((second, first.pressure)), second.load / first.problem.load - 1
    return replace(found, value=max(found.value, off**2 / entrant.claim))


@check(
    "there-and-back",
    title="Load to approach and back",
    claim="Pressed to the approach that its pressures say a load takes, the bump carries that load again",
    source="the contact problem has one solution",
    metric="at_most",
    tolerance=10.0,
    tolerance_reason="in claims: two answers (four), and the approach recomputed from the first, which a gap "
    "of one claim leaves uncertain by as much",
    catches=(Fault.MEAN_DISPLACEMENT_LOST, Fault.MEAN_PRESSURE_LOST),
)
def there_and_back(entrant: Entrant) -> Measured:
    gap = bump(47)
    first = entrant.press(gap, 1.0, load=LOAD)
    touch = reference_solution.approach_of(first.problem, first.pressure)
    second = entrant.press(gap, 1.0, approach=touch + float(gap.min()))
    return loaded_again(entrant, first, second)


@check(
    "periodic-there-and-back",
    title="Load to approach and back, periodic",
    claim="An approach counts from the mean planes, and takes a periodic plane back to its load",
    source="the contact problem has one solution",
    metric="at_most",
    tolerance=10.0,
    tolerance_reason="as there-and-back",
    catches=(Fault.MEAN_PLANES_LOST, Fault.MEAN_PRESSURE_LOST),
)
def periodic_there_and_back(entrant: Entrant) -> Measured:
    load = 0.02 * MODULUS
    first = entrant.press(wavy(24, 48), 1.0, load=load, periodic=True)
    approach = reference_solution.approach_of(first.problem, first.pressure)
    second = entrant.press(wavy(24, 48), 1.0, approach=approach, periodic=True)
    return loaded_again(entrant, first, second)


@check(
    "periodic-shift",
    title="A periodic plane shifted by whole elements",
    claim="The shifted gap has the shifted pressure, across the square's border as well",
    source="translation of a periodic problem",
    metric="at_most",
    tolerance=4.1,
    tolerance_reason=TWICE,
    catches=(Fault.APERIODIC_FOR_PERIODIC,),
)
def periodic_shift(entrant: Entrant) -> Measured:
    gap, shift = wavy(24, 49), (7, -9)
    first, second = (
        entrant.press(g, 1.0, load=0.02 * MODULUS, periodic=True) for g in (gap, np.roll(gap, shift, (0, 1)))
    )
    return entrant.against((second, np.roll(first.pressure, shift, (0, 1))))


@check(
    "periodic-tiling",
    title="Four periods in one square",
    claim="Two by two copies of a periodic gap have two by two copies of its pressure",
    source="a periodic problem has all multiples of its period",
    metric="at_most",
    tolerance=4.1,
    tolerance_reason=TWICE,
    catches=(Fault.APERIODIC_FOR_PERIODIC,),
)
def periodic_tiling(entrant: Entrant) -> Measured:
    gap = wavy(16, 50)
    one = entrant.press(gap, 1.0, load=0.02 * MODULUS, periodic=True)
    four = entrant.press(np.tile(gap, (2, 2)), 2.0, load=0.08 * MODULUS, periodic=True)
    return entrant.against((four, np.tile(one.pressure, (2, 2))))
