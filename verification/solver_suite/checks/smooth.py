"""Smooth indenters with closed forms: Hertz, round and elliptical, the cone, power laws, flat punches."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array, Mask
from verification.exact.hertz import UNCERTAINTY, Ellipse, Sphere
from verification.exact.power_law import Cone, PowerLaw
from verification.exact.punch import UNCERTAINTY_SQUARE, CircularPunch, square_stiffness
from verification.framework.case import Measured, Metric
from verification.solver_suite.check import MODULUS, Check, Entrant, Pressed, difference
from verification.solver_suite.check import Fault as F
from verification.solver_suite.gaps import centres

M = 32
SPHERE = Sphere(load=1.0, radius=0.5, modulus=MODULUS)
ELLIPSE = Ellipse(load=1.0, curvature_x=2.0, curvature_y=6.0, modulus=MODULUS)
CONE = Cone(load=1.0, slope=0.05, modulus=MODULUS)
WIDE = 2.4
"""Side of the square over the contact's largest radius."""
SIDE = WIDE * SPHERE.contact_radius
"""Side (m) of the square under `SPHERE`."""
BOTH_MODULI = (F.MODULUS_OFF, F.MODULUS_DOUBLED)
Fields = tuple[Array, Array]
"""Pressures (Pa) that were found, and the exact ones."""


def relative_l2(found: Array, exact: Array) -> float:
    """Return the Euclidean norm of the difference over that of the exact array."""
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


def apart(found: Array, exact: Array) -> Measured:
    """Return `relative_l2` as a verdict's number, with a note on where it comes from."""
    return Measured(relative_l2(found, exact), unit="relative L2", note=difference(found, exact))


def sphere(side: float, n: int) -> Array:
    """Return the gap of `SPHERE` (m)."""
    x, y = centres(side, n)
    return np.asarray((x**2 + y**2) / (2 * SPHERE.radius))


def hertz(entrant: Entrant, n: int) -> Fields:
    """Return the pressures of `SPHERE` under its load."""
    pressed = entrant.press(sphere(SIDE, n), SIDE, load=1.0)
    return pressed.pressure, SPHERE.pressure(np.hypot(*centres(SIDE, n)))


def load_at_approach(entrant: Entrant, n: int) -> float:
    """Load (N) of `SPHERE` at its approach; exact is 1."""
    return entrant.press(sphere(SIDE, n), SIDE, approach=SPHERE.approach).load


def off_centre(entrant: Entrant, n: int, x0: float, y0: float) -> Fields:
    """Return the pressures of `SPHERE` with its tip off the middle, by shares of the side."""
    side = 3.2 * SPHERE.contact_radius
    x, y = centres(side, n)
    x, y = x - x0 * side, y - y0 * side
    pressed = entrant.press((x**2 + y**2) / (2 * SPHERE.radius), side, load=1.0)
    return pressed.pressure, SPHERE.pressure(np.hypot(x, y))


def ellipse(entrant: Entrant, n: int) -> Fields:
    """Return the pressures of `ELLIPSE`."""
    side = WIDE * ELLIPSE.semi_axes[0]
    x, y = centres(side, n)
    pressed = entrant.press(ELLIPSE.curvature_x / 2 * x**2 + ELLIPSE.curvature_y / 2 * y**2, side, load=1.0)
    return pressed.pressure, ELLIPSE.pressure(x, y)


def cone(entrant: Entrant, n: int) -> Fields:
    """Return the pressures of `CONE`."""
    side = WIDE * CONE.contact_radius
    r = np.hypot(*centres(side, n))
    return entrant.press(CONE.slope * r, side, load=1.0).pressure, CONE.pressure(r)


def _peak(entrant: Entrant) -> Measured:
    found, exact = hertz(entrant, M)[0].max(), SPHERE.peak_pressure
    return Measured(float(found), exact, exact * UNCERTAINTY, "Pa")


def _load(entrant: Entrant) -> Measured:
    return Measured(load_at_approach(entrant, M), 1.0, UNCERTAINTY, "N")


def _load_doubling(entrant: Entrant) -> Measured:
    worst, ratios = 0.0, []
    for n in (1.0, 2.0, 4.0):
        light, heavy = (PowerLaw(P, 0.05, n, MODULUS) for P in (1.0, 2.0))
        side = WIDE * heavy.contact_radius
        r = np.hypot(*centres(side, M))
        core = r < 0.5 * light.contact_radius
        found = [
            entrant.press(0.05 * r**n, side, load=law.load).pressure[core].sum() for law in (light, heavy)
        ]
        exact = [law.pressure(r[core]).sum() for law in (light, heavy)]
        ratios.append(found[1] / found[0] if found[0] else None)
        worst = max(worst, *(abs(f / e - 1) for f, e in zip(found, exact, strict=True)))
    return Measured(worst, unit="relative", data={"exponent": [1.0, 2.0, 4.0], "core load ratio": ratios})


def _punch(entrant: Entrant, inside: Mask, side: float) -> Pressed:
    """Return a flat punch at an approach of 1 mm; the elements outside it stand off by 1 m."""
    return entrant.press(np.where(inside, 0.0, 1.0), side, approach=1e-3)


