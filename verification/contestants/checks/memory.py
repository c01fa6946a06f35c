"""What a solver was asked before must not show: problems in turn that differ in one parameter at a time.

Codes keep transforms of their kernels, and may forget what these were made for. (c0 and the direction are
changed in the sliding beds of pins.)
"""

from __future__ import annotations

from refimpl.grid import Array
from verification.case import Measured
from verification.contestants.beds import Bed, standing, uneven
from verification.contestants.check import MODULUS, Entrant, Fault, check
from verification.contestants.checks.exact import BOUND, SOURCE, M
from verification.contestants.checks.invariance import LOAD, TWICE, bump
from verification.contestants.checks.residuals import wavy
from verification.contestants.gaps import rough_bump

KEPT = (Fault.SPACING_KEPT, Fault.MODULUS_KEPT)


def in_turn(entrant: Entrant, gap: Array, other: Array, load: float, *, periodic: bool) -> Measured:
    """A gap; at three times the modulus; at twice the spacing too; another size; the first again.

    Displacements are pressure times spacing over modulus, so on the same gap pressures go with modulus over
    spacing, and loads with modulus times spacing.
    """
    first = entrant.press(gap, 1.0, load=load, periodic=periodic)
    stiff = entrant.press(gap, 1.0, load=3 * load, modulus=3 * MODULUS, periodic=periodic)
    coarse = entrant.press(gap, 2.0, load=6 * load, modulus=3 * MODULUS, periodic=periodic)
    entrant.press(other, 1.0, load=load, periodic=periodic)
    again = entrant.press(gap, 1.0, load=load, periodic=periodic)
    return entrant.against(
        (stiff, 3 * first.pressure), (coarse, 1.5 * first.pressure), (again, first.pressure)
    )


@check(
    "memory",
    title="Problems in turn",
    claim="The modulus changes alone, then the spacing alone, then the size, and the first problem comes "
    "again: nothing of one gets into the next",
    source="a solver is a function; dimensional analysis",
    metric="at_most",
    tolerance=4.1,
    tolerance_reason=TWICE,
    catches=KEPT,
)
def memory(entrant: Entrant) -> Measured:
    return in_turn(entrant, bump(45), rough_bump(24, 45), LOAD, periodic=False)


@check(
    "memory-periodic",
    title="Periodic problems in turn",
    claim="The same with periodic planes: modulus alone, spacing alone, size, and the first problem again",
    source="a solver is a function; dimensional analysis",
    metric="at_most",
    tolerance=4.1,
    tolerance_reason=TWICE,
    catches=KEPT,
)
def memory_periodic(entrant: Entrant) -> Measured:
    return in_turn(entrant, wavy(20, 45), wavy(24, 45), 0.02 * MODULUS, periodic=True)


@check(
    "memory-borders",
    title="Free and periodic problems in turn",
    claim="Beds of pins on the same elements, free, periodic and free again, carry the pressures that were "
    "chosen",
    source=SOURCE + "; the exact Fourier symbols",
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "a load off by 1e-8 adds nothing that shows",
    catches=(Fault.PERIODIC_FOR_APERIODIC, Fault.APERIODIC_FOR_PERIODIC, Fault.BORDERS_KEPT),
)
def memory_borders(entrant: Entrant) -> Measured:
    pressure = uneven(standing(M), seed=4)
    return entrant.against(*(Bed(pressure, periodic=p).under_load(entrant) for p in (False, True, False)))
