"""Independence of earlier problems: problems in turn that differ in one parameter at a time.

Codes keep transforms of their kernels, or whole answers, and may forget what these were made for. Sixteen
elements a side at most. (c0 and the direction are changed in the sliding arrays of pins.)
"""

from __future__ import annotations

from typing import Any

from refimpl.grid import Array
from verification.solver_suite.check import COMPLIANCE, MODULUS, Judge, Press, pressing
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.invariance import LIGHT, LOAD
from verification.solver_suite.checks.residuals import (
    ALWAYS,
    PERIODIC_SOURCE,
    SIGN,
    SOURCE,
    held,
    wavy,
    worst_in_turn,
)
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.protocol import Coupling

KEPT = (*ALWAYS, F.SPACING_KEPT, F.MODULUS_KEPT)
"""Few other residuals are recomputed on squares this small: what those of large ones catch, these do too."""
STIFF = 3 * MODULUS
BETA, TAU = 0.25, 0.02 * MODULUS
"""Little enough that there is one contact to be found: with both twice over, no element in it has less than
3 % of the peak, and none beside it a clearance below 0.2 % of the approach (computed in the tests)."""
FRICTION = [
    None,
    *(
        Coupling(tau, beta, COMPLIANCE, 0.9)
        for tau, beta in ((0.0, BETA), (0.0, 2 * BETA), (TAU, 2 * BETA), (2 * TAU, 2 * BETA))
    ),
    None,
]


def in_turn(*problems: Press) -> Judge:
    """Return the judge of several problems by the worst of their residuals."""
    return lambda entrant: worst_in_turn(entrant, [press(entrant) for press in problems])


def loads(gap: Array, other: Array, **how: Any) -> Judge:
    """Pose a gap; at three times the modulus; at twice the spacing too; another size; the first again."""
    first = pressing(gap, **how)
    stiff, spread = pressing(gap, modulus=STIFF, **how), pressing(gap, 2.0, modulus=STIFF, **how)
    return in_turn(first, stiff, spread, pressing(other, **how), first)


def approaches(gap: Array, lightly: float, well: float, **how: Any) -> Judge:
    """Pose a gap at two approaches, the second at 3 E*, then at twice the spacing; the first again."""
    first, deeper = pressing(gap, deep=lightly, **how), how | {"deep": well}
    stiff, spread = pressing(gap, modulus=STIFF, **deeper), pressing(gap, 2.0, modulus=STIFF, **deeper)
    return in_turn(first, pressing(gap, **deeper), stiff, spread, first)


# fmt: off
CHECKS = (
    held("memory", "Problems in turn",
         "The modulus changes alone, then the spacing alone, then the size, and the first problem comes "
         "again: nothing of one gets into the next",
         SOURCE, (*KEPT, F.TENSION), loads(rough_bump(16, 45), rough_bump(12, 45), load=LOAD)),
    held("memory-periodic", "Periodic problems in turn",
         "The same with periodic planes: modulus alone, spacing alone, size, and the first problem again",
         PERIODIC_SOURCE, (*KEPT, F.TENSION), loads(wavy(16, 45), wavy(15, 45), load=LIGHT, periodic=True)),
    held("memory-approaches", "Approaches in turn",
         "The approach changes alone, then the modulus alone, then the spacing alone; and the first contact "
         "comes again",
         SOURCE, (*KEPT, F.APPROACH_FORGOTTEN), approaches(rough_bump(16, 45), 0.05, 0.1)),
    held("memory-approaches-periodic", "Approaches of periodic planes in turn",
         "The same with approaches of the mean planes: approach, modulus and spacing, each alone; and the "
         "first contact comes again",
         PERIODIC_SOURCE, (*KEPT, F.APPROACH_FORGOTTEN), approaches(wavy(16, 45), -0.6, -0.4, periodic=True)),
    held("memory-borders", "Free and periodic problems in turn",
         "The same gap under the same load, free, periodic and free again: what was claimed is so each time",
         SOURCE + "; " + PERIODIC_SOURCE,
         (F.PERIODIC_FOR_APERIODIC, F.APERIODIC_FOR_PERIODIC, F.BORDERS_KEPT),
         in_turn(*(pressing(wavy(16, 46), load=LIGHT, periodic=p) for p in (False, True, False)))),
    held("memory-coupling", "Friction in turn",
         "The same gap under the same load without friction, with beta, with twice that, with tau as well, "
         "with twice that, and without again: what was claimed is so each time",
         SOURCE + SIGN, (F.BETA_KEPT, F.TAU_KEPT, F.FRICTION_FORGOTTEN, F.TAU_MISSING, F.SIGN_OF_C),
         in_turn(*(pressing(rough_bump(16, 85), load=LOAD, coupling=each) for each in FRICTION))),
)
# fmt: on
