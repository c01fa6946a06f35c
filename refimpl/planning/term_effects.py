"""What each term does to the friction coefficient and to the contact area, estimated from an outlook.

Estimates are meant to be exceeded by one effect in twenty. Their form is derived; the factors named below
cover 19 of 20 of the effects on random scenes made for that purpose (seeds other than those of the
verification case that judges the estimates). Notation: ``<.>`` is a mean weighted by pressure,
``mu = beta + tau / f_m``, ``t = tan theta_x`` of the common surface.

*Shear's tilt.* Under r the common surface of two bodies is moved by half of ``(c_l + c_u) r``, up on one
side and down on the other. The derivative of ``I[s/rho^2]`` along s is ``pi r`` at the point itself plus a
principal value without isotropic part, so ``<t> = -pi (c_l + c_u)/2 (beta <f> + tau)``; F loses P times that.

*Obliqueness.* To first order ``F/P = mu + (1 + mu^2) <t>``. Newton's third law for elastic bodies,
``sum f du/dx = 0`` of each alone, makes ``<t>`` the mean slope of either undeformed body on the contact: a
flat body allows none but shear's. A symmetric scene has none either. Second order is the mean square slope.

*Shear coupling.* ``c r`` is odd about each spot and ``|c| / a`` times mu in size next to ``a f``. Areas of
single spots change to first order, with either sign, which leaves their sum the root of their number; of a
symmetric contact only to second.

*Slope correction.* Tractions ``r tan theta`` down and ``f tan theta`` along, in place of none. What acts
along a surface works as well: the third law becomes ``<t> = -<(t, t_y) . du/dx>`` with u along each body,
whose strain under f is its own ``c/a`` of a slope.

Whole elements: A is counted in them, and a change of ``m`` elements comes as ``m`` events of chance, four at
a time in a symmetric scene; two standard deviations are added.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from refimpl.model.materials import Pair
from refimpl.planning.expected_contact import Outlook
from refimpl.scene.scene import Friction

_TILT = 1.4  # spots that are not round; 0.6 to 1.3 found
_MEAN_SLOPE = 1.5  # mean slope on the solver's contact over that on the expected one
_UNEVEN = 0.4  # pressure not spread evenly over slopes of one spot
_ONE_SIDED = 2.0  # slopes at the border are one-sided differences, and the sum over f du/dx is not zero
_ODD = 0.35  # area of spots under an odd displacement
_EVEN = 2.0  # area of a symmetric contact, to second order in the same
_FACETS = 0.7  # area under the tractions of facets
_STRETCH = 0.5  # slopes times strains, whose signs differ over a spot; 0.03 in the median, 0.45 of 19 in 20


@dataclass(frozen=True)
class Effect:
    """Size of a change: of mu, relative to local friction, and of A, relative.

    Without friction there is nothing to relate to, and ``bare`` is the change of mu itself.
    """

    friction: float
    area: float
    bare: float = 0.0

    @property
    def larger(self) -> float:
        """The larger of both."""
        return max(self.friction, self.area)


NONE = Effect(0.0, 0.0)


@dataclass(frozen=True)
class Scales:
    """What the estimates share: local friction at the outlook's pressure, and tau's part of it."""

    outlook: Outlook
    pair: Pair
    friction: Friction

    @property
    def mu(self) -> float:
        """``beta + tau / f_m``."""
        return self.friction.beta + self.friction.tau / self.outlook.mean_pressure

    def tilt(self, compliance: float) -> float:
        """``|<t>|`` under shear, for a compliance c (1/Pa)."""
        shear = self.friction.beta * self.outlook.pressure + self.friction.tau
        return _TILT * math.pi * compliance * shear

    def effect(self, friction: float, area: float, local: float) -> Effect:
        """An effect from the change of mu apart from tau's, of A, and of single spots' areas."""
        bunch = 4 if self.outlook.symmetric else 1
        area = area + 2 * math.sqrt(bunch * local / self.outlook.elements)
        if self.friction.is_zero:
            return Effect(0.0, area, bare=friction)
        adhesive = self.friction.tau / self.outlook.mean_pressure
        return Effect((friction + adhesive * area) / self.mu, area)


def shear_coupling(scales: Scales) -> Effect:
    """Of leaving ``(c_lower - c_upper) r`` out of Eq. (7)."""
    c = abs(scales.pair.shear_compliance)
    if c == 0 or scales.friction.is_zero:
        return NONE
    strength = c / scales.pair.normal_compliance * scales.mu
    local = _ODD * strength
    area = _EVEN * strength**2
    if not scales.outlook.symmetric:
        area += local / math.sqrt(scales.outlook.spots)
    return scales.effect(scales.tilt(0.5 * c) + local * scales.outlook.least_slope, area, local)


def shear_tilt(scales: Scales) -> Effect:
    """Of leaving shear's motion of the common surface out of its slopes."""
    if scales.friction.is_zero:
        return NONE
    c = 0.5 * (abs(scales.pair.lower.shear_compliance) + abs(scales.pair.upper.shear_compliance))
    tilt = scales.tilt(c)
    area = scales.mu * tilt
    return scales.effect((1 + scales.mu**2) * tilt, area, area)


def obliqueness(scales: Scales) -> Effect:
    """Of cosines 1 and sines 0 everywhere."""
    outlook = scales.outlook
    bodies = abs(scales.pair.lower.shear_compliance), abs(scales.pair.upper.shear_compliance)
    if scales.friction.is_zero and outlook.symmetric:
        return Effect(0.0, outlook.slope_squared)  # the same on all sides: no chance in which elements tip
    slope = scales.tilt(max(bodies)) + outlook.slope_squared
    if not outlook.symmetric:
        slope += _MEAN_SLOPE * outlook.least_mean_slope + _UNEVEN * outlook.least_slope
        slope += _ONE_SIDED * outlook.border * math.sqrt(outlook.slope_squared)
    area = scales.mu * slope + outlook.slope_squared
    return scales.effect((1 + scales.mu**2) * slope, area, area)


def slope_correction(scales: Scales) -> Effect:
    """Of the printed tractions in Eq. (7) in place of the facets' exact ones."""
    outlook, pair = scales.outlook, scales.pair
    slope = math.sqrt(outlook.slope_squared)
    local = _FACETS * (abs(pair.shear_compliance) / pair.normal_compliance + scales.mu) * slope
    if scales.friction.is_zero and outlook.symmetric:  # no force along the surface, whatever the tractions
        return scales.effect(0.0, local, local)
    stretch = (abs(pair.lower.shear_compliance) + abs(pair.upper.shear_compliance)) / pair.normal_compliance
    return scales.effect((scales.mu + _STRETCH * stretch) * outlook.slope_squared, local, local)
