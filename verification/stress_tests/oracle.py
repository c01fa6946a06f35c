"""The discrete problem solved in 34 digits, started from the state under test (mpmath, tiny grids).

Arrays stand before scalars in products: an mpf before an array asks for the array's text first, slowly.

At fixed slopes and a fixed active set of tau the problem has one solution (`positive_definite`), so where the
search for it starts cannot bend the answer: the contact set under test is taken as a first guess, its linear
equations are solved exactly, and elements are exchanged until every inequality of Eq. (6) holds exactly.
Slopes are brought up to date until they stand. tau's active set is that of the returned traction. Where
friction is strong, slopes may stand in several states: sought from the returned ones on, a state that is
right is one of these to the last digit, which does not prove it the only one.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

import refimpl as rf
from refimpl.grid import Array
from verification.stress_tests import exact_operators as operators
from verification.stress_tests.exact_operators import DIGITS, Exact

EXCHANGES, SLOPE_UPDATES, MIXED = 80, 150, 5
SETTLED = mp.mpf(10) ** -20  # relative change of pressure by an update of slopes: below a double's digits
TIE = mp.mpf(10) ** (6 - DIGITS)  # share of the maximum pressure or gap: signs nearer to zero are ties


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
    contact: NDArray[np.bool_]
    margin: float


class Oracle:
    """One scene on a tiny grid; heights are the doubles that the surfaces deliver, exact from there on."""

    def __init__(
        self,
        scene: rf.Scene,
        M: int,
        *,
        approach: float | None = None,
        oblique: bool = True,
        slope_correction: bool = False,
    ) -> None:
        grid = scene.grid(M)
        self.scene, self.M, self.oblique, self.correction = scene, M, oblique, slope_correction
        self.spacing = mp.mpf(scene.side) / M
        self.z_lower = _exact(scene.lower.surface.heights(grid))
        self.z_upper = _exact(scene.upper.surface.heights(grid))
        gap = self.z_upper - self.z_lower
        self.h = gap - min(gap)
        self.approach = None
        if approach is not None:
            self.approach = mp.mpf(approach) + (sum(self.h) / len(self.h) if scene.periodic else 0)
        bodies = [(mp.mpf(body.material.E), mp.mpf(body.material.nu)) for body in (scene.lower, scene.upper)]
        self.a = [(1 - nu**2) / (mp.pi * E) for E, nu in bodies]
        self.c = [(1 + nu) * (1 - 2 * nu) / (2 * mp.pi * E) for E, nu in bodies]
        self.A = operators.normal(M, scene.periodic) * self.spacing
        x, y = (matrix * self.spacing for matrix in operators.tangential(M, scene.periodic))
        cos, sin = mp.cos(mp.mpf(scene.sliding_direction)), mp.sin(mp.mpf(scene.sliding_direction))
        self.S, self.T = x * cos + y * sin, y * cos - x * sin
        self.D = [operators.difference(M, axis, scene.periodic) / self.spacing for axis in (0, 1)]
        self.cos, self.sin = cos, sin
        self.flat = (np.full(M**2, mp.mpf(0), dtype=object),) * 2

    def solve(
        self, pressure: Array, support: NDArray[np.bool_], tangents: tuple[Array, Array] | None = None
    ) -> Exactly:
        """The exact state that belongs to a returned pressure and to tau's active set, both ``(M, M)``.

        Slopes are sought from the returned ``tangents`` on, or from those that the pressure leaves on flats.
        """
        with mp.workdps(DIGITS):
            chi = np.array([mp.mpf(int(s)) for s in support.ravel()], dtype=object)
            f, contact = _exact(pressure), pressure.ravel() > 0
            tan = self._slopes(f, self._traction(f, chi), self.flat)
            if self.oblique and tangents is not None:
                tan = _exact(tangents[0]), _exact(tangents[1])
            history: list[tuple[Exact, Exact]] = []
            for _ in range(SLOPE_UPDATES):
                last = f
                f, delta, contact, margin = self._frozen(tan, chi, contact)
                r = self._traction(f, chi)
                new = self._slopes(f, r, tan)
                if not self.oblique or max(abs(f - last)) <= SETTLED * max(f):
                    tan = new
                    break
                history = [*history[-MIXED:], (np.array(new), np.array(new) - np.array(tan))]
                tan = _mixed(history)
            else:
                raise NotSettled("slopes of the exact state do not settle")
            cos_x, cos_y = _cos(tan[0]), _cos(tan[1])
            sin_x, dA = tan[0] * cos_x, self.spacing**2
            normal = sum((f * cos_x - r * sin_x) * cos_y) * dA
            friction = sum((f * sin_x + r * cos_x) * cos_y) * dA
        return Exactly(f, delta, normal, friction, contact, margin)

    def _traction(self, f: Exact, chi: Exact) -> Exact:
        return chi * mp.mpf(self.scene.friction.tau) + f * mp.mpf(self.scene.friction.beta)

    def _slopes(self, f: Exact, r: Exact, tan: tuple[Exact, Exact]) -> tuple[Exact, Exact]:
        """Tangents of the mean of both deformed surfaces, along and across sliding."""
        if not self.oblique:
            return self.flat
        down, along, across = f, r, None
        if self.correction:
            down, along, across = f - r * tan[0], r + f * tan[0], f * tan[1]
        shear = self.S @ along + (0 if across is None else self.T @ across)
        pressed = self.A @ down
        lower = self.z_lower - pressed * self.a[0] - shear * self.c[0]
        upper = self.z_upper + pressed * self.a[1] - shear * self.c[1]
        x, y = (D @ ((lower + upper) / 2) for D in self.D)
        return x * self.cos + y * self.sin, y * self.cos - x * self.sin

    def _frozen(
        self, tan: tuple[Exact, Exact], chi: Exact, contact: NDArray[np.bool_]
    ) -> tuple[Exact, Exact, NDArray[np.bool_], float]:
        """Pressure, approach, contact set and margin at fixed slopes and active set of tau."""
        tau, beta = mp.mpf(self.scene.friction.tau), mp.mpf(self.scene.friction.beta)
        a, c, (tan_x, tan_y) = sum(self.a), self.c[0] - self.c[1], tan
        cos_x, cos_y = _cos(tan_x), _cos(tan_y)
        G, g = self.A * a + self.S * (c * beta), (self.S @ chi) * (c * tau)
        if self.correction:
            G = self.A * a * (1 - tan_x * beta) + self.S * c * (tan_x + beta) + self.T * c * tan_y
            g = ((self.S @ chi) * c - (self.A @ (chi * tan_x)) * a) * tau
        K = cos_x * cos_y
        weights = (cos_x - tan_x * cos_x * beta) * cos_y
        offset = tau * sum(chi * tan_x * K)
        target = (mp.mpf(self.scene.load) / self.spacing**2) + offset
        right = -(K * self.h + g)
        for exchange in range(EXCHANGES):
            f, delta = self._equations(G, right, K, weights, target, contact)
            room = G @ f - right - K * delta
            bad, margin = _infeasible(f, room, contact)
            if not bad.any():
                return f, delta, contact, margin
            if exchange > EXCHANGES // 4:  # blocks may cycle; one at a time from the last index on does not
                bad[: np.flatnonzero(bad)[-1]] = False
            contact = contact ^ bad
            if not contact.any():
                contact = bad
        raise NotSettled("exchanges of the exact state do not end")

    def _equations(
        self, G: Exact, right: Exact, K: Exact, weights: Exact, target: Exact, contact: NDArray[np.bool_]
    ) -> tuple[Exact, Exact]:
        """Pressure on the contact set, and the approach: bordered by the load unless that is prescribed."""
        index = np.flatnonzero(contact)
        f = np.full(len(K), mp.mpf(0), dtype=object)
        if self.approach is not None:
            if len(index):
                f[index] = eliminated(G[np.ix_(index, index)], (right + K * self.approach)[index])
            return f, self.approach
        n = len(index)
        # pressures come in units of 1/|G|: the border and the block then have one size
        unit, scale = (np.max(np.abs(values)) or mp.mpf(1) for values in (G, weights))
        bordered = np.full((n + 1, n + 1), mp.mpf(0), dtype=object)
        bordered[:n, :n], bordered[:n, n] = G[np.ix_(index, index)] / unit, -K[index]
        bordered[n, :n] = weights[index] / scale
        found = eliminated(bordered, np.append(right[index], target * unit / scale))
        f[index] = found[:n] / unit
        return f, found[n]


def _infeasible(f: Exact, room: Exact, contact: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], float]:
    """Elements that break Eq. (6), and the least relative distance of any element from doing so."""
    inside, outside = f[contact], room[~contact]
    scale_f, scale_v = max(abs(f)) or mp.mpf(1), max(abs(room)) or mp.mpf(1)
    bad = np.zeros(len(f), dtype=bool)
    bad[contact] = [bool(value < -TIE * scale_f) for value in inside]
    bad[~contact] = [bool(value < -TIE * scale_v) for value in outside]
    margins = [float(min(abs(v)) / s) for v, s in ((inside, scale_f), (outside, scale_v)) if len(v)]
    return bad, min(margins)


def eliminated(matrix: Exact, right: Exact) -> Exact:
    """Gaussian elimination with partial pivoting on object arrays."""
    m, x = matrix.copy(), right.copy()
    n = len(x)
    for k in range(n):
        p = k + int(np.argmax(np.abs(m[k:, k])))
        if m[p, k] == 0:
            raise NotSettled("singular equations")
        if p != k:
            m[[k, p]], x[[k, p]] = m[[p, k]], x[[p, k]]
        factors = m[k + 1 :, k] / m[k, k]
        m[k + 1 :, k + 1 :] -= np.outer(factors, m[k, k + 1 :])
        x[k + 1 :] -= factors * x[k]
    for k in reversed(range(n)):
        x[k] = (x[k] - (m[k, k + 1 :] @ x[k + 1 :] if k + 1 < n else 0)) / m[k, k]
    return x


def _cos(tan: Exact) -> Exact:
    return np.array([1 / mp.sqrt(1 + t * t) for t in tan], dtype=object)


def _mixed(history: list[tuple[Exact, Exact]]) -> tuple[Exact, Exact]:
    """The next slopes from the last ones found and their changes: Anderson (1965) mixing.

    Its few shares are doubles: they steer the iteration, and where it ends does not depend on them.
    """
    found, changes = zip(*history, strict=True)
    if len(history) < 2:
        return tuple(found[-1])
    steps = [(later - earlier).ravel() for earlier, later in pairwise(changes)]
    scale = max(max(abs(step)) for step in steps)
    columns = np.array([(step / scale).astype(float) for step in steps]).T
    shares = np.linalg.lstsq(columns, (changes[-1].ravel() / scale).astype(float), rcond=None)[0]
    mixed = found[-1]
    for share, (earlier, later) in zip(shares, pairwise(found), strict=True):
        mixed = mixed - (later - earlier) * mp.mpf(float(share))
    return tuple(mixed)


def _exact(values: Array) -> Exact:
    return np.array([mp.mpf(float(v)) for v in values.ravel()], dtype=object)
