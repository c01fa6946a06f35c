"""Projected CG with a second bound: pressures are capped at the hardness, ``0 <= f <= H``.

CG works on the free elements, ``0 < f < H``. Elements that reach H leave them and keep that pressure; they
come back where ``v`` exceeds the approach, as less pressure would do there. The load's target for the free
elements is what the capped ones leave of it.
"""

from __future__ import annotations

import math
from typing import Self

import numpy as np

from refimpl.grid import Array, Mask, inner
from refimpl.model.certificate import contact_residuals
from refimpl.operators.preconditioner import Apply
from refimpl.solvers.production.constants import VANISHING
from refimpl.solvers.production.contact_vectors import cut_at_zero, longest_step
from refimpl.solvers.production.projected_cg import ProjectedCG

_LOAD_ROUNDING = 1e-14  # relative rounding error of the load's sum
_FULL = 0.9  # share of the cap up to which elements that come into contact are filled
_FILLINGS = 60  # halvings of the range of a factor that fills pressures up to the cap


class CappedCG(ProjectedCG):
    """`ProjectedCG` with the cap H (Pa); ``capped`` marks the elements with ``f = H``."""

    def __init__(
        self, apply: Apply, precondition: Apply, pressure: Array, cap: float, rounding: float = 0.0
    ) -> None:
        super().__init__(apply, precondition, np.minimum(pressure, cap), rounding)
        self._cap = cap
        self.capped: Mask = np.zeros(pressure.shape, dtype=bool)
        self._pressing[self._pressing >= cap * (1 - VANISHING)] = 0.0
        self._move_to_cap(pressure >= cap * (1 - VANISHING))

    def copy(self) -> Self:
        other = super().copy()
        other.capped = self.capped.copy()
        return other

    @property
    def contact(self) -> Mask:
        return self.free | self.capped

    @property
    def pressure(self) -> Array:
        return self._vectors.scatter(self._pressing) + self._cap * self.capped

    @property
    def approach(self) -> float:
        """The prescribed approach, or the mean ``v`` of free pressures; without any the middle (m)."""
        if self._approach is not None or self._pressing.any():
            return super().approach
        v = self.separation
        deepest = float(np.max(v, where=self.capped, initial=-math.inf))
        lowest = float(np.min(v, where=~self.capped, initial=math.inf))
        return 0.5 * (deepest + lowest) if math.isfinite(lowest) else deepest

    def residuals(self) -> tuple[float, float]:
        """Return the complementarity gap of both bounds over the elastic energy, and the penetration.

        At an approach the gap is at least the work by the error of the mean of ``v``.
        """
        f, v, approach = self.pressure, self.separation, self.approach
        shares = f / (float(f.sum()) or 1.0)
        energy = 0.5 * inner(shares, self.normal_displacement)
        excess = v - approach
        room = (self._cap - f) / (float(f.sum()) or 1.0)
        gap = float(np.sum(shares * np.maximum(excess, 0)) + np.sum(room * np.maximum(-excess, 0)))
        if self._approach is not None and self._pressing.any():
            gap = max(gap, abs(self._separate().mean - approach))
        lowest = float(np.min(v, where=~self.capped, initial=math.inf))
        missed = 0.0 if self._target is None else abs(inner(self._K, f) - self._target) / self._target
        rounding = self._rounding * float(f.max())
        relative, penetration = contact_residuals(gap, energy, approach, lowest, rounding)
        return max(relative, missed), penetration

    def undecided(self, stiffness: float, among: Mask | None = None) -> int:
        """Return what `ProjectedCG` does where no pressure is at the cap or near it; else all elements.

        Load that capped elements do not bear may bring any others into contact.
        """
        below_cap = not self.capped.any() and bool(self._pressing.max(initial=0.0) < _FULL * self._cap)
        return super().undecided(stiffness, among) if below_cap else self.capped.size

    def iterate(self) -> None:
        """Take one step on the free elements, then the exchange of elements at both bounds."""
        if self.free.any():
            self._step()
        self._separation = None
        v, approach = self.separation, self.approach
        self._release(self.capped & (v > approach))
        self._enter((v < approach) & ~self.capped)
        if self._target is not None:
            self._bear(self._target - inner(self._K, self.pressure))

    def _bear(self, missing: float) -> None:
        """Let the room below the cap bear load that a cut has lost: free elements, then the next."""
        assert self._target is not None
        if missing <= _LOAD_ROUNDING * self._target:
            return
        pressure, v = self.pressure, self.separation
        candidates = self.free.copy()
        if missing > _FULL * float(np.sum(self._K * (self._cap - pressure), where=candidates)):
            count = math.ceil(missing / (_FULL * self._cap * float(self._K.min())))
            order = np.argsort(np.where(self.contact, math.inf, v), axis=None, kind="stable")
            candidates.ravel()[order[: min(count, np.count_nonzero(~self.contact))]] = True
        room = np.where(candidates, self._cap - pressure, 0.0)
        whole = float(np.sum(self._K * room))
        if whole == 0:  # the window is full, or slopes leave no contact that bears the load: it stays missing
            return
        pressure += min(1.0, missing / whole) * room
        self._set_pressure(pressure)
        self.normal_displacement = self._apply(self.pressure)
        self._separation = None

    def _release(self, lifted: Mask) -> None:
        if lifted.any():
            pressure = self.pressure
            self.capped &= ~lifted
            self.free |= lifted
            self._exchange()
            self._pressing = self._vectors.gather(pressure)
            self._exchanged = True

    def _move_to_cap(self, reached: Mask) -> None:
        if reached.any():
            self.capped |= reached
            self._leave(reached)

    def _take(self, share: float, change: Array, moved: Array, cut: Mask | None) -> None:
        super()._take(share, change, moved, cut)
        reached = self._pressing >= self._cap * (1 - VANISHING)
        if reached.any():
            self._pressing[reached] = 0.0
            self._move_to_cap(self._vectors.scatter_mask(reached))

    def _step_then_cut(self, residual: Array, direction: Array) -> None:
        super()._step_then_cut(residual, direction)
        if self._pressing.max(initial=0.0) > self._cap:
            self._set_pressure(np.minimum(self.pressure, self._cap))
            if self._target is not None:
                self._scale_to_target(displace=False)
            self.normal_displacement = self._apply(self.pressure)

    def _within_bounds(self, pressing: Array) -> bool:
        return super()._within_bounds(pressing) and bool(pressing.max() <= self._cap)

    def _longest_step(self, before: Array, change: Array) -> float:
        steps = [1.0]
        if (change < 0).any():
            steps.append(longest_step(before, change))
        if (change > 0).any():
            steps.append(longest_step(self._cap - before, -change))
        return max(1.0, min(steps[1:], default=1.0))

    def _cut(self, trial: Array, change: Array) -> bool:
        """Cut a trial at both bounds; load that is missing then is taken from the room below the cap."""
        target = self._free_target
        if not cut_at_zero(trial, self._pressing, change, self._weights, target):
            return False
        np.add(self._pressing, change, out=trial)
        if trial.max() > self._cap:
            np.minimum(trial, self._cap, out=trial)
            room = (self._cap - trial) * self._vectors.ones()
            missing = 0.0 if target is None else target - inner(self._weights, trial)
            whole = inner(self._weights, room)
            if missing > 0 and whole > 0:
                trial += min(1.0, missing / whole) * room
            np.subtract(trial, self._pressing, out=change)
        return True

    @property
    def _free_target(self) -> float | None:
        if self._target is None:
            return None
        return self._target - self._cap * float(np.sum(self._K * self.capped))

    def _scale_to_target(self, *, displace: bool = True) -> None:
        """Scale the free pressures to the load that the capped ones leave, but none beyond the cap.

        Where capped ones bear more, those of largest ``v`` lose pressure; where free ones cannot, all scale.
        """
        assert self._target is not None
        assert self._free_target is not None
        free = self._vectors.scatter(self._pressing)
        carried, target = inner(self._K, free), self._free_target
        if not self.capped.any() and target * float(free.max()) <= self._cap * carried:
            super()._scale_to_target(displace=displace)
            return
        if carried > 0 and 0 < target < self._cap * float(np.sum(self._K, where=free > 0)):
            filled = filled_up(free, self._K, target, self._cap) + self._cap * self.capped
        elif target <= 0 and displace:  # without displacements ``v`` is that of an earlier pressure
            filled = self._deepest_first()
        elif self.contact.any():
            filled = filled_up(self.pressure, self._K, self._target, self._cap)
        else:
            return
        self._set_pressure(filled)
        if displace:
            self.normal_displacement = self._apply(self.pressure)

    def _deepest_first(self) -> Array:
        """Return the cap on the capped elements in the order of ``v``, as far as the target goes."""
        assert self._target is not None
        order = np.argsort(np.where(self.capped, self.separation, math.inf), axis=None, kind="stable")
        most = (self._cap * self._K * self.capped).ravel()[order]
        share = np.ones(order.size)
        np.divide(self._target - (np.cumsum(most) - most), most, out=share, where=most > 0)
        filled = np.zeros(order.size)
        filled[order] = self._cap * np.clip(share, 0.0, 1.0) * (most > 0)
        return filled.reshape(self.capped.shape)

    def _set_pressure(self, pressure: Array) -> None:
        """Go on from another pressure, with the sets that it has; the last direction is dropped."""
        self.capped = pressure >= self._cap * (1 - VANISHING)
        self.free = (pressure > 0) & ~self.capped
        self._exchange()
        self._pressing = self._vectors.gather(pressure)
        self._exchanged, self._direction, self._separation = True, None, None


def filled_up(pressure: Array, weights: Array, target: float, cap: float) -> Array:
    """Return ``min(factor pressure, cap)`` whose weighted sum is the target, as far as the cap allows.

    >>> filled_up(np.array([[1.0, 3.0]]), np.ones((1, 2)), 5.0, 3.5)
    array([[1.5, 3.5]])
    """
    low, high = 0.0, target / inner(weights, pressure)
    while inner(weights, np.minimum(high * pressure, cap)) < target * (1 - 1e-15) and high * cap < math.inf:
        low, high = high, 2 * high
        if np.all((high * pressure >= cap) | (pressure == 0)):
            break
    for _ in range(_FILLINGS):
        middle = 0.5 * (low + high)
        below = inner(weights, np.minimum(middle * pressure, cap)) < target
        low, high = (middle, high) if below else (low, middle)
    return np.minimum(high * pressure, cap)
