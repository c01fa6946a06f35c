"""Proven bounds on what separates a returned state from the solution, from its arrays alone.

Held fixed are the slopes and the part ``t = r - beta f`` of the returned traction (``tau`` on its support).
Then ``u = (a + beta c) f + c t``, and with ``K = cos theta_x cos theta_y`` Eq. (6), times K, reads

    w = (a + beta c) f + c t + K (h - approach) >= 0,    f >= 0,    f.w = 0:

the factor K scales rows and leaves the matrix alone. Let a star mark the solution, and ``e = f - f*`` with
any ``f >= 0``. Because c is skew, ``e.a e = e.(a + beta c) e``, hence

    e.a e = e.(w - w*) + (approach - approach*) K.e.                                                    (B1)

Split ``w = r + p`` with any ``p >= 0``. Since ``f.w* >= 0``, ``f*.w* = 0`` and ``f*.p >= 0``,

    e.a e <= e.r + f.p + (approach - approach*) K.e <= ||r||' ||e|| + f.p + ...                         (B2)

with ``||e||^2 = e.a e`` and ``||.||'`` its dual norm. No condition is set on f: pressure that is negative, or
stands where the gap is open, is set to zero first and its own norm added at the end; penetration (w < 0) is
part of r.

*The complementarity gap.* Where nothing penetrates, ``r = 0`` and ``p = w`` give ``e.a e <= f.w``, which is
``sum K f (v - approach) <= sum f (v - approach)``, since K <= 1. With N exact and flat slopes that holds for
any approach, so for min v: the certificate's gap (in J) bounds the error as it stands. Used here is a sharper
split: p where ``w >= a_ii f`` (no contact), r elsewhere, which makes the bound linear in the residual. Off
contact r may be anything below w: it is ``a z`` with ``a z = w`` on contact, and ``||r||' = ||z||``,
the very error if both supports agree, plus what of r is left over the root of the least eigenvalue.

*Prescribed approach*: the last term is absent. *Prescribed load* ``l.f* = T``, where ``l = K - beta s``,
``s = K tan theta_x`` and T is Eq. (2)'s load less the share of t: with ``n = l.f - T`` (the load's error),

    K.e = n + beta s.e,
    approach* - approach <= (f.w + ||(a - beta c) f||' ||e||) / K.f                    from f.w* >= 0,
    approach - approach* <= (-f.r + (||(a - beta c) f||' + ||r||') ||e||) / K.f*       from f*.w* = 0,

``K.f* >= T / (1 + beta max |tan theta_x|)`` by f* >= 0. So ``|approach - approach*| <= c0 + c1 ||e||``, and
(B2) is a quadratic inequality for ``||e||``. *Periodic*: a mean pressure displaces nothing. ``m (K.e)^2`` on
both sides of (B1) makes ``a + m K K'`` definite; K.e is known as above. At a prescribed approach it is not,
and no bound is claimed.

*Pressures that end at a hardness.* With ``0 <= f <= H`` on both sides ``(f - f*).w* >= 0``, so (B1) becomes

    e.a e <= e.r + sum [f p+ + (H - f) p-] + (approach - approach*) K.e

for any split ``w = r + p``: p costs nothing where it is negative at H, or positive without load. The last
term is absent at a prescribed approach, and under a load where slopes are flat and f is balanced first. The
approach then comes from any element proven to be free, where ``w* = 0``: it is off by no more than that
element's w and displacement are. With slopes and a load no bound is claimed.

Not proven, and not contained in these numbers: that slopes and tau's active set are those of the solution
of the whole problem (see the certificate's ``slope`` and ``law_violations``), and the grid's own error.
Rounding of the products is allowed for (`EnergyNorm.rounding`); that of sums over elements, below 1e-12 of
a number, is not.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from refimpl.bounds.energy_norm import EnergyNorm
from refimpl.grid import Array, Mask
from refimpl.model.certificate import approach_from
from refimpl.model.forces import resultants
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes


@dataclass(frozen=True, eq=False)
class Bounds:
    """Bounds on returned value minus solution, at the state's slopes and active set of tau; inf: no bound.

    ``energy`` bounds ``sum (f - f*) a (f - f*) dA`` (J), ``pressure`` each element's pressure and the largest
    (Pa), ``pressure_l2`` the root of ``sum (f - f*)^2 dA`` (Pa m). ``approach`` in m, forces in N. The masks
    mark elements that carry load in the solution (pressure above its bound), or do not (separation above
    its own); ``contact_area`` is the interval they leave (m^2). ``plastic`` marks elements that are at the
    hardness in the solution. ``unproven`` says what is not bounded.
    """

    energy: float
    pressure: float
    pressure_l2: float
    approach: float
    normal_force: float
    friction_force: float
    binormal_force: float
    friction_coefficient: float
    in_contact: Mask
    out_of_contact: Mask
    contact_area: tuple[float, float]
    plastic: Mask
    unproven: str


UNPROVEN = "slopes and tau's active set are held as returned; the grid's own error is not included"
NO_BOUND_CORRECTED = "the slope correction's matrix is not a plus a skew one: no bound"
NO_BOUND_STEEP = "slopes too uneven for a definite norm on a periodic domain: no bound"
NO_BOUND_PLASTIC = "pressures reach the hardness under a load on slopes, or all of them do: no bound"
NO_BOUND_PERIODIC = "a periodic scene's approach does not bound its mean pressure: no bound"


def proven_bounds(problem: Problem, pressure: Array, traction: Array, slopes: Slopes) -> Bounds:
    """Return bounds for any pressure and traction (Pa) at these slopes; infinite where none is proven."""
    if problem.terms.slope_correction:
        return _none(problem, NO_BOUND_CORRECTED)
    yields = bool(pressure.max() >= problem.cap)
    if yields and problem.load is not None and not slopes.is_flat:
        return _none(problem, NO_BOUND_PLASTIC)
    norm = EnergyNorm(problem, slopes.cosine_product)
    if problem.approach is not None and not norm.operator.displaces_mean:
        return _none(problem, NO_BOUND_PERIODIC)
    if norm.floor <= 0:
        return _none(problem, NO_BOUND_STEEP)
    frozen = (_Capped if yields else _Frozen)(problem, norm, pressure, traction, slopes)
    distance, approach = frozen.distance()
    if not math.isfinite(distance):
        return _none(
            problem, NO_BOUND_PLASTIC if yields else "the load does not fix the contact: " + UNPROVEN
        )
    found = _translated(frozen, distance, approach)
    # an elastic solution below the hardness is the capped problem's as well
    if math.isfinite(problem.cap) and not yields and float(pressure.max()) + found.pressure >= problem.cap:
        return _none(problem, NO_BOUND_PLASTIC)
    return found


class _Frozen:
    """The returned state with slopes and ``t`` held: ``w = r + p`` and all that (B2) needs."""

    def __init__(
        self, problem: Problem, norm: EnergyNorm, pressure: Array, traction: Array, slopes: Slopes
    ) -> None:
        self.problem, self.norm, self.slopes = problem, norm, slopes
        self.pressure, self.traction = pressure, traction
        self.slope = problem.friction.slope
        self.K = slopes.cosine_product
        self.coupled = self.slope > 0 and problem.elasticity.coupling_ratio != 0
        self._admit()
        self.clipped = norm.norm(self.f - pressure)
        self._split()

    def _admit(self) -> None:
        """Set the state at the pressures of the bounds: those that stand where the gap is open are zero."""
        self._set(np.maximum(self.pressure, 0.0))
        spurious = (self.f > 0) & (self.w >= self.norm.diagonal * self.f)
        if spurious.any():
            self._set(np.where(spurious, 0.0, self.f))

    def _set(self, f: Array) -> None:
        """Set the pressure, approach and w, from the displacements of this pressure."""
        problem, K = self.problem, self.K
        shear = self.traction - self.slope * self.pressure + self.slope * f
        free = np.add(*problem.displacements(self.norm.operator, f, shear, self.slopes)) + K * problem.gap
        self.f, self.total = f, float(np.vdot(K, f))
        if problem.approach is not None:
            self.approach = problem.approach
        else:
            self.approach = self._level(f, free)
        self.w = free - K * self.approach
        # cancellation of h against the approach, as well as the products' own rounding
        cancelled = float(np.linalg.norm(K * (problem.gap + abs(self.approach))))
        self.noise = self.norm.rounding(f, shear) + 4 * np.finfo(float).eps * cancelled

    def _level(self, f: Array, free: Array) -> float:
        """Return the approach under a load (m), from ``free = w + K approach``."""
        return float(np.vdot(f, free)) / self.total if self.total > 0 else 0.0

    def _split(self) -> None:
        """Set ``r`` with its dual norm, and ``f.p``."""
        touching: Mask = (self.w < self.norm.diagonal * self.f) | (self.w < 0)
        self._set_residual(touching, np.minimum)
        self.slack = float(np.vdot(self.f, self.w - self.r))

    def _set_residual(self, touching: Mask, beyond: Callable[[Array, Array], Array]) -> None:
        """Set ``r``, w on the contact and the allowed part ``beyond`` it, with its dual norm."""
        z, az = self.norm.solve(self.w, touching)
        self.r = np.where(touching, self.w, beyond(self.w, az))
        left = float(np.linalg.norm(self.r - az)) + self.norm.rounding(z) + self.noise
        self.residual = self.norm.norm(z) + left / math.sqrt(self.norm.floor)

    def distance(self) -> tuple[float, float]:
        """Return bounds on ``||e||`` and on the approach's error (m); infinite when (B2) does not close."""
        problem, beta = self.problem, self.slope
        if problem.load is None:
            return _largest_root(1.0, self.residual, self.slack), 0.0
        tan = self.slopes.tan_x
        everywhere = np.ones_like(self.f, dtype=bool)
        held = self.traction - beta * self.pressure
        target = problem.load / problem.grid.element_area + float(np.vdot(held, self.K * tan))
        error = abs(self.total - beta * float(np.vdot(self.K * tan, self.f)) - target)
        least_total = target / (1 + beta * float(np.abs(tan).max()))
        if min(self.total, least_total) <= 0:
            return math.inf, math.inf
        norm = self.norm
        stiffness = norm.norm(self.f)
        if self.coupled:
            shear = problem.elasticity.gap_by_shear(norm.operator.shear(beta * self.f))
            stiffness += norm.dual_norm(shear, everywhere)
        lowest = min(self.total, least_total)
        c0 = max(float(np.vdot(self.f, self.w)), -float(np.vdot(self.f, self.r)), 0.0) / lowest
        c0 += float(np.linalg.norm(self.f)) * self.noise / lowest
        c1 = (stiffness + self.residual) / lowest
        tilt = beta * norm.dual_norm(self.K * tan, everywhere) if beta else 0.0
        lift = norm.lift
        x = _largest_root(
            1 - c1 * tilt - lift * tilt**2,
            self.residual + c1 * error + c0 * tilt + 2 * lift * error * tilt,
            self.slack + c0 * error + lift * error**2,
        )
        return x, c0 + c1 * x


