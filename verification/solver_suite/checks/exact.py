"""Discrete problems whose exact answer is known beforehand: the pressures are chosen, the gap follows.

The squared error in the energy norm counts in units of the claim (`reference_solution.misfit`).
"""

from __future__ import annotations

import mpmath as mp
import numpy as np

from verification.exact.patch import Patch
from verification.framework.case import Measured
from verification.solver_suite.check import CLAIMS, MODULUS, Check, Entrant, Judge
from verification.solver_suite.check import Fault as F
from verification.solver_suite.gaps import centres
from verification.solver_suite.pin_arrays import FAR, PinArray, graded, standing, uneven

BOUND = "proven: the squared energy-norm error is at most the relative complementarity gap, 1 claim; "
TWO_SIDED = BOUND + "a prescribed approach adds as much again for its penetration"
HIDDEN = BOUND + "a load off by 1e-8 adds nothing that shows"
SOURCE = "influence coefficients from 50 digits (verification.exact.kernel_reference)"
M, WIDE = 12, 160
"""Elements a side; and so many that a circle of 256 points puts the farthest pins at 97 elements for 159."""
ALWAYS = (F.MODULUS_OFF, F.MODULUS_DOUBLED, F.NEAR_FIELD)


def by_load(*arrays: PinArray) -> Judge:
    """Return the judge of pins under the load of the pressures that were chosen."""
    return lambda entrant: entrant.against(*(pins.under_load(entrant) for pins in arrays))


def by_approach(pins: PinArray) -> Judge:
    """Return the judge of pins at the approach of the pressures that were chosen."""
    return lambda entrant: entrant.against(pins.at_approach(entrant))


def _one_element(entrant: Entrant) -> Measured:
    gap = np.full((4, 4), FAR)
    gap[1, 2] = 0.0
    pressed = entrant.press(gap, 1.0, approach=1e-3)
    exact = 1e-3 * np.pi * MODULUS * 0.25 / float(4 * mp.asinh(1))
    off = abs(pressed.load / exact - 1) / entrant.claim
    return Measured(off, unit=CLAIMS, data={"load (N)": pressed.load, "exact": exact})


def _square_patch(entrant: Entrant) -> Measured:
    side, n = 1.0, 24
    x, y = centres(side, n)
    exact = np.zeros((n, n))
    exact[3:11, 8:20] = 1e-3 * MODULUS
    block = Patch(1e-3 * MODULUS, 8 / n, 12 / n, MODULUS)
    u = block.displacement(x - x[3:11].mean(), y - y[:, 8:20].mean())
    gap = u.max() - u + np.where(exact > 0, 0.0, 0.1 * u.max())
    load = float(exact.sum()) * (side / n) ** 2
    return entrant.against((entrant.press(gap, side, load=load), exact))


# fmt: off
CHECKS = (
    Check("one-element", "One element pressed in",
          "A single loaded element carries pi E* h/(4 arsinh 1) per m of approach",
          "Love 1929: the centre of a uniformly loaded square", 1.0,
          "in claims: with one unknown the load's relative error is half the complementarity gap",
          (F.MODULUS_OFF, F.MODULUS_DOUBLED, F.MEAN_DISPLACEMENT_LOST), _one_element),
    Check("pins", "A bed of pins at a prescribed approach",
          "Twelve single elements of unequal height, near and far, in all corners and on all edges of the "
          "square, carry the pressures that were chosen",
          SOURCE, 2.0, TWO_SIDED,
          (*ALWAYS, F.TRANSPOSED, F.HALF_ELEMENT, F.PERIODIC_FOR_APERIODIC, F.MEAN_DISPLACEMENT_LOST,
           F.CORNER_LEFT_OUT),
          by_approach(PinArray(uneven(standing(M), seed=1)))),
    Check("wide-pins", "A bed of pins on 160 by 160 elements",
          "The pins in all corners of the largest grid of the suite carry the pressures that were chosen, "
          "though some are 0.3 % of others",
          SOURCE, 1.1, HIDDEN, (*ALWAYS, F.TRANSPOSED, F.CORNER_LEFT_OUT, F.PADDING_CAPPED),
          by_load(PinArray(graded(standing(WIDE), seed=2)))),
    Check("chequered", "A chequered contact under a load",
          "Random pressures on every other element, the harshest waves a grid can carry, come back",
          SOURCE, 1.1, HIDDEN, (F.NEAR_FIELD, F.MODULUS_OFF, F.MODULUS_DOUBLED, F.HALF_ELEMENT),
          by_load(PinArray(uneven(np.indices((M, M)).sum(axis=0) % 2 == 0, seed=2)))),
    Check("square-patch", "A rectangular patch of uniform pressure",
          "The gap that Love's displacement of an off-centre rectangle leaves is closed by uniform pressure",
          "Love 1929; Johnson 1985, Eq. (3.25)", 1.1,
          BOUND + "the closed form's rounding, 1e-13, does not show",
          (*ALWAYS, F.TRANSPOSED, F.HALF_ELEMENT, F.PERIODIC_FOR_APERIODIC), _square_patch),
)
# fmt: on
