"""Estimates of a rough contact from its spectrum alone, to be held against a solved one.

- Persson 2001 (J. Chem. Phys. 115, 3840): ``A / A0 = erf(sqrt(2) p / (E* g))``, g the rms gradient.
- Greenwood and Williamson 1966 (Proc. R. Soc. A 295, 300) with the summits of an isotropic Gaussian surface,
  from the mean squares m0, m2, m4 of heights, slopes and curvatures along a line (McCool 1986, Wear 107, 37):
  density ``m4 / (6 pi sqrt(3) m2)``, radius ``3/8 sqrt(pi / m4)``, spread ``sqrt(m0 (1 - 0.8968 m2^2 / (m0
  m4)))``.

Both are elastic, without friction, and for nominally flat bodies: A0 is the domain.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import scipy

from refimpl.grid import Array, Grid
from refimpl.scene.scene import Scene
from refimpl.surfaces import Flat, Sphere

_FINE = 768  # elements along the longer side at least; differences of neighbours err by 1 % of shortest waves
_FARTHEST = 12.0  # spreads between the planes: areas are below 1e-30 of A0 from there on


@dataclass(frozen=True)
class Roughness:
    """Mean squares along a line of heights (m^2), slopes and curvatures (1/m^2), the mean of both axes'."""

    m0: float
    m2: float
    m4: float

    @classmethod
    def of(cls, z: Array, spacings: tuple[float, float]) -> Roughness:
        """Return those of heights (m), missing ones NaN, by differences of neighbours."""
        rises, bends = [], []
        for axis, spacing in enumerate(spacings):
            rises.append(np.nanmean((np.diff(z, axis=axis) / spacing) ** 2))
            bends.append(np.nanmean((np.diff(z, 2, axis=axis) / spacing**2) ** 2))
        return cls(float(np.nanvar(z)), float(np.mean(rises)), float(np.mean(bends)))

    @property
    def rms_gradient(self) -> float:
        """Root mean square of |grad z|."""
        return math.sqrt(2 * self.m2)


def persson_share(pressure: float, roughness: Roughness, modulus: float) -> float:
    """Return A/A0 by Persson at a nominal pressure and E* (Pa).

    >>> round(persson_share(1e6, Roughness(1e-12, 0.005, 1e8), 1e9), 5)  # light: sqrt(8 / pi) p / (E* g)
    0.01596
    """
    return math.erf(math.sqrt(2) * pressure / (modulus * roughness.rms_gradient))


def greenwood_williamson_share(pressure: float, roughness: Roughness, modulus: float) -> float:
    """Return A/A0 by Greenwood and Williamson at a nominal pressure and E* (Pa), 1 at most."""
    m0, m2, m4 = roughness.m0, roughness.m2, roughness.m4
    density, radius = m4 / (6 * math.pi * math.sqrt(3) * m2), 0.375 * math.sqrt(math.pi / m4)
    spread = math.sqrt(m0 * max(1 - 0.8968 * m2**2 / (m0 * m4), 0.0))
    full = 4 / 3 * modulus * density * math.sqrt(radius) * spread**1.5

    def misfit(distance: float) -> float:
        return float(full * summits(1.5, distance) - pressure)

    if misfit(-_FARTHEST) <= 0:
        return 1.0
    distance = 0.0 if spread == 0 else float(scipy.optimize.brentq(misfit, -_FARTHEST, _FARTHEST))
    return min(1.0, math.pi * density * radius * spread * summits(1.0, distance))


def summits(power: float, distance: float) -> float:
    """Return the mean of ``(s - distance)^power`` over standard normal s above it (Greenwood-Williamson's F).

    >>> round(summits(1.0, 0.0) * math.sqrt(2 * math.pi), 9)
    1.0
    """

    def density(t: float) -> float:
        return float(t**power * math.exp(-0.5 * (distance + t) ** 2))

    top = max(-distance, 0.0)
    found, _ = scipy.integrate.quad(density, 0.0, top + 12.0, points=[top] if top else None)
    return float(found) / math.sqrt(2 * math.pi)


@dataclass(frozen=True)
class Estimate:
    """Real contact area (m^2) and mean contact pressure (Pa) of a theory, at a nominal pressure (Pa)."""

    theory: str
    area: float
    mean_pressure: float
    nominal_pressure: float


def estimates(load: float, nominal_area: float, roughness: Roughness, modulus: float) -> tuple[Estimate, ...]:
    """Return both theories' contact under a load (N) on A0 (m^2) at E* (Pa); empty without roughness."""
    if not (load > 0 and roughness.m2 > 0 and roughness.m4 > 0):
        return ()
    nominal = load / nominal_area
    shares = {
        "Persson": persson_share(nominal, roughness, modulus),
        "Greenwood-Williamson": greenwood_williamson_share(nominal, roughness, modulus),
    }
    return tuple(
        Estimate(name, share * nominal_area, nominal / share, nominal)
        for name, share in shares.items()
        if share > 0
    )


def estimates_of(scene: Scene, grid: Grid) -> tuple[Estimate, ...]:
    """Return the estimates of a nominally flat scene's roughness, none of others.

    Roughness is sampled on the grid, or more finely without points of data: a coarse grid misses slopes.
    """
    if scene.curvature != 0 or min(grid.shape) < 3:  # no curvatures
        return ()
    if scene.pitch is None:
        grid = scene.grid([n * math.ceil(_FINE / max(grid.shape)) for n in grid.shape])
    gap = sum(_rough(scene, "upper", grid), grid.zeros) - sum(_rough(scene, "lower", grid), grid.zeros)
    roughness, modulus = Roughness.of(gap, grid.spacings), scene.materials.reduced_modulus
    return estimates(scene.load, grid.nominal_area, roughness, modulus)


def _rough(scene: Scene, body: str, grid: Grid) -> Iterable[Array]:
    return (part.sample(grid) for part in scene.parts(body) if not isinstance(part, Sphere | Flat))