class _Capped(_Frozen):
    """The like for pressures up to the hardness; under a load for flat slopes, with f balanced first."""

    def _admit(self) -> None:
        problem, f = self.problem, np.clip(self.pressure, 0.0, self.problem.cap)
        between: Mask = (f > 0) & (f < problem.cap)
        if problem.load is not None and between.any():
            missing = problem.load / problem.grid.element_area - float(f.sum())
            f = np.where(between, f + missing / np.count_nonzero(between), f)
        self._set(f)
        self.between: Mask = (f > 0) & (f < problem.cap)

    def _level(self, f: Array, free: Array) -> float:
        return approach_from(f, free, self.problem.cap)

    def _split(self) -> None:
        """Set ``r`` with its dual norm; p is nowhere such that it costs."""
        at_cap: Mask = self.f >= self.problem.cap
        touching: Mask = self.between | np.where(at_cap, self.w > 0, self.w < 0)
        self._set_residual(touching, lambda w, az: np.where(at_cap, np.maximum(w, az), np.minimum(w, az)))
        self.slack = 0.0

    def distance(self) -> tuple[float, float]:
        """Return ``||e||``, and the approach's error from the elements that are proven to be free (m)."""
        problem, x = self.problem, self.residual
        lawful = bool(self.f.min() >= 0 and self.f.max() <= problem.cap)
        if problem.load is None:
            return (x, 0.0) if lawful else (math.inf, math.inf)
        off = x / math.sqrt(self.norm.floor)
        free = (self.f > off) & (self.f < problem.cap - off)
        if not (lawful and free.any()):
            return math.inf, math.inf
        return x, float(np.abs(self.w[free]).min()) + _moved(self, x) + self.noise


