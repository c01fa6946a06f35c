"""Frictionless contact of a paraboloid, its pressure capped at a hardness, from rings of uniform pressure.

Sources: Johnson 1985, section 3.4 (uniformly loaded circle). Rings that break a sign are exchanged, all at
once, with the approach as an unknown. Nothing here is shared with the solvers of `refimpl`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipe, ellipk

from refimpl.grid import Array
from verification.exact.hertz import Sphere

_EXCHANGES = 100
_FITTED = 5  # rings beside an edge whose squares are extrapolated to it


@dataclass(frozen=True, eq=False)
class Capped:
    """A solution on rings; lengths in m, pressures in Pa.

    r, pressure : radii of the rings' middles, and the pressures there
    approach : from first contact
    radius : of the contact, where the squared pressure extrapolates to zero
    core : radius of the plastic core, where the squared distance to the hardness does; 0 without one
    """

    r: Array
    pressure: Array
    approach: float
    radius: float
    core: float


def disc_displacement(r: Array, radius: Array) -> Array:
    """Return E* times the displacement at ``r`` (m) by unit pressure on a circle of ``radius`` (m)."""
    r, radius = np.broadcast_arrays(r, radius)
    m = np.minimum(r, radius) / np.maximum(r, radius)
    E = ellipe(m**2)
    ring = np.where(m < 1, (1 - m**2) * ellipk(np.where(m < 1, m**2, 0.0)), 0.0)  # the limit at the edge is 0
    inside, outside = radius * E, r * (E - ring)
    return np.asarray(4 / np.pi * np.where(r < radius, inside, outside))


def capped_sphere(sphere: Sphere, hardness: float, rings: int = 800) -> Capped:
    """Solve under the sphere's load with pressures up to ``hardness`` (Pa).

    Below half of Hertz' maximum pressure `plastic_limit` is closer than these rings. Raises ArithmeticError
    where the exchanges of rings do not end.
    """
    ideal = np.sqrt(sphere.load / (np.pi * hardness))  # the least radius that bears the load
    outer = 1.2 * max(1.2 * ideal, sphere.contact_radius)
    edges = np.linspace(0.0, outer, rings + 1)
    r, area = (edges[1:] + edges[:-1]) / 2, np.pi * np.diff(edges**2)
    discs = np.zeros((rings, rings + 1))
    discs[:, 1:] = disc_displacement(r[:, None], edges[None, 1:]) / sphere.modulus
    compliance, gap = np.diff(discs, axis=1), r**2 / (2 * sphere.radius)
    free, full = r < sphere.contact_radius, np.zeros(rings, dtype=bool)
    for _ in range(_EXCHANGES):
        p, approach = _balanced(compliance, gap, area, sphere.load, hardness * full, free)
        v = compliance @ p + gap
        now_full = (free & (p >= hardness)) | (full & (v <= approach))
        now_free = (free & (p > 0) & (p < hardness)) | (full & (v > approach))
        now_free |= ~free & ~full & (v < approach)
        if np.array_equal(now_free, free) and np.array_equal(now_full, full):
            h = outer / rings
            return Capped(r, p, approach, _edge(r, p, h), _core(r, hardness - p, full, h))
        free, full = now_free, now_full
        if not free.any():  # the ring beside the core balances the load
            free = np.arange(rings) == min(int(full.sum()), rings - 1)
    raise ArithmeticError("the exchange of rings did not end")


def plastic_limit(sphere: Sphere, hardness: float) -> tuple[float, float]:
    """Return radius and approach (m) where all contact is at the hardness: a circle of even load.

    ``a = sqrt(P / (pi H))``, and ``d = a^2 / 2R + 4 H a / (pi E*)`` at its edge.
    """
    a = float(np.sqrt(sphere.load / (np.pi * hardness)))
    return a, a**2 / (2 * sphere.radius) + 4 * hardness * a / (np.pi * sphere.modulus)


def _balanced(
    compliance: Array, gap: Array, area: Array, load: float, pressure: Array, free: NDArray[np.bool_]
) -> tuple[Array, float]:
    """Return the pressures with the free rings' from contact and load, and the approach."""
    k = np.flatnonzero(free)
    scale = float(np.abs(compliance).max())
    n = len(k)
    system = np.zeros((n + 1, n + 1))
    system[:n, :n], system[:n, n] = compliance[np.ix_(k, k)] / scale, -1.0
    system[n, :n] = area[k] / area.max()
    right = np.append(-(gap + compliance @ pressure)[k] / scale, (load - area @ pressure) / area.max())
    found = np.linalg.solve(system, right)
    p = pressure.copy()
    p[k] = found[:-1]
    return p, float(found[-1] * scale)


def _edge(r: Array, pressure: Array, h: float) -> float:
    """Return the radius where the squared pressure extrapolates to zero, if near the outermost ring."""
    last = np.flatnonzero(pressure > 0)
    return _zero(r, pressure**2, last[-_FITTED:], float(r[last[-1]] + h / 2), h)


def _core(r: Array, room: Array, full: NDArray[np.bool_], h: float) -> float:
    """Return the radius at which the square of the room below the hardness extrapolates to zero."""
    if not full.any():
        return 0.0
    first = int(np.flatnonzero(~full)[0])
    return _zero(r, room**2, np.arange(first, first + _FITTED), float(r[first] - h / 2), h)


def _zero(r: Array, values: Array, k: NDArray[np.intp], near: float, h: float) -> float:
    slope, at_zero = np.polyfit(r[k] - near, values[k], 1)
    found = -at_zero / slope if slope else 0.0
    return near + float(np.clip(found, -h, h))
