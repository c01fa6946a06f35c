"""Local friction, Eqs (1) and (8): the law that gives the shear traction from the contact pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from refimpl.errors import InputError, keep_doubles, require_number
from refimpl.grid import Array, Mask


@runtime_checkable
class FrictionLaw(Protocol):
    """Interface of a law ``r(f)`` on elements in contact; what has its members may be a scene's friction.

    ``jump`` is ``r`` at vanishing pressure (Pa); ``slope`` is the part of ``dr/df`` that solvers may take
    into their linear systems. The rest, ``r - slope f``, is the shear offset. It is constant on the active
    set if the law ``is_linear``; otherwise solvers update it together with the slopes of the surface.
    Pressures are arrays (Pa) of any shape, active sets masks of the same shape, tractions arrays of it (Pa).
    """

    @property
    def jump(self) -> float:
        """``r`` of an element in contact at vanishing pressure (Pa)."""

    @property
    def slope(self) -> float:
        """Dimensionless coefficient of the pressure in the linear part of the law."""

    @property
    def is_linear(self) -> bool:
        """True if ``r - slope f`` does not depend on the pressure."""

    def traction(self, pressure: Array, active: Mask) -> Array:
        """Return r (Pa): the law on the active set, and ``slope f`` outside."""

    def shear_offset(self, pressure: Array, active: Mask) -> Array:
        """Return ``r - slope f`` (Pa): zero outside the active set."""


@dataclass(frozen=True)
class Friction:
    """Local friction ``r = tau + beta f`` on contact, Eq. (1): ``tau`` in Pa, ``beta`` dimensionless.

    Raises `InputError` for a negative or infinite number.
    """

    tau: float = 0.0
    beta: float = 0.0
    is_linear = True

    def __post_init__(self) -> None:
        require_number("friction.tau", self.tau, "a finite shear strength in Pa, not negative", at_least=0)
        allowed = "a finite number, not negative, at most 1e6 (the order is tau, beta)"
        require_number("friction.beta", self.beta, allowed, at_least=0, at_most=1e6)
        keep_doubles(self, "tau", "beta")

    @property
    def jump(self) -> float:
        """``tau`` (Pa)."""
        return self.tau

    @property
    def slope(self) -> float:
        """``beta``."""
        return self.beta

    def traction(self, pressure: Array, active: Mask) -> Array:
        """Return Eq. (8): ``tau`` on the active set plus ``beta f`` (Pa)."""
        found = self.beta * pressure
        found += self.tau * active
        return found

    def shear_offset(self, pressure: Array, active: Mask) -> Array:
        """Return ``tau`` on the active set, zero outside (Pa)."""
        return self.tau * active.astype(np.float64)


def require_law(law: object) -> None:
    """Raise `InputError` unless this is a law with a jump and a slope that are not negative."""
    if not isinstance(law, FrictionLaw):
        members = "jump, slope, is_linear, traction and shear_offset"
        raise InputError("friction", law, f"a Friction, or a FrictionLaw of one's own: {members}")
    require_number("friction.jump", law.jump, "a finite shear strength in Pa, not negative", at_least=0)
    require_number("friction.slope", law.slope, "a finite number, not negative", at_least=0)


def is_frictionless(law: FrictionLaw) -> bool:
    """Return whether no shear acts at all."""
    return law.jump == 0 and law.slope == 0 and law.is_linear


def friction_coefficient_at(law: FrictionLaw, mean_pressure: float) -> float:
    """Return ``r / f`` at a pressure (Pa): Eq. (10), ``tau / f_m + beta``, of the paper's law.

    >>> friction_coefficient_at(Friction(tau=15e6, beta=0.08), 800e6)    # the paper's H of copper
    0.09875
    """
    return shear_at(law, mean_pressure) / mean_pressure


def shear_at(law: FrictionLaw, pressure: float) -> float:
    """Return ``r`` at a pressure (Pa)."""
    return float(law.traction(np.array([pressure]), np.array([True]))[0])


def friction_per_area(law: FrictionLaw, normal_force: float) -> float:
    """Return ``d mu / d A = tau / N`` of Eq. (10): what a change of the contact area does to mu (1/m^2)."""
    return law.jump / normal_force if normal_force > 0 else 0.0