def _moved(frozen: _Frozen, x: float) -> float:
    """Bound on an element's displacement by ``||e|| <= x`` (m)."""
    return x * (math.sqrt(frozen.norm.diagonal) + _shear_row(frozen) / math.sqrt(frozen.norm.floor))


def _translated(frozen: _Frozen, x: float, approach: float) -> Bounds:
    """Return what ``||e|| <= x`` says of each reported number."""
    problem, norm, slopes, beta = frozen.problem, frozen.norm, frozen.slopes, frozen.slope
    dA, root = problem.grid.element_area, math.sqrt(norm.floor)
    moved = _moved(frozen, x)
    out: Mask = frozen.w > moved + frozen.K * approach + frozen.noise
    inside: Mask = frozen.f > x / root
    total = x + frozen.clipped
    open_: Mask = ~out | (frozen.pressure != 0)  # elsewhere the state's error is exactly zero

    def force(weights: Array) -> float:
        return total * norm.dual_norm(weights, open_) * dA

    forces = resultants(frozen.pressure, frozen.traction, slopes, dA)
    friction = force((slopes.sin_x + beta * slopes.cos_x) * slopes.cos_y)
    if problem.load is not None:
        normal, mu = abs(forces.normal - problem.load), friction / problem.load
    else:
        normal = force((slopes.cos_x - beta * slopes.sin_x) * slopes.cos_y)
        least = forces.normal - normal
        mu = (friction + abs(forces.friction / forces.normal) * normal) / least if least > 0 else math.inf
    return Bounds(
        energy=total**2 * dA,
        pressure=total / root,
        pressure_l2=total / root * math.sqrt(dA),
        approach=approach,
        normal_force=normal,
        friction_force=friction,
        binormal_force=force((slopes.cos_x - beta * slopes.sin_x) * slopes.sin_y),
        friction_coefficient=mu,
        in_contact=inside,
        out_of_contact=out,
        contact_area=(float(inside.sum()) * dA, float((~out).sum()) * dA),
        plastic=frozen.w < -(moved + frozen.K * approach + frozen.noise),
        unproven=UNPROVEN,
    )


