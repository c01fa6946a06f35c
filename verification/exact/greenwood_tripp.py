"""Greenwood and Tripp's rough sphere: effective pressure of summits on a bulk that bends under their average.

Source: Greenwood and Tripp 1967, J. Appl. Mech. 34, 153; Johnson 1985, section 13.5. With d(r) the separation
from the mean plane of the summits (density eta, radius beta, Gaussian heights of rms sigma),

    p(r) = (4/3) eta E* beta^(1/2) sigma^(3/2) F(d/sigma),   F(z) = integral of t^(3/2) phi(z + t) dt, t > 0,
    d(r) = d0 + r^2/2R + u(r),   u(r) = 4/(pi E*) integral of p(s) s/(s + r) K(m) ds, m = 4 s r/(s + r)^2,

and 2 pi times the integral of p r dr is the load. Parameters: alpha = sigma R/a0^2 (a0 of Hertz) and mu =
(8/3) eta sigma (2 R beta)^(1/2). Gauss-Legendre panels with the logarithm integrated on its own: the error
falls spectrally.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import ArrayLike
from scipy.special import ellipkm1

from refimpl.errors import InputError
from refimpl.grid import Array
from verification.exact.hertz import Sphere

ORDER = 12  # nodes of a panel
UNCERTAINTY = 1e-9
"""Relative error of the pressure with 24 panels (change to 48 panels, measured in the tests for alpha from
0.02 to 2).
"""


@dataclass(frozen=True)
class RoughSphere:
    """``load`` (N), R (m), E* (Pa); summits: rms height (m), density (1/m^2), tip radius (m)."""

    load: float
    radius: float
    modulus: float
    summit_rms: float
    summit_density: float
    summit_radius: float

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not value > 0:
                raise InputError(name, value, "a positive number in SI units")

    @property
    def smooth(self) -> Sphere:
        """The Hertz contact of the same sphere without roughness."""
        return Sphere(self.load, self.radius, self.modulus)

    @property
    def alpha(self) -> float:
        """Summit rms over the Hertz approach."""
        return self.summit_rms / self.smooth.approach

    @property
    def mu(self) -> float:
        """(8/3) eta sigma (2 R beta)^(1/2); the pressure depends on it weakly."""
        return float(
            8 / 3 * self.summit_density * self.summit_rms * np.sqrt(2 * self.radius * self.summit_radius)
        )

    @property
    def stiffness(self) -> float:
        """Pressure (Pa) where F = 1: (4/3) eta E* beta^(1/2) sigma^(3/2)."""
        return float(
            4 / 3 * self.summit_density * self.modulus * np.sqrt(self.summit_radius * self.summit_rms**3)
        )


@dataclass(frozen=True)
class EffectivePressure:
    """Solution ``(n,)``: nodes ``r``, ``weights``, separation ``d`` (m), pressure ``p`` (Pa)."""

    r: Array
    weights: Array
    p: Array
    d: Array
    residual: float  # largest misfit of the separation equation over sigma

    @property
    def load(self) -> float:
        """2 pi times the integral of p r (N)."""
        return float(2 * np.pi * np.sum(self.weights * self.r * self.p))

    @property
    def effective_radius(self) -> float:
        """a* (m) = (3 pi/4) integral of r p over that of p: the contact radius of Hertz' pressure."""
        return float(3 * np.pi / 4 * np.sum(self.weights * self.r * self.p) / np.sum(self.weights * self.p))

    def at(self, r: ArrayLike) -> Array:
        """Return the pressure (Pa) at ``r`` (m), any shape, by the panels' polynomials; zero beyond them."""
        where = np.atleast_1d(np.asarray(r, dtype=float))
        panels = len(self.r) // ORDER
        end = float(np.sum(self.weights))
        index = np.minimum((where / end * panels).astype(int), panels - 1)
        local = 2 * (where / end * panels - index) - 1
        coefficients = (
            self.p.reshape(panels, ORDER) @ np.linalg.inv(legvander(leggauss(ORDER)[0], ORDER - 1)).T
        )
        value = np.einsum("...k,...k->...", legvander(local, ORDER - 1), coefficients[index])
        return np.where(where <= end, value, 0.0).reshape(np.shape(r))


def overlap_integral(z: Array, power: float) -> Array:
    """Return the integral over t > 0 of t^power phi(z + t), phi the standard normal density; shape of ``z``.

    In y = sqrt(t), which smooths half powers; cut where the density has fallen by exp(-40) below its largest.
    """
    nodes, weights = leggauss(100)
    z = np.asarray(z, dtype=float)[..., None]
    top = np.sqrt(np.sqrt(z**2 + 80) - z)
    y = top * (1 + nodes) / 2
    density = np.exp(-((z + y**2) ** 2) / 2) / np.sqrt(2 * np.pi)
    return np.asarray(np.sum(2 * y ** (2 * power + 1) * density * weights, axis=-1) * top[..., 0] / 2)


