"""Fig. 6: the effective pressure of a frictionless rough contact against Hertz and Greenwood-Tripp."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import t as student

import refimpl as rf
from refimpl.grid import Array
from verification.exact import greenwood_tripp as gt
from verification.reproduction.ensemble import CONFIDENCE
from verification.reproduction.printed import CORRELATION_LENGTH
from verification.reproduction.table1 import RADIUS, SMOOTH, hertz, rough

BIN = 25e-6  # m, width of an annulus: about 1/18 of the Hertz radius
NO_FRICTION = rf.Friction()


@dataclass(frozen=True)
class Profile:
    """Pressures (Pa) by annuli about the axis: mean over azimuth and realisations, with its 95 % half width.

    ``greenwood_tripp`` has the summits of Eq. (9); ``textbook`` the caption's alpha and Johnson's mu = 4.
    ``outside`` is the share of the load beyond the Hertz radius, one value per realisation.
    """

    r: Array
    pressure: Array
    half_width: Array
    greenwood_tripp: Array
    textbook: Array
    hertz: Array
    outside: Array

    def misfit(self, theory: Array) -> float:
        """Rms difference from a theory, weighted by area, over Hertz' peak."""
        return self._rms(self.pressure - theory)

    @property
    def without_roughness(self) -> float:
        """The misfit of Hertz' pressure from Greenwood and Tripp's."""
        return self._rms(self.hertz - self.greenwood_tripp)

    @property
    def misfit_of_half(self) -> float:
        """The misfit of half of Greenwood and Tripp's pressure from theirs, which should not pass."""
        return self._rms(self.greenwood_tripp / 2)

    @property
    def noise(self) -> float:
        """Contribution of sampling alone to a misfit: the rms standard error, weighted and scaled alike."""
        return self._rms(self.half_width / 2)

    def _rms(self, pressure: Array) -> float:
        square = np.sum(self.r * pressure**2) / np.sum(self.r)
        return float(np.sqrt(square)) / hertz().peak_pressure

    def load_share(self, curve: Array) -> float:
        """Load that a curve carries on the annuli, all of which lie in the domain, over the load."""
        areas = np.pi * BIN**2 * (2 * np.arange(len(curve)) + 1)
        return float(np.sum(areas * curve)) / SMOOTH.load

    def central(self, curve: Array) -> float:
        """Mean of a curve over the inner half of the Hertz circle, over that of Hertz' own pressure."""
        inner = self.r < hertz().contact_radius / 2
        return float(np.sum((self.r * curve)[inner]) / np.sum((self.r * self.hertz)[inner]))


def summits(rms: float) -> gt.RoughSphere:
    """Greenwood and Tripp's rough sphere with the summit statistics of Eq. (9)."""
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
    """The curve in Johnson 1985, Fig. 13.12: alpha from all heights, as in the caption, and mu."""
    _, _, radius = gt.gaussian_summits(rms, CORRELATION_LENGTH)
    density = mu * 3 / 8 / (rms * np.sqrt(2 * RADIUS * radius))
    return replace(summits(rms), summit_rms=rms, summit_density=float(density))


def contact(rms: float, realisation: int, grid: int) -> rf.Solution:
    """Frictionless contact with all the roughness on the flat, slopes neglected ("tips of asperities")."""
    scene = rough(rms, realisation=realisation, friction=NO_FRICTION)
    return rf.solve(scene, grid, oblique=False)


def effective_pressure(rms: float, realisations: int, grid: int) -> Profile:
    """The averaged pressure, and both theories at the same radii."""
    centres = SMOOTH.grid(grid).x - SMOOTH.lengths[0] / 2
    distance = np.hypot(centres[:, None], centres[None, :])
    ring = (distance / BIN).astype(int)
    rings = int(SMOOTH.lengths[0] / 2 / BIN)  # whole annuli only
    inside = ring < rings
    count = np.bincount(ring[inside], minlength=rings)
    radius = np.bincount(ring[inside], distance[inside], rings) / count
    means, outside, beyond = [], [], distance > hertz().contact_radius
    for k in range(realisations):
        pressure = contact(rms, k, grid).pressure
        means.append(np.bincount(ring[inside], pressure[inside], rings) / count)
        outside.append(pressure[beyond].sum() / pressure.sum())
    pressure, theory = np.array(means), gt.solve(summits(rms))
    edges = np.minimum(np.arange(rings + 1) * BIN / hertz().contact_radius, 1.0)
    load_between = -SMOOTH.load * np.diff((1 - edges**2) ** 1.5)  # Hertz' load on each annulus
    factor = student.ppf((1 + CONFIDENCE) / 2, realisations - 1) / np.sqrt(realisations)
    return Profile(
        r=radius,
        pressure=pressure.mean(axis=0),
        half_width=factor * pressure.std(axis=0, ddof=1),
        greenwood_tripp=theory.at(radius),
        textbook=gt.solve(textbook(rms)).at(radius),
        hertz=load_between / (np.pi * BIN**2 * (2 * np.arange(rings) + 1)),
        outside=np.array(outside),
    )
