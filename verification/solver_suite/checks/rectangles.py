"""Rectangular domains and oblong elements, for solvers that claim them: residuals, elimination, symmetry."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array
from verification.exact.westergaard import Wave
from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import CLAIMS, MODULUS, Check, Entrant
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.residuals import (
    PERIODIC_SOURCE,
    PIVOTING,
    PROVEN,
    SOURCE,
    elimination,
    held,
    residual,
    sliding,
    worst_in_turn,
)
from verification.solver_suite.gaps import rough_bump

OBLONG = (F.EDGES_EXCHANGED, F.SQUARE_ELEMENTS)
LOAD, LIGHT = 0.03 * MODULUS, 0.01 * MODULUS
"""Load (N) of bumps, and of periodic planes."""


def bump(rows: int, columns: int, seed: int) -> Array:
    """Return a rough bump (m) on a part of the unit square: ``rows`` of 48 elements along x, so along y."""
    i, j = (48 - rows) // 2, (48 - columns) // 2
    return rough_bump(48, seed)[i : i + rows, j : j + columns]


def wavy(rows: int, columns: int, seed: int) -> Array:
    """Return a periodic rough gap (m) of waves up to a sixth of the elements."""
    k = [np.fft.fftfreq(n) for n in (rows, columns)]
    wave = np.hypot(k[0][:, None], k[1][None, :])
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal((rows, columns)))
    kept = (wave > 0) & (wave <= 1 / 6)
    heights = np.fft.ifft2(np.where(kept, noise / np.where(kept, wave, 1.0), 0.0)).real
    return np.asarray(0.01 * (heights.max() - heights) / heights.std())


def _wave(entrant: Entrant) -> Measured:
    n, across, amplitude = 64, 16, 1e-3
    star = Wave(1.0, amplitude, 1.0, MODULUS).full_contact_pressure
    wave = Wave(0.5 * star, amplitude, 1.0, MODULUS)
    x = (np.arange(n) + 0.5) / n - 0.5
    ridge = amplitude * (1 - np.cos(2 * np.pi * x))
    gap, exact = (np.outer(v, np.ones(across)) for v in (ridge, wave.pressure(x)))
    errors = []
    for turn in (False, True):  # the ridge along y, then along x; elements 1 : 2 and 2 : 1
        size = (0.5, 1.0) if turn else (1.0, 0.5)
        pressed = entrant.press(gap.T if turn else gap, size, load=0.25 * star, periodic=True)
        pressure = pressed.pressure.T if turn else pressed.pressure
        errors.append(float(np.linalg.norm(pressure - exact) / np.linalg.norm(exact)))
    return Measured(max(errors), unit="of the pressure", data={"errors of ridges along y, x": errors})


def _rotated(entrant: Entrant) -> Measured:
    gap, phi, load = bump(28, 18, seed=18), 0.4, 0.02 * MODULUS
    one = entrant.press(gap, (0.9, 0.4), load=load, coupling=sliding(phi))
    other = entrant.press(gap.T[::-1], (0.4, 0.9), load=load, coupling=sliding(phi + np.pi / 2))
    back = other.pressure[::-1].T
    found = worst_in_turn(entrant, [one, other])
    error = reference_solution.misfit(one.problem, np.ascontiguousarray(back), one.pressure) / entrant.claim
    note = f"the two answers differ by {error:.2g} claims; residuals of {found.note}"
    return Measured(max(error, found.value), unit=CLAIMS, note=note)


# fmt: off
CHECKS = (
    held("rectangle-residual", "A rough bump on a rectangle: what was claimed is so",
         "On 42 x 20 square elements the recomputed residuals meet the claim",
         SOURCE, (F.STRETCHED, F.MODULUS_OFF),
         residual(bump(42, 20, seed=13), (42 / 48, 20 / 48), load=LOAD)),
    held("rectangle-residual-periodic", "Periodic waves on a rectangle: what was claimed is so",
         "On 24 x 40 square elements the recomputed residuals meet the claim",
         PERIODIC_SOURCE, (F.STRETCHED, F.MODULUS_OFF),
         residual(wavy(24, 40, seed=14), (24 / 40, 1.0), load=LIGHT, periodic=True)),
    held("oblong-residual", "A rough bump on oblong elements: what was claimed is so",
         "On a square of 20 x 36 elements, dx = 1.8 dy, the recomputed residuals meet the claim",
         SOURCE, (*OBLONG, F.MODULUS_OFF), residual(bump(20, 36, seed=15), load=LOAD)),
    held("oblong-residual-periodic", "Periodic waves on oblong elements: what was claimed is so",
         "On 36 x 30 elements, dy = 1.6 dx, the recomputed residuals meet the claim",
         PERIODIC_SOURCE, (*OBLONG, F.MODULUS_OFF),
         residual(wavy(36, 30, seed=16), (0.75, 1.0), load=LIGHT, periodic=True)),
    Check("oblong-elimination", "A rough bump on oblong elements against elimination",
          "The pressures are those of block principal pivoting on the dense matrix, element by element",
          PIVOTING, 1.1, PROVEN, OBLONG, elimination(bump(25, 16, seed=17), (0.5, 1.0), load=LOAD)),
    Check("oblong-wave", "Westergaard's wave along both axes of oblong elements",
          "At half the full-contact load a ridge along y, and one along x, has Westergaard's pressure",
          "Westergaard 1939; Johnson 1985, Eq. (13.7)", 6e-3,
          "square-root edges: order 1, 3.7e-3 on 64 elements a wave; exchanged edges miss by 35 %",
          OBLONG, _wave),
    Check("oblong-rotated", "A rectangle of oblong elements, sliding, and the same one rotated by 90 degrees",
          "A scene rotated by 90 degrees, its sliding direction too, has the rotated pressures",
          "symmetry of the contact conditions under a quarter turn", 4.0,
          "in claims of the squared energy-norm error: two answers, each within one", OBLONG, _rotated),
)
# fmt: on
