"""The discrete problem solved in 34 digits, started from the state under test (mpmath, tiny grids).

Unknowns are one number an element (its pressure in contact, its gap elsewhere), the tangents of the common
surface, and the approach. Newton's method solves Eqs (2), (6) and (7) together, and exchanges elements whose
number is negative. The Jacobian is exact, by complex steps in doubles; residuals are taken in 34 digits at
last. A state that is not reached from the one under test is sought by continuation in the load, in beta, and
in tau. At fixed slopes and active set of tau there is one solution (`positive_definite`); where friction is
strong, slopes may stand in several states: one that is right is not proved the only one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np

import refimpl as rf
from refimpl.grid import Array, Mask
from verification.exact import exact_operators as operators
from verification.exact.exact_operators import DIGITS, Exact

EXACT = "the exact discrete state, 34 digits"
STEPS, REFINEMENTS = 60, 20  # at most: steps of Newton in doubles, and in digits
CLOSE, SETTLED = 1e-8, 1e-20  # largest last step: relative to the state; in digits, below a double's
TIE = 1e-26  # share of the maximum pressure or gap: signs nearer to zero are ties
TINY = 1e-60  # complex step
ROUTES = {"load": 1e-3, "beta": 1e-6, "tau": 1e-6}  # continuation: what it leads up, from which share on
LARGEST, LEAST, SOLVES = 10**0.5, 1.01, 60  # ratio of two shares, at most and at least; solves, at most


class NotSettled(ArithmeticError):
    """The oracle's own iteration did not end: no verdict on the state."""


@dataclass(frozen=True)
class Exactly:
    """The exact state: pressure (Pa), approach from first contact (m), forces (N), and the contact's margin.

    ``margin`` is how far, relative to the largest, the least pressure or gap is from zero: at 1e-16 no double
    can tell the contact set.
    """

    pressure: Exact
    approach: Exact
    normal: Exact
    friction: Exact
    contact: Mask
    margin: float


class Terms(NamedTuple):
    """Load (N) and the constants of friction, beta and tau (Pa): the scene's own, or on the way to them."""

    load: float
    beta: float
    tau: float


class Guess(NamedTuple):
    """Unknowns in their units, elements in contact, and those units: of pressure (Pa), length and gap (m)."""

    x: Any
    contact: Mask
    units: tuple[float, float, float]


