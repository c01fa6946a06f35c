"""Points at which the influence integrals are judged: random ones over the whole range, and awkward ones.

A point is ``(x, y, dx, dy)``; offsets are meant in elements, so that ``x = offset dx`` as rounded is the
exact input.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from refimpl.kernels.quadrature import shells

Point = tuple[float, float, float, float]

FARTHEST = 1e6
ASPECTS = (1e-3, 1.0, 1e3)


def random_points(seed: int, count: int) -> list[Point]:
    """Return lengths 1e-12 ... 1e12, aspect 1e-3 ... 1e3, offsets 0 ... 1e6 of every kind, either sign."""
    rng = np.random.default_rng(seed)
    points = []
    for _ in range(count):
        dx = 10 ** rng.uniform(-12, 12)
        dy = dx * 10 ** rng.uniform(-3, 3)
        x, y = (_random_offset(rng) * edge * rng.choice([-1, 1]) for edge in (dx, dy))
        points.append((float(x), float(y), float(dx), float(dy)))
    return points


def _random_offset(rng: np.random.Generator) -> float:
    """Draw a point on the axis, inside, near the axis, near an edge, on the grid, or anywhere."""
    kinds = (
        lambda: 0.0,
        lambda: rng.uniform(0, 0.5),
        lambda: 10 ** rng.uniform(-12, -1),
        lambda: 0.5 + rng.choice([-1, 1]) * 10 ** rng.uniform(-16, -1),
        lambda: float(rng.integers(0, 10)),
        lambda: float(np.floor(10 ** rng.uniform(0, np.log10(FARTHEST)))),
        lambda: 10 ** rng.uniform(0, np.log10(FARTHEST)),
    )
    return float(kinds[rng.integers(len(kinds))]())


def awkward_points() -> Iterator[Point]:
    """Yield centre, axes, edges, corners, points close to them, diagonals, far ends; extreme aspects."""
    below, above = np.nextafter(0.5, 0), np.nextafter(0.5, 1)
    offsets = (0.0, 1e-100, 1e-8, 0.24999, 0.25, 0.4999, below, 0.5, above, 0.5001,
               1.0, 2.5, 10.0, 1e3, FARTHEST)  # fmt: skip
    for aspect, x, y in product(ASPECTS, offsets, offsets):
        yield float(x), float(y) * aspect, 1.0, aspect


def boundary_points() -> Iterator[Point]:
    """Yield both sides of every change of formula or order, in x and in y, from the axis to the diagonal."""
    for start, _, _ in shells():
        for offset in (np.nextafter(start, 0) / 2, start / 2):
            for other, aspect in product((0.0, 1e-8, 0.5, 2.0, 0.99 * offset, offset), ASPECTS):
                yield float(offset), float(other) * aspect, 1.0, aspect
                yield float(other), float(offset) * aspect, 1.0, aspect
