"""Independence of earlier problems: problems in turn that differ in one parameter at a time.

Codes keep transforms of their kernels, or whole answers, and may forget what these were made for. Each answer
is judged by itself, so that what is wrong in all of them shows as well. (c0 and the direction are changed in
the sliding beds of pins.) Sixteen elements a side at most: a solver of small problems is judged too.
"""

from __future__ import annotations

from refimpl.grid import Array
from verification.framework.case import Measured
from verification.solver_suite.check import CLAIMS, COMPLIANCE, MODULUS, Entrant, Fault, Pressed, check
from verification.solver_suite.checks.invariance import LOAD
from verification.solver_suite.checks.residuals import ALWAYS, CLAIM, PERIODIC_SOURCE, SOURCE, wavy
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.protocol import Coupling

KEPT = (*ALWAYS, Fault.SPACING_KEPT, Fault.MODULUS_KEPT)
"""Few other residuals are recomputed on squares this small: what those of large ones catch, these do too."""
LIGHT = 0.02 * MODULUS
"""Load (N) of periodic planes."""
BETA, TAU = 0.25, 0.02 * MODULUS
"""Little enough that there is one contact to be found: with both twice over, no element in it has less than
3 % of the peak, and none beside it a clearance below 0.2 % of the approach (computed in the tests)."""


def worst(entrant: Entrant, *answers: Pressed) -> Measured:
    """The worst residual of several answers, in claims; the note names the problem."""
    found = [entrant.residual(pressed) for pressed in answers]
    most = max(found)
    return Measured(most, unit=CLAIMS, note=f"problem {found.index(most) + 1} of {len(found)}")


def loads(entrant: Entrant, gap: Array, other: Array, load: float, *, periodic: bool) -> Measured:
    """A gap; at three times the modulus; at twice the spacing too; another size; the first again."""
    return worst(
        entrant,
        entrant.press(gap, 1.0, load=load, periodic=periodic),
        entrant.press(gap, 1.0, load=load, modulus=3 * MODULUS, periodic=periodic),
        entrant.press(gap, 2.0, load=load, modulus=3 * MODULUS, periodic=periodic),
        entrant.press(other, 1.0, load=load, periodic=periodic),
        entrant.press(gap, 1.0, load=load, periodic=periodic),
    )


def approaches(entrant: Entrant, gap: Array, lightly: float, well: float) -> Measured:
    """A gap at two approaches, the second at three times the modulus, and at twice the spacing too; and the
    first again.

    Approaches (m) count from first contact or, if they are negative, from the mean planes.
    """
    periodic = well < 0
    return worst(
        entrant,
        entrant.press(gap, 1.0, approach=lightly, periodic=periodic),
        entrant.press(gap, 1.0, approach=well, periodic=periodic),
        entrant.press(gap, 1.0, approach=well, modulus=3 * MODULUS, periodic=periodic),
        entrant.press(gap, 2.0, approach=well, modulus=3 * MODULUS, periodic=periodic),
        entrant.press(gap, 1.0, approach=lightly, periodic=periodic),
    )


@check(
    "memory",
    title="Problems in turn",
    claim="The modulus changes alone, then the spacing alone, then the size, and the first problem comes "
    "again: nothing of one gets into the next",
    source=SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*KEPT, Fault.TENSION),
)
def memory(entrant: Entrant) -> Measured:
    return loads(entrant, rough_bump(16, 45), rough_bump(12, 45), LOAD, periodic=False)


@check(
    "memory-periodic",
    title="Periodic problems in turn",
    claim="The same with periodic planes: modulus alone, spacing alone, size, and the first problem again",
    source=PERIODIC_SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*KEPT, Fault.TENSION),
)
def memory_periodic(entrant: Entrant) -> Measured:
    return loads(entrant, wavy(16, 45), wavy(15, 45), LIGHT, periodic=True)


@check(
    "memory-approaches",
    title="Approaches in turn",
    claim="The approach changes alone, then the modulus alone, then the spacing alone; and the first contact "
    "comes again",
    source=SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*KEPT, Fault.APPROACH_FORGOTTEN),
)
def memory_approaches(entrant: Entrant) -> Measured:
    gap = rough_bump(16, 45)
    return approaches(entrant, gap - gap.min(), 0.05, 0.1)


@check(
    "memory-approaches-periodic",
    title="Approaches of periodic planes in turn",
    claim="The same with approaches of the mean planes: approach, modulus and spacing, each alone; and the "
    "first contact comes again",
    source=PERIODIC_SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*KEPT, Fault.APPROACH_FORGOTTEN),
)
def memory_approaches_periodic(entrant: Entrant) -> Measured:
    gap = wavy(16, 45)
    mean = float(gap.mean() - gap.min())
    return approaches(entrant, gap, -0.6 * mean, -0.4 * mean)


@check(
    "memory-borders",
    title="Free and periodic problems in turn",
    claim="The same gap under the same load, free, periodic and free again: what was claimed is so each time",
    source=SOURCE + "; " + PERIODIC_SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(Fault.PERIODIC_FOR_APERIODIC, Fault.APERIODIC_FOR_PERIODIC, Fault.BORDERS_KEPT),
)
def memory_borders(entrant: Entrant) -> Measured:
    gap, borders = wavy(16, 46), (False, True, False)
    return worst(entrant, *(entrant.press(gap, 1.0, load=LIGHT, periodic=p) for p in borders))


@check(
    "memory-coupling",
    title="Friction in turn",
    claim="The same gap under the same load without friction, with beta, with twice that, with tau as well, "
    "with twice that, and without again: what was claimed is so each time",
    source=SOURCE + "; c is lower minus upper (verification.solver_suite.protocol)",
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(Fault.BETA_KEPT, Fault.TAU_KEPT, Fault.FRICTION_FORGOTTEN, Fault.TAU_MISSING, Fault.SIGN_OF_C),
)
def memory_coupling(entrant: Entrant) -> Measured:
    gap = rough_bump(16, 85)
    sliding = [
        Coupling(tau, beta, COMPLIANCE, 0.9)
        for tau, beta in ((0.0, BETA), (0.0, 2 * BETA), (TAU, 2 * BETA), (2 * TAU, 2 * BETA))
    ]
    answers = (entrant.press(gap, 1.0, load=LOAD, coupling=coupling) for coupling in (None, *sliding, None))
    return worst(entrant, *answers)