class Oracle:
    """One scene on a tiny grid; heights are the doubles that the surfaces deliver, exact from there on."""

    def __init__(
        self, scene: rf.Scene, M: int, *,
        approach: float | None = None, oblique: bool = True, slope_correction: bool = False,
    ) -> None:  # fmt: skip
        grid, periodic = scene.grid(M), scene.periodic
        self.n, self.oblique, self.correction = M**2, oblique, slope_correction
        self.own = Terms(scene.load, scene.friction.beta, scene.friction.tau)
        self.spacing = mp.mpf(scene.lengths[0]) / M
        bodies = [(mp.mpf(body.material.E), mp.mpf(body.material.nu)) for body in (scene.lower, scene.upper)]
        x, y = (matrix * self.spacing for matrix in operators.tangential(M, periodic))
        cos, sin = mp.cos(mp.mpf(scene.sliding_direction)), mp.sin(mp.mpf(scene.sliding_direction))
        d_x, d_y = (operators.difference(M, axis, periodic) / self.spacing for axis in (0, 1))
        z_lower, z_upper = (_exact(body.surface.heights(grid)) for body in (scene.lower, scene.upper))
        gap = z_upper - z_lower
        self.h = gap - min(gap)
        self.approach = None
        if approach is not None:
            self.approach = mp.mpf(approach) + (sum(self.h) / self.n if periodic else 0)
        self.a = [(1 - nu**2) / (mp.pi * E) for E, nu in bodies]
        self.exact = {
            "h": self.h[:, None], "mean": ((z_lower + z_upper) / 2)[:, None],
            "A": operators.normal(M, periodic) * self.spacing, "S": x * cos + y * sin, "T": y * cos - x * sin,
            "D_x": d_x * cos + d_y * sin, "D_y": d_y * cos - d_x * sin, "a": np.array(self.a),
            "c": np.array([(1 + nu) * (1 - 2 * nu) / (2 * mp.pi * E) for E, nu in bodies]),
            "dA": np.array([self.spacing**2]), "approach": np.array([self.approach or mp.mpf(0)]),
        }  # fmt: skip
        self.doubles = {name: values.astype(float) for name, values in self.exact.items()}

    def solve(self, pressure: Array, support: Mask, tangents: tuple[Array, Array] | None = None) -> Exactly:
        """Return the exact state of a returned pressure and of tau's active set, both ``(M, M)``.

        Slopes are sought from the returned ``tangents`` on, or from those that the pressure leaves on flats.
        """
        guess = self._guess(pressure.ravel(), support.ravel(), self.own, tangents)
        return self._refined(self._newton(guess, support.ravel(), self.own), support.ravel())

    def continued(self) -> Exactly:
        """Return an exact state with tau on all of its contact, by the first route that arrives."""
        for route, first in ROUTES.items():
            if getattr(self.own, route) > 0:
                try:
                    return self._continued(route, first)
                except NotSettled:
                    pass  # the next route may arrive
        raise NotSettled("neither the load's route, nor beta's, nor tau's arrives")

    def _continued(self, route: str, known: float) -> Exactly:
        """Return the exact state by continuation in one of the terms, from a known share of it on."""

        def terms(share: float) -> Terms:
            return self.own._replace(**{route: share * getattr(self.own, route)})

        even = np.full(self.n, terms(known).load / self.n / float(self.spacing) ** 2)
        guess = self._guess(even, np.ones(self.n, dtype=bool), terms(known))
        guess, ratio = self._newton(guess, None, terms(known)), LARGEST
        for _ in range(SOLVES):
            if known == 1:
                return self._lawful(guess)
            share = min(1.0, known * ratio)
            try:
                guess, known, ratio = self._newton(guess, None, terms(share)), share, min(LARGEST, ratio**1.5)
            except NotSettled:
                ratio = ratio**0.5
                if ratio < LEAST:
                    raise
        raise NotSettled("the continuation does not arrive")

    def _lawful(self, guess: Guess) -> Exactly:
        """Return the exact state; raises NotSettled where its contact is not tau's active set any more."""
        found = self._refined(guess, guess.contact)
        if not np.array_equal(found.contact, guess.contact):
            raise NotSettled("the contact changes in the last digits")
        return found

    def _guess(
        self, f: Array, support: Mask, terms: Terms, tangents: tuple[Array, Array] | None = None
    ) -> Guess:
        """Return the unknowns of a pressure; gaps, approach and slopes follow from its displacements."""
        peak = float(f.max())
        length = float(sum(self.a) * self.spacing) * peak
        if length == 0:
            raise NotSettled("no digits")
        units = peak, length, length + float(max(self.h))
        n, contact = self.n, f > 0
        x = np.zeros((3 * n + 1, 1))
        x[:n, 0] = f / peak
        if tangents is None or not self.oblique:  # the residual of flat slopes is minus those of the surface
            of_flat = self._residual(self.doubles, Guess(x, contact, units), support, terms)
            x[n : 3 * n] = -of_flat[n : 3 * n] if self.oblique else 0.0
        else:
            x[n : 3 * n, 0] = np.concatenate([tan.ravel() for tan in tangents])
        K = ((1 + x[n : 2 * n] ** 2) * (1 + x[2 * n : 3 * n] ** 2)) ** -0.5
        missed = self._residual(self.doubles, Guess(x, contact, units), support, terms)
        v = (missed[:n] / K)[:, 0] * np.where(contact, length, units[2])
        approach = float(v @ (f / f.sum()))
        x[:n, 0] += np.where(contact, 0.0, abs(v - approach) / units[2])
        x[-1] = approach / length
        return Guess(x, contact, units)

    def _residual(self, on: dict[str, Exact], state: Guess, support: Mask, terms: Terms) -> Exact:
        """Return residuals of Eqs (6), (7), the tangents and Eq. (2); a column for each ``state.x``."""
        n, (peak, length, room) = self.n, state.units
        x, inside = state.x, state.contact[:, None].astype(float)
        f, gap = x[:n] * inside, x[:n] * (1 - inside)
        tan_x, tan_y = x[n : 2 * n], x[2 * n : 3 * n]
        cos_x, cos_y = (1 + tan_x * tan_x) ** -0.5, (1 + tan_y * tan_y) ** -0.5
        r = f * terms.beta + support[:, None] * (terms.tau / peak)
        down, along, across = f, r, f * 0
        if self.correction:
            down, along, across = f - r * tan_x, r + f * tan_x, f * tan_y
        pressed, shear = on["A"] @ down, on["S"] @ along + on["T"] @ across
        a, c = on["a"] * (peak / length), on["c"] * (peak / length)
        lower, upper = pressed * a[0] + shear * c[0], pressed * a[1] - shear * c[1]
        surface = on["mean"] + (upper - lower) * (0.5 * length)
        slopes = [tan - (on[D] @ surface) * self.oblique for tan, D in ((tan_x, "D_x"), (tan_y, "D_y"))]
        unit = np.where(inside > 0, length, room)
        share = length / unit
        contact = (lower + upper) * share + cos_x * cos_y * (on["h"] / unit - x[-1:] * share - gap)
        if self.approach is not None:
            return np.concatenate([contact, *slopes, x[-1:] - on["approach"][0] / length])
        carried = np.sum((f - r * tan_x) * cos_x * cos_y, axis=0, keepdims=True)
        return np.concatenate([contact, *slopes, carried * (on["dA"][0] * peak / terms.load) - 1])

    def _step(self, state: Guess, support: Mask, terms: Terms, residual: Array) -> Array:
        """Return Newton's step for a residual: the Jacobian by complex steps, rows and columns scaled."""
        size = len(state.x)
        shifted = state.x.astype(float) + 1j * TINY * np.eye(size)
        jacobian = self._residual(self.doubles, state._replace(x=shifted), support, terms).imag / TINY
        rows = 1 / np.abs(jacobian).max(axis=1)
        columns = 1 / np.abs(jacobian * rows[:, None]).max(axis=0)
        try:
            step = np.linalg.solve(jacobian * rows[:, None] * columns, -rows * residual)
        except np.linalg.LinAlgError:
            raise NotSettled("singular equations") from None
        return np.asarray(columns * step)

    def _moved(self, state: Guess, step: Exact, one: bool) -> tuple[Guess, bool]:
        """Return the state after a step; elements of negative pressure or gap change, all or the last."""
        x = state.x + step[:, None]
        y = x[: self.n, 0]
        bad = np.zeros(self.n, dtype=bool)
        for side in (state.contact, ~state.contact):
            if side.any():
                bad[side] = (y[side] < -TIE * max(abs(y[side]))).astype(bool)
        if one and bad.any():
            bad[: np.flatnonzero(bad)[-1]] = False
        y[bad] = 0
        contact = state.contact ^ bad
        return state._replace(x=x, contact=contact if contact.any() else bad), bool(bad.any())

    def _settled(self, state: Guess, step: Exact, share: float) -> bool:
        """Return whether a step is at most that share of pressures, of gaps, of tangents and of the approach.

        Each of the four has its own size: a large one excuses no step of another. Tangents count against 1 at
        least, gaps and approach against the displacement under the peak.
        """
        n, x, (_, length, room) = self.n, abs(state.x[:, 0]), state.units
        peak = max(x[:n][state.contact])
        gap = max(np.where(state.contact, peak * length / room, x[:n]))
        sizes = np.where(state.contact, peak, gap)
        tangent, approach = max(1, max(x[n:-1])), max(x[-1], peak)
        return bool((abs(step) <= share * np.concatenate([sizes, [tangent] * (2 * n), [approach]])).all())

    def _newton(self, state: Guess, support: Mask | None, terms: Terms) -> Guess:
        """Solve in doubles; tau acts on the support, by default on the contact."""
        for count in range(STEPS):
            on = state.contact if support is None else support
            with np.errstate(all="ignore"):
                residual = self._residual(self.doubles, state, on, terms)[:, 0]
                if not np.isfinite(residual).all():
                    raise NotSettled("slopes of the exact state do not settle")
                step = self._step(state, on, terms, residual)
            state, exchanged = self._moved(state, step, one=count > STEPS // 2)
            if not exchanged and self._settled(state, step, CLOSE):
                return state
        raise NotSettled("Newton's steps do not end")

    def _refined(self, state: Guess, support: Mask) -> Exactly:
        """Return the residuals in digits, steps by the Jacobian in doubles."""
        with mp.workdps(DIGITS):
            state = state._replace(x=_exact(state.x[:, 0])[:, None])
            for _ in range(REFINEMENTS):
                residual = self._residual(self.exact, state, support, self.own)[:, 0]
                size = max(abs(residual)) or mp.mpf(1)
                step = _exact(self._step(state, support, self.own, (residual / size).astype(float))) * size
                state, exchanged = self._moved(state, step, one=False)
                if not exchanged and self._settled(state, step, SETTLED):
                    return self._state(state, support)
        raise NotSettled("refinements of the exact state do not end")

    def _state(self, state: Guess, support: Mask) -> Exactly:
        n, (peak, length, _) = self.n, state.units
        y, tan_x, tan_y = (state.x[k * n : (k + 1) * n, 0] for k in range(3))
        f = y * np.where(state.contact, peak, 0.0)
        r = f * self.own.beta + support * self.own.tau
        K = ((1 + tan_x * tan_x) * (1 + tan_y * tan_y)) ** -0.5
        margins = [
            min(abs(y[side])) / (max(abs(y[side])) or 1)
            for side in (state.contact, ~state.contact)
            if side.any()
        ]
        dA = self.exact["dA"][0]
        normal, friction = sum((f - r * tan_x) * K) * dA, sum((f * tan_x + r) * K) * dA
        return Exactly(f, state.x[-1, 0] * length, normal, friction, state.contact, float(min(margins)))


def _exact(values: Array) -> Exact:
    return np.array([mp.mpf(float(v)) for v in values.ravel()], dtype=object)
