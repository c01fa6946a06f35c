"""Discrete problems whose exact answer is known beforehand: the pressures are chosen, the gap follows.

Each counts the squared error in the energy norm in units of the residual that the solver claims, so a lax
claim and a strict one are held to the same bound (`referee.misfit`).
"""

from __future__ import annotations

from functools import cache

import mpmath as mp
import numpy as np

from refimpl.friction import Mask
from refimpl.grid import Array
from verification.case import Measured
from verification.contestants.check import COMPLIANCE, MODULUS, Entrant, Fault, check
from verification.contestants.gaps import centres
from verification.contestants.protocol import Coupling
from verification.exact import kernel_reference
from verification.exact.patch import Patch

BOUND = "proven: the squared energy-norm error is at most the relative complementarity gap, 1 claim; "
M, FAR, PEAK = 12, 0.5, 1e-3 * MODULUS
"""Elements a side, gap (m) of those out of reach on a unit square, largest pressure (Pa)."""
PINS = ((1, 2), (1, 3), (4, 9), (5, 5), (6, 5), (9, 1), (10, 10), (8, 11))
ALWAYS = (Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.NEAR_FIELD)


@cache
def coefficients() -> tuple[Array, Array]:
    """``I[1/rho]`` and ``I[x/rho^2]`` of a unit element at whole offsets, ``(M, M)`` each, from 50 digits."""
    normal, shear = np.empty((2, M, M))
    for i, j in np.ndindex(M, M):
        normal[i, j] = float(kernel_reference.normal(float(i), float(j), 1.0, 1.0))
        shear[i, j] = float(kernel_reference.tangential(float(i), float(j), 1.0, 1.0))
    return normal, shear


def displacement(pressure: Array, coupling: Coupling | None = None) -> Array:
    """Normal displacement (m) of a unit square of ``(M, M)`` elements, summed element by element."""
    normal, shear = coefficients()
    u = np.zeros((M, M))
    for k, m in np.argwhere(pressure > 0):
        i, j = np.arange(M)[:, None] - k, np.arange(M)[None, :] - m
        u += pressure[k, m] / (np.pi * MODULUS) * normal[abs(i), abs(j)]
        if coupling is not None:
            r, angle = coupling.tau + coupling.beta * pressure[k, m], coupling.sliding_direction
            along_x, along_y = np.sign(i) * shear[abs(i), abs(j)], np.sign(j) * shear[abs(j), abs(i)]
            u += coupling.shear_compliance * r * (np.cos(angle) * along_x + np.sin(angle) * along_y)
    return u / M


def chosen(contact: Mask, seed: int, coupling: Coupling | None = None) -> tuple[Array, Array, float]:
    """Random pressures (Pa) on a contact set, the gap (m) on a unit square that they solve, its approach."""
    pressure = np.where(contact, PEAK * np.random.default_rng(seed).uniform(0.3, 1.0, contact.shape), 0.0)
    u = displacement(pressure, coupling)
    approach = float(u[contact].max())
    return pressure, np.where(contact, approach - u, FAR), approach


def bed() -> Mask:
    """Where the `PINS` stand."""
    contact = np.zeros((M, M), dtype=bool)
    contact[tuple(zip(*PINS, strict=True))] = True
    return contact


@check(
    "one-element",
    title="One element pressed in",
    claim="A single loaded element carries pi E* h/(4 arsinh 1) per metre of approach",
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
    exact, gap, approach = chosen(bed(), seed=1)
    return Measured(entrant.misfit(entrant.press(gap, 1.0, approach=approach), exact))


@check(
    "sheared-pins",
    title="A bed of pins that slides",
    claim="With tau and beta, sliding at 0.9 rad, the pins carry the pressures that were chosen",
    source="influence coefficients from 50 digits (verification.exact.kernel_reference); SPEC 1 for signs",
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "it holds with c, which is skew",
    catches=(
        Fault.SIGN_OF_C,
        Fault.TAU_MISSING,
        Fault.TAU_EVERYWHERE,
        Fault.TRANSPOSED,
        Fault.HALF_ELEMENT,
        Fault.MODULUS_OFF,
    ),
)
def sheared_pins(entrant: Entrant) -> Measured:
    coupling = Coupling(0.2 * PEAK, 0.4, COMPLIANCE, sliding_direction=0.9)
    exact, gap, _ = chosen(bed(), 3, coupling)
    load = float(exact.sum()) / M**2
    return Measured(entrant.misfit(entrant.press(gap, 1.0, load=load, coupling=coupling), exact))


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
    exact, gap, _ = chosen((i + j) % 2 == 0, seed=2)
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
