"""Periodic waves from light to full contact, and a rough plane's area."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from refimpl.grid import Array
from verification.exact import fourier, jgh, rough_plane
from verification.exact.westergaard import Wave
from verification.framework.case import Measured, Metric
from verification.solver_suite.check import MODULUS, Check, Entrant, Judge
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.smooth import Fields, apart
from verification.solver_suite.gaps import centres, waves

AMPLITUDE = 1e-3
"""Delta (m) on a square of one wavelength of 1 m."""
STAR = np.pi * MODULUS * AMPLITUDE
"""Westergaard's full-contact pressure p* (Pa)."""
EGG_STAR = jgh.full_contact_pressure(AMPLITUDE, 1.0, MODULUS)
"""Full-contact pressure of Johnson, Greenwood and Higginson (Pa)."""
M = 32
WAVES = "Johnson, Greenwood and Higginson 1985; own 21-grid extrapolation (verification.exact.jgh)"
AT_APPROACH = (F.MEAN_PLANES_LOST, F.MODULUS_OFF, F.MODULUS_DOUBLED, F.APERIODIC_FOR_PERIODIC)


def ridge(n: int) -> Array:
    """Return the gap (m) of a wave along x."""
    return AMPLITUDE * (1 - np.cos(2 * np.pi * centres(1.0, n)[0])) * np.ones((n, n))


def egg_box(n: int) -> Array:
    """Return the gap (m) of Johnson, Greenwood and Higginson."""
    x, y = centres(1.0, n)
    return np.asarray(AMPLITUDE * (1 - np.cos(2 * np.pi * x) * np.cos(2 * np.pi * y)))


def wave(share: float = 0.5) -> Wave:
    """Return Westergaard's wave at a share of the full-contact load."""
    return Wave(share * STAR, AMPLITUDE, 1.0, MODULUS)


def _areas(gap: Array, star: float, exact: Mapping[float, float]) -> Judge:
    """Return the judge of contact fractions by load over that of full contact."""

    def judge(entrant: Entrant) -> Measured:
        pressed = [entrant.press(gap, load=share * star, periodic=True).pressure for share in exact]
        areas = [float(np.mean(pressure > 0)) for pressure in pressed]
        worst = max(abs(area - right) for area, right in zip(areas, exact.values(), strict=True))
        data = {"load/p*": [*exact], "area": areas, "exact": [*exact.values()]}
        return Measured(worst, unit="of the area", data=data)

    return judge


def _egg_box_load(entrant: Entrant) -> Measured:
    approach = (jgh.APPROACH[0.1] - 1) * AMPLITUDE
    pressed = entrant.press(egg_box(M), approach=approach, periodic=True)
    return Measured(pressed.load, 0.1 * EGG_STAR, 1e-4 * EGG_STAR, "N")


def ridge_pressures(entrant: Entrant, n: int) -> Fields:
    """Return the pressures of a wave at half the full-contact load."""
    pressed = entrant.press(ridge(n), load=0.5 * STAR, periodic=True)
    return pressed.pressure, wave().pressure(centres(1.0, n)[0]) * np.ones((n, n))


def ridge_load(entrant: Entrant, n: int) -> float:
    """Load (N) of a wave at the approach of half the full-contact load."""
    return entrant.press(ridge(n), approach=wave().approach - AMPLITUDE, periodic=True).load


def _full_contact(entrant: Entrant) -> Measured:
    gap = AMPLITUDE * waves(M, seed=21, longest=2, shortest=8)
    mean = 40 * STAR
    exact = fourier.FullContact(gap, 1.0, MODULUS, mean).pressure
    pressed = entrant.press(gap, 1.0, load=mean, periodic=True)
    return entrant.against((pressed, exact))


def _rough_plane(entrant: Entrant) -> Measured:
    found = []
    for seed in (31, 32):
        heights = AMPLITUDE * waves(64, seed, longest=3, shortest=8)
        slope = rough_plane.spectral_rms_gradient(heights, 1.0)
        pressure = 0.04 * MODULUS * slope
        pressed = entrant.press(heights.max() - heights, 1.0, load=pressure, periodic=True)
        fraction = float(np.mean(pressed.pressure > 0))
        found.append(float(rough_plane.kappa(fraction, pressure, MODULUS, slope)))
    return Measured(float(np.mean(found)), 2.05, 0.0, "kappa", {"kappa": found})


