"""Two asperities in sliding contact in three dimensions, Coulomb friction; the scheme of `contact`.

Pressures are bilinear between the ends of the lower patch's elements.  Pressure acts along the deformed
lower surface's normal, friction along its tangent in the vertical plane of sliding, both per deformed area.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from appendix_a.contact_fem.contact import NotConverged, complementary
from appendix_a.contact_fem.solid import Patch
from appendix_a.fem.body import lagrange

Array = NDArray[np.float64]
GAUSS = 4  # points along either side of an element
TOLERANCE = 1e-8
UPDATES = 60


@dataclass(frozen=True)
class SolidContact:
    """Numbers of the whole contact, both halves: `approach` from first contact, forces, projected `area`."""

    approach: float
    normal: float
    friction: float
    area: float
    updates: int

    @property
    def friction_coefficient(self) -> float:
        """F / N."""
        return self.friction / self.normal


@dataclass(frozen=True, eq=False)
class _Sampled:
    """Values at q points of the lower surface: interpolations, weighted area vector, gap, upper slopes."""

    hats: csr_matrix
    on_lower: csr_matrix
    on_upper: csr_matrix
    area: Array
    gap: Array
    slope: Array

    def traction(self, beta: float) -> Array:
        """Return (3, q) force on the lower body by unit pressure: normal, and beta along the tangent."""
        tangent = np.array([self.area[2], np.zeros_like(self.gap), -self.area[0]])
        tangent /= np.hypot(self.area[2], self.area[0])
        force: Array = -self.area + beta * np.linalg.norm(self.area, axis=0) * tangent
        return force


def _matrix(grid: tuple[int, int], place: Array, orders: tuple[int, int]) -> csr_matrix:
    """Return (q, n) biquadratic interpolation at places (2, q), in elements; `orders`: 1 for d/dplace."""
    count = [(n - 1) // 2 for n in grid]
    element = [np.clip(np.floor(p).astype(int), 0, m - 1) for p, m in zip(place, count, strict=True)]
    one, two = (lagrange(2, p - e)[o] for p, e, o in zip(place, element, orders, strict=True))
    values = one[:, None] * two[None, :]
    columns = (2 * element[0] + np.arange(3)[:, None])[:, None] * grid[1] + (
        2 * element[1] + np.arange(3)[:, None]
    )[None, :]
    rows = np.broadcast_to(np.arange(place.shape[1]), columns.shape)
    return csr_matrix((values.ravel(), (rows.ravel(), columns.ravel())), (place.shape[1], grid[0] * grid[1]))


def _hats(grid: tuple[int, int], place: Array) -> csr_matrix:
    """Return (q, vertices) bilinear interpolation between element ends."""
    ends = [(n - 1) // 2 + 1 for n in grid]
    cell = [np.clip(np.floor(p).astype(int), 0, m - 2) for p, m in zip(place, ends, strict=True)]
    local = [p - c for p, c in zip(place, cell, strict=True)]
    parts = []
    for i in (0, 1):
        for j in (0, 1):
            weight = (local[0] if i else 1 - local[0]) * (local[1] if j else 1 - local[1])
            parts.append((weight, (cell[0] + i) * ends[1] + cell[1] + j))
    rows = np.tile(np.arange(place.shape[1]), 4)
    values = np.concatenate([w for w, _ in parts])
    columns = np.concatenate([c for _, c in parts])
    return csr_matrix((values, (rows, columns)), (place.shape[1], ends[0] * ends[1]))


def _gauss(grid: tuple[int, int]) -> tuple[Array, Array]:
    """Return the places (2, q) in element spacings, and weights (q,)."""
    t, w = np.polynomial.legendre.leggauss(GAUSS)
    axes = [(np.arange((n - 1) // 2)[:, None] + (1 + t) / 2).ravel() for n in grid]
    weights = [np.tile(w / 2, (n - 1) // 2) for n in grid]
    place = np.array(np.meshgrid(*axes, indexing="ij")).reshape(2, -1)
    return place, np.outer(*weights).ravel()


def _located(upper: Array, at: Array, start: Array) -> Array:
    """Return places on the upper grid (3, nx, ny) with x, y `at` (2, q), by Newton's method."""
    grid, place = upper.shape[1:], start.copy()
    flat = upper[:2].reshape(2, -1)
    limit = [[1e-9], [1e-9]], [[(n - 1) / 2 - 1e-9] for n in grid]
    for _ in range(20):
        error = at - (_matrix(grid, place, (0, 0)) @ flat.T).T
        a, b = ((_matrix(grid, place, orders) @ flat.T).T for orders in ((1, 0), (0, 1)))
        determinant = a[0] * b[1] - a[1] * b[0]
        step = np.array([b[1] * error[0] - b[0] * error[1], a[0] * error[1] - a[1] * error[0]]) / determinant
        moved = np.clip(place + step, *limit)
        if np.abs(moved - place).max() < 1e-12:
            break
        place = moved
    return place


