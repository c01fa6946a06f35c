"""Projected, preconditioned conjugate gradients for contact with everything but the pressure held.

Minimise ``1/2 f.(a f) + f.b`` over ``f >= 0``, either with ``K.f = target`` (the load) or with
``b`` holding ``-K approach``. On the set S of elements in contact each step is one of projected CG
with the constraint eliminated in the preconditioner's metric (Gould, Hribar and Nocedal 2001, SIAM
J. Sci. Comput. 23, 1376); after it, elements with negative pressure leave S and elements that
penetrate enter it (Polonsky and Keer 1999, Wear 231, 206). Conjugacy is measured by the
Polak-Ribiere quotient, which forgets the past by itself when S changes.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from refimpl.friction import Mask
from refimpl.grid import Array

Apply = Callable[[Array], Array]


def relative_gap(duality: float, energy: float) -> float:
    """Complementarity gap over elastic energy; an exact state without energy has none."""
    if duality == 0:
        return 0.0
    return duality / energy if energy > 0 else np.inf


class ProjectedCG:
    """Iterates ``pressure`` towards the contact of the frozen problem.

    ``apply`` is the flexibility ``a`` on the window, ``precondition`` an approximate inverse. After
    construction call `freeze`, then `iterate`; ``normal_displacement`` is ``a f`` at all times.
    """

    def __init__(self, apply: Apply, precondition: Apply, pressure: Array) -> None:
        self._apply, self._precondition = apply, precondition
        self.pressure = pressure
        self.normal_displacement = apply(pressure)
        self.contact: Mask = pressure > 0
        self._direction: Array | None = None
        self._lift: Array | None = None
        self._residual, self._product = pressure, 0.0

    def freeze(self, b: Array, K: Array, *, target: float | None, approach: float | None) -> None:
        """Hold ``b = K h + shear displacement`` (m), the weights ``K`` and the target or approach."""
        self._b, self._K, self._target, self._approach = b, K, target, approach
        self._direction = self._lift = None
        if target is not None:
            self._scale_to_target()

    @property
    def separation(self) -> Array:
        """``v = (a f + b) / K`` (m): the approach where there is contact, more elsewhere."""
        return (self.normal_displacement + self._b) / self._K

    def approach(self, separation: Array) -> float:
        """The prescribed approach, or the pressure-weighted mean of ``v`` (m)."""
        if self._approach is not None:
            return self._approach
        return float(np.vdot(self.pressure, separation)) / float(self.pressure.sum())

    def residuals(self) -> tuple[float, float]:
        """Complementarity gap over elastic energy, and penetration over approach, of the frozen problem."""
        v = self.separation
        approach, lowest = self.approach(v), float(v.min())
        energy = 0.5 * float(np.vdot(self.pressure, self.normal_displacement))
        gap = float(np.vdot(self.pressure, v - lowest))
        total = float(self.pressure.sum())  # zero where a step to a prescribed approach overshot
        off = abs(float(np.vdot(self.pressure, v)) / total - approach) if total > 0 else 0.0
        scale = abs(approach) or 1.0
        return relative_gap(gap, energy), max(off, approach - lowest) / scale

    def iterate(self) -> None:
        """One step of projected CG on the contact set, then the exchange of elements."""
        residual = -(self.normal_displacement + self._b)
        if self._approach is not None:
            residual += self._K * self._approach
        residual *= self.contact
        step = self._preconditioned(residual)
        if self._target is not None:
            lift, stiffness = self._lift_of_set()
            multiplier = -float(np.vdot(self._K, step)) / stiffness
            step += multiplier * lift
            residual += multiplier * (self._K * self.contact)
        direction = self._conjugate(residual, step)
        moved = self._apply(direction)
        curvature = float(np.vdot(direction, moved))
        if curvature > 0:  # zero when the constraint alone fixes the set's pressure
            length = float(np.vdot(residual, direction)) / curvature
            self.pressure = self.pressure + length * direction
            self.normal_displacement = self.normal_displacement + length * moved
        self._exchange()

    def _preconditioned(self, residual: Array) -> Array:
        step = self._precondition(residual)
        step *= self.contact
        return step

    def _lift_of_set(self) -> tuple[Array, float]:
        """``M K`` on the contact set and ``K.M K``: how pressure answers to a change of approach."""
        if self._lift is None:
            self._lift = self._preconditioned(self._K * self.contact)
            self._stiffness = float(np.vdot(self._K, self._lift))
        return self._lift, self._stiffness

    def _conjugate(self, residual: Array, step: Array) -> Array:
        product = float(np.vdot(residual, step))
        direction = step
        if self._direction is not None and self._product > 0:
            quotient = (product - float(np.vdot(self._residual, step))) / self._product
            direction = step + max(0.0, quotient) * (self._direction * self.contact)
            if self._target is not None:
                lift, stiffness = self._lift_of_set()
                direction -= (float(np.vdot(self._K, direction)) / stiffness) * lift
        self._direction, self._residual, self._product = direction, residual, product
        return direction

    def _exchange(self) -> None:
        negative = self.pressure < 0
        if negative.any():
            if negative[self.contact].all():  # the step overshot everything: keep the largest element
                negative.flat[int(np.argmax(self.pressure))] = False
            self.pressure[negative] = 0.0
            self.contact = self.contact & ~negative
            if self._target is not None:
                self._scale_to_target(displace=False)
            self.normal_displacement = self._apply(self.pressure)
            self._lift = None
        v = self.separation
        entering = ~self.contact & (v < self.approach(v))
        if entering.any():
            self.contact = self.contact | entering
            self._lift = None

    def _scale_to_target(self, *, displace: bool = True) -> None:
        assert self._target is not None
        factor = self._target / float(np.vdot(self._K, self.pressure))
        self.pressure = self.pressure * factor
        if displace:
            self.normal_displacement = self.normal_displacement * factor
