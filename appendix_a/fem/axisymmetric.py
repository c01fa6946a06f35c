"""Axisymmetric asperity (cone or paraboloid on a half-space) under a pressed patch at its tip.

The displacements decay with distance and need no datum: the self coefficient, which a plane problem lacks,
comes out too.  Lengths in units of the patch's radius a along the surface, displacements of p a / E.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import bmat, csc_matrix
from scipy.special import ellipe, ellipkm1
from skfem import BilinearForm

from appendix_a.errors import InputError, real, reals
from appendix_a.fem.body import Body, solve_fixed
from appendix_a.fem.departure import LEVELS, ORDER
from appendix_a.fem.elasticity import lame
from appendix_a.fem.geometry import Boundary, bend, cap_boundary, flat, ridge_boundary
from appendix_a.fem.mesh import Source, graded_mesh
from appendix_a.fem.result import WavyResult

Array = NDArray[np.float64]
OUTER = 64.0  # outer radius over the asperity's base; a quarter of it is the smallest of the three radii


def circular_patch(r: Array, nu: float) -> Array:
    """Return the exact u_z (m,) under unit pressure on r < 1 (Johnson 1985, Eqs 3.29), in p a / E.

    >>> float(circular_patch(np.array([0.0]), 0.5)[0])  # 2 (1 - nu^2)
    1.5
    """
    inside = ellipe(np.minimum(r, 1.0) ** 2)
    far = 1.0 / np.maximum(r, 1.0)
    outside = (ellipe(far**2) - (1.0 - far**2) * ellipkm1(np.maximum(1.0 - far**2, 1e-300))) / far
    values: Array = 4.0 * (1.0 - nu**2) / np.pi * np.where(r <= 1.0, inside, outside)
    return values


def _weighted(form: Callable[..., Any]) -> Any:
    """Return the integral over the meridian plane, weighted with the radius."""
    return BilinearForm(lambda u, v, w: form(u, v, w.x[0]) * w.x[0])


FORMS = {
    "rr": _weighted(lambda u, v, r: u.grad[0] * v.grad[0]),
    "rz": _weighted(lambda u, v, r: u.grad[0] * v.grad[1]),
    "zz": _weighted(lambda u, v, r: u.grad[1] * v.grad[1]),
    "0z": _weighted(lambda u, v, r: u / r * v.grad[1]),
    "0r": _weighted(lambda u, v, r: (u * v.grad[0] + u.grad[0] * v) / r),
    "00": _weighted(lambda u, v, r: u / r * v / r),
}


@dataclass(frozen=True)
class Axisymmetric(Body):
    """A body of revolution about x = 0 under unit pressure on its patch; integrals per radian."""

    @cached_property
    def load(self) -> Array:
        """Consistent nodal forces (2, n), (r; z), of the patch's pressure."""
        return self.pressed(lambda r: r)

    def stiffness(self, nu: float) -> csc_matrix:
        """Return lambda div u div v + 2 mu eps(u) : eps(v) in (r, z); unknowns (u_r; u_z)."""
        lam, mu = lame(nu)
        m = {name: form.assemble(self.basis).tocsc() for name, form in FORMS.items()}
        radial = (lam + 2 * mu) * (m["rr"] + m["00"]) + lam * m["0r"] + mu * m["zz"]
        mixed = lam * (m["rz"] + m["0z"]) + mu * m["rz"].T
        return bmat([[radial, mixed.T], [mixed, (lam + 2 * mu) * m["zz"] + mu * m["rr"]]], format="csc")

    def displacements(self, nu: float) -> Array:
        """Return (2, n) nodal displacements; on the outer boundary Boussinesq's of the resultant force."""
        nodes, axis = self.nodes_of(self.outer), self.nodes_of(self.axis)
        r, z = self.basis.doflocs[:, nodes]
        z = z - self.surface_level
        distance = np.hypot(r, z)
        strength = (1.0 + nu) * self.load[1].sum()  # (1 + nu) P / (2 pi E), the load being per radian
        u_r = strength * (r * z / distance**3 - (1.0 - 2.0 * nu) * r / (distance * (distance + z)))
        u_z = strength * (z**2 / distance**3 + 2.0 * (1.0 - nu) / distance)
        inner_axis = np.setdiff1d(axis, nodes)
        fixed = np.concatenate([nodes, self.basis.N + nodes, inner_axis])
        values = np.concatenate([u_r, u_z, np.zeros(len(inner_axis))])
        return solve_fixed(self.stiffness(nu), self.load.ravel(), fixed, values).reshape(2, -1)


def asperity(
    shape: Literal["cone", "paraboloid"], slope_deg: float, half_base: float, nu: float, *, offsets: ArrayLike
) -> WavyResult:
    """Return an asperity's axial surface displacements (into the body), patch at its tip.

    slope_deg: the cone's slope, or the paraboloid's at its rim; 0 to 45 degrees.
    half_base: radius of the base, a power of two >= 4.
    nu: -1 < nu < 0.5.
    offsets: (m,) radii >= 0; at 0 the self coefficient.
    Values are absolute (no datum needed) in units of p a / E; `flat` is exact.  Raises InputError.
    """
    where = np.atleast_1d(reals("offsets", offsets, "radii >= 0"))
    if not (0.0 <= real(slope_deg) <= 45.0 and -1.0 < real(nu) < 0.5):
        raise InputError("slope_deg, nu", (slope_deg, nu), "0 to 45 degrees, -1 < nu < 0.5")
    if not real(half_base) >= 4.0 or np.log2(half_base) % 1.0 or not np.all(where >= 0.0):
        raise InputError("half_base, offsets", (half_base, where), "a power of two >= 4, radii >= 0")
    boundary = (ridge_boundary if shape == "cone" else cap_boundary)(slope_deg, half_base)
    radius = OUTER * half_base

    def departure(part: float, level: int) -> Array:
        return _departure(boundary, half_base, part * radius, level, nu, where)

    radii = [departure(part, 1) for part in (0.25, 0.5, 1.0)]
    meshes = [radii[-1], departure(1.0, 2), departure(1.0, 3)]
    return WavyResult.of(where, circular_patch(where, nu), meshes, radii)


def body_on(boundary: Boundary, half_base: float, radius: float, level: int) -> Axisymmetric:
    """Return the mesh graded to the tip, the patch's rim and the foot of the asperity."""
    scale, centred = LEVELS[level]
    feet = ((0.0, 2.0**-4), (1.0, 2.0**-7), (half_base, half_base * 2.0**-5))
    sources = [Source(x, x, scale * size, scale) for x, size in feet]
    mesh = graded_mesh(sources, radius, centred=centred, quadrant=True)
    return Axisymmetric.on(mesh, bend(mesh, boundary), ORDER)


def _departure(
    boundary: Boundary, half_base: float, radius: float, level: int, nu: float, offsets: Array
) -> Array:
    """Return the rough minus flat u_z (m,) with the error both share removed; both absolute."""
    found = []
    for profile in (boundary, flat()):
        body = body_on(profile, half_base, radius, level)
        known = circular_patch(body.basis.doflocs[0] / profile.right, nu) * profile.right
        smooth = body.surface_values(body.displacements(nu)[1] - known, offsets)
        found.append(smooth + circular_patch(offsets / profile.right, nu) * profile.right)
    rough, smooth_flat = found
    return rough - smooth_flat