def solve(sphere: RoughSphere, panels: int = 24) -> EffectivePressure:
    """Solve by Newton's method for the separation at the nodes and d0; RuntimeError if not settled."""
    a0, sigma = sphere.smooth.contact_radius, sphere.summit_rms
    end = np.sqrt(2) * a0 + np.sqrt(2 * sphere.radius * sigma * 12)
    r, weights, kernel = _displacement_matrix(end, panels)
    kernel = kernel * 4 / (np.pi * sphere.modulus) * sphere.stiffness / sigma
    shape = r**2 / (2 * sphere.radius * sigma)
    ring = 2 * np.pi * r * weights * sphere.stiffness / sphere.load
    unknown = _first_guess(sphere, r)

    def misfit(state: Array) -> tuple[Array, Array]:
        z, z0 = state[:-1], state[-1]
        F = overlap_integral(z, 1.5)
        return np.append(z - z0 - shape - kernel @ F, np.log(ring @ F)), F

    error, F = misfit(unknown)
    for _ in range(100):
        slope = -1.5 * overlap_integral(unknown[:-1], 0.5)
        n = len(r)
        jacobian = np.zeros((n + 1, n + 1))
        jacobian[:n, :n] = np.eye(n) - kernel * slope
        jacobian[:n, n] = -1.0
        jacobian[n, :n] = ring * slope / (ring @ F)
        step = np.linalg.solve(jacobian, -error)
        step *= min(1.0, 2.0 / np.max(np.abs(step)))  # F is nearly exponential: no step beyond two sigma
        unknown = unknown + step
        error, F = misfit(unknown)
        if np.max(np.abs(step)) < 1e-11 * (1 + np.max(np.abs(unknown))):
            break
    else:
        raise RuntimeError(f"Greenwood-Tripp iteration left {np.max(np.abs(error))}")
    return EffectivePressure(
        r, weights, sphere.stiffness * F, unknown[:-1] * sigma, float(np.max(np.abs(error)))
    )


def _first_guess(sphere: RoughSphere, r: Array) -> Array:
    """Return separation over sigma at nodes, and d0: Hertz' pressure, Hertz' gap beyond it."""
    smooth = sphere.smooth
    table = np.linspace(10, -40, 2001)
    log_F = np.log(overlap_integral(table, 1.5))
    floor = 1e-3 * smooth.peak_pressure
    z = np.interp(np.log(np.maximum(smooth.pressure(r), floor) / sphere.stiffness), log_F, table)
    gap = np.maximum(0.0, smooth.displacement(r) + r**2 / (2 * sphere.radius) - smooth.approach)
    z = z + gap / sphere.summit_rms
    return np.append(z, z[0] - smooth.approach / sphere.summit_rms)


def _displacement_matrix(end: float, panels: int) -> tuple[Array, Array, Array]:
    """Return nodes, weights, and the matrix of the integral of p(s) s/(s + r) K(m) ds."""
    nodes, base = leggauss(ORDER)
    edges = np.linspace(0, end, panels + 1)
    half = end / panels / 2
    r = (edges[:-1, None] + half * (1 + nodes)).ravel()
    weights = np.tile(half * base, panels)
    to_legendre = np.linalg.inv(legvander(nodes, ORDER - 1))
    fine_nodes, fine_weights = leggauss(32)
    t, t_weights = (1 + fine_nodes) / 2, fine_weights / 2
    matrix = np.zeros((len(r), len(r)))
    for k in range(panels):
        columns = slice(k * ORDER, (k + 1) * ORDER)
        inside = np.clip(r, edges[k], edges[k + 1])[:, None]
        for far in (edges[k], edges[k + 1]):
            # s = start + (far - start) t^4: dense where the logarithm (or its neighbourhood) sits
            s = inside + (far - inside) * t**4
            ds = np.abs(far - inside) * 4 * t**3 * t_weights
            basis = legvander(np.clip((s - edges[k]) / half - 1, -1, 1), ORDER - 1) @ to_legendre
            matrix[:, columns] += np.einsum("iq,iqj->ij", _ring(s, r[:, None]) * ds, basis)
    return r, weights, matrix


def _ring(s: Array, r: Array) -> Array:
    """Return s/(s + r) K(m), with 1 - m = ((s - r)/(s + r))^2 free of cancellation."""
    return np.asarray(s / (s + r) * ellipkm1(((s - r) / (s + r)) ** 2))


def gaussian_summits(rms: float, correlation_length: float) -> tuple[float, float, float]:
    """Return the summit rms height (m), density (1/m^2) and mean tip radius (m) of a Gaussian isotropic
    surface of the ACF ``rms^2 exp(-2.3 (r/correlation_length)^2)`` (paper Eq. 9).

    Spectral moments m0 = rms^2, m2 = 2 c rms^2, m4 = 12 c^2 rms^2, c = 2.3/correlation_length^2, so Nayak's
    alpha is 3. Nayak 1971; Bush, Gibson and Keogh 1976; McCool 1986.
    """
    c = 2.3 / correlation_length**2
    m0, m2, m4 = rms**2, 2 * c * rms**2, 12 * c**2 * rms**2
    summit_rms = np.sqrt(m0 * (1 - 0.8968 * m2**2 / (m0 * m4)))
    return float(summit_rms), float(m4 / m2 / (6 * np.pi * np.sqrt(3))), float(3 / 8 * np.sqrt(np.pi / m4))
