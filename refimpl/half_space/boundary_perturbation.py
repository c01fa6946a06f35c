"""First-order change of a half-space's displacements by its own undeformed surface.

A body ``z < eta(x)`` under pressure f and shear q, both per projected area, carries to first order in
``grad eta`` the tractions of a half-space and, at ``z = 0``, in addition

    shear     div(eta sigma_s)    with sigma_s the half-space's in-plane stress at its surface,
    pressure  -div(eta q),

because ``d_z sigma_iz = -d_j sigma_ij`` in equilibrium. Its surface lies ``eta`` above ``z = 0``, which adds
``-eta eps_zz`` to the displacement into the body. Three more terms of the same order belong to the contact:
the facet's tractions ``-q . grad H`` (down) and ``f grad H`` (along), with H the deformed surface; and
material points move along the surface by u_s, which carries pressures (``div(f u_s)``) and heights
(``u_s . grad(eta - w)``) with them. In the plane, at points that keep to the material and under a rigid flat,
together they are ``C (<eta f> + eta <f>)``, with ``C = (1 + nu)(1 - 2 nu) / E`` and means over a period:
symmetric between source and point, as Betti's theorem wants it.

Derived for this code from the expansion of the boundary condition about z = 0 (a boundary perturbation, as
Van Dyke 1975, section 2.4); in-plane fields of the half-space: Johnson 1985, sections 2.2 and 3.6.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array, Grid
from refimpl.model.materials import Material, Pair
from refimpl.model.slopes import Slopes

Complex = NDArray[np.complex128]
Vector = tuple[Array, Array]
Strains = tuple[Array, Array, Array]


@dataclass(frozen=True, eq=False)
class Contact:
    """A solved contact as the perturbation reads it; arrays have the grid's shape.

    heights : undeformed (lower, upper), upwards (m)
    displacements : into the (lower, upper) body (m)
    pressure, traction : f and r (Pa), r along ``direction`` on the lower body
    slopes : of the common surface
    facets_solved : the solution has the facet's tractions already (``slope_correction``)
    near : only changes in contact are wanted, to single precision: an empty margin of the contact's size does
    """

    grid: Grid
    pair: Pair
    heights: tuple[Array, Array]
    displacements: tuple[Array, Array]
    pressure: Array
    traction: Array
    slopes: Slopes
    direction: float
    facets_solved: bool = False
    near: bool = False

    @property
    def transform_shape(self) -> tuple[int, int]:
        """Shape of the fields' Fourier transforms: no image of the contact touches what is wanted."""
        return self.grid.transform_shape_near(self.pressure > 0) if self.near else self.grid.transform_shape


def gap_changes(contact: Contact) -> tuple[Array, Array]:
    """Return how far the lower and the upper surface recede at the same tractions, beyond the model (m)."""
    found = []
    bodies = (contact.pair.lower, contact.pair.upper)
    for material, sign, height, inward in zip(
        bodies, (1.0, -1.0), contact.heights, contact.displacements, strict=True
    ):
        if material.is_rigid:
            found.append(contact.grid.zeros)
        else:
            found.append(_Body(contact, material, sign).recession(sign * height, inward))
    return found[0], found[1]


