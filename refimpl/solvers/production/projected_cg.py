"""Projected, preconditioned conjugate gradients for contact with the lagged terms fixed.

Minimise ``1/2 f.(a f) + f.b`` over ``f >= 0``, either with ``K.f = target`` (the load) or with ``b`` holding
``-K approach``. The method is that of Polonsky and Keer (1999, Wear 231, 206); the comments [PK n] give the
steps of their pseudocode (section 3):

    [PK 1] gap (here ``v``) of the present pressure      [PK 5] step length along the direction
    [PK 2] residual about its mean on the contact set    [PK 6] new pressure, cut at zero
    [PK 3] conjugate direction                           [PK 7] elements that penetrate enter the contact
    [PK 4] influence of the direction                    [PK 8] pressure scaled to the load

Differences: residual and direction are preconditioned, with both projected onto ``K.d = 0``, which keeps the
preconditioner symmetric there. Conjugacy is measured by the Polak-Ribiere quotient, which forgets the past by
itself when the contact changes. The trial point of a step is cut and scaled *before* its displacement is
computed, and the best point from the present one through the trial is taken: one application of ``a`` a step,
whether elements leave or not. ``a`` may have a weak skew part (`lagged_terms`): the residual contains it, and
no curvature does.
"""

from __future__ import annotations

import math
from copy import copy
from typing import NamedTuple, Self

import numpy as np

from refimpl.grid import Array, Mask, inner
from refimpl.model.certificate import contact_residuals
from refimpl.operators.preconditioner import Apply
from refimpl.solvers.production.constants import CERTAINTY, FIRST_LENGTH, TRIAL_SHARE, TRUSTED, VANISHING
from refimpl.solvers.production.contact_vectors import ContactVectors, cut_at_zero, longest_step, step_share


class Separation(NamedTuple):
    """``v`` of the present pressure (m), on the contact set alone, and its mean weighted by pressure."""

    v: Array
    on_contact: Array
    mean: float


