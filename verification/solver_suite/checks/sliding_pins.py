"""Beds of pins that slide, free and periodic, under a load and at an approach: pressures chosen beforehand.

Their pressures span two and a half decades, so that tau moves most of what barely carries anything. That no
other active set of tau gives a solution is tested for every array, over all 4096 supports.
"""

from __future__ import annotations

from verification.framework.case import Measured
from verification.solver_suite.check import COMPLIANCE, Entrant, Fault, check
from verification.solver_suite.checks.exact import BOUND, SOURCE, TWO_SIDED
from verification.solver_suite.checks.residuals import AND_MEAN
from verification.solver_suite.pin_arrays import PEAK, PinArray, graded, standing
from verification.solver_suite.protocol import Coupling

TAU, BETA = 0.05 * PEAK, 0.4
COUPLINGS = (
    Coupling(TAU, BETA, COMPLIANCE, 0.9),
    Coupling(TAU, BETA, -COMPLIANCE / 2, 0.9),
    Coupling(TAU, BETA, -COMPLIANCE / 2, 2.2),
)
"""In turn: another c0, and that alone; then another direction."""
FREE = tuple(PinArray(graded(standing(12), 3), coupling) for coupling in COUPLINGS)
PERIODIC = tuple(PinArray(graded(standing(13), 3), coupling, periodic=True) for coupling in COUPLINGS)
"""An odd number of elements has no Nyquist frequency to disagree about."""
SIGNS = "; c is lower minus upper, and odd in the offset (verification.solver_suite.protocol)"
SYMBOLS = "the exact Fourier symbols (verification.exact.fourier)" + SIGNS
BY_LOAD = BOUND + "it holds with c, which is skew"
FRICTION = (
    Fault.SIGN_OF_C,
    Fault.TAU_MISSING,
    Fault.TAU_EVERYWHERE,
    Fault.TAU_NOT_ON_ALL,
    Fault.TRANSPOSED,
    Fault.HALF_ELEMENT,
    Fault.MODULUS_OFF,
)
IN_PERIODS = (
    Fault.APERIODIC_FOR_PERIODIC,
    Fault.TAU_BESIDE,
    Fault.TAU_ALONG_X,
    Fault.SIGN_OF_C_LOST,
)


@check(
    "sheared-pins",
    title="A bed of pins that slides",
    claim="With tau and beta, at two c0 of unlike sign and in two oblique directions, each changed alone, "
    "the pins carry the pressures that were chosen, down to 0.3 % of the largest",
    source=SOURCE + SIGNS,
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BY_LOAD,
    catches=(*FRICTION, Fault.C0_KEPT, Fault.DIRECTION_KEPT, Fault.CORNER_LEFT_OUT, Fault.PADDING_SHORT),
)
def sheared_pins(entrant: Entrant) -> Measured:
    return entrant.against(*(array.under_load(entrant) for array in FREE))


@check(
    "sheared-pins-approach",
    title="A bed of pins that slides at a prescribed approach",
    claim="The sliding pins carry the same pressures at the approach that their load takes",
    source=SOURCE + SIGNS,
    metric="at_most",
    tolerance=2.0,
    tolerance_reason=TWO_SIDED,
    catches=(
        *FRICTION,
        Fault.MEAN_DISPLACEMENT_LOST,
        Fault.CORNER_LEFT_OUT,
        Fault.PADDING_SHORT,
        Fault.UNCOUPLED_AT_APPROACH,
    ),
)
def sheared_pins_approach(entrant: Entrant) -> Measured:
    return entrant.against(FREE[-1].at_approach(entrant))


@check(
    "periodic-sheared-pins",
    title="A periodic bed of pins that slides",
    claim="With tau and beta, at two c0 of unlike sign and in two oblique directions, each changed alone, "
    "the pins carry the pressures that were chosen, across the border as well",
    source=SYMBOLS,
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BY_LOAD,
    catches=(*FRICTION, *IN_PERIODS, Fault.C0_KEPT, Fault.DIRECTION_KEPT, Fault.ODD_GRIDS),
)
def periodic_sheared_pins(entrant: Entrant) -> Measured:
    return entrant.against(*(array.under_load(entrant) for array in PERIODIC))


@check(
    "periodic-sheared-pins-approach",
    title="A periodic bed of pins that slides at a prescribed approach",
    claim="The sliding pins carry the same pressures at the approach of mean planes that their load takes",
    source=SYMBOLS,
    metric="at_most",
    tolerance=2.0,
    tolerance_reason=AND_MEAN + "3.0 here",
    catches=(
        *FRICTION,
        *IN_PERIODS,
        Fault.MEAN_PLANES_LOST,
        Fault.MEAN_PRESSURE_ADDED,
        Fault.UNCOUPLED_AT_APPROACH,
        Fault.ODD_GRIDS,
    ),
)
def periodic_sheared_pins_approach(entrant: Entrant) -> Measured:
    return entrant.against(PERIODIC[-1].at_approach(entrant))
