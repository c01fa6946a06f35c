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

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array, Grid
from refimpl.model.materials import Material, Pair
from refimpl.model.slopes import Slopes

Complex = NDArray[np.complex128]
Vector = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class Contact:
    """A solved contact as the perturbation reads it; arrays have the grid's shape.

    heights : undeformed (lower, upper), upwards (m)
    displacements : into the (lower, upper) body (m)
    pressure, traction : f and r (Pa), r along ``direction`` on the lower body
    slopes : of the common surface
    facets_solved : the solution has the facet's tractions already (``slope_correction``)
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
        self.shape = grid.transform_shape
        dx, dy = grid.spacings
        kx = 2 * np.pi * scipy.fft.fftfreq(self.shape[0], dx)[:, None]
        ky = 2 * np.pi * scipy.fft.rfftfreq(self.shape[1], dy)[None, :]
        self.square = kx**2 + ky**2
        # first derivatives have no sign at the highest wavenumber of an even grid
        kx = np.where(np.abs(kx) < np.pi / dx * (1 - 1e-12), kx, 0.0)
        ky = np.where(np.abs(ky) < np.pi / dy * (1 - 1e-12), ky, 0.0)
        self.ik = (1j * kx, 1j * ky)
        E, nu = material.E, material.nu
        self.modulus = E
        self.coupling = (1 + nu) * (1 - 2 * nu) / E

    def recession(self, eta: Array, inward: Array) -> Array:
        """Return the first-order change of the displacement into the body at its surface (m)."""
        f, along, slopes = self.contact.pressure, self.contact.traction, self.contact.slopes
        cos, sin = np.cos(self.contact.direction), np.sin(self.contact.direction)
        q = (self.sign * cos * along, self.sign * sin * along)
        eta = self.contact.grid.about_datum(eta, f)
        u, strain, stress = self._surface_fields(f, q)
        pressure = -self._divergence((eta * q[0], eta * q[1])) + self._divergence((f * u[0], f * u[1]))
        shear = [
            self._divergence((eta * stress[i][0], eta * stress[i][1]))
            + self._divergence((q[i] * u[0], q[i] * u[1]))
            for i in (0, 1)
        ]
        if not self.contact.facets_solved:
            pressure -= along * slopes.tan_x
            facet = (f * slopes.tan_x, f * slopes.tan_y)
            shear[0] += self.sign * (cos * facet[0] - sin * facet[1])
            shear[1] += self.sign * (sin * facet[0] + cos * facet[1])
        nu, squeeze = self.material.nu, strain[0][0] + strain[1][1]
        lifted = eta * (self.coupling * f + nu * squeeze) / (1 - nu)
        rest = self.contact.grid.gradient(eta - inward)
        change: Array = (
            self._inward(pressure, (shear[0], shear[1])) + lifted + u[0] * rest[0] + u[1] * rest[1]
        )
        return change

    def _surface_fields(self, f: Array, q: Vector) -> tuple[Vector, list[list[Array]], list[list[Array]]]:
        """In-plane displacement (m), strain, and stress (Pa) of a half-space's surface under f and q."""
        E, nu, ik = self.modulus, self.material.nu, self.ik
        over_square = self._inverse(self.square)
        over_k = np.sqrt(over_square)
        pressed, sheared = self._to(f), [self._to(part) for part in q]
        divergence = ik[0] * sheared[0] + ik[1] * sheared[1]
        u = [
            self.coupling * over_square * ik[i] * pressed
            + 2 * (1 + nu) / E * over_k * (sheared[i] + nu * over_square * ik[i] * divergence)
            for i in (0, 1)
        ]
        strain = [[self._back(0.5 * (ik[i] * u[j] + ik[j] * u[i])) for j in (0, 1)] for i in (0, 1)]
        trace = strain[0][0] + strain[1][1]
        stress = [
            [
                E / (1 - nu**2) * ((1 - nu) * strain[i][j] + (i == j) * nu * trace)
                - (i == j) * nu / (1 - nu) * f
                for j in (0, 1)
            ]
            for i in (0, 1)
        ]
        return (self._back(u[0]), self._back(u[1])), strain, stress

    def _inward(self, pressure: Array, shear: Vector) -> Array:
        """Displacement into a half-space (m) under a pressure and a shear; no mean."""
        over_square = self._inverse(self.square)
        normal = 2 * (1 - self.material.nu**2) / self.modulus * np.sqrt(over_square) * self._to(pressure)
        divergence = self.ik[0] * self._to(shear[0]) + self.ik[1] * self._to(shear[1])
        return self._back(normal - self.coupling * over_square * divergence)

    def _divergence(self, flux: Vector) -> Array:
        return self._back(self.ik[0] * self._to(flux[0]) + self.ik[1] * self._to(flux[1]))

    def _to(self, values: Array) -> Complex:
        found: Complex = scipy.fft.rfft2(values, self.shape)
        return found

    def _back(self, transform: Complex) -> Array:
        nx, ny = self.contact.grid.shape
        found: Array = scipy.fft.irfft2(transform, self.shape)[:nx, :ny]
        return found

    @staticmethod
    def _inverse(square: Array) -> Array:
        """``1 / k^2``, without the mean."""
        return np.divide(1.0, square, out=np.zeros_like(square), where=square > 0)
