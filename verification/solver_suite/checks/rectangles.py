"""Rectangular domains and oblong elements, for solvers that claim them: residuals, elimination, symmetry."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array
from verification.exact.westergaard import Wave
from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import CLAIMS, COMPLIANCE, MODULUS, Entrant, Fault, check
from verification.solver_suite.checks.residuals import CLAIM, PERIODIC_SOURCE, SOURCE, judged
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.protocol import Coupling

OBLONG = (Fault.EDGES_EXCHANGED, Fault.SQUARE_ELEMENTS)


def bump(rows: int, columns: int, seed: int) -> Array:
    """A rough bump (m) on a part of the unit square: ``rows`` of 48 elements along x, and so along y."""
    i, j = (48 - rows) // 2, (48 - columns) // 2
    return rough_bump(48, seed)[i : i + rows, j : j + columns]


def wavy(rows: int, columns: int, seed: int) -> Array:
    """A periodic rough gap (m) of waves up to a sixth of the elements."""
    k = [np.fft.fftfreq(n) for n in (rows, columns)]
    wave = np.hypot(k[0][:, None], k[1][None, :])
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal((rows, columns)))
    kept = (wave > 0) & (wave <= 1 / 6)
    heights = np.fft.ifft2(np.where(kept, noise / np.where(kept, wave, 1.0), 0.0)).real
    return np.asarray(0.01 * (heights.max() - heights) / heights.std())


@check(
    "rectangle-residual",
    title="A rough bump on a rectangle: what was claimed is so",
    claim="On 42 x 20 square elements the recomputed residuals meet the claim",
    source=SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(Fault.STRETCHED, Fault.MODULUS_OFF),
)
def rectangle_residual(entrant: Entrant) -> Measured:
    return judged(entrant, entrant.press(bump(42, 20, seed=13), (42 / 48, 20 / 48), load=0.03 * MODULUS))


@check(
    "rectangle-residual-periodic",
    title="Periodic waves on a rectangle: what was claimed is so",
    claim="On 24 x 40 square elements the recomputed residuals meet the claim",
    source=PERIODIC_SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(Fault.STRETCHED, Fault.MODULUS_OFF),
)
def rectangle_residual_periodic(entrant: Entrant) -> Measured:
    gap = wavy(24, 40, seed=14)
    return judged(entrant, entrant.press(gap, (24 / 40, 1.0), load=0.01 * MODULUS, periodic=True))


@check(
    "oblong-residual",
    title="A rough bump on oblong elements: what was claimed is so",
    claim="On a square of 20 x 36 elements, dx = 1.8 dy, the recomputed residuals meet the claim",
    source=SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*OBLONG, Fault.MODULUS_OFF),
)
def oblong_residual(entrant: Entrant) -> Measured:
    return judged(entrant, entrant.press(bump(20, 36, seed=15), 1.0, load=0.03 * MODULUS))


@check(
    "oblong-residual-periodic",
    title="Periodic waves on oblong elements: what was claimed is so",
    claim="On 36 x 30 elements, dy = 1.6 dx, the recomputed residuals meet the claim",
    source=PERIODIC_SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*OBLONG, Fault.MODULUS_OFF),
)
def oblong_residual_periodic(entrant: Entrant) -> Measured:
    gap = wavy(36, 30, seed=16)
    return judged(entrant, entrant.press(gap, (0.75, 1.0), load=0.01 * MODULUS, periodic=True))


@check(
    "oblong-elimination",
    title="A rough bump on oblong elements against elimination",
    claim="The pressures are those of block principal pivoting on the dense matrix, element by element",
    source="principal pivoting (Murty 1974), written for this suite",
    metric="at_most",
    tolerance=1.1,
    tolerance_reason="in claims of the squared energy-norm error: at most the complementarity gap (proven)",
    catches=OBLONG,
)
def oblong_elimination(entrant: Entrant) -> Measured:
    pressed = entrant.press(bump(25, 16, seed=17), (0.5, 1.0), load=0.03 * MODULUS)
    return entrant.against((pressed, reference_solution.eliminated(pressed.problem)))


@check(
    "oblong-wave",
    title="Westergaard's wave along both axes of oblong elements",
    claim="At half the full-contact load a ridge along y, and one along x, has Westergaard's pressure",
    source="Westergaard 1939; Johnson 1985, Eq. (13.7)",
    metric="at_most",
    tolerance=6e-3,
    tolerance_reason="square-root edges: order 1, 3.7e-3 on 64 elements a wave; exchanged edges miss by 35 %",
    catches=OBLONG,
)
def oblong_wave(entrant: Entrant) -> Measured:
    n, across, amplitude = 64, 16, 1e-3
    star = Wave(1.0, amplitude, 1.0, MODULUS).full_contact_pressure
    wave = Wave(0.5 * star, amplitude, 1.0, MODULUS)
    x = (np.arange(n) + 0.5) / n - 0.5
    ridge = amplitude * (1 - np.cos(2 * np.pi * x))
    gap, exact = (np.outer(v, np.ones(across)) for v in (ridge, wave.pressure(x)))
    worst = 0.0
    for turn in (False, True):  # the ridge along y, then along x; elements 1 : 2 and 2 : 1
        size = (0.5, 1.0) if turn else (1.0, 0.5)
        pressed = entrant.press(gap.T if turn else gap, size, load=0.25 * star, periodic=True)
        pressure = pressed.pressure.T if turn else pressed.pressure
        worst = max(worst, float(np.linalg.norm(pressure - exact) / np.linalg.norm(exact)))
    return Measured(worst, unit="of the pressure")


@check(
    "oblong-rotated",
    title="A rectangle of oblong elements, sliding, and the same one rotated by 90 degrees",
    claim="A scene rotated by 90 degrees, its sliding direction too, has the rotated pressures",
    source="symmetry of the contact conditions under a quarter turn",
    metric="at_most",
    tolerance=4.0,
    tolerance_reason="in claims of the squared energy-norm error: two answers, each within one",
    catches=OBLONG,
)
def oblong_rotated(entrant: Entrant) -> Measured:
    gap, phi, load = bump(28, 18, seed=18), 0.4, 0.02 * MODULUS
    coupling = Coupling(tau=0.0, beta=0.5, shear_compliance=COMPLIANCE, sliding_direction=phi)
    turned = Coupling(0.0, 0.5, COMPLIANCE, phi + np.pi / 2)
    one = entrant.press(gap, (0.9, 0.4), load=load, coupling=coupling)
    other = entrant.press(gap.T[::-1], (0.4, 0.9), load=load, coupling=turned)
    back = other.pressure[::-1].T
    residuals = max(entrant.residual(one), entrant.residual(other))
    misfit = reference_solution.misfit(one.problem, np.ascontiguousarray(back), one.pressure) / entrant.claim
    return Measured(max(misfit, residuals), unit=CLAIMS)
