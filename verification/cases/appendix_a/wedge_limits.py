"""Wedge pressed on both faces (Appendix A, Tranter): its limits, and what its tip does to displacements."""

from __future__ import annotations

import numpy as np

from appendix_a import wedge, wedge_tip
from appendix_a.strip import field
from verification.framework.case import Measured
from verification.framework.registry import case


@case("appendix-wedge/tip", metric="at_most", tolerance=2e-5)
def tip() -> Measured:
    """Wedge: uniform pressure at the tip.

    Claim: sigma_r, sigma_theta, tau tend to -1, -1, 0 at the tip
    Source: residue at z = -1; Williams 1952
    Tolerance: the next power of r is 0.77 at gamma = 0.3 and higher beyond: 1e-8^0.77 = 7e-7, times a
    coefficient; at gamma = 1e-6 it is nearly zero, with a coefficient of a few gamma
    """
    radii = [1e-2, 1e-4, 1e-6, 1e-8]
    series = {}
    for gamma in (1e-6, 0.3, 1.0, 1.5):
        theta = np.linspace(-1, 1, 7) * (np.pi / 2 - gamma)
        sigma_r, sigma_theta, tau = wedge.stresses(np.array(radii)[:, None], theta, gamma)
        away = np.maximum(np.abs(sigma_r + 1), np.maximum(np.abs(sigma_theta + 1), np.abs(tau)))
        series[f"gamma {gamma:g}"] = away.max(axis=1).tolist()
    return Measured(value=max(s[-1] for s in series.values()), data={"r over a": radii, **series})


@case("appendix-wedge/far-field", metric="at_most", tolerance=1e-7)
def far_field() -> Measured:
    """Wedge: radial field of the resultant far away.

    Claim: r sigma_r tends to -4 a cos(gamma) cos(theta) / (pi - 2 gamma + sin 2 gamma), the rest to zero
    Source: Michell 1900; the resultant is 2 a p cos(gamma)
    Tolerance: the next term falls like (a/r)^2 or faster against a/r, with a coefficient below 10
    """
    radii = [1e2, 1e4, 1e6, 1e8]
    series = {}
    for gamma in (1e-6, 0.3, 1.0, 1.5):
        theta = np.linspace(-1, 1, 7) * (np.pi / 2 - gamma)
        r = np.array(radii)[:, None]
        radial = -4 * np.cos(gamma) * np.cos(theta) / (np.pi - 2 * gamma + np.sin(2 * gamma))
        sigma_r, sigma_theta, tau = (r * s for s in wedge.stresses(r, theta, gamma))
        away = np.maximum(np.abs(sigma_r - radial), np.maximum(np.abs(sigma_theta), np.abs(tau)))
        series[f"gamma {gamma:g}"] = away.max(axis=1).tolist()
    return Measured(value=max(s[-1] for s in series.values()), data={"r over a": radii, **series})


@case("appendix-wedge/half-plane", metric="at_most", tolerance=1e-7)
def half_plane() -> Measured:
    """Wedge: gamma -> 0 is the half-plane under a strip.

    Claim: at gamma = 1e-8 the stresses are those of (A1) on both sides of the strip's ends and below them
    Source: paper Eq. (A1); Johnson 1985, section 2.5
    Tolerance: first order in gamma, 1e-8, times a coefficient below 10 at these points
    """
    x, y = np.meshgrid([-5.0, -1.3, -0.4, 0.2, 0.8, 2.0, 40.0], [1e-3, 0.1, 1.0, 7.0])
    differences = {}
    for gamma in (1e-4, 1e-6, 1e-8):
        r, theta = np.hypot(x, y), np.arctan2(x, y) * (1 - 2 * gamma / np.pi)
        sin, cos = np.sin(theta), np.cos(theta)
        sigma_r, sigma_theta, tau = wedge.stresses(r, theta, gamma)
        sigma_x, sigma_y, tau_xy = field.stresses(r * sin, r * cos)
        expected = (
            sigma_y * cos**2 + sigma_x * sin**2 + 2 * tau_xy * sin * cos,
            sigma_y * sin**2 + sigma_x * cos**2 - 2 * tau_xy * sin * cos,
            (sigma_x - sigma_y) * sin * cos + tau_xy * (cos**2 - sin**2),
        )
        pairs = zip((sigma_r, sigma_theta, tau), expected, strict=True)
        differences[f"gamma {gamma:g}"] = max(float(np.max(np.abs(a - b))) for a, b in pairs)
    return Measured(value=differences["gamma 1e-08"], data=differences)