# fmt: off
CHECKS = (
    Check("westergaard-pressure", "One-dimensional wave in partial contact: pressure",
          "At half the full-contact load the pressure is Westergaard's, with its ridges along y",
          "Westergaard 1939; Johnson 1985, Eq. (13.7)", 0.01,
          "relative L2; square-root edges: order 1, 7.7e-3 measured at 32 elements to a wave",
          (F.TRANSPOSED, F.HALF_ELEMENT, F.APERIODIC_FOR_PERIODIC, F.MODULUS_DOUBLED),
          lambda entrant: apart(*ridge_pressures(entrant, M))),
    Check("westergaard-area", "One-dimensional wave: contact fraction against load",
          "Mean pressure = p* sin^2(pi a/lambda) from a tenth to nine tenths of full contact",
          "Johnson 1985, Eq. (13.8)", 1 / M,
          "whole elements: each of the two edges is placed to half an element of 1/32",
          (F.MODULUS_DOUBLED, F.APERIODIC_FOR_PERIODIC),
          _areas(ridge(M), STAR, {share: wave(share).contact_fraction for share in (0.1, 0.5, 0.9)})),
    Check("westergaard-load", "One-dimensional wave: load at a prescribed approach",
          "At the approach of the mean planes that belongs to half the full-contact load, out it comes",
          "approach integrated from Johnson's flat-punch increment: Delta s^2 (1 - ln s^2)", 0.002,
          "order 2 with the edge on element borders: 1.4e-3 measured at 32 elements to a wave",
          AT_APPROACH,
          lambda entrant: Measured(ridge_load(entrant, M), 0.5 * STAR, 0.0, "N"), Metric.RELATIVE),
    Check("egg-box-load", "Two-dimensional wave: load at a prescribed approach",
          "Mean planes at 0.61525 Delta from first contact carry a tenth of the full-contact load",
          WAVES, 0.0025,
          "order 2 in h over the contact's radius, eight elements: 1.7e-3 measured. 1 % of "
          "modulus is 1 % of load",
          AT_APPROACH, _egg_box_load, Metric.RELATIVE),
    Check("egg-box-area", "Two-dimensional wave: contact fraction between the asymptotes",
          "The contact fraction follows the extrapolated curve at 0.1, 0.5 and 0.9 of the full-contact load",
          WAVES, 0.01,
          "whole elements: the area inside an outline of three waves scatters by some 5e-3 on "
          "elements of 1/48; 4.3e-3 measured",
          (F.MODULUS_DOUBLED, F.APERIODIC_FOR_PERIODIC),
          _areas(egg_box(48), EGG_STAR, {share: jgh.AREA_FRACTION[share][0] for share in (0.1, 0.5, 0.9)})),
    Check("full-contact", "A rough plane in full contact",
          "Pressed flat, a random surface's pressure is its Fourier transform times E* q/2, about the mean",
          "Johnson 1985, section 13.2, superposed", 2.0,
          "in claims of the squared energy-norm error: at most the complementarity gap (proven); "
          "as much again for the mean, which stores no energy",
          (F.MODULUS_OFF, F.MODULUS_DOUBLED, F.TRANSPOSED, F.HALF_ELEMENT, F.APERIODIC_FOR_PERIODIC,
           F.MEAN_PRESSURE_LOST), _full_contact),
    Check("rough-plane", "Rough plane: slope of the area-load line",
          "kappa = (A/A0) E* h'/p of self-affine planes lies within the range of theories and simulations "
          "from Persson's 1.6 to Bush, Gibson and Thomas' 2.5",
          "Bush, Gibson and Thomas 1975; Persson 2001; Yastrebov, Anciaux and Molinari 2017", 0.65,
          "the range itself, 2.05 +- 0.45, and 0.2 for whole elements on a coarse grid and two "
          "realisations; half or twice the modulus halves or doubles kappa",
          (F.MODULUS_DOUBLED,), _rough_plane, Metric.ABSOLUTE),
)
# fmt: on
