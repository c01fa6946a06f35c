"""Contact states that are exact by construction: the answer is chosen first, the surfaces follow from it.

Chosen are the contact set, the pressure on it, the active set of tau and the common surface with its slopes.
Eq. (7) then gives the displacements, as sums in 30 digits, Eq. (6) the gap and Eq. (2) the load. Pressures at
a hardness bring the bodies nearer by a chosen plastic indentation.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

import refimpl as rf
from refimpl.grid import Array, Grid
from verification.exact.kernel_reference import normal, tangential

Exact = NDArray[Any]
"""Array of mpf numbers."""

DIGITS = 30
SIDE = 2.0**-10
LOWER, UPPER = rf.Material(E=2.5e9, nu=0.10), rf.Material(E=70e9, nu=0.45)
PEAK, TAU, BETA = 5e6, 0.4e6, 0.15
HEIGHT = 1.5e-6
"""Height (m) of the waves of the chosen common surface: slopes of some 0.02."""


@dataclass(frozen=True, eq=False)
class Manufactured:
    """A scene, the exact state it was made from, and the terms that entered (see `refimpl.solve`)."""

    scene: rf.Scene
    M: int
    oblique: bool
    slope_correction: bool
    pressure: Array
    traction: Array
    approach: float


@cache
def manufacture(
    M: int, seed: int, angle: float, oblique: bool, slope_correction: bool, hardness: float | None = None
) -> Manufactured:
    """Return a random state sliding at ``angle`` (rad); slopes if ``oblique``, lower ``hardness`` (Pa)."""
    random = np.random.default_rng(seed)
    touching = random.random((M, M)) < 0.4
    f = np.where(touching, PEAK * random.uniform(0.01, 1.0, (M, M)), 0.0)
    capped, f = f >= (hardness or np.inf), np.minimum(f, hardness or np.inf)
    with mp.workdps(DIGITS):
        r = TAU * touching + mp.mpf(BETA) * _exact(f)
        common = _common_surface(M, random) if oblique else _exact(np.zeros((M, M)))
        tan_x, tan_y = _slopes(common, M, mp.mpf(angle))
        down, along, across = _exact(f), r, 0 * r
        if slope_correction:
            down, along, across = f - r * tan_x, r + f * tan_x, f * tan_y
        lower, upper = _displacements(M, mp.mpf(angle), down, along, across)
        cos_x, cos_y = (1 / _sqrt(1 + t * t) for t in (tan_x, tan_y))
        v = (lower + upper) / (cos_x * cos_y)
        room = _exact(np.where(touching, 0.0, random.uniform(0.01, 1.0, (M, M)))) * v.max()
        depth = (
            _exact(np.where(capped, random.uniform(0.01, 0.3, (M, M)), 0.0)) * v.max() if hardness else 0 * v
        )
        room -= depth / (cos_x * cos_y)
        approach = max((v - room).ravel())
        gap = approach - v + room
        mean_surface = common - (upper - lower) / 2 + depth / 2  # the lower body yields
        dA = (mp.mpf(SIDE) / M) ** 2
        load = mp.fsum(((f * cos_x - r * tan_x * cos_x) * cos_y).ravel()) * dA
    scene = rf.Scene(
        upper=rf.Body(UPPER, _rounded(mean_surface + gap / 2)),
        lower=rf.Body(replace(LOWER, hardness=hardness), _rounded(mean_surface - gap / 2)),
        friction=rf.Friction(TAU, BETA),
        load=float(load),
        side=SIDE,
        sliding_direction=angle,
        plastic=hardness is not None,
    )
    return Manufactured(scene, M, oblique, slope_correction, f, _rounded(r), float(approach))


def _common_surface(M: int, random: np.random.Generator) -> Exact:
    x = (np.arange(M) + 0.5) / M
    k, phase = random.uniform(2, 6, (2, 3)), random.uniform(0, 6, (2, 3))
    waves = [np.sin(np.add.outer(k[0, n] * x, k[1, n] * x) + phase[0, n]) for n in range(3)]
    return _exact(HEIGHT * np.sum(waves, axis=0))


def _slopes(z: Exact, M: int, angle: Any) -> tuple[Exact, Exact]:
    """Return the central differences along and across the direction, one-sided at the border."""
    h, d = mp.mpf(SIDE) / M, []
    for axis in (0, 1):
        line = np.moveaxis(z, axis, 0)
        up, down = np.minimum(np.arange(M) + 1, M - 1), np.maximum(np.arange(M) - 1, 0)
        step = np.array([mp.mpf(int(n)) for n in up - down], dtype=object)[:, None]
        d.append(np.moveaxis((line[up] - line[down]) / (step * h), 0, axis))
    cos, sin = mp.cos(angle), mp.sin(angle)
    return cos * d[0] + sin * d[1], cos * d[1] - sin * d[0]


def _displacements(M: int, angle: Any, down: Exact, along: Exact, across: Exact) -> tuple[Exact, Exact]:
    """Return ``(u_lower, u_upper)`` of Eq. (7); friction pulls the upper body back, hence its minus sign."""
    a, c = _tables(M)
    s, t = _exact(np.zeros((2, M, M)))
    total = _exact(np.zeros((M, M)))
    cos, sin = mp.cos(angle), mp.sin(angle)
    # a traction (along, across) has components (x, y) on the grid; each moves the surface by its own offset
    x, y = along * cos - across * sin, along * sin + across * cos
    for i in range(M):
        for j in range(M):
            for k in range(M):
                for m in range(M):
                    if not (down[k, m] or x[k, m] or y[k, m]):
                        continue
                    di, dj = i - k, j - m
                    total[i, j] += a[abs(di), abs(dj)] * down[k, m]
                    s[i, j] += _sign(di) * c[abs(di), abs(dj)] * x[k, m]
                    t[i, j] += _sign(dj) * c[abs(dj), abs(di)] * y[k, m]
    found = []
    for body, direction in ((LOWER, 1), (UPPER, -1)):
        E, nu = mp.mpf(body.E), mp.mpf(body.nu)
        by_pressure, by_shear = (1 - nu**2) / (mp.pi * E), (1 + nu) * (1 - 2 * nu) / (2 * mp.pi * E)
        found.append(by_pressure * total + direction * by_shear * (s + t))
    return found[0], found[1]


@cache
def _tables(M: int) -> tuple[Exact, Exact]:
    """Return ``I[1/rho]`` and ``I[x/rho^2]`` at offsets ``(i, j)`` (m)."""
    h = Grid.square(SIDE, M).spacings[0]
    a, c = np.empty((2, M, M), dtype=object)
    for i in range(M):
        for j in range(M):
            a[i, j], c[i, j] = normal(i * h, j * h, h, h), tangential(i * h, j * h, h, h)
    return a, c


def _sign(n: int) -> int:
    return (n > 0) - (n < 0)


def _exact(values: Array) -> Exact:
    return np.array([mp.mpf(float(v)) for v in values.ravel()], dtype=object).reshape(values.shape)


def _sqrt(values: Exact) -> Exact:
    return np.array([mp.sqrt(v) for v in values.ravel()], dtype=object).reshape(values.shape)


def _rounded(values: Exact) -> Array:
    return values.astype(np.float64)