class ProjectedCG:
    """Iterates ``pressure`` towards the contact of the frozen problem.

    ``apply`` is the flexibility ``a`` on the window, ``precondition`` an approximate inverse, ``rounding``
    that of displacements over the peak pressure (m/Pa). After construction call `set_problem`, then
    `iterate`; ``normal_displacement`` is ``a f`` at all times.
    """

    def __init__(self, apply: Apply, precondition: Apply, pressure: Array, rounding: float = 0.0) -> None:
        self._apply, self._precondition = apply, precondition
        self.normal_displacement = apply(pressure)
        self.free: Mask = pressure > 0
        self._vectors = ContactVectors(self.free)
        self._pressing = self._vectors.gather(pressure)
        self._direction: Array | None = None
        self._separation: Separation | None = None
        self._residual, self._product = self._pressing, 0.0
        self._length, self._trusted = FIRST_LENGTH, True
        self._rounding = rounding

    def set_problem(self, b: Array, K: Array, *, target: float | None, approach: float | None) -> None:
        """Set ``b = K h + shear displacement`` (m), the weights ``K``, and the target or the approach."""
        self._b, self._K, self._target, self._approach = b, K, target, approach
        self._unweighted = not any(K.strides) and bool(K.flat[0] == 1)  # one 1, broadcast
        self._direction = self._separation = None
        self._exchanged = True
        if target is not None:
            self._scale_to_target()

    def copy(self) -> Self:
        """Return CG with a state of its own; other arrays than these are replaced, never changed."""
        other = copy(self)
        other.normal_displacement, other.free = self.normal_displacement.copy(), self.free.copy()
        return other

    @property
    def contact(self) -> Mask:
        """Elements that bear pressure; on the ``free`` ones pressures are still sought."""
        return self.free

    @property
    def pressure(self) -> Array:
        """``f`` on the window (Pa)."""
        return self._vectors.scatter(self._pressing)

    @property
    def separation(self) -> Array:
        """``v = (a f + b) / K`` (m), which is the approach where there is contact, and more elsewhere."""
        return self._separate().v

    @property
    def approach(self) -> float:
        """The prescribed approach, or the pressure-weighted mean of ``v`` (m)."""
        return self._separate().mean if self._approach is None else self._approach

    def _separate(self) -> Separation:
        """Return ``v`` of the present pressure [PK 1]."""
        if self._separation is None:
            v = self.normal_displacement + self._b
            if not self._unweighted:
                v /= self._K
            on = self._vectors.gather_view(v)
            total = float(self._pressing.sum()) or 1.0  # 1 after a step that left no pressure
            mean = inner(self._pressing, on) / total or inner(self._pressing / total, on)  # products vanish
            self._separation = Separation(v, on, mean)
        return self._separation

    def residuals(self) -> tuple[float, float]:
        """Return gap over elastic energy, and penetration over approach, of the fixed problem.

        At a prescribed approach the first is at least the work done by the error of the mean separation.
        """
        (v, on, mean), approach = self._separate(), self.approach
        lowest, pressing = float(v.min()), self._pressing
        shares = pressing / (float(pressing.sum()) or 1.0)  # products of the least pressures would vanish
        energy = 0.5 * inner(shares, self._vectors.gather_view(self.normal_displacement))
        gap = inner(shares, on - lowest)
        if self._approach is not None and pressing.any():
            gap = max(gap, abs(mean - approach))
        rounding = self._rounding * float(pressing.max(initial=0.0))
        return contact_residuals(gap, energy, approach, lowest, rounding)

    def undecided(self, stiffness: float, among: Mask | None = None) -> int:
        """Return how many elements the error left may move; ``stiffness``: of a single element (Pa/m)."""
        v, approach = self._separate().v, self.approach
        margin = CERTAINTY * float((np.abs(v - approach) * self.free).max())
        pressing = self._vectors.scatter_mask(self._pressing > stiffness * margin)
        certain = np.where(self.free, pressing, v > approach + margin)
        return int(np.count_nonzero(~certain if among is None else ~certain[among]))

    def iterate(self) -> None:
        """Take a step on the contact set, which may be empty at an approach, then exchange elements."""
        if self.free.any():
            self._step()
        self._separation = None
        self._enter(self.separation < self.approach)  # [PK 7]

    def _step(self) -> None:
        if self._exchanged:
            self._exchange()
        residual = self._residual_on_contact()  # [PK 2]
        step = self._vectors.gather(self._precondition(self._vectors.scatter(residual)))
        direction = self._conjugate(residual, self._projected(step))  # [PK 3]
        self._exchanged = False
        if not (self._trusted and self._step_to_trial(residual, direction)):
            self._step_then_cut(residual, direction)

    def _exchange(self) -> None:
        """Move all vectors to the present contact set, with the load's weights and their squares."""
        last, self._vectors = self._vectors, ContactVectors(self.free)
        self._pressing = self._vectors.gather(last.scatter(self._pressing))
        if self._separation is not None:
            self._separation = self._separation._replace(
                on_contact=self._vectors.gather_view(self._separation.v)
            )
        if self._direction is not None:
            self._direction = self._vectors.gather(last.scatter(self._direction))
            self._residual = self._vectors.gather(last.scatter(self._residual))
        self._weights = self._vectors.ones() if self._unweighted else self._vectors.gather(self._K)
        self._squares = self._weights if self._unweighted else self._weights**2
        self._norm = float(self._squares.sum())

    def _residual_on_contact(self) -> Array:
        """Return ``K (approach - v)`` on the contact, by the approach that leaves nothing along K."""
        v, approach = self._separate().on_contact, self._approach
        if approach is None:
            approach = inner(self._squares, v) / self._norm
        residual = approach - v
        residual *= self._weights
        return residual

    def _projected(self, values: Array) -> Array:
        """Return ``values`` on the contact set minus their part along the load's weights."""
        if self._target is None:
            return values
        values -= (inner(self._weights, values) / self._norm) * self._weights
        return values

    def _conjugate(self, residual: Array, step: Array) -> Array:
        product = inner(residual, step)
        direction = step
        if self._direction is not None and self._product > 0:
            quotient = (product - inner(self._residual, step)) / self._product
            if 0 < quotient < math.inf:  # products of the least numbers vanish
                direction = self._carried_over(quotient)
                direction += step
        self._direction, self._residual, self._product = direction, residual, product
        return direction

    def _carried_over(self, quotient: float) -> Array:
        assert self._direction is not None
        direction = quotient * self._direction
        return self._projected(direction) if self._exchanged else direction

    def _step_to_trial(self, residual: Array, direction: Array) -> bool:
        """Go to the best point up to the trial, cut and scaled; False if the cut leaves nothing."""
        change = (TRIAL_SHARE * self._length) * direction
        trial = self._pressing + change
        cut: Mask | None = None
        if not self._within_bounds(trial):
            cut = trial < 0
            if not self._cut(trial, change):
                return False
        moved = self._apply(self._vectors.scatter(change))  # [PK 4]
        best = step_share(residual, change, self._vectors.gather_view(moved))
        self._take(max(best, 0.0), change, moved, cut)  # [PK 5, 6]
        self._length *= TRIAL_SHARE * best
        self._trusted = TRUSTED[0] < best < TRUSTED[1]
        return True

    def _take(self, share: float, change: Array, moved: Array, cut: Mask | None) -> None:
        """Add a share of a change; elements whose pressure is cut or falls to zero leave the contact."""
        before = self._pressing
        pressure = before + share * change
        beyond = share > 1 and not self._within_bounds(pressure)
        if beyond:
            share = self._longest_step(before, change)
            pressure = before + share * change
        if beyond or cut is not None:
            pressure[pressure < VANISHING * before] = 0.0  # rounding
            falling = change < 0
            self._leave(
                self._vectors.scatter_mask((pressure == 0) & (falling if cut is None else falling | cut))
            )
        self._pressing = pressure
        moved *= share
        self.normal_displacement += moved

    def _within_bounds(self, pressing: Array) -> bool:
        return bool(pressing.min() >= 0)

    def _longest_step(self, before: Array, change: Array) -> float:
        return longest_step(before, change)

    def _cut(self, trial: Array, change: Array) -> bool:
        return cut_at_zero(trial, self._pressing, change, self._weights, self._target)

    def _enter(self, penetrating: Mask) -> None:
        entering = penetrating > self.free
        if entering.any():
            self.free |= entering
            self._exchanged = True

    def _leave(self, lifted: Mask) -> None:
        if lifted.any():
            self.free &= ~lifted
            self._exchanged = True

    def _step_then_cut(self, residual: Array, direction: Array) -> None:
        """Take the step by its exact length, then cut: two applications, without a trial."""
        moved = self._apply(self._vectors.scatter(direction))
        length = step_share(residual, direction, self._vectors.gather_view(moved))
        if length:  # zero when the constraint alone fixes the set's pressure
            self._length = length
            self._pressing = self._pressing + self._length * direction
            self.normal_displacement = self.normal_displacement + self._length * moved
            self._trusted = True
        negative = self._pressing < 0
        if negative.any():
            self._pressing[negative] = 0.0  # at an approach all may go, and come back as they penetrate
            self._leave(self._vectors.scatter_mask(negative))
            if self._target is not None:
                self._scale_to_target(displace=False)
            self.normal_displacement = self._apply(self.pressure)

    def _scale_to_target(self, *, displace: bool = True) -> None:
        """Scale the pressure [PK 8], and its displacement on request, to the load."""
        assert self._target is not None
        carried = inner(self._K, self.pressure)
        if carried == 0:  # without pressure there is no factor; the load error reports it
            return
        factor = self._target / carried
        self._pressing = self._pressing * factor
        if displace:
            self.normal_displacement = self.normal_displacement * factor
