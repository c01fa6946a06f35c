"""Periodic waves from light to full contact, and a rough plane's area."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array
from verification.exact import fourier, jgh, rough_plane
from verification.exact.westergaard import Wave
from verification.framework.case import Measured
from verification.solver_suite.check import MODULUS, Entrant, Fault, check
from verification.solver_suite.checks.smooth import apart
from verification.solver_suite.gaps import centres, waves

AMPLITUDE = 1e-3
"""Delta (m) on a square of one wavelength of 1 m."""
STAR = np.pi * MODULUS * AMPLITUDE
"""Westergaard's full-contact pressure p* (Pa)."""
M = 32
OF_THE_AREA = "of the area"


def ridge(n: int) -> Array:
    """Gap (m) of a wave along x."""
    return AMPLITUDE * (1 - np.cos(2 * np.pi * centres(1.0, n)[0])) * np.ones((n, n))


def egg_box(n: int) -> Array:
    """Gap (m) of Johnson, Greenwood and Higginson."""
    x, y = centres(1.0, n)
    return np.asarray(AMPLITUDE * (1 - np.cos(2 * np.pi * x) * np.cos(2 * np.pi * y)))


@check(
    "westergaard-pressure",
    title="One-dimensional wave in partial contact: pressure",
    claim="At half the full-contact load the pressure is Westergaard's, with its ridges along y",
    source="Westergaard 1939; Johnson 1985, Eq. (13.7)",
    metric="at_most",
    tolerance=0.01,
    tolerance_reason="relative L2; square-root edges: order 1, 7.7e-3 measured at 32 elements to a wave",
    catches=(Fault.TRANSPOSED, Fault.HALF_ELEMENT, Fault.APERIODIC_FOR_PERIODIC, Fault.MODULUS_DOUBLED),
)
def westergaard_pressure(entrant: Entrant) -> Measured:
    wave = Wave(0.5 * STAR, AMPLITUDE, 1.0, MODULUS)
    pressed = entrant.press(ridge(M), 1.0, load=0.5 * STAR, periodic=True)
    return apart(pressed.pressure, wave.pressure(centres(1.0, M)[0]) * np.ones((M, M)))


@check(
    "westergaard-area",
    title="One-dimensional wave: contact fraction against load",
    claim="Mean pressure = p* sin^2(pi a/lambda) from a tenth to nine tenths of full contact",
    source="Johnson 1985, Eq. (13.8)",
    metric="at_most",
    tolerance=1 / M,
    tolerance_reason="whole elements: each of the two edges is placed to half an element of 1/32",
    catches=(Fault.MODULUS_DOUBLED, Fault.APERIODIC_FOR_PERIODIC),
)
def westergaard_area(entrant: Entrant) -> Measured:
    shares, areas, worst = (0.1, 0.5, 0.9), [], 0.0
    for share in shares:
        pressed = entrant.press(ridge(M), 1.0, load=share * STAR, periodic=True)
        areas.append(float(np.mean(pressed.pressure > 0)))
        exact = Wave(share * STAR, AMPLITUDE, 1.0, MODULUS).contact_fraction
        worst = max(worst, abs(areas[-1] - exact))
    return Measured(worst, unit=OF_THE_AREA, data={"load/p*": list(shares), "contact fraction": areas})


@check(
    "westergaard-load",
    title="One-dimensional wave: load at a prescribed approach",
    claim="At the approach of the mean planes that belongs to half the full-contact load, out it comes",
    source="approach integrated from Johnson's flat-punch increment: Delta s^2 (1 - ln s^2)",
    metric="relative",
    tolerance=0.002,
    tolerance_reason="order 2 with the edge on element borders: 1.4e-3 measured at 32 elements to a wave",
    catches=(Fault.MEAN_PLANES_LOST, Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.APERIODIC_FOR_PERIODIC),
)
def westergaard_load(entrant: Entrant) -> Measured:
    wave = Wave(0.5 * STAR, AMPLITUDE, 1.0, MODULUS)
    pressed = entrant.press(ridge(M), 1.0, approach=wave.approach - AMPLITUDE, periodic=True)
    return Measured(pressed.load, 0.5 * STAR, 0.0, "N")


