"""Larger squares that touch all over: offsets from one border to the other count, between pressures that a
solver has to find. The beds of pins have a few elements in contact, and those of large squares are given.
"""

from __future__ import annotations

from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import COMPLIANCE, MODULUS, Entrant, Fault, check
from verification.solver_suite.checks.residuals import ALWAYS, CLAIM, PERIODIC_SOURCE, SOURCE, judged, wavy
from verification.solver_suite.gaps import waves
from verification.solver_suite.protocol import Coupling

LOAD = 0.02 * MODULUS
"""Load (N): a fifth of the square touches, with all four corners."""
CONVOLVED = SOURCE + ", convolved"


@check(
    "wide-approach",
    title="A free wavy square of 80 by 80 elements at a prescribed approach",
    claim="With contact from corner to corner no element penetrates, and the loaded ones lie at the approach",
    source=CONVOLVED,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*ALWAYS, Fault.PERIODIC_FOR_APERIODIC, Fault.MEAN_DISPLACEMENT_LOST, Fault.NEAR_FIELD),
)
def wide_approach(entrant: Entrant) -> Measured:
    gap = wavy(80, seed=91)
    return judged(entrant, entrant.press(gap, 1.0, approach=float(gap.min()) + 0.025))


@check(
    "wide-sliding",
    title="A free wavy square of 72 by 72 elements that slides",
    claim="With shear beta f in an oblique direction, and contact from corner to corner, the residuals meet "
    "the claim",
    source=CONVOLVED + "; c is lower minus upper (verification.solver_suite.protocol)",
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*ALWAYS, Fault.SIGN_OF_C, Fault.SHEAR_PADDING_CAPPED),
)
def wide_sliding(entrant: Entrant) -> Measured:
    coupling = Coupling(tau=0.0, beta=0.5, shear_compliance=COMPLIANCE, sliding_direction=0.6)
    return judged(entrant, entrant.press(wavy(72, seed=91), 1.0, load=LOAD, coupling=coupling))


@check(
    "wide-periodic",
    title="A periodic rough plane of 100 by 100 elements",
    claim="Gap, balance and tension meet the claim with the periodic symbols",
    source=PERIODIC_SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*ALWAYS, Fault.APERIODIC_FOR_PERIODIC, Fault.TENSION, Fault.MEAN_PRESSURE_LOST),
)
def wide_periodic(entrant: Entrant) -> Measured:
    return judged(entrant, entrant.press(wavy(100, seed=91), 1.0, load=LOAD, periodic=True))


@check(
    "full-square",
    title="A wavy square pressed flat all over",
    claim="With every element of a free square in contact the pressures are those of elimination",
    source="Gauss' elimination, written for this suite",
    metric="at_most",
    tolerance=1.1,
    tolerance_reason="in claims of the squared energy-norm error: at most the complementarity gap (proven)",
    catches=(
        Fault.MODULUS_DOUBLED,
        Fault.TRANSPOSED,
        Fault.HALF_ELEMENT,
        Fault.NEAR_FIELD,
        Fault.PERIODIC_FOR_APERIODIC,
        Fault.MEAN_PRESSURE_LOST,
        Fault.CORNER_LEFT_OUT,
    ),
)
def full_square(entrant: Entrant) -> Measured:
    gap = 3e-3 * waves(16, seed=93, shortest=5)
    pressed = entrant.press(gap, 1.0, load=0.2 * MODULUS)
    return entrant.against((pressed, reference_solution.eliminated(pressed.problem)))
