"""Larger squares that touch all over: offsets from one border to the other count, between pressures that a
solver has to find. The arrays of pins have a few elements in contact, and those of large squares are given.
"""

from __future__ import annotations

from verification.solver_suite.check import MODULUS, Check
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.residuals import (
    ALWAYS,
    PERIODIC_SOURCE,
    PROVEN,
    SIGN,
    SOURCE,
    elimination,
    held,
    residual,
    sliding,
    wavy,
)
from verification.solver_suite.gaps import waves

LOAD = 0.02 * MODULUS
"""Load (N): a fifth of the square touches, with all four corners."""
CONVOLVED = SOURCE + ", convolved"

# fmt: off
CHECKS = (
    held("wide-approach", "A free wavy square of 80 by 80 elements at a prescribed approach",
         "With contact from corner to corner no element penetrates, and the loaded ones lie at the approach",
         CONVOLVED, (*ALWAYS, F.PERIODIC_FOR_APERIODIC, F.MEAN_DISPLACEMENT_LOST, F.NEAR_FIELD),
         residual(wavy(80, seed=91), deep=0.025)),
    held("wide-sliding", "A free wavy square of 72 by 72 elements that slides",
         "With shear beta f in an oblique direction, and contact from corner to corner, the residuals meet "
         "the claim",
         CONVOLVED + SIGN, (*ALWAYS, F.SIGN_OF_C, F.SHEAR_PADDING_CAPPED),
         residual(wavy(72, seed=91), load=LOAD, coupling=sliding(0.6))),
    held("wide-periodic", "A periodic rough plane of 100 by 100 elements",
         "Gap, balance and tension meet the claim with the periodic symbols",
         PERIODIC_SOURCE, (*ALWAYS, F.APERIODIC_FOR_PERIODIC, F.TENSION, F.MEAN_PRESSURE_LOST),
         residual(wavy(100, seed=91), load=LOAD, periodic=True)),
    Check("full-square", "A wavy square pressed flat all over",
          "With every element of a free square in contact the pressures are those of elimination",
          "Gauss' elimination, written for this suite", 1.1, PROVEN,
          (F.MODULUS_DOUBLED, F.TRANSPOSED, F.HALF_ELEMENT, F.NEAR_FIELD, F.PERIODIC_FOR_APERIODIC,
           F.MEAN_PRESSURE_LOST, F.CORNER_LEFT_OUT),
          elimination(3e-3 * waves(16, seed=93, shortest=5), load=0.2 * MODULUS)),
)
# fmt: on