def _sample(lower: Array, upper: Array) -> _Sampled:
    grid = lower.shape[1:]
    place, weight = _gauss(grid)
    on_lower = _matrix(grid, place, (0, 0))
    flat, above = lower.reshape(3, -1), upper.reshape(3, -1)
    along, across = ((_matrix(grid, place, orders) @ flat.T).T for orders in ((1, 0), (0, 1)))
    point = (on_lower @ flat.T).T
    there = _located(upper, point[:2], place)
    on_upper = _matrix(upper.shape[1:], there, (0, 0))
    a, b = ((_matrix(upper.shape[1:], there, orders) @ above.T).T for orders in ((1, 0), (0, 1)))
    normal = np.cross(a, b, axis=0)
    return _Sampled(
        hats=_hats(grid, place),
        on_lower=on_lower,
        on_upper=on_upper,
        area=weight * np.cross(along, across, axis=0),
        gap=(on_upper @ above[2]) - point[2],
        slope=-normal[:2] / normal[2],
    )


def press(lower: Patch, upper: Patch, distance: float, load: float, beta: float) -> SolidContact:
    """Solve as the upper body slides along +x under `load` per square wavelength, `distance` apart at touch.

    Raises NotConverged.
    """
    shape = lower.at.shape
    u_l, u_u, sink = np.zeros(lower.at.size), np.zeros(upper.at.size), 0.0
    pressure = np.zeros(((shape[1] - 1) // 2 + 1) * ((shape[2] - 1) // 2 + 1))
    raised = replace(upper, at=upper.at + np.array([0.0, 0.0, distance])[:, None, None])
    for update in range(1, UPDATES + 1):
        down = np.array([0.0, 0.0, sink])[:, None, None]
        sampled = _sample(lower.at + u_l.reshape(shape), raised.at + u_u.reshape(upper.at.shape) - down)
        force = sampled.traction(beta)
        hats = sampled.hats.toarray()
        on_lower = np.vstack([sampled.on_lower.T @ (f[:, None] * hats) for f in force])
        on_upper = -np.vstack([sampled.on_upper.T @ (f[:, None] * hats) for f in force])
        weighted = (sampled.hats.multiply(sampled.area[2][:, None])).T.tocsr()
        direction = (-sampled.slope[0], -sampled.slope[1], np.ones_like(sampled.gap))
        by_lower = -np.hstack([(weighted.multiply(d) @ sampled.on_lower).toarray() for d in direction])
        by_upper = np.hstack([(weighted.multiply(d) @ sampled.on_upper).toarray() for d in direction])
        respond_lower, respond_upper = lower.compliance @ on_lower, upper.compliance @ on_upper
        gap = weighted @ sampled.gap - by_lower @ u_l - by_upper @ u_u
        n = shape[1] * shape[2]
        weights = -on_lower[2 * n :].sum(axis=0)
        width = np.asarray(weighted.sum(axis=1)).ravel()
        start = pressure > 0 if pressure.any() else np.ones(len(pressure), dtype=bool)
        matrix = by_lower @ respond_lower + by_upper @ respond_upper
        new, more = complementary(matrix, gap, width, weights, load / 2, start)
        change = float(np.abs(new - pressure).max() / new.max())
        pressure, sink = new, sink + more
        u_l, u_u = respond_lower @ pressure, respond_upper @ pressure
        if change < TOLERANCE:
            friction = 2 * float(on_lower[:n].sum(axis=0) @ pressure)
            area = 2 * float(width[pressure > 0].sum())
            return SolidContact(sink, load, friction, area, update)
    raise NotConverged(f"pressures still change by {change:.1e} of the peak after {UPDATES} updates")
