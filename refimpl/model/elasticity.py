"""Eq. (7): from tractions to normal displacements. Compliances are multiplied in this module only.

Two half-spaces under pressure f and shear r along the sliding direction:

    u_lower = a_lower f + c_lower r,    u_upper = a_upper f - c_upper r,

because both bodies feel the same pressure and opposite shear. The gap closes by ``u_lower + u_upper = a f + c
r``, with ``a`` the sum and ``c`` lower minus upper; the common surface moves by ``(u_upper - u_lower) / 2``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.model.materials import Pair


class Influence(Protocol):
    """The convolutions of Eq. (7) without their compliances.

    ``normal(p)`` is ``sum I[1/rho] p`` and ``shear(q)`` is ``sum I[s/rho^2] q`` with ``s`` along the
    sliding direction; ``shear_across(q)`` has ``s`` along the direction 90 degrees anticlockwise of it.
    Tractions in Pa give products in Pa m; arrays have the shape of the grid or of a window of it.
    """

    @property
    def displaces_mean(self) -> bool:
        """True if a uniform pressure displaces anything; in a periodic scene it does not."""

    def normal(self, pressure: Array) -> Array:
        """Return ``I[1/rho]`` applied to a pressure."""

    def shear(self, traction: Array) -> Array:
        """Return ``I[s/rho^2]`` applied to a traction along the sliding direction."""

    def shear_across(self, traction: Array) -> Array:
        """Return ``I[t/rho^2]`` applied to a traction across the sliding direction."""


class WindowOperator(Influence, Protocol):
    """An influence by Fourier transforms, of a window onto itself."""

    def coupled(self, ratio: float) -> Callable[[Array], Array]:
        """Return the product ``I[1/rho] + ratio I[s/rho^2]`` of a pressure."""

    @property
    def symbol(self) -> Array:
        """The transform of ``I[1/rho]`` on a circle without padding (m), half along the first axis."""


@dataclass(frozen=True)
class Elasticity:
    """Two elastic half-spaces.

    ``coupled``: shear closes the gap (normal-tangential coupling). ``tilted``: shear moves the common
    surface, which only its slopes feel.
    """

    pair: Pair
    coupled: bool = True
    tilted: bool = True

    @property
    def shear_displaces(self) -> bool:
        """True if shear displaces anything that enters the problem."""
        return self.coupled or self.tilted

    @property
    def coupling_ratio(self) -> float:
        """``c / a``: displacement by unit shear over that by unit pressure, 0 without coupling."""
        return self.pair.coupling_ratio if self.coupled else 0.0

    def normal(self, operator: Influence, pressure: Array) -> Array:
        """Return ``a f``: how far pressure closes the gap (m)."""
        displacement = operator.normal(pressure)
        displacement *= self.pair.normal_compliance
        return displacement

    def normal_with_shear(self, operator: WindowOperator, slope: float) -> Callable[[Array], Array]:
        """Return the map ``f -> a f + slope c f`` (m): pressure and the shear proportional to it."""
        product = operator.coupled(self.coupling_ratio * slope)

        def displacement(pressure: Array) -> Array:
            result = product(pressure)
            result *= self.pair.normal_compliance
            return result

        return displacement

    def gap_by_shear(self, product: Array) -> Array:
        """Return ``c r`` (m): how far shear closes the gap, from its product (Pa m)."""
        return self.pair.shear_compliance * product if self.coupled else np.zeros_like(product)

    def body_displacements(
        self, normal: Array, pressure: Array, shear_product: Array | None
    ) -> tuple[Array, Array]:
        """Return ``(u_lower, u_upper)`` (m) from ``normal = a f`` of a pressure and the shear's product.

        The pressure itself is for bodies with a compliance of their own, such as a layer.
        """
        share = self.pair.lower.normal_compliance / self.pair.normal_compliance
        lower = share * normal
        upper = normal - lower
        if shear_product is not None:
            into_lower, into_upper = self.shear_compliances()
            lower += into_lower * shear_product
            upper += into_upper * shear_product
        return lower, upper

    def shear_compliances(self) -> tuple[float, float]:
        """Return each body's factor of ``I[s/rho^2]`` (1/Pa): the sum couples, half the difference tilts."""
        if not (self.coupled or self.tilted):
            return 0.0, 0.0
        into_lower, into_upper = self.pair.lower.shear_compliance, -self.pair.upper.shear_compliance
        if not self.coupled:
            tilt = 0.5 * (into_lower - into_upper)
            return tilt, -tilt
        if not self.tilted:
            closing = 0.5 * (into_lower + into_upper)
            return closing, closing
        return into_lower, into_upper

    def equivalent_bodies(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return (E, nu) of half-spaces, lower and upper, that move as these do with the neglected terms.

        ``c/a = (1 - 2 nu) / (2 (1 - nu))`` gives nu, and ``pi a = (1 - nu^2)/E`` gives E. Raises `InputError`
        for a rigid body where one of coupled and tilted is neglected alone.
        """
        bodies, (into_lower, into_upper) = (self.pair.lower, self.pair.upper), self.shear_compliances()
        if self.coupled and self.tilted:
            return (bodies[0].E, bodies[0].nu), (bodies[1].E, bodies[1].nu)
        found = []
        for body, c in zip(bodies, (into_lower, -into_upper), strict=True):
            if body.normal_compliance == 0:
                if c != 0:
                    raise InputError("tilted", self.tilted, "that of coupled: dense, with a rigid body")
                found.append((math.inf, body.nu))
                continue
            ratio = c / body.normal_compliance
            nu = (1 - 2 * ratio) / (2 - 2 * ratio)
            found.append(((1 - nu**2) / (math.pi * body.normal_compliance), nu))
        return found[0], found[1]

    def symbol(self, coefficients: Array) -> Array:
        """Return the transform of ``a`` (m/Pa) from that of ``I[1/rho]`` (m), for approximate inverses."""
        return self.pair.normal_compliance * coefficients

    def mean_compliance(self, grid: Grid) -> float:
        """Return the displacement by unit mean pressure of an area as large as the domain (m/Pa)."""
        return self.pair.normal_compliance * grid.size

    def element_compliance(self, grid: Grid) -> float:
        """Return ``a`` at the grid's highest frequency, one element against its neighbours (m/Pa)."""
        return 2 * self.pair.normal_compliance * grid.element_size
