"""First-order theory of the influence coefficient on a wavy surface, in three dimensions.

Body z < h(x, y), pressure p along the normal, E = 1, displacements w down. To first order in h the flat
boundary carries, besides p, the tangential traction q_b = d_a(h s_ab) + p d_b h, with the flat field's
surface stress

    s_ab = -2 nu p delta_ab - (1 - 2 nu) M_ab p,    M_ab = k_a k_b / k^2 in wavenumbers,

which outside the load is Boussinesq's +-(1 - 2 nu) P / (2 pi r^2) and has no counterpart in plane strain.
With Cerruti's K x / r^2 per unit tangential force, K = (1 + nu)(1 - 2 nu) / (2 pi), and the change of
level h dw/dz,

    w1 = K [grad ln r] * (p grad h)  +  2 pi (1 - 2 nu) K {h p - M : (h M p)}.

The first term is the facet's horizontal load, which [c_s] f tan(theta) restores. The second vanishes for a
shift and for a tilt of the surface. For a ridge of wavenumber k and a force P it is, for small k r (gamma
is Euler's),

    -(1 - 2 nu) K P kappa / 2 * [ln(2 / (k r)) - gamma + x^2 / r^2],

kappa = d^2 h / dx^2 midway between source and field (`wave_kernel` is real but for the phase of the
midpoint: reciprocity allows nothing else). Over Boussinesq's (1 - nu^2) P / (pi r) it grows like kappa r:
an error of first order in the slope that no facet correction sees, symmetric and in proportion to offset /
wavelength on a crest, antisymmetric and to (offset / wavelength)^2 on a flank. Zero at nu = 1/2.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.special import exp1

from appendix_a.fem3d.patch import tangential_coefficient
from appendix_a.fem3d.wavy import Kind, Waviness

Array = NDArray[np.float64]
GAUSS = 24  # points a side over the patch; 48 change no part by more than 1e-4 of itself


def _moment(distance: Array, pole: complex) -> NDArray[np.complex128]:
    """Integrate q exp(-q d) / (q + b) over q > 0, Re d >= 0: 1/d - b exp(b d) E1(b d)."""
    result: NDArray[np.complex128] = 1 / distance - pole * np.exp(pole * distance) * exp1(pole * distance)
    return result


def wave_kernel(x: Array, y: Array, wavenumber: float) -> NDArray[np.complex128]:
    """Invert the transform of sin^2(angle of k and k + k0), times exp(i k0 x); (x, y) != 0.

    That is exp(i k0 x) (2 pi)^-2 times the integral of k0^2 k_y^2 / (|k|^2 |k + k0|^2) exp(i k . x): done
    over k_x by residues it leaves, over k_y = q, q cos(q y) exp(-q |x|) / (k0 +- 2 i q), an exponential
    integral.
    """
    ahead = np.exp(1j * wavenumber * np.maximum(x, 0.0))
    behind = np.exp(1j * wavenumber * np.minimum(x, 0.0))
    depth = np.maximum(np.abs(x), 1e-9)  # on x = 0 the cut of E1 is approached from its side
    total = np.zeros(np.broadcast(x, y).shape, dtype=np.complex128)
    for side in (-1j, 1j):
        distance = depth + side * y
        total += ahead * _moment(distance, -0.5j * wavenumber) - behind * _moment(distance, 0.5j * wavenumber)
    return wavenumber / (8j * pi) * total


def waves(surface: Waviness) -> list[tuple[float, float, float]]:
    """Return (amplitude, k_x, k_y) of the surface's plane waves; an egg-box is two oblique ones."""
    k = surface.wavenumber
    if surface.kind is Kind.RIDGE:
        return [(surface.amplitude, k, 0.0)]
    return [(0.5 * surface.amplitude, k, k), (0.5 * surface.amplitude, k, -k)]


def facet_part(surface: Waviness, x: Array, y: Array, nu: float) -> Array:
    """Return [c] tan(theta) (m,): the slope under the centre, taken as that of the whole loaded element."""
    return surface.local_slope * tangential_coefficient(x, y, nu)


def far_part(surface: Waviness, x: Array, y: Array, nu: float) -> Array:
    """Return (m,) the rest of first order: the slope's variation, and the second term of w1."""
    nodes, weights = np.polynomial.legendre.leggauss(GAUSS)
    sx, sy = np.meshgrid(nodes, nodes, indexing="ij")
    area = np.outer(weights, weights)
    dx, dy = x[:, None, None] - sx, y[:, None, None] - sy
    slope_x, slope_y = surface.gradient(sx, sy)
    force = (1 + nu) * (1 - 2 * nu) / (2 * pi)
    tilting = ((slope_x - surface.local_slope) * dx + slope_y * dy) / (dx * dx + dy * dy)
    total: Array = force * np.sum(area * tilting, axis=(1, 2))
    for amplitude, kx, ky in waves(surface):
        k = float(np.hypot(kx, ky))
        kernel = wave_kernel((kx * dx + ky * dy) / k, (kx * dy - ky * dx) / k, k)
        phase = np.exp(1j * (kx * sx + ky * sy + 2 * pi * surface.position))
        total += 2 * pi * (1 - 2 * nu) * force * amplitude * np.sum(area * (phase * kernel).real, axis=(1, 2))
    return total


def first_order(surface: Waviness, x: Array, y: Array, nu: float) -> Array:
    """Return wavy minus flat displacement (m,) at (x, y), first order: `facet_part` + `far_part`."""
    return facet_part(surface, x, y, nu) + far_part(surface, x, y, nu)