class _Body:
    """One elastic body in its own frame: heights out of the body, displacements into it."""

    def __init__(self, contact: Contact, material: Material, sign: float) -> None:
        self.contact, self.material, self.sign = contact, material, sign
        grid = contact.grid
        self.shape = contact.transform_shape
        self.real = np.float32 if contact.near else np.float64
        dx, dy = grid.spacings
        kx = 2 * np.pi * scipy.fft.fftfreq(self.shape[0], dx)[:, None]
        ky = 2 * np.pi * scipy.fft.rfftfreq(self.shape[1], dy)[None, :]
        square = kx**2 + ky**2
        self.over_square = np.divide(1.0, square, out=np.zeros_like(square), where=square > 0)
        # first derivatives have no sign at the highest wavenumber of an even grid
        kx = np.where(np.abs(kx) < np.pi / dx * (1 - 1e-12), kx, 0.0)
        ky = np.where(np.abs(ky) < np.pi / dy * (1 - 1e-12), ky, 0.0)
        self.over_square = self.over_square.astype(self.real)
        self.ik = tuple(np.multiply(1j, k.astype(self.real)) for k in (kx, ky))
        E, nu = material.E, material.nu
        self.modulus = E
        self.coupling = (1 + nu) * (1 - 2 * nu) / E

    def recession(self, eta: Array, inward: Array) -> Array:
        """Return the first-order change of the displacement into the body at its surface (m)."""
        f, along, direction = self.contact.pressure, self.contact.traction, self.contact.direction
        q = self.sign * math.cos(direction) * along, self.sign * math.sin(direction) * along
        eta = self.contact.grid.about_datum(eta, f)
        u, (xx, yy, xy) = self._surface_fields(self._to(f), self._to(along))
        xy_stress = eta * self.modulus / (1 + self.material.nu) * xy
        pressure = self._divergence(f * u[0] - eta * q[0], f * u[1] - eta * q[1])
        shear = [
            self._divergence(eta * self._stress(xx, yy, f) + q[0] * u[0], xy_stress + q[0] * u[1]),
            self._divergence(xy_stress + q[1] * u[0], eta * self._stress(yy, xx, f) + q[1] * u[1]),
        ]
        if not self.contact.facets_solved:
            facet_pressure, facet_shear = self._facets(f, along)
            pressure += facet_pressure
            shear = [own + facet for own, facet in zip(shear, facet_shear, strict=True)]
        nu = self.material.nu
        lifted = eta * (self.coupling * f + nu * (xx + yy)) / (1 - nu)
        rest = self.contact.grid.gradient(eta - inward)
        return np.asarray(self._inward(pressure, shear) + lifted + u[0] * rest[0] + u[1] * rest[1])

    def _facets(self, f: Array, along: Array) -> tuple[Array, Vector]:
        """Return the pressure and shear of the facets' tractions that the solution does not have (Pa)."""
        slopes, direction = self.contact.slopes, self.contact.direction
        cos, sin = self.sign * math.cos(direction), self.sign * math.sin(direction)
        ahead, across = f * slopes.tan_x, f * slopes.tan_y
        return -along * slopes.tan_x, (cos * ahead - sin * across, sin * ahead + cos * across)

    def _surface_fields(self, pressed: Complex, sheared: Complex) -> tuple[Vector, Strains]:
        """Return in-plane displacements (m) and strains xx, yy, xy of the surface under f and r."""
        E, nu, ik, direction = self.modulus, self.material.nu, self.ik, self.contact.direction
        towards = self.sign * math.cos(direction), self.sign * math.sin(direction)
        over_k = np.sqrt(self.over_square)
        divergence = (towards[0] * ik[0] + towards[1] * ik[1]) * sheared
        along_k = self.over_square * (self.coupling * pressed + 2 * (1 + nu) / E * nu * over_k * divergence)
        sheared = 2 * (1 + nu) / E * over_k * sheared
        u = [ik[i] * along_k + towards[i] * sheared for i in (0, 1)]
        strains = ik[0] * u[0], ik[1] * u[1], 0.5 * (ik[0] * u[1] + ik[1] * u[0])
        xx, yy, xy = (self._back(strain) for strain in strains)
        return (self._back(u[0]), self._back(u[1])), (xx, yy, xy)

    def _stress(self, strain: Array, other: Array, f: Array) -> Array:
        """Return the in-plane normal stress (Pa) along the axis of ``strain``, at the surface under f."""
        nu = self.material.nu
        return np.asarray(self.modulus / (1 - nu**2) * (strain + nu * other) - nu / (1 - nu) * f)

    def _inward(self, pressure: Array, shear: list[Array]) -> Array:
        """Return the displacement into a half-space (m) under a pressure and a shear; no mean."""
        normal = 2 * (1 - self.material.nu**2) / self.modulus * np.sqrt(self.over_square) * self._to(pressure)
        divergence = self.ik[0] * self._to(shear[0]) + self.ik[1] * self._to(shear[1])
        return self._back(normal - self.coupling * self.over_square * divergence)

    def _divergence(self, along_x: Array, along_y: Array) -> Array:
        return self._back(self.ik[0] * self._to(along_x) + self.ik[1] * self._to(along_y))

    def _to(self, values: Array) -> Complex:
        return np.asarray(scipy.fft.rfft2(values.astype(self.real, copy=False), self.shape))

    def _back(self, transform: Complex) -> Array:
        nx, ny = self.contact.grid.shape
        return np.asarray(scipy.fft.irfft2(transform, self.shape)[:nx, :ny])
