"""Errors in the printed Appendix A: each equation, a number against it, the correction, a number for it.

Each has its `Kind`. ``evidence()`` measures the printed form, ``check()`` the corrected one by the same
measure: zero is right.
(A1), given its angles, (A4) and (A6) stand as printed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from appendix_a.strip import field, first_order
from appendix_a.strip.profile import Sinusoid
from appendix_a.strip.superposition import Theta, applied, printed, pseudo_tractions
from appendix_a.wedge import printed as wedge_printed


class Kind(StrEnum):
    """Likely origin of a fault: the text of the paper here was recovered from print by machine."""

    CONVERSION = "likely conversion, undecidable without a scan of the print"
    NOTATION = "notation: right as meant, wrong as it stands"
    PAPER = "the paper's own"


@dataclass(frozen=True)
class Erratum:
    """One fault; ``measure`` says what ``evidence`` and ``check`` compute, ``tolerance`` bounds ``check``."""

    equation: str
    kind: Kind
    printed: str
    corrected: str
    measure: str
    evidence: Callable[[], float]
    check: Callable[[], float]
    tolerance: float
    tolerance_reason: str


GAMMA, RADIUS = 0.3, 7.0
GAUSS_POINTS = 10
SMALL_SLOPE = 0.01  # degrees


def _missing_load(sign: int) -> float:
    """Return the relative difference of the force across the arc r = 7 a from 2 a cos(gamma)."""
    alpha = np.pi / 2 - GAMMA
    nodes, weights = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    force = 0.0
    for node, weight in zip(nodes[nodes > 0], weights[nodes > 0], strict=True):
        theta = alpha * node
        s = wedge_printed.stresses(RADIUS, theta, GAMMA, sign)
        across = s.sigma_r * np.cos(theta) - s.tau * np.sin(theta)
        force -= 2 * weight * alpha * RADIUS * across
    return float(abs(force / (2 * np.cos(GAMMA)) - 1))


def _kernel_left(literal: bool) -> float:
    """Return P(50) / P(1) of (A7) at gamma = 0.3, theta = 0.5: it must fall off for (A4) to converge."""

    if literal:
        return wedge_printed.literal_p(50.0, 0.5, GAMMA) / wedge_printed.literal_p(1.0, 0.5, GAMMA)
    first, later = wedge_printed.kernels(np.array([1.0, 50.0]), 0.5, GAMMA)[0]
    return float(later / first)


def _flat_residual(theta: Theta) -> float:
    """Return the largest net pseudo traction on a flat boundary, over the pressure: none is needed."""
    flat = Sinusoid(0.0, 100.0, 0.0)
    x = np.array([-2.0, -0.9, -0.5, 0.0, 0.5, 0.9, 2.0])
    along, down = pseudo_tractions(x, flat, theta)
    load_along, load_down = applied(x, flat)
    return float(np.max(np.hypot(along + load_along, down + load_down)))


def _load_left() -> float:
    """Return the pseudo traction under a flat strip's centre by (A3), which must vanish."""
    along, down = pseudo_tractions(0.0, Sinusoid(0.0, 100.0, 0.0), Theta.NORMAL)
    return float(np.hypot(along, down))


def _strain_left(added: float) -> float:
    """Return the first-order change's relative error at x = a/2 on a crest; ``added`` = 1: strain."""
    nu, x = 0.3, 0.5
    profile = Sinusoid(SMALL_SLOPE, 20.0, 0.0)
    wavy, flat = printed(SMALL_SLOPE, 20.0, nu, offsets=[x])
    strain = -(1 + nu) * (1 - 2 * nu) * profile.depth(x)
    right = first_order(SMALL_SLOPE, 20.0, 0.0, nu, offsets=[x])[0] - flat
    return float(abs((wavy - flat + added * strain) / right - 1)[0])


def _branch(principal: bool) -> float:
    """Return |sigma_y + p| at the middle of the loaded boundary."""
    if not principal:
        return float(abs(field.stresses(0.0, 0.0)[1] + 1))
    first, second = np.arctan(0.0 / (0 - 1)), np.arctan(0.0 / (0 + 1))
    sigma_y = -(2 * (first - second) - (np.sin(2 * first) - np.sin(2 * second))) / (2 * np.pi)
    return float(abs(sigma_y + 1))


