"""Projected, preconditioned conjugate gradients for contact with everything but the pressure held.

Minimise ``1/2 f.(a f) + f.b`` over ``f >= 0``, either with ``K.f = target`` (the load) or with
``b`` holding ``-K approach``. On the set S of elements in contact each step is one of CG, residual and
step both projected onto ``K.d = 0`` (which keeps the preconditioner symmetric there). The trial point of a
step is cut at zero pressure and brought to the load *before* the displacement is applied, and the best point
from the present through the trial is taken: one application a step, whether elements leave or not. Elements
that penetrate enter S afterwards (Polonsky and Keer 1999, Wear 231, 206). Conjugacy is measured by the
Polak-Ribiere quotient, which forgets the past by itself when S changes. ``a`` may have a weak skew part
(`refimpl.solvers.production.flexibility`): the residual holds it, and no curvature sees it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from refimpl.grid import Array, inner
from refimpl.model.friction import Mask
from refimpl.model.gap import relative_gap
from refimpl.solvers.production.contact_vectors import Support
from refimpl.solvers.production.step_length import cut_at_zero, room

Apply = Callable[[Array], Array]

FIRST_LENGTH = 0.7  # of a step: the preconditioned spectrum lies between 1 and 2 (see the tests)
_SHORTER = 0.8  # trial over last best length: a trial too long would leave cut elements halfway
_NOTHING = 1e-12  # of a pressure: what a step that makes it vanish may leave
_DOUBT = 2.0  # times the worst misfit; 1 is enough for all of tau's states on random scenes (see the tests)
_TRUSTED = (0.4, 3.0)  # best over trial length; beyond, the next step finds its length before it cuts


class _Seen(NamedTuple):
    """Separation ``v`` of the present pressure (m), on CG's elements alone, and its mean by pressure."""

    v: Array
    on: Array
    mean: float


