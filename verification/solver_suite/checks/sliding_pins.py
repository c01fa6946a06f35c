"""Arrays of pins that slide, free and periodic, under a load and at an approach: pressures chosen beforehand.

Their pressures span two and a half decades, so that tau moves most of what barely carries anything. That no
other active set of tau gives a solution is tested for every array, over all 4096 supports.
"""

from __future__ import annotations

from verification.solver_suite.check import COMPLIANCE, Check
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.exact import BOUND, SOURCE, TWO_SIDED, by_approach, by_load
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
SKEW = BOUND + "it holds with c, which is skew"
FRICTION = (
    *(F.SIGN_OF_C, F.TAU_MISSING, F.TAU_EVERYWHERE, F.TAU_NOT_ON_ALL),
    *(F.TRANSPOSED, F.HALF_ELEMENT, F.MODULUS_OFF),
)
IN_PERIODS = (F.APERIODIC_FOR_PERIODIC, F.TAU_BESIDE, F.TAU_ALONG_X, F.SIGN_OF_C_LOST)

# fmt: off
CHECKS = (
    Check("sheared-pins", "A bed of pins that slides",
          "With tau and beta, at two c0 of unlike sign and in two oblique directions, each changed alone, "
          "the pins carry the pressures that were chosen, down to 0.3 % of the largest",
          SOURCE + SIGNS, 1.1, SKEW,
          (*FRICTION, F.C0_KEPT, F.DIRECTION_KEPT, F.CORNER_LEFT_OUT, F.PADDING_SHORT), by_load(*FREE)),
    Check("sheared-pins-approach", "A bed of pins that slides at a prescribed approach",
          "The sliding pins carry the same pressures at the approach that their load takes",
          SOURCE + SIGNS, 2.0, TWO_SIDED,
          (*FRICTION, F.MEAN_DISPLACEMENT_LOST, F.CORNER_LEFT_OUT, F.PADDING_SHORT, F.UNCOUPLED_AT_APPROACH),
          by_approach(FREE[-1])),
    Check("periodic-sheared-pins", "A periodic bed of pins that slides",
          "With tau and beta, at two c0 of unlike sign and in two oblique directions, each changed alone, "
          "the pins carry the pressures that were chosen, across the border as well",
          SYMBOLS, 1.1, SKEW, (*FRICTION, *IN_PERIODS, F.C0_KEPT, F.DIRECTION_KEPT, F.ODD_GRIDS),
          by_load(*PERIODIC)),
    Check("periodic-sheared-pins-approach", "A periodic bed of pins that slides at a prescribed approach",
          "The sliding pins carry the same pressures at the approach of mean planes that their load takes",
          SYMBOLS, 2.0, AND_MEAN + "3.0 here",
          (*FRICTION, *IN_PERIODS, F.MEAN_PLANES_LOST, F.MEAN_PRESSURE_ADDED, F.UNCOUPLED_AT_APPROACH,
           F.ODD_GRIDS),
          by_approach(PERIODIC[-1])),
)
# fmt: on
