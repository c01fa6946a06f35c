"""Smooth indenters: Hertz' ellipse, Sneddon's cone, the rectangular patch."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.operators.fft import FFTInfluence
from verification.cases import Measured, case, family
from verification.cases.contact.scenes import MODULUS, measured_order, press
from verification.exact.hertz import Ellipse
from verification.exact.patch import UNCERTAINTY as PATCH_UNCERTAINTY
from verification.exact.patch import Patch
from verification.exact.power_law import Cone
from verification.solver_suite.gaps import centres

ELLIPSE = Ellipse(load=1.0, curvature_x=2.0, curvature_y=6.0, modulus=MODULUS)
CONE = Cone(load=1.0, slope=0.05, modulus=MODULUS)
GRIDS = (48, 64, 80, 96, 128, 160, 192)


def ellipsoid(x: Array, y: Array) -> Array:
    """Return the gap of `ELLIPSE` (m)."""
    return ELLIPSE.curvature_x / 2 * x**2 + ELLIPSE.curvature_y / 2 * y**2


def cone(x: Array, y: Array) -> Array:
    """Return the gap of `CONE` (m)."""
    return CONE.slope * np.hypot(x, y)


def press_ellipse(M: int) -> tuple[rf.Solution, Array, Array]:
    """Return the solution and element centres (m); the square is 2.4 semi-axes wide along the longer one."""
    side = 2.4 * ELLIPSE.semi_axes[0]
    return press(ellipsoid, side, M), *centres(side, M)


def ellipse_error(M: int) -> float:
    """Return the relative error of the ellipse's approach, from the lowest point between element centres."""
    solution, x, y = press_ellipse(M)
    return abs((solution.approach + float(ellipsoid(x, y).min())) / ELLIPSE.approach - 1)


def cone_error(M: int) -> float:
    """Return the relative error of the cone's approach, from the tip between element centres."""
    solution, r = press_cone(M)
    return abs((solution.approach + CONE.slope * float(r.min())) / CONE.approach - 1)


@family(
    "error, title, claim, source, tolerance_reason",
    {
        "reference/hertz-ellipse-approach-order": (
            ellipse_error, "Elliptical Hertz contact: order of the approach",
            "The approach converges with order 2 although the pressure's edge is a square root",
            "Johnson 1985, section 4.2",
            "an edge row misplaces h^(3/2) of load, of either sign, which averages to h^2 over the outline; "
            "the outline's fit to the grid scatters the points by some 5 %"),
        "reference/cone-approach-order": (
            cone_error, "Cone: order of the approach",
            "Counted from the tip, which lies between element centres, the approach converges with order 2; "
            "counted from the lowest centre it would have order 1",
            "Sneddon 1965; Johnson 1985, section 5.2",
            "the tip's logarithmic peak and the edge's root misplace h^2 of load; the outline's fit to the "
            "grid scatters the points"),
    },
    metric="absolute", tolerance=0.3,
)  # fmt: skip
def approach_order(error: Callable[[int], float]) -> Measured:
    return measured_order(GRIDS, [error(M) for M in GRIDS], 2.0)


@case("reference/hertz-ellipse-outside", metric="at_most", tolerance=8e-4)
def ellipse_outside() -> Measured:
    """Elliptical Hertz contact: separation of the surfaces outside.

    Claim: Outside the contact the deformed surfaces part as the potential of the Hertz pressure says
    Source: Johnson 1985, Eq. (3.35); ellipsoidal potential from the confocal ellipse outwards
    Tolerance: over the approach; 5.0e-4 measured at M = 96, at the elements beside the edge
    """
    solution, x, y = press_ellipse(96)
    exact = ellipsoid(x, y) + ELLIPSE.displacement(x, y) - ELLIPSE.approach
    outside = ELLIPSE.pressure(x, y) == 0
    misfit = np.abs(solution.details.separation - exact)[outside] / ELLIPSE.approach
    return Measured(float(misfit.max()))


def press_cone(M: int) -> tuple[rf.Solution, Array]:
    """Return the solution and distance of the element centres from the axis (m)."""
    side = 2.4 * CONE.contact_radius
    x, y = centres(side, M)
    return press(cone, side, M), np.hypot(x, y)


@case("reference/patch-displacement", metric="at_most", tolerance=2e-13)
def patch_displacement() -> Measured:
    """Uniform pressure on a rectangle: displacement inside and outside.

    Claim: The whole-grid convolution of a uniform block of elements is Love's displacement of the rectangle
    Source: Love 1929; Johnson 1985, Eq. (3.25)
    Tolerance: an FFT of 128^2 points loses 20 eps of its largest value; reference 1e-13. Measured 1e-15
    """
    M, side = 48, 1.0
    x, y = centres(side, M)
    pressure = np.zeros((M, M))
    pressure[8:32, 20:32] = 1.0
    x0, y0 = float(x[8:32].mean()), float(y[:, 20:32].mean())
    block = Patch(pressure=1.0, width=24 / M, height=12 / M, modulus=MODULUS)
    found = FFTInfluence(rf.Grid.square(side, M), 0.0).normal(pressure) / (np.pi * MODULUS)
    exact = block.displacement(x - x0, y - y0)
    worst = float(np.max(np.abs(found - exact)) / exact.max())
    return Measured(worst, reference_uncertainty=PATCH_UNCERTAINTY)