ERRATA: tuple[Erratum, ...] = (
    Erratum(
        equation="A1",
        kind=Kind.NOTATION,
        printed="'tan theta_1,2 = y / (x -+ a), -infinity < x < infinity, and 0 <= y < infinity'",
        corrected="theta_1,2 the angles in [0, pi] with that tangent (not the principal arctan)",
        measure="|sigma_y + p| in the middle of the loaded boundary, over p",
        evidence=lambda: _branch(principal=True),
        check=lambda: _branch(principal=False),
        tolerance=1e-15,
        tolerance_reason="one rounding of pi / pi",
    ),
    Erratum(
        equation="A3 (theta)",
        kind=Kind.PAPER,
        printed="'where theta is the slope of the boundary'",
        corrected="theta is the direction angle of the outward normal: "
        "n = (cos theta, sin theta) = (sin s, -cos s) for the slope s",
        measure="largest net traction left on a flat boundary, over p",
        evidence=lambda: _flat_residual(Theta.SLOPE),
        check=lambda: _flat_residual(Theta.NORMAL),
        tolerance=1e-15,
        tolerance_reason="rounding of cos(pi/2) and of the stresses",
    ),
    Erratum(
        equation="A3 (load)",
        kind=Kind.NOTATION,
        printed="'X = -(sigma_x cos theta + tau_xy sin theta)', 'Y = -(sigma_y sin theta + tau_xy cos "
        "theta)', for 'A stress-free boundary on such a periodically wavy surface'",
        corrected="the applied traction -p n is added under the strip; (A3) alone cancels the load itself",
        measure="pseudo traction under the centre of a strip on a flat boundary, over p",
        evidence=_load_left,
        check=lambda: _flat_residual(Theta.NORMAL),
        tolerance=1e-15,
        tolerance_reason="rounding of cos(pi/2) and of the stresses",
    ),
    Erratum(
        equation="A3 (displacement)",
        kind=Kind.PAPER,
        printed="'Surface displacements due to the pseudo forces are calculated as a function of surface "
        "waviness'",
        corrected="plus, under the strip, the strain -(1+nu)(1-2nu) p/E times the depth of the wavy line",
        measure="relative error of the first-order change at x = a/2, crest, lambda = 20 a, 0.01 degrees",
        evidence=lambda: _strain_left(0.0),
        check=lambda: _strain_left(1.0),
        tolerance=5e-3,
        tolerance_reason="second order: the slope, 1.7e-4 rad, times a factor of some tens (measured 3e-5)",
    ),
    Erratum(
        equation="A5",
        kind=Kind.CONVERSION,
        printed="'(pi r / 2 a) (sigma_theta + sigma_r) = pi cos gamma cos theta / "
        "(pi - 2 gamma + sin 2 gamma) + ...'",
        corrected="... = - pi cos gamma cos theta / (pi - 2 gamma + sin 2 gamma) + ...",
        measure="force across the arc r = 7 a against the load 2 a p cos(gamma), gamma = 0.3",
        evidence=lambda: _missing_load(wedge_printed.PRINTED_SIGN),
        check=lambda: _missing_load(wedge_printed.CORRECT_SIGN),
        tolerance=1e-8,
        tolerance_reason="10-point Gauss rule over the arc (1e-9) and quadratures to 10 digits",
    ),
    Erratum(
        equation="A7-A9",
        kind=Kind.NOTATION,
        printed="'cosh(pi/2 - gamma + theta)xi', 'sinh(pi - 2 gamma)xi', and so on",
        corrected="cosh{(pi/2 - gamma + theta) xi}, sinh{(pi - 2 gamma) xi}, ...",
        measure="P(50) / P(1) at gamma = 0.3, theta = 0.5; read literally xi cancels and (A4)-(A6) diverge",
        evidence=lambda: _kernel_left(literal=True),
        check=lambda: _kernel_left(literal=False),
        tolerance=1e-15,
        tolerance_reason="exp(-49 (pi/2 - gamma - theta)) = 4e-17",
    ),
)