@case("appendix-wedge/slender", metric="at_most", tolerance=1e-9)
def slender() -> Measured:
    """Wedge: gamma -> pi/2 is a slender strut.

    Claim: at gamma = 1.5 (half-angle 4 degrees) the wedge is under uniform pressure at r = 0.4 a, and under
    the radial field at 2.5 a
    Source: Saint-Venant; decay exponents of the wedge's eigenfunctions (Williams 1952)
    Tolerance: eigenfunctions fall like (r/a)^(4.2/(2 alpha)) = (r/a)^29.7: 2e-12 at both points, times a
    coefficient of some tens
    """
    gamma = 1.5
    theta = np.linspace(-1, 1, 9) * (np.pi / 2 - gamma)
    inner = np.array(wedge.stresses(0.4, theta, gamma)) - np.array([[-1.0], [-1.0], [0.0]])
    outer = np.array(wedge.stresses(2.5, theta, gamma))
    outer[0] += 4 * np.cos(gamma) * np.cos(theta) / (np.pi - 2 * gamma + np.sin(2 * gamma)) / 2.5
    worst = {"r = 0.4 a": float(np.max(np.abs(inner))), "r = 2.5 a": float(np.max(np.abs(outer)))}
    return Measured(value=max(worst.values()), data=worst)


@case("appendix-wedge/base-load", metric="at_most", tolerance=1e-12)
def base_load() -> Measured:
    """Wedge tip: its base carries the load.

    Claim: the base tractions of the wedge tip add up to 2 a p cos(gamma), the load on its faces
    Source: equilibrium of the tip
    Tolerance: graded Gauss panels, and rounding over some 2000 nodes
    """
    slopes, errors = [0.1, 2.5, 6.5, 20.0, 45.0], []
    for slope in slopes:
        gamma, half_base = np.radians(slope), 10.0
        s, weights = wedge_tip.graded_nodes([0.0, np.cos(gamma), half_base], half_base)
        _, down = wedge_tip.base_tractions(s, gamma, half_base)
        errors.append(float(abs(np.sum(weights * down) / np.cos(gamma) - 1)))
    return Measured(value=max(errors), data={"slope in degrees": slopes, "relative difference": errors})


FIG13_SLOPES = (0.125, 1.0, 2.5, 6.5, 15.0)
DATUM = 100.0


@case("appendix-wedge/fig13", metric="at_most", tolerance=0.02)
def fig13() -> Measured:
    """Fig. 13: wedge tip against flat strip.

    Claim: for nu = 0.3 and slopes up to 6.5 degrees the displacement beyond 3 a, counted from a datum at 100
    a, differs from a flat strip's by less than 2 %
    Source: paper Fig. 13 and its 2 %; load matched at the base, half-base 10 a
    Tolerance: the paper's own bound
    """
    x = np.concatenate([np.linspace(0.0, 4.0, 21), [5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0]])
    flat = field.flat_displacement(x, 0.3)
    from_datum = flat - field.flat_displacement(DATUM, 0.3)
    data: dict[str, object] = {"x over a": x}
    beyond = []
    for slope in FIG13_SLOPES:
        tip = wedge_tip.tip_displacement(x, np.radians(slope), 0.3, half_base=10.0, datum=DATUM)
        far = (tip - from_datum) / from_datum
        data[f"{slope:g} degrees, datum 100 a"] = far
        data[f"{slope:g} degrees, datum at the apex"] = (tip - tip[0])[1:] / flat[1:] - 1
        if slope <= 6.5:
            beyond.append(float(np.max(np.abs(far[x > 3]))))
    data["x over a, datum at the apex"] = x[1:]
    note = "the paper's figure states neither datum nor base width"
    return Measured(value=max(beyond), data=data, note=note)
