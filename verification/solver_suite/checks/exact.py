"""Discrete problems whose exact answer is known beforehand: the pressures are chosen, the gap follows.

Each counts the squared error in the energy norm in units of the residual that the solver claims, so a lax
claim and a strict one are held to the same bound (`reference_solution.misfit`).
"""

from __future__ import annotations

import mpmath as mp
import numpy as np

from verification.exact.patch import Patch
from verification.framework.case import Measured
from verification.solver_suite.check import CLAIMS, MODULUS, Entrant, Fault, check
from verification.solver_suite.gaps import centres
from verification.solver_suite.pin_arrays import FAR, PinArray, graded, standing, uneven

BOUND = "proven: the squared energy-norm error is at most the relative complementarity gap, 1 claim; "
TWO_SIDED = BOUND + "a prescribed approach adds as much again for its penetration"
SOURCE = "influence coefficients from 50 digits (verification.exact.kernel_reference)"
M, WIDE = 12, 160
"""Elements a side; and so many that a circle of 256 points puts the farthest pins at 97 elements for 159."""
ALWAYS = (Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.NEAR_FIELD)


@check(
    "one-element",
    title="One element pressed in",
    claim="A single loaded element carries pi E* h/(4 arsinh 1) per m of approach",
    source="Love 1929: the centre of a uniformly loaded square",
    metric="at_most",
    tolerance=1.0,
    tolerance_reason="in claims: with one unknown the load's relative error is half the complementarity gap",
    catches=(Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.MEAN_DISPLACEMENT_LOST),
)
def one_element(entrant: Entrant) -> Measured:
    gap = np.full((4, 4), FAR)
    gap[1, 2] = 0.0
    pressed = entrant.press(gap, 1.0, approach=1e-3)
    exact = 1e-3 * np.pi * MODULUS * 0.25 / float(4 * mp.asinh(1))
    off = abs(pressed.load / exact - 1) / entrant.claim
    return Measured(off, unit=CLAIMS, data={"P": pressed.load, "exact": exact})


@check(
    "pins",
    title="A bed of pins at a prescribed approach",
    claim="Twelve single elements of unequal height, near and far, in all corners and on all edges of the "
    "square, carry the pressures that were chosen",
    source=SOURCE,
    metric="at_most",
    tolerance=2.0,
    tolerance_reason=TWO_SIDED,
    catches=(
        *ALWAYS,
        Fault.TRANSPOSED,
        Fault.HALF_ELEMENT,
        Fault.PERIODIC_FOR_APERIODIC,
        Fault.MEAN_DISPLACEMENT_LOST,
        Fault.CORNER_LEFT_OUT,
    ),
)
def pins(entrant: Entrant) -> Measured:
    return entrant.against(PinArray(uneven(standing(M), seed=1)).at_approach(entrant))


@check(
    "wide-pins",
    title="A bed of pins on 160 by 160 elements",
    claim="The pins in all corners of the largest grid of the suite carry the pressures that were chosen, "
    "though some are 0.3 % of others",
    source=SOURCE,
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "a load off by 1e-8 adds nothing that shows",
    catches=(*ALWAYS, Fault.TRANSPOSED, Fault.CORNER_LEFT_OUT, Fault.PADDING_CAPPED),
)
def wide_pins(entrant: Entrant) -> Measured:
    return entrant.against(PinArray(graded(standing(WIDE), seed=2)).under_load(entrant))


@check(
    "chequered",
    title="A chequered contact under a load",
    claim="Random pressures on every other element, the harshest waves a grid can carry, come back",
    source=SOURCE,
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "a load off by 1e-8 adds nothing that shows",
    catches=(Fault.NEAR_FIELD, Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.HALF_ELEMENT),
)
def chequered(entrant: Entrant) -> Measured:
    i, j = np.indices((M, M))
    return entrant.against(PinArray(uneven((i + j) % 2 == 0, seed=2)).under_load(entrant))


@check(
    "square-patch",
    title="A rectangular patch of uniform pressure",
    claim="The gap that Love's displacement of an off-centre rectangle leaves is closed by uniform pressure",
    source="Love 1929; Johnson 1985, Eq. (3.25)",
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "the closed form's rounding, 1e-13, does not show",
    catches=(
        Fault.MODULUS_OFF,
        Fault.MODULUS_DOUBLED,
        Fault.NEAR_FIELD,
        Fault.TRANSPOSED,
        Fault.HALF_ELEMENT,
        Fault.PERIODIC_FOR_APERIODIC,
    ),
)
def square_patch(entrant: Entrant) -> Measured:
    side, n = 1.0, 24
    x, y = centres(side, n)
    exact = np.zeros((n, n))
    exact[3:11, 8:20] = 1e-3 * MODULUS
    block = Patch(1e-3 * MODULUS, 8 / n, 12 / n, MODULUS)
    u = block.displacement(x - x[3:11].mean(), y - y[:, 8:20].mean())
    gap = u.max() - u + np.where(exact > 0, 0.0, 0.1 * u.max())
    load = float(exact.sum()) * (side / n) ** 2
    return entrant.against((entrant.press(gap, side, load=load), exact))
