"""Proof of a scene by ball arithmetic (Arb): coefficients, linear solution, strict KKT margins.

A contact set S is given. On S Eq. (6) with equality, with ``r = tau + beta f``, and Eq. (2) are linear in the
pressures and the approach. Their balls contain the exact solution, whatever the rounding; if every pressure's
ball on S is above 0, and the ball of ``w = u + K (h - approach)`` elsewhere, S is the contact set and the
balls contain the solution. There is no other: ``a + beta c`` is positive definite, and under a load, at flat
slopes, the difference of two solutions has no resultant, so that the approach drops out. (With slopes see
`refimpl.bounds.proven_bounds`.)

Shares nothing with `refimpl`: influence coefficients are the textbook's corner sums (Love 1929; Johnson 1985,
Eqs 3.25 and 3.73), or the modes' sums where periodic.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from refimpl.grid import Mask
from verification.enclosures.scenes import SIDE, EnclosedScene
from verification.exact.kernel_reference import arb

BITS = 256
"""Working precision. Corner sums on 12 elements lose some 10 bits, the linear solution some 10 more."""

Ball = Any
"""A python-flint arb."""


class NotProven(ArithmeticError):
    """The contact set fails, or its margins do not exceed the balls; the message says where."""


@dataclass(frozen=True, eq=False)
class Proof:
    """Balls: pressures (Pa) on ``contact`` in row order, approach (m), forces (N) and w (m).

    ``approach`` counts from first contact; ``separations`` are w off contact, in row order.
    """

    contact: Mask
    pressures: list[Ball]
    separations: list[Ball]
    approach: Ball
    forces: dict[str, Ball]


def prove(known: EnclosedScene, contact: Mask) -> Proof:
    """Prove a scene; raises `NotProven`, and `Unavailable` without python-flint."""
    flint = arb()
    with flint.ctx.workprec(BITS):
        return _Balls(known, contact).proof()


class _Balls:
    """The frozen linear problem of one scene and contact set."""

    def __init__(self, known: EnclosedScene, contact: Mask) -> None:
        self.known, self.contact, self.flint = known, contact, arb()
        self.number = self.flint.arb
        self.h = self.number(SIDE) / known.M
        self.inside = [(int(i), int(j)) for i, j in np.argwhere(contact)]
        self.outside = [(int(i), int(j)) for i, j in np.argwhere(~contact)]

    def proof(self) -> Proof:
        """Return the balls, if their signs prove the set."""
        pressures, approach = self._solution()
        separations = [self._separation(e, pressures, approach) for e in self.outside]
        for what, elements, balls in (
            ("pressure", self.inside, pressures), ("separation", self.outside, separations)
        ):  # fmt: skip
            for element, ball in zip(elements, balls, strict=True):
                if not ball > 0:
                    raise NotProven(f"{self.known.name}: the {what} {ball} at {element} is not above 0")
        return Proof(self.contact, pressures, separations, approach, self._forces(pressures))

    def _solution(self) -> tuple[list[Ball], Ball]:
        """Return the rows: Eq. (6) times K on the set's elements; then the load, or the approach."""
        known, n = self.known, len(self.inside)
        matrix, right = self.flint.arb_mat(n + 1, n + 1), self.flint.arb_mat(n + 1, 1)
        for row, element in enumerate(self.inside):
            for column, source in enumerate(self.inside):
                matrix[row, column] = self._influence(element, source)
            K = self._cosines(element)[2]
            matrix[row, n] = -K
            right[row, 0] = -K * self._gap(element) - self._by_tau(element)
        if known.approach is not None:
            matrix[n, n], right[n, 0] = self.number(1), self.number(known.approach)
        else:
            right[n, 0] = self.number(known.load) / self.h**2
            for column, source in enumerate(self.inside):
                by_pressure, by_tau = self._force_weights(source)["normal_force"]
                matrix[n, column] = by_pressure
                right[n, 0] -= by_tau
        found = matrix.solve(right)
        return [found[k, 0] for k in range(n)], found[n, 0]

    def _separation(self, element: tuple[int, int], pressures: list[Ball], approach: Ball) -> Ball:
        u = self._by_tau(element)
        for source, f in zip(self.inside, pressures, strict=True):
            u += self._influence(element, source) * f
        return u + self._cosines(element)[2] * (self._gap(element) - approach)

    def _forces(self, pressures: list[Ball]) -> dict[str, Ball]:
        totals = {name: self.number(0) for name in ("normal_force", "friction_force", "binormal_force")}
        for source, f in zip(self.inside, pressures, strict=True):
            for name, (by_pressure, by_tau) in self._force_weights(source).items():
                totals[name] += (by_pressure * f + by_tau) * self.h**2
        load = totals["normal_force"] if self.known.approach is not None else self.number(self.known.load)
        return {**totals, "friction_coefficient": totals["friction_force"] / load}

    def _force_weights(self, element: tuple[int, int]) -> dict[str, tuple[Ball, Ball]]:
        """Return Eqs (2), (3) and Q per element: factor of f, and the share of tau."""
        tau, beta = self.number(self.known.friction.tau), self.number(self.known.friction.beta)
        cos_x, cos_y, _ = self._cosines(element)
        sin_x, sin_y = (t * c for t, c in zip(self._tangents(element), (cos_x, cos_y), strict=True))
        down, along = cos_x - beta * sin_x, sin_x + beta * cos_x
        return {
            "normal_force": (down * cos_y, -tau * sin_x * cos_y),
            "friction_force": (along * cos_y, tau * cos_x * cos_y),
            "binormal_force": (down * sin_y, -tau * sin_x * sin_y),
        }

    def _tangents(self, element: tuple[int, int]) -> tuple[Ball, Ball]:
        if self.known.tan_x is None or self.known.tan_y is None:
            return self.number(0), self.number(0)
        return self.number(float(self.known.tan_x[element])), self.number(float(self.known.tan_y[element]))

    def _cosines(self, element: tuple[int, int]) -> tuple[Ball, Ball, Ball]:
        cos_x, cos_y = (1 / (1 + t * t).sqrt() for t in self._tangents(element))
        return cos_x, cos_y, cos_x * cos_y

    def _gap(self, element: tuple[int, int]) -> Ball:
        return self.number(float(self.known.heights.max())) - self.number(float(self.known.heights[element]))

    def _by_tau(self, element: tuple[int, int]) -> Ball:
        total = self.number(0)
        if self.known.friction.tau:
            for source in self.inside:
                total += self._shear(element[0] - source[0], element[1] - source[1])
        return total * self.number(self.known.friction.tau)

    def _influence(self, element: tuple[int, int], source: tuple[int, int]) -> Ball:
        """Return ``a + beta c`` between two elements (m/Pa)."""
        i, j = element[0] - source[0], element[1] - source[1]
        coefficient = self._compliances[0] * self._table["normal"][abs(i)][abs(j)]
        if self.known.friction.beta:
            coefficient += self.number(self.known.friction.beta) * self._shear(i, j)
        return coefficient

    def _shear(self, i: int, j: int) -> Ball:
        """Return c at an offset: ``s = x cos phi + y sin phi`` (m/Pa)."""
        phi = self.number(self.known.direction)
        x = self._table["tangential"][abs(i)][abs(j)] * ((i > 0) - (i < 0))
        y = self._table["tangential"][abs(j)][abs(i)] * ((j > 0) - (j < 0))
        return self._compliances[1] * (phi.cos() * x + phi.sin() * y)

    @cached_property
    def _compliances(self) -> tuple[Ball, Ball]:
        """Factors of I[1/rho], the sum of both bodies, and of I[s/rho^2], lower minus upper (1/Pa)."""
        pi, by_pressure, by_shear = self.number.pi(), [], []
        for body in (self.known.lower, self.known.upper):
            E, nu = self.number(body.E), self.number(body.nu)
            by_pressure.append((1 - nu**2) / (pi * E))
            by_shear.append((1 + nu) * (1 - 2 * nu) / (2 * pi * E))
        return by_pressure[0] + by_pressure[1], by_shear[0] - by_shear[1]

    @cached_property
    def _table(self) -> dict[str, list[list[Ball]]]:
        """I[1/rho] and I[x/rho^2] (m) at offsets of ``i, j >= 0`` elements."""
        if self.known.periodic:
            return self._periodic_table()
        M, half = self.known.M, self.number(1) / 2
        corners = [
            [(_love(X, Y), _cerruti(X, Y)) for Y in (j - half for j in range(M + 1))]
            for X in (i - half for i in range(M + 1))
        ]

        def difference(kind: int, i: int, j: int) -> Ball:
            near, far = corners[i], corners[i + 1]
            return (far[j + 1][kind] - near[j + 1][kind] - far[j][kind] + near[j][kind]) * self.h

        return {
            name: [[difference(kind, i, j) for j in range(M)] for i in range(M)]
            for kind, name in enumerate(("normal", "tangential"))
        }

    def _periodic_table(self) -> dict[str, list[list[Ball]]]:
        """Return sums of the modes ``2 pi/q``, ``-2 pi i q_x/q^2``; no mean, no Nyquist sine."""
        M = self.known.M
        number, scale = self.number, self.number(SIDE) / M**2
        turn = [2 * number(k) / M for k in range(M)]
        cos, sin = [t.cos_pi() for t in turn], [t.sin_pi() for t in turn]
        waves = range(-(M // 2), (M + 1) // 2)
        modes = [(k, m) for k in waves for m in waves if (k, m) != (0, 0)]
        table: dict[str, list[list[Ball]]] = {"normal": [], "tangential": []}
        for i in range(M):
            for rows in table.values():
                rows.append([])
            for j in range(M):
                normal, tangential = number(0), number(0)
                for k, m in modes:
                    phase = (k * i + m * j) % M
                    normal += cos[phase] / number(k * k + m * m).sqrt()
                    tangential += (0 if 2 * k == -M else k) * sin[phase] / number(k * k + m * m)
                table["normal"][i].append(scale * normal)
                table["tangential"][i].append(scale * tangential)
        return table


def _love(X: Ball, Y: Ball) -> Ball:
    return X * (Y / abs(X)).asinh() + Y * (X / abs(Y)).asinh()


def _cerruti(X: Ball, Y: Ball) -> Ball:
    return Y * (X * X + Y * Y).log() / 2 + X * (Y / X).atan()