def _shear_row(frozen: _Frozen) -> float:
    """Bound the 2-norm of a row of ``beta c`` (m/Pa): elements in the corners meet every offset."""
    if not frozen.coupled:
        return 0.0
    rows = []
    for i, j in ((0, 0), (0, -1), (-1, 0), (-1, -1)):
        corner = np.zeros(frozen.K.shape)
        corner[i, j] = frozen.slope
        rows.append(frozen.problem.elasticity.gap_by_shear(frozen.norm.operator.shear(corner)))
    return float(np.linalg.norm(rows))


def _largest_root(quadratic: float, linear: float, constant: float) -> float:
    """Return the largest x with ``quadratic x^2 <= linear x + constant``; infinite unless ``quadratic > 0``.

    >>> _largest_root(1.0, 1.0, 2.0), _largest_root(0.0, 1.0, 2.0)
    (2.0, inf)
    """
    if not quadratic > 0:
        return math.inf
    return (linear + math.sqrt(linear**2 + 4 * quadratic * constant)) / (2 * quadratic)


def _none(problem: Problem, why: str) -> Bounds:
    nowhere = np.zeros(problem.gap.shape, dtype=bool)
    whole = nowhere.size * problem.grid.element_area
    unbounded = (math.inf,) * 8  # numbers from the energy to mu
    return Bounds(*unbounded, nowhere, nowhere, contact_area=(0.0, whole), plastic=nowhere, unproven=why)
