"""Effects of each term on the friction coefficient and on the contact area, estimated from a contact.

One effect in twenty may exceed its estimate. The form of the estimates is derived; the factors named below
cover 19 of 20 effects on random scenes made for that purpose (seeds other than those of the verification case
that judges the estimates). Notation: ``<.>`` is a mean weighted by pressure, ``mu = beta + tau / f_m``,
``t = tan theta_x`` of the common surface.

*Slope change by shear.* Under r the common surface of two bodies moves by half of ``(c_l + c_u) r``, up on
one side and down on the other. The derivative of ``I[s/rho^2]`` along s is ``pi r`` at the point itself plus
a principal value without isotropic part, so ``<t> = -pi (c_l + c_u)/2 (beta <f> + tau)``; F loses P times
that.

*Slope terms.* To first order ``F/P = mu + (1 + mu^2) <t>``. Newton's third law for elastic bodies, ``sum f
du/dx = 0`` of each alone, makes ``<t>`` the mean slope of either undeformed body on the contact. A flat body
allows none but that by shear, and a symmetric scene none at all. Second order is the mean square slope.

*Normal-tangential coupling.* ``c r`` is odd about each patch, and ``|c| / a`` times mu in size next to ``a
f``. Areas of single patches change to first order, with either sign, so their sum changes by the root of
their number; that of a symmetric contact only to second order.

*Slope correction.* Tractions ``r tan theta`` down and ``f tan theta`` along, in place of none. Tractions
along a surface do work as well: the third law becomes ``<t> = -<(t, t_y) . du/dx>`` with u along each body,
whose strain under f is its own ``c/a`` of a slope.

*Whole elements.* A is counted in them. A change of ``m`` elements comes as ``m`` random events, four at a
time in a symmetric scene; two standard deviations are added.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from refimpl.grid import Array
from refimpl.model.friction import FrictionLaw, friction_coefficient_at, is_frictionless, shear_at
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem
from refimpl.planning.expected_contact import ExpectedContact, solved_contact

_TILT = 2.0  # strips; patches that are not round: 0.6 to 1.4 found
_MEAN_SLOPE = 1.5  # mean slope on the solved contact over that on the expected one
_UNEVEN = 0.4  # pressure distributed unevenly over the slopes of one patch
_ONE_SIDED = 2.0  # slopes at the border are one-sided differences, and the sum over f du/dx is not zero
_ODD = 0.35  # area of patches under an odd displacement
_EVEN = 2.0  # area of a symmetric contact under it, to second order
_FACETS = 0.7  # area under the tractions of facets
_STRETCH = 0.5  # slopes times strains, whose signs differ over a patch; median 0.03, 19 of 20 below 0.45


@dataclass(frozen=True)
class Effect:
    """Size of a change: of mu, relative to local friction, and of A, relative.

    Without friction, ``bare`` is the change of mu itself.
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
    """A contact, the two materials and the friction law that all estimates are made from."""

    contact: ExpectedContact
    pair: Pair
    friction: FrictionLaw

    @property
    def frictionless(self) -> bool:
        """True if no shear acts, or less than a double holds over the pressure."""
        return is_frictionless(self.friction) or self.mu == 0

    @property
    def mu(self) -> float:
        """``beta + tau / f_m``."""
        return friction_coefficient_at(self.friction, self.contact.mean_pressure)

    @property
    def tilts(self) -> tuple[float, float]:
        """Mean slopes ``<t>`` of both surfaces under shear, each of its own body."""
        return self.pair.tilts(_TILT * shear_at(self.friction, self.contact.pressure))

    def effect(self, friction: float, area: float, local: float) -> Effect:
        """Return an effect from the changes of mu without tau's, of A, and of single patches' areas."""
        bunch = 4 if self.contact.symmetric else 1
        area = area + 2 * math.sqrt(bunch * local / self.contact.elements)
        if self.frictionless:
            return Effect(0.0, area, bare=friction)
        adhesive = self.friction.jump / self.contact.mean_pressure
        return Effect((friction + adhesive * area) / self.mu, area)