class ProjectedCG:
    """Iterates ``pressure`` towards the contact of the frozen problem.

    ``apply`` is the flexibility ``a`` on the window, ``precondition`` an approximate inverse. After
    construction call `freeze`, then `iterate`; ``normal_displacement`` is ``a f`` at all times.
    """

    def __init__(self, apply: Apply, precondition: Apply, pressure: Array) -> None:
        self._apply, self._precondition = apply, precondition
        self.normal_displacement = apply(pressure)
        self.contact: Mask = pressure > 0
        self._support = Support(self.contact)
        self._pressing = self._support.of(pressure)
        self._direction: Array | None = None
        self._seen: _Seen | None = None
        self._residual, self._product = self._pressing, 0.0
        self._length, self._trusted = FIRST_LENGTH, True

    def freeze(self, b: Array, K: Array, *, target: float | None, approach: float | None) -> None:
        """Hold ``b = K h + shear displacement`` (m), the weights ``K`` and the target or approach."""
        self._b, self._K, self._target, self._approach = b, K, target, approach
        self._unweighted = not any(K.strides) and bool(K.flat[0] == 1)  # one 1, broadcast
        self._direction = self._seen = None
        self._exchanged = True
        if target is not None:
            self._scale_to_target()

    @property
    def pressure(self) -> Array:
        """``f`` on the window (Pa)."""
        return self._support.onto(self._pressing)

    @property
    def separation(self) -> Array:
        """``v = (a f + b) / K`` (m): the approach where there is contact, more elsewhere."""
        return self._look().v

    @property
    def approach(self) -> float:
        """The prescribed approach, or the pressure-weighted mean of ``v`` (m)."""
        return self._look().mean if self._approach is None else self._approach

    def _look(self) -> _Seen:
        if self._seen is None:
            v = self.normal_displacement + self._b
            if not self._unweighted:
                v /= self._K
            on = self._support.seen(v)
            total = float(self._pressing.sum()) or 1.0  # a step overshot: nothing presses, and no mean counts
            self._seen = _Seen(v, on, inner(self._pressing, on) / total)
        return self._seen

    def residuals(self) -> tuple[float, float]:
        """Complementarity gap over elastic energy, and penetration over approach, of the frozen problem.

        At an approach the first is no less than the work of what the mean separation misses of it.
        """
        (v, on, mean), approach = self._look(), self.approach
        lowest = float(v.min())
        energy = 0.5 * inner(self._pressing, self._support.seen(self.normal_displacement))
        gap = inner(self._pressing, on - lowest)
        if self._approach is not None:
            gap = max(gap, abs(mean - approach) * float(self._pressing.sum()))
        return relative_gap(gap, energy), max(0.0, approach - lowest) / (abs(approach) or 1.0)

    def beyond_doubt(self, stiffness: float) -> bool:
        """Whether what the separation still lacks can bring no element into contact, and take none out.

        ``stiffness`` turns a displacement of single elements into pressure (Pa/m).
        """
        v, approach = self._look().v, self.approach
        doubt = _DOUBT * float((np.abs(v - approach) * self.contact).max())
        pressing = np.count_nonzero(self._pressing > stiffness * doubt)
        close = np.count_nonzero(v <= approach + doubt)
        return bool(pressing == close == np.count_nonzero(self.contact))

    def iterate(self) -> None:
        """One step of projected CG on the contact set, then the exchange of elements.

        At an approach the set may be empty: there is no step then, and elements that penetrate come back.
        """
        if self.contact.any():
            self._step()
        self._seen = None
        self._enter(self.separation < self.approach)

    def _step(self) -> None:
        if self._exchanged:
            self._exchange()
        residual = self._frozen_residual()
        direction = self._conjugate(residual, self._projected(self._preconditioned(residual)))
        self._exchanged = False
        if not (self._trusted and self._step_to_trial(residual, direction)):
            self._step_then_cut(residual, direction)

    def _exchange(self) -> None:
        """Go on with the present contact set: all that lives on it, the load's weights and their squares."""
        last, self._support = self._support, Support(self.contact)
        self._pressing = self._support.of(last.onto(self._pressing))
        if self._seen is not None:
            self._seen = self._seen._replace(on=self._support.seen(self._seen.v))
        if self._direction is not None:
            self._direction = self._support.of(last.onto(self._direction))
            self._residual = self._support.of(last.onto(self._residual))
        self._weights = self._support.ones() if self._unweighted else self._support.of(self._K)
        self._squares = self._weights if self._unweighted else self._weights**2
        self._norm = float(self._squares.sum())

    def _frozen_residual(self) -> Array:
        """``K (approach - v)`` on the contact set: at the approach that leaves nothing along the weights."""
        v, approach = self._look().on, self._approach
        if approach is None:
            approach = inner(self._squares, v) / self._norm
        residual = approach - v
        residual *= self._weights
        return residual

    def _projected(self, values: Array) -> Array:
        """``values`` on the contact set without what they have along the load's weights."""
        if self._target is None:
            return values
        values -= (inner(self._weights, values) / self._norm) * self._weights
        return values

    def _preconditioned(self, residual: Array) -> Array:
        return self._support.of(self._precondition(self._support.onto(residual)))

    def _conjugate(self, residual: Array, step: Array) -> Array:
        product = inner(residual, step)
        direction = step
        if self._direction is not None and self._product > 0:
            quotient = (product - inner(self._residual, step)) / self._product
            if 0 < quotient < math.inf:  # numbers next to none have products next to none
                direction = self._carried_over(quotient)
                direction += step
        self._direction, self._residual, self._product = direction, residual, product
        return direction

    def _carried_over(self, quotient: float) -> Array:
        """That much of the last direction, on the present contact set."""
        assert self._direction is not None
        direction = quotient * self._direction
        return self._projected(direction) if self._exchanged else direction

    def _step_to_trial(self, residual: Array, direction: Array) -> bool:
        """To the best point between here and the trial, cut and scaled; False if the cut leaves nothing."""
        change = (_SHORTER * self._length) * direction
        trial = self._pressing + change
        cut: Mask | None = None
        if trial.min() < 0:
            cut = trial < 0
            if not cut_at_zero(trial, self._pressing, change, self._weights, self._target):
                return False
        moved = self._apply(self._support.onto(change))
        curvature = inner(change, self._support.seen(moved))
        best = inner(residual, change) / curvature if curvature > 0 else 0.0
        self._take(max(best, 0.0), change, moved, cut)
        self._length *= _SHORTER * best
        self._trusted = _TRUSTED[0] < best < _TRUSTED[1]
        return True

    def _take(self, share: float, change: Array, moved: Array, cut: Mask | None) -> None:
        """That share of a change, but no pressure below zero; what is cut or falls to zero leaves."""
        before = self._pressing
        pressure = before + share * change
        beyond = share > 1 and bool(pressure.min() < 0)
        if beyond:
            share = room(before, change)
            pressure = before + share * change
        if beyond or cut is not None:
            pressure[pressure < _NOTHING * before] = 0.0  # whatever trace rounding leaves
            falling = change < 0
            self._leave(self._support.where((pressure == 0) & (falling if cut is None else falling | cut)))
        self._pressing = pressure
        moved *= share
        self.normal_displacement += moved

    def _enter(self, penetrating: Mask) -> None:
        entering = penetrating > self.contact
        if entering.any():
            self.contact |= entering
            self._exchanged = True

    def _leave(self, lifted: Mask) -> None:
        if lifted.any():
            self.contact &= ~lifted
            self._exchanged = True

    def _step_then_cut(self, residual: Array, direction: Array) -> None:
        """The exact step along the direction, then the cut: two applications, and no guess."""
        moved = self._apply(self._support.onto(direction))
        curvature = inner(direction, self._support.seen(moved))
        if curvature > 0:  # zero when the constraint alone fixes the set's pressure
            self._length = inner(residual, direction) / curvature
            self._pressing = self._pressing + self._length * direction
            self.normal_displacement = self.normal_displacement + self._length * moved
            self._trusted = True
        negative = self._pressing < 0
        if negative.any():
            self._pressing[negative] = 0.0  # at an approach all may go, and come back as they penetrate
            self._leave(self._support.where(negative))
            if self._target is not None:
                self._scale_to_target(displace=False)
            self.normal_displacement = self._apply(self.pressure)

    def _scale_to_target(self, *, displace: bool = True) -> None:
        assert self._target is not None
        carried = inner(self._K, self.pressure)
        if carried == 0:  # nothing presses: no factor helps, and the balance of the load says so
            return
        factor = self._target / carried
        self._pressing = self._pressing * factor
        if displace:
            self.normal_displacement = self.normal_displacement * factor
