"""Wedge pressed on both faces (Appendix A, Tranter): its limits, and what its tip does to displacements."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from appendix_a import wedge, wedge_tip
from appendix_a.strip import field
from refimpl.grid import Array
from verification.cases import Measured, case


def uniform(r: float, theta: Array, gamma: float) -> Array:
    """Return the stresses (sigma_r, sigma_theta, tau) of uniform pressure, ``(3, angles)``."""
    return np.array([-1.0, -1.0, 0.0])[:, None] + 0 * theta


def radial(r: float, theta: Array, gamma: float) -> Array:
    """Return Michell's radial field of the resultant, ``(3, angles)``."""
    along = -4 * np.cos(gamma) * np.cos(theta) / (np.pi - 2 * gamma + np.sin(2 * gamma)) / r
    return np.array([along, 0 * theta, 0 * theta])


def departure(
    limit: Callable[[float, Array, float], Array], r: float, gamma: float, angles: int = 7
) -> float:
    """Return the wedge's largest difference of stress from a limit at a distance, over even angles."""
    theta = np.linspace(-1, 1, angles) * (np.pi / 2 - gamma)
    return float(np.abs(np.array(wedge.stresses(r, theta, gamma)) - limit(r, theta, gamma)).max())


GAMMAS = (1e-6, 0.3, 1.0, 1.5)


@case("appendix-wedge/tip", metric="at_most", tolerance=2e-5)
def tip() -> Measured:
    """Wedge: uniform pressure at the tip.

    Claim: sigma_r, sigma_theta, tau tend to -1, -1, 0 at the tip
    Source: residue at z = -1; Williams 1952
    Tolerance: the next power of r is 0.77 at gamma = 0.3 and higher beyond: 1e-8^0.77 = 7e-7, times a
    coefficient; at gamma = 1e-6 it is nearly zero, with a coefficient of a few gamma
    """
    off = {f"gamma {gamma:g}": departure(uniform, 1e-8, gamma) for gamma in GAMMAS}
    return Measured(value=max(off.values()), data=off)


@case("appendix-wedge/far-field", metric="at_most", tolerance=1e-7)
def far_field() -> Measured:
    """Wedge: radial field of the resultant far away.

    Claim: r sigma_r tends to -4 a cos(gamma) cos(theta) / (pi - 2 gamma + sin 2 gamma), the rest to zero
    Source: Michell 1900; the resultant is 2 a p cos(gamma)
    Tolerance: the next term falls like (a/r)^2 or faster against a/r, with a coefficient below 10
    """
    r = 1e8
    off = {f"gamma {gamma:g}": r * departure(radial, r, gamma) for gamma in GAMMAS}
    return Measured(value=max(off.values()), data=off)


@case("appendix-wedge/half-plane", metric="at_most", tolerance=1e-7)
def half_plane() -> Measured:
    """Wedge: gamma -> 0 is the half-plane under a strip.

    Claim: at gamma = 1e-8 the stresses are those of (A1) on both sides of the strip's ends and below them
    Source: paper Eq. (A1); Johnson 1985, section 2.5
    Tolerance: first order in gamma, 1e-8, times a coefficient below 10 at these points
    """
    x, y = np.meshgrid([-5.0, -1.3, -0.4, 0.2, 0.8, 2.0, 40.0], [1e-3, 0.1, 1.0, 7.0])
    gamma = 1e-8
    r, theta = np.hypot(x, y), np.arctan2(x, y) * (1 - 2 * gamma / np.pi)
    sin, cos = np.sin(theta), np.cos(theta)
    sigma_x, sigma_y, tau_xy = field.stresses(r * sin, r * cos)
    expected = (
        sigma_y * cos**2 + sigma_x * sin**2 + 2 * tau_xy * sin * cos,
        sigma_y * sin**2 + sigma_x * cos**2 - 2 * tau_xy * sin * cos,
        (sigma_x - sigma_y) * sin * cos + tau_xy * (cos**2 - sin**2),
    )
    return Measured(value=float(np.abs(np.subtract(wedge.stresses(r, theta, gamma), expected)).max()))


@case("appendix-wedge/slender", metric="at_most", tolerance=1e-9)
def slender() -> Measured:
    """Wedge: gamma -> pi/2 is a slender strut.

    Claim: at gamma = 1.5 (half-angle 4 degrees) the wedge is under uniform pressure at r = 0.4 a, and under
    the radial field at 2.5 a
    Source: Saint-Venant; decay exponents of the wedge's eigenfunctions (Williams 1952)
    Tolerance: eigenfunctions fall like (r/a)^(4.2/(2 alpha)) = (r/a)^29.7: 2e-12 at both points, times a
    coefficient of some tens
    """
    off = {"r = 0.4 a": departure(uniform, 0.4, 1.5, 9), "r = 2.5 a": departure(radial, 2.5, 1.5, 9)}
    return Measured(value=max(off.values()), data=off)


@case("appendix-wedge/base-load", metric="at_most", tolerance=1e-12)
def base_load() -> Measured:
    """Wedge tip: its base carries the load.

    Claim: the base tractions of the wedge tip add up to 2 a p cos(gamma), the load on its faces
    Source: equilibrium of the tip
    Tolerance: graded Gauss panels, and rounding over some 2000 nodes
    """
    off = {}
    for slope in (0.1, 2.5, 6.5, 20.0, 45.0):
        gamma, half_base = np.radians(slope), 10.0
        s, weights = wedge_tip.graded_nodes([0.0, np.cos(gamma), half_base], half_base)
        _, down = wedge_tip.base_tractions(s, gamma, half_base)
        off[f"{slope:g} degrees"] = float(abs(np.sum(weights * down) / np.cos(gamma) - 1))
    return Measured(value=max(off.values()), data={"relative difference": off})


DATUM = 100.0


@case("appendix-wedge/fig13", metric="at_most", tolerance=0.02)
def fig13() -> Measured:
    """Fig. 13: wedge tip against flat strip.

    Claim: for nu = 0.3 and slopes up to 6.5 degrees the displacement beyond 3 a, counted from a datum at 100
    a, differs from a flat strip's by less than 2 %
    Source: paper Fig. 13 and its 2 %; load matched at the base, half-base 10 a
    Tolerance: the paper's own bound
    """
    x = np.concatenate([np.linspace(3.2, 4.0, 5), [5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0]])
    flat = field.flat_displacement(x, 0.3) - field.flat_displacement(DATUM, 0.3)
    off = {}
    for slope in (0.125, 1.0, 2.5, 6.5):
        tip = wedge_tip.tip_displacement(x, np.radians(slope), 0.3, half_base=10.0, datum=DATUM)
        off[f"{slope:g} degrees"] = float(np.max(np.abs((tip - flat) / flat)))
    note = "the paper's figure states neither datum nor base width"
    return Measured(value=max(off.values()), data=off, note=note)