def coupled(scales: Scales) -> Effect:
    """Return the effect of neglecting ``(c_lower - c_upper) r`` in Eq. (7)."""
    ratio = abs(scales.pair.coupling_ratio)
    if ratio == 0 or scales.frictionless:
        return NONE
    strength = ratio * scales.mu
    local = _ODD * strength
    area = _EVEN * strength**2
    if not scales.contact.symmetric:
        area += local / math.sqrt(scales.contact.patches)
    lower, upper = scales.tilts
    return scales.effect(0.5 * abs(lower - upper) + local * scales.contact.least_slope, area, local)


def tilted(scales: Scales) -> Effect:
    """Return the effect of neglecting shear's motion of the common surface in its slopes."""
    if scales.frictionless:
        return NONE
    tilt = 0.5 * sum(map(abs, scales.tilts))
    area = scales.mu * tilt
    return scales.effect((1 + scales.mu**2) * tilt, area, area)


def oblique(scales: Scales) -> Effect:
    """Return the effect of cosines 1 and sines 0 everywhere."""
    contact = scales.contact
    if scales.frictionless and contact.symmetric:
        return Effect(0.0, contact.slope_squared)  # equal on all sides: no random change of elements
    slope = max(map(abs, scales.tilts)) + contact.slope_squared
    if not contact.symmetric:
        slope += _MEAN_SLOPE * contact.least_mean_slope + _UNEVEN * contact.least_slope
        slope += _ONE_SIDED * contact.border * math.sqrt(contact.slope_squared)
    area = scales.mu * slope + contact.slope_squared
    return scales.effect((1 + scales.mu**2) * slope, area, area)


def slope_correction(scales: Scales) -> Effect:
    """Return the effect of the printed tractions in Eq. (7) in place of the facets' exact ones."""
    contact, pair = scales.contact, scales.pair
    slope = math.sqrt(contact.slope_squared)
    local = _FACETS * (abs(pair.coupling_ratio) + scales.mu) * slope
    if scales.frictionless and contact.symmetric:  # no force along the surface, whatever the tractions
        return scales.effect(0.0, local, local)
    return scales.effect((scales.mu + _STRETCH * pair.shear_ratio) * contact.slope_squared, local, local)


ESTIMATES = {"coupled": coupled, "oblique": oblique, "tilted": tilted, "slope_correction": slope_correction}
"""The estimate of each term, by the name of its switch (`refimpl.model.problem.Terms`)."""


def effects_in(
    names: tuple[str, ...],
    problem: Problem,
    pressure: Array,
    clearance: Array,
    before: ExpectedContact,
    elements: int | None = None,
) -> dict[str, Effect]:
    """Return each named term's effect by a solved pressure (Pa) and clearance (m), as on ``elements``."""
    if not names or not pressure.any():
        return {}
    contact = solved_contact(problem, pressure, clearance, before)
    finer = max(1.0, (elements or 0) / problem.grid.elements)
    contact = replace(contact, elements=round(finer * contact.elements))
    scales = Scales(contact, problem.pair, problem.friction)
    return {name: ESTIMATES[name](scales) for name in names}


def neglected_parts(
    effects: Mapping[str, Effect], local_friction: float, load: float, numbers: Mapping[str, float]
) -> dict[str, dict[str, float]]:
    """Return the effects as parts of the uncertainty, in each number's unit; Q changes as F does.

    ``local_friction`` is ``sum r / sum f``. ``numbers`` holds what changes as areas do: A, p_max, the
    approach from first contact, or at an approach the force times its exponent.
    """
    if not effects:
        return {}
    friction = sum(local_friction * effect.friction + effect.bare for effect in effects.values())
    area = sum(effect.area for effect in effects.values())
    parts = {name: {"neglected": area * abs(value)} for name, value in numbers.items()}
    parts["friction_coefficient"] = {"neglected": friction}
    parts["friction_force"] = {"neglected": friction * load}
    parts["binormal_force"] = {"neglected": friction * load}
    return parts
