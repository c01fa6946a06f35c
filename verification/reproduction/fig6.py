"""Fig. 6: the effective pressure of a frictionless rough contact against Hertz and Greenwood-Tripp."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.exact import greenwood_tripp as gt
from verification.reproduction.ensemble import CONFIDENCE
from verification.reproduction.printed import CORRELATION_LENGTH
from verification.reproduction.table1 import RADIUS, SMOOTH, hertz, rough

RINGS = 16  # rings of equal area, to half the side of the domain; the innermost is a disc of 0.45 Hertz radii
RESAMPLES, RESAMPLING_SEED = 4000, 6
NO_FRICTION = rf.Friction()


@dataclass(frozen=True)
class Profile:
    """Pressures (Pa) by rings of equal area about the axis: means over each ring.

    ``surfaces`` has a row per realisation, ``low`` and ``high`` bound the 95 % interval of their mean.
    ``greenwood_tripp`` has the summits of Eq. (9); ``textbook`` the caption's alpha and Johnson's mu = 4.
    ``r`` (m) are mean radii, ``outside`` is the share of the load beyond the Hertz radius by realisation.
    """

    r: Array
    surfaces: Array
    low: Array
    high: Array
    greenwood_tripp: Array
    textbook: Array
    hertz: Array
    outside: Array

    @property
    def pressure(self) -> Array:
        """Mean over realisations."""
        return np.asarray(self.surfaces.mean(axis=0))

    def misfit(self, theory: Array) -> float:
        """Return the rms difference from a theory by area, over Hertz' peak."""
        return _rms(self.pressure - theory)

    @property
    def without_roughness(self) -> float:
        """The misfit of Hertz' pressure from Greenwood and Tripp's."""
        return _rms(self.hertz - self.greenwood_tripp)

    @property
    def noise(self) -> float:
        """Contribution of sampling alone to a misfit: the rms standard error."""
        return _rms(self.surfaces.std(axis=0, ddof=1) / np.sqrt(len(self.surfaces)))

    @property
    def empty(self) -> float:
        """Share of realisations without contact in the innermost ring."""
        return float(np.mean(self.surfaces[:, 0] == 0))

    def farthest(self, theory: Array) -> float:
        """Return the largest difference of a ring's mean from a theory, over Hertz' peak."""
        return float(np.abs(self.pressure - theory).max()) / hertz().peak_pressure

    def load_share(self, curve: Array) -> float:
        """Load that a curve carries on the rings, all of which lie in the domain, over the load."""
        return float(curve.mean()) * np.pi * (SMOOTH.lengths[0] / 2) ** 2 / SMOOTH.load


def _rms(pressure: Array) -> float:
    return float(np.sqrt(np.mean(pressure**2))) / hertz().peak_pressure


def interval(samples: Array) -> tuple[Array, Array]:
    """Return the 95 % interval of the mean over the first axis by the percentile bootstrap (Efron 1979).

    Where contact is rare a ring's pressure is mostly zero and far from normal; this interval ends at zero.
    """
    rng = np.random.default_rng(RESAMPLING_SEED)
    counts = rng.multinomial(len(samples), np.full(len(samples), 1 / len(samples)), RESAMPLES)
    low, high = np.quantile(counts @ samples / len(samples), [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2], 0)
    return low, high


def summits(rms: float) -> gt.RoughSphere:
    """Return Greenwood and Tripp's rough sphere with the summit statistics of Eq. (9)."""
    height, density, radius = gt.gaussian_summits(rms, CORRELATION_LENGTH)
    return gt.RoughSphere(
        load=SMOOTH.load,
        radius=RADIUS,
        modulus=SMOOTH.materials.reduced_modulus,
        summit_rms=height,
        summit_density=density,
        summit_radius=radius,
    )


def textbook(rms: float, mu: float = 4.0) -> gt.RoughSphere:
    """Return the curve in Johnson 1985, Fig. 13.12: alpha from all heights, as in the caption, and mu."""
    _, _, radius = gt.gaussian_summits(rms, CORRELATION_LENGTH)
    density = mu * 3 / 8 / (rms * np.sqrt(2 * RADIUS * radius))
    return replace(summits(rms), summit_rms=rms, summit_density=float(density))


def contact(rms: float, realisation: int, grid: int) -> rf.Solution:
    """Return frictionless contact, all roughness on the flat, no slopes ("tips of asperities")."""
    scene = rough(rms, realisation=realisation, friction=NO_FRICTION)
    return rf.solve(scene, grid, oblique=False)


def effective_pressure(rms: float, first: int, realisations: int, grid: int) -> Profile:
    """Return pressures by ring from realisation ``first`` on, and both theories' there."""
    centres = SMOOTH.grid(grid).x - SMOOTH.lengths[0] / 2
    distance = np.hypot(centres[:, None], centres[None, :])
    ring = (RINGS * (2 * distance / SMOOTH.lengths[0]) ** 2).astype(int)
    inside = ring < RINGS
    count = np.bincount(ring[inside])

    def by_ring(field: Array) -> Array:
        return np.bincount(ring[inside], field[inside]) / count

    def averaged(theory: gt.EffectivePressure) -> Array:
        values, which = np.unique(distance, return_inverse=True)
        return by_ring(theory.at(values)[which].reshape(distance.shape))

    solved = [contact(rms, first + k, grid).pressure for k in range(realisations)]
    surfaces = np.array([by_ring(pressure) for pressure in solved])
    beyond, (low, high) = distance > hertz().contact_radius, interval(surfaces)
    return Profile(
        r=by_ring(distance),
        surfaces=surfaces,
        low=low,
        high=high,
        greenwood_tripp=averaged(gt.solve(summits(rms))),
        textbook=averaged(gt.solve(textbook(rms))),
        hertz=by_ring(hertz().pressure(distance)),
        outside=np.array([pressure[beyond].sum() / pressure.sum() for pressure in solved]),
    )