@check(
    "egg-box-load",
    title="Two-dimensional wave: load at a prescribed approach",
    claim="Mean planes at 0.61525 Delta from first contact carry a tenth of the full-contact load",
    source="Johnson, Greenwood and Higginson 1985; own 21-grid extrapolation (verification.exact.jgh)",
    metric="relative",
    tolerance=0.0025,
    tolerance_reason="order 2 in h over the contact's radius, eight elements: 1.7e-3 measured. 1 % of "
    "modulus is 1 % of load",
    catches=(Fault.MEAN_PLANES_LOST, Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.APERIODIC_FOR_PERIODIC),
)
def egg_box_load(entrant: Entrant) -> Measured:
    star = jgh.full_contact_pressure(AMPLITUDE, 1.0, MODULUS)
    pressed = entrant.press(egg_box(M), 1.0, approach=(jgh.APPROACH[0.1] - 1) * AMPLITUDE, periodic=True)
    return Measured(pressed.load, 0.1 * star, 1e-4 * star, "N")


@check(
    "egg-box-area",
    title="Two-dimensional wave: contact fraction between the asymptotes",
    claim="The contact fraction follows the extrapolated curve at 0.1, 0.5 and 0.9 of the full-contact load",
    source="Johnson, Greenwood and Higginson 1985; own 21-grid extrapolation (verification.exact.jgh)",
    metric="at_most",
    tolerance=0.01,
    tolerance_reason="whole elements: the area inside an outline of three waves scatters by some 5e-3 on "
    "elements of 1/48; 4.3e-3 measured",
    catches=(Fault.MODULUS_DOUBLED, Fault.APERIODIC_FOR_PERIODIC),
)
def egg_box_area(entrant: Entrant) -> Measured:
    ratios, areas = (0.1, 0.5, 0.9), []
    star = jgh.full_contact_pressure(AMPLITUDE, 1.0, MODULUS)
    for ratio in ratios:
        pressed = entrant.press(egg_box(48), 1.0, load=ratio * star, periodic=True)
        areas.append(float(np.mean(pressed.pressure > 0)))
    table = [jgh.AREA_FRACTION[ratio][0] for ratio in ratios]
    worst = max(abs(a - t) for a, t in zip(areas, table, strict=True))
    return Measured(worst, unit=OF_THE_AREA, data={"load/p*": list(ratios), "area": areas, "table": table})


@check(
    "full-contact",
    title="A rough plane in full contact",
    claim="Pressed flat, a random surface's pressure is its Fourier transform times E* q/2, about the mean",
    source="Johnson 1985, section 13.2, superposed",
    metric="at_most",
    tolerance=2.0,
    tolerance_reason="in claims of the squared energy-norm error: at most the complementarity gap (proven); "
    "as much again for the mean, which stores no energy",
    catches=(
        Fault.MODULUS_OFF,
        Fault.MODULUS_DOUBLED,
        Fault.TRANSPOSED,
        Fault.HALF_ELEMENT,
        Fault.APERIODIC_FOR_PERIODIC,
        Fault.MEAN_PRESSURE_LOST,
    ),
)
def full_contact(entrant: Entrant) -> Measured:
    gap = AMPLITUDE * waves(M, seed=21, longest=2, shortest=8)
    mean = 40 * STAR
    exact = fourier.FullContact(gap, 1.0, MODULUS, mean).pressure
    pressed = entrant.press(gap, 1.0, load=mean, periodic=True)
    return entrant.against((pressed, exact))


@check(
    "rough-plane",
    title="Rough plane: slope of the area-load line",
    claim="kappa = (A/A0) E* h'/p of self-affine planes lies within the range of theories and simulations "
    "from Persson's 1.6 to Bush, Gibson and Thomas' 2.5",
    source="Bush, Gibson and Thomas 1975; Persson 2001; Yastrebov, Anciaux and Molinari 2017",
    metric="absolute",
    tolerance=0.65,
    tolerance_reason="the range itself, 2.05 +- 0.45, and 0.2 for whole elements on a coarse grid and two "
    "realisations; half or twice the modulus halves or doubles kappa",
    catches=(Fault.MODULUS_DOUBLED,),
)
def rough_plane_area(entrant: Entrant) -> Measured:
    found = []
    for seed in (31, 32):
        heights = AMPLITUDE * waves(64, seed, longest=3, shortest=8)
        slope = rough_plane.spectral_rms_gradient(heights, 1.0)
        pressure = 0.04 * MODULUS * slope
        pressed = entrant.press(heights.max() - heights, 1.0, load=pressure, periodic=True)
        fraction = float(np.mean(pressed.pressure > 0))
        found.append(float(rough_plane.kappa(fraction, pressure, MODULUS, slope)))
    return Measured(float(np.mean(found)), 2.05, 0.0, "kappa", {"kappa": found})