def _square_punch(entrant: Entrant) -> Measured:
    grids, loads = np.array([12, 18, 24, 30]), []
    for n in grids:
        x, y = centres(3.0, int(n))
        loads.append(_punch(entrant, np.maximum(abs(x), abs(y)) <= 1, 3.0).load / 1e-3)
    h = 1 / grids
    limit = np.linalg.lstsq(np.column_stack([h**0, h, h**1.593]), np.asarray(loads))[0][0]
    exact = square_stiffness(2.0, MODULUS)
    return Measured(float(limit), exact, UNCERTAINTY_SQUARE * exact, "N/m", {"M": grids, "P/delta": loads})


def _circular_punch(entrant: Entrant) -> Measured:
    side = 2.4
    r = np.hypot(*centres(side, M))
    found = _punch(entrant, r <= 1, side).pressure[r < 0.7].mean()
    exact = float(CircularPunch(2 * MODULUS * 1e-3, 1.0, MODULUS).pressure(r[r < 0.7]).mean())
    return Measured(float(found), exact, 0.0, "Pa")


# fmt: off
CHECKS = (
    Check("hertz-peak", "Hertz: peak pressure under a load",
          "A paraboloid under a load has Hertz' peak pressure",
          "Hertz 1882; Johnson 1985, Eq. (4.24)", 0.002,
          "order 2 in h/a: 1.0e-3 measured at 13 elements across the radius. 1 % of modulus is "
          "worth 6.7e-3", BOTH_MODULI, _peak, Metric.RELATIVE),
    Check("hertz-load", "Hertz: load at a prescribed approach",
          "P = 4/3 E* sqrt(R) delta^(3/2), the approach counted from the tip between four centres",
          "Hertz 1882; Johnson 1985, Eq. (4.23)", 0.001,
          "order 2 in h/a with scatter: 1.5e-4 measured, 7e-4 at most with 26 to 48 elements. 1 % "
          "of modulus is 1 % of load", (*BOTH_MODULI, F.MEAN_DISPLACEMENT_LOST), _load, Metric.RELATIVE),
    Check("hertz-off-centre", "Hertz: near a corner of the square",
          "A half-space is free outside the square, so a contact beside its corner is Hertz' all the same",
          "Johnson 1985, Eq. (3.39); what a periodic image would add", 0.03,
          "relative L2; square-root edges: order 1, 2.4e-2 measured at 10 elements across the "
          "radius", (F.PERIODIC_FOR_APERIODIC, F.TRANSPOSED),
          lambda entrant: apart(*off_centre(entrant, M, 5.5 / M, -3.5 / M))),
    Check("hertz-ellipse", "Elliptical Hertz contact: pressure element by element",
          "The long semi-axis of a paraboloid of curvatures 2 and 6 lies along x, where it is flatter",
          "Johnson 1985, section 4.2; Carlson's integrals", 0.02,
          "relative L2; square-root edges: order 1, 1.7e-2 measured at 13 elements across "
          "the long semi-axis. Exchanged axes miss by 60 %, half an element by 10 %",
          (F.TRANSPOSED, F.HALF_ELEMENT, F.MODULUS_DOUBLED), lambda entrant: apart(*ellipse(entrant, M))),
    Check("cone", "Cone: pressure element by element",
          "The pressure is E* slope/2 arccosh(a/r), logarithmic at the tip",
          "Sneddon 1965; Johnson 1985, section 5.2", 0.013,
          "relative L2: order 1 by tip and edge alike, 1.04e-2 measured at 13 elements across the "
          "radius", (F.MODULUS_DOUBLED, F.HALF_ELEMENT), lambda entrant: apart(*cone(entrant, M))),
    Check("load-doubling", "Load doubling of power-law indenters",
          "On r, r^2, r^4 the load within half the first contact's radius is Galin's, before and after the "
          "load is doubled",
          "Galin 1961; Sneddon 1965; Archard 1957 for the meaning", 0.007,
          "relative; the cone's tip, logarithmic, is worth h^2 of load: 4.7e-3 measured at ten "
          "elements across the first contact's radius", (F.MODULUS_DOUBLED,), _load_doubling),
    Check("square-punch", "Square flat punch: stiffness",
          "Freed of its edges' and corners' known orders, the stiffness of four grids is the electrified "
          "plate's, 1.1523 E* (2a)",
          "Read 1997 and Hwang and Mascagni 2004 (0.3667874)", 4e-4,
          "least squares in 1, h (edges, d^-1/2) and h^1.593 (corners): the next term, h^2, moves "
          "the limit by 1e-4 on grids of 6 to 15 elements",
          (*BOTH_MODULI, F.NEAR_FIELD, F.MEAN_DISPLACEMENT_LOST), _square_punch, Metric.RELATIVE),
    Check("circular-punch", "Circular flat punch: pressure away from the edge",
          "Within 0.7 a the mean pressure is that of P/(2 pi a^2) (1 - r^2/a^2)^(-1/2) at P = 2 a E* delta",
          "Boussinesq 1885; Johnson 1985, Eq. (3.34)", 0.02,
          "the staircase outline moves the edge by a share of h: 0.35 h/a at most, 2.6e-2, on the "
          "stiffness, and half of it was measured here",
          (F.MODULUS_DOUBLED, F.MEAN_DISPLACEMENT_LOST), _circular_punch, Metric.RELATIVE),
)
# fmt: on
