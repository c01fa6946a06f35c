"""Pressures that end at a hardness: chosen ones that come back, residuals of both bounds, plastic limit."""

from __future__ import annotations

from dataclasses import replace

from verification.framework.case import Measured
from verification.solver_suite.check import COMPLIANCE, MODULUS, Check, Entrant, pressing
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.exact import BOUND, HIDDEN, SOURCE, by_approach, by_load
from verification.solver_suite.checks.memory import in_turn
from verification.solver_suite.checks.residuals import (
    ALWAYS,
    PERIODIC_SOURCE,
    held,
    judged,
    residual,
    wavy,
)
from verification.solver_suite.checks.residuals import SOURCE as CONDITIONS
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.pin_arrays import PEAK, PinArray, standing, uneven
from verification.solver_suite.protocol import Coupling

BUMP, WAVY = 0.03 * MODULUS, 0.08 * MODULUS
"""Hardness (Pa) of a rough bump and of a rough plane: a quarter to a half of the contact is at it."""
SEEN = tuple(fault for fault in ALWAYS if fault is not F.SINGLE_PRECISION)
"""Without noise: where both bounds count no element is measured against the lowest v of all."""
OF_CAP = (F.HARDNESS_IGNORED, F.HARDNESS_CUT)
SLIDING = Coupling(0.02 * PEAK, 0.3, COMPLIANCE, sliding_direction=2.2)


def _plastic_limit(entrant: Entrant) -> Measured:
    hardness = 1e-3 * MODULUS
    pressed = entrant.press(rough_bump(24, seed=9), 1.0, load=0.497 * hardness, hardness=hardness)
    short = pressed.pressure[pressed.pressure > 0] < 0.999 * hardness
    found = judged(entrant, pressed)
    return replace(found, note=f"{found.note}; {int(short.sum())} of {short.size} below the hardness")


# fmt: off
CHECKS = (
    Check("capped-pins", "A bed of pins, half of them at the hardness",
          "Pressures that were chosen, some at the hardness over bodies that overlap, come back under a load",
          SOURCE, 1.1, HIDDEN, (*OF_CAP, F.MODULUS_OFF, F.TRANSPOSED, F.PERIODIC_FOR_APERIODIC),
          by_load(PinArray.yielding(uneven(standing(12), seed=1)))),
    Check("capped-pins-approach", "A bed of pins at an approach, half of them at the hardness",
          "Pressures that were chosen, some at the hardness, come back at a prescribed approach",
          SOURCE, 1.1, BOUND + "the approach is exact",
          (*OF_CAP, F.MODULUS_OFF, F.TRANSPOSED, F.MEAN_DISPLACEMENT_LOST),
          by_approach(PinArray.yielding(uneven(standing(12), seed=2)))),
    Check("capped-sheared-pins", "A sliding bed of pins, half of them at the hardness",
          "With shear tau + beta f, at the hardness tau + beta H, the chosen pressures come back",
          SOURCE, 1.1, BOUND + "shear is fixed on pins that all stand", (*OF_CAP, F.SIGN_OF_C, F.TAU_MISSING),
          by_load(PinArray.yielding(uneven(standing(12), seed=3), SLIDING))),
    held("capped-residual", "A rough bump that yields: what was claimed is so",
         "The complementarity gap of both bounds, load balance, tension and excess meet the claim",
         CONDITIONS, (*SEEN, *OF_CAP, F.PERIODIC_FOR_APERIODIC, F.NEAR_FIELD, F.TENSION),
         residual(rough_bump(32, seed=3), load=0.02 * MODULUS, hardness=BUMP)),
    held("capped-residual-approach", "A rough bump that yields at an approach: what was claimed is so",
         "At a prescribed approach the gap of both bounds, tension and excess meet the claim",
         CONDITIONS, (*SEEN, *OF_CAP, F.PERIODIC_FOR_APERIODIC, F.MEAN_DISPLACEMENT_LOST, F.ODD_GRIDS),
         residual(rough_bump(31, seed=5), deep=0.05, hardness=BUMP)),
    held("capped-residual-periodic", "A periodic rough plane that yields: what was claimed is so",
         "The complementarity gap of both bounds, load balance, tension and excess meet the claim",
         PERIODIC_SOURCE, (*SEEN, *OF_CAP, F.APERIODIC_FOR_PERIODIC, F.TENSION, F.MEAN_PRESSURE_LOST),
         residual(wavy(32, seed=91), load=0.02 * MODULUS, periodic=True, hardness=WAVY)),
    held("capped-lower-and-lower", "One rough bump with three hardnesses, one after the other",
         "Each hardness has its own pressures: none is kept from an earlier problem",
         CONDITIONS, (*OF_CAP, F.HARDNESS_KEPT),
         in_turn(*(pressing(rough_bump(24, seed=8), load=0.01 * MODULUS, hardness=share * BUMP)
                   for share in (2.0, 1.0, 0.5)))),
    held("plastic-limit", "The fully plastic limit",
         "Under half the load that the hardness bears on the whole square, nearly all of the contact is at "
         "the hardness, and the residuals meet the claim",
         CONDITIONS, (*OF_CAP, F.MEAN_PRESSURE_LOST, F.TENSION), _plastic_limit),
)
# fmt: on
