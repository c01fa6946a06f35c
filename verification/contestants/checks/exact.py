"""Discrete problems whose exact answer is known beforehand: the pressures are chosen, the gap follows.

Each counts the squared error in the energy norm in units of the residual that the solver claims, so a lax
claim and a strict one are held to the same bound (`referee.misfit`).
"""

from __future__ import annotations

from functools import cache

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from verification.case import Measured
from verification.contestants.check import MODULUS, Entrant, Fault, check
from verification.contestants.gaps import centres
from verification.exact.kernel_reference import normal
from verification.exact.patch import Patch

BOUND = (
    "proven: the squared energy-norm error is at most the relative complementarity gap, which is 1 claim; "
)
M, DEPTH, FAR = 12, 1e-3, 1.0
PINS = ((1, 2), (1, 3), (4, 9), (5, 5), (6, 5), (9, 1), (10, 10), (8, 11))
ALWAYS = (Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.NEAR_FIELD)


@cache
def coefficients() -> Array:
    """``I[1/rho]`` of a unit element at whole offsets, ``(M, M)``, from 50 digits."""
    table = np.empty((M, M))
    for i in range(M):
        for j in range(i + 1):
            table[i, j] = table[j, i] = float(normal(float(i), float(j), 1.0, 1.0))
    return table


def chosen(contact: NDArray[np.bool_], seed: int) -> tuple[Array, Array]:
    """Random pressures (Pa) on a contact set, and the gap (m) over a unit square that they solve at `DEPTH`."""
    shape = np.where(contact, np.random.default_rng(seed).uniform(0.3, 1.0, contact.shape), 0.0)
    i, j = (axis.ravel() for axis in np.indices(contact.shape))
    influence = coefficients()[abs(i[:, None] - i), abs(j[:, None] - j)] / (np.pi * MODULUS * M)
    u = (influence @ shape.ravel()).reshape(shape.shape)
    scale = 0.5 * DEPTH / u[contact].max()
    gap = np.where(contact, DEPTH - scale * u, DEPTH + FAR)
    return scale * shape, gap


@check(
    "one-element",
    title="One element pressed in",
    claim="A single loaded element carries pi E* h/(4 arsinh 1) per metre of approach",
    source="Love 1929: the centre of a uniformly loaded square",
    metric="at_most",
    tolerance=1.0,
    tolerance_reason="in claims: with one unknown the load's relative error is half the complementarity gap",
    catches=(*ALWAYS, Fault.MEAN_DISPLACEMENT_LOST),
)
def one_element(entrant: Entrant) -> Measured:
    gap = np.full((4, 4), FAR)
    gap[1, 2] = 0.0
    pressed = entrant.press(gap, 1.0, approach=DEPTH)
    exact = DEPTH * np.pi * MODULUS * 0.25 / float(4 * mp.asinh(1))
    return Measured(abs(pressed.load / exact - 1) / entrant.claim, data={"P": pressed.load, "exact": exact})


@check(
    "pins",
    title="A bed of pins at a prescribed approach",
    claim="Eight single elements, near and far, of unequal height carry the pressures that were chosen",
    source="influence coefficients from 50 digits (verification.exact.kernel_reference)",
    metric="at_most",
    tolerance=2.0,
    tolerance_reason=BOUND + "a prescribed approach adds as much again for its penetration",
    catches=(
        *ALWAYS,
        Fault.TRANSPOSED,
        Fault.HALF_ELEMENT,
        Fault.PERIODIC_FOR_APERIODIC,
        Fault.MEAN_DISPLACEMENT_LOST,
    ),
)
def pins(entrant: Entrant) -> Measured:
    contact = np.zeros((M, M), dtype=bool)
    contact[tuple(zip(*PINS, strict=True))] = True
    exact, gap = chosen(contact, seed=1)
    return Measured(entrant.misfit(entrant.press(gap, 1.0, approach=DEPTH), exact))


@check(
    "chequered",
    title="A chequered contact under a load",
    claim="Random pressures on every other element, the harshest waves a grid can carry, come back",
    source="influence coefficients from 50 digits (verification.exact.kernel_reference)",
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "a load off by 1e-8 adds nothing that shows",
    catches=(Fault.NEAR_FIELD, Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.HALF_ELEMENT),
)
def chequered(entrant: Entrant) -> Measured:
    i, j = np.indices((M, M))
    exact, gap = chosen((i + j) % 2 == 0, seed=2)
    return Measured(entrant.misfit(entrant.press(gap, 1.0, load=float(exact.sum()) / M**2), exact))


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
    return Measured(entrant.misfit(entrant.press(gap, side, load=load), exact))
