"""The two deformed surfaces against each other: positions, projection, forces of tractions, gaps.

Nothing of the interface is linearised here: integrals run over the deformed lower surface, whose tangent
gives the directions of pressure and friction, and the point of the upper surface that touches a point of the
lower one is the one vertically above it as both are deformed (finite sliding).  The pressure is piecewise
linear between the ends of the lower surface's edges, the displacements quadratic: a mortar method.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, vstack

from appendix_a.contact_fem.bodies import Surface
from appendix_a.fem.body import Numbers, lagrange

Array = NDArray[np.float64]
GAUSS = 6  # points on an edge: the other body's nodes, kinks of the integrands, lie between them


def locate(x: Array, at: Array) -> tuple[Numbers, Array]:
    """Return edge and parameter t on it, for edges of node abscissae x (3, m), at points (q,).

    Quadratic sides, x(t) = x0 + (x2 - x0) t + bow t (1 - t), by the root that does not cancel; points beyond
    the first or last edge are taken for its end (contact never comes near the zone's ends).
    """
    at = np.clip(at, x[0, 0], x[2, -1])
    edge = np.clip(np.searchsorted(x[0], at, side="right") - 1, 0, x.shape[1] - 1)
    x0, x1, x2 = x[:, edge]
    bow = 4.0 * x1 - 2.0 * (x0 + x2)
    b = x2 - x0 + bow
    t: Array = 2.0 * (at - x0) / (b + np.sqrt(b**2 - 4.0 * bow * (at - x0)))
    return edge, t


@dataclass(frozen=True)
class Points:
    """Points on a surface: `edge` (q,), parameter `t` (q,) and weight dt `weight` (q,)."""

    edge: Numbers
    t: Array
    weight: Array


def gauss_points(left: Array, right: Array) -> Points:
    """Return Gauss points on the parts [left, right] (m,) of the parameter of each edge."""
    t, weight = np.polynomial.legendre.leggauss(GAUSS)
    width = np.maximum(right - left, 0.0)
    where = left[:, None] + width[:, None] * (1.0 + t) / 2.0
    edges = np.repeat(np.arange(len(left)), GAUSS)
    return Points(edges, where.ravel(), (width[:, None] * weight / 2.0).ravel())


@dataclass(frozen=True, eq=False)
class Interface:
    """Both surfaces with their nodes where deformation has taken them, `lower_at` and `upper_at` (2, n)."""

    lower: Surface
    upper: Surface
    lower_at: Array
    upper_at: Array

    @cached_property
    def vertices(self) -> Numbers:
        """(m + 1,) lower nodes that carry a pressure, from left to right."""
        ends: Numbers = np.append(self.lower.edges[0], self.lower.edges[2, -1])
        return ends

    def at(self, points: Points) -> Sampled:
        """Return everything that integrals over the interface need at points on the lower surface."""
        shape, slope = lagrange(2, points.t)
        on_lower = _interpolation(self.lower, points.edge, shape)
        tangent = _interpolation(self.lower, points.edge, slope) @ self.lower_at.T
        place = on_lower @ self.lower_at.T
        edge, t = locate(self.upper_at[0][self.upper.edges], place[:, 0])
        shape, slope = lagrange(2, t)
        on_upper = _interpolation(self.upper, edge, shape)
        above = on_upper @ self.upper_at.T
        upper_tangent = _interpolation(self.upper, edge, slope) @ self.upper_at.T
        count, m = len(points.t), self.lower.edges.shape[1]
        hats = csr_matrix(
            (
                np.concatenate([1.0 - points.t, points.t]),
                (np.tile(np.arange(count), 2), np.concatenate([points.edge, points.edge + 1])),
            ),
            shape=(count, m + 1),
        )
        return Sampled(
            hats=hats,
            on_lower=on_lower,
            on_upper=on_upper,
            dx=points.weight * tangent[:, 0],
            dz=points.weight * tangent[:, 1],
            gap=above[:, 1] - place[:, 1],
            slope=upper_tangent[:, 1] / upper_tangent[:, 0],
        )

    def edges_within(self, span: tuple[float, float]) -> Points:
        """Return Gauss points on the part of the lower surface whose deformed abscissae lie in `span`."""
        x = self.lower_at[0][self.lower.edges]
        m = x.shape[1]
        (first, last), (t_first, t_last) = locate(x, np.array(span))
        index = np.arange(m)
        left = np.where(index == first, t_first, np.where(index > first, 0.0, 1.0))
        right = np.where(index == last, t_last, np.where(index < last, 1.0, 0.0))
        return gauss_points(left, right)

    def whole(self) -> Points:
        """Return Gauss points on every edge of the lower surface."""
        m = self.lower.edges.shape[1]
        return gauss_points(np.zeros(m), np.ones(m))


@dataclass(frozen=True, eq=False)
class Sampled:
    """Interpolations and geometry at q points; `dx`, `dz`: the weighted components of the length element."""

    hats: csr_matrix
    on_lower: csr_matrix
    on_upper: csr_matrix
    dx: Array
    dz: Array
    gap: Array
    slope: Array

    def forces(self, pressure: Array | csr_matrix, traction: Array | csr_matrix) -> tuple[Array, Array]:
        """Return the nodal forces on the lower body and the upper one, stacked (F_x; F_z), (2n, k).

        `pressure`, `traction`: (q, k) values per unit deformed length, along the inward normal of the lower
        body and along the surface towards +x: (f dz + r dx, -f dx + r dz).
        """
        along = pressure * self.dz[:, None] + traction * self.dx[:, None]
        up = traction * self.dz[:, None] - pressure * self.dx[:, None]
        lower = np.vstack([self.on_lower.T @ along, self.on_lower.T @ up])
        upper = -np.vstack([self.on_upper.T @ along, self.on_upper.T @ up])
        return lower, upper

    def gap_change(self) -> tuple[csr_matrix, csr_matrix]:
        """Return (m + 1, 2n) weighted gap's derivatives by the lower and the upper nodal displacements.

        A point of either surface that moves along x meets the other at another place: each displacement
        counts as u_z - slope u_x, with the upper surface's slope for both.
        """
        weighted = self.hats.multiply(self.dx[:, None]).T.tocsr()
        lower, upper = (
            csr_matrix(vstack([-(weighted.multiply(self.slope) @ shape).T, (weighted @ shape).T]).T)
            for shape in (self.on_lower, self.on_upper)
        )
        return -lower, upper

    def weighted_gap(self) -> tuple[Array, Array]:
        """Return (m + 1,) integrals of hat times gap, and of hat, over dx."""
        return self.hats.T @ (self.gap * self.dx), self.hats.T @ self.dx


def _interpolation(surface: Surface, edge: Numbers, shape: Array) -> csr_matrix:
    """Return (q, n) values at points from nodal values; `shape` (3, q)."""
    rows = np.tile(np.arange(len(edge)), 3)
    columns = surface.edges[:, edge].ravel()
    return csr_matrix((shape.ravel(), (rows, columns)), (len(edge), surface.at.shape[1]))
