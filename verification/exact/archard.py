"""Archard's area-load powers: a sphere, a sphere covered with spheres, and so on (2/3, 8/9, 26/27, towards
1).

Source: Archard 1957, Proc. R. Soc. A 243, 190. Level k replaces each Hertz contact by a Hertz pressure that
is carried by ``density`` small spheres per unit area, each in Hertz contact under pressure/density; all
levels without interaction. The area is A = c P^e; a level turns (c, e) of the small sphere into (c', 1 + (e -
1)/3), because p varies as P^(1/3).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad

UNCERTAINTY = 1e-14
"""Relative error of the closed forms: rounding only."""


@dataclass(frozen=True)
class Hierarchy:
    """Sphere radii from large to small (m), the small ones' densities (1/m^2), reduced ``modulus`` E* (Pa).

    >>> smooth, once, twice = (Hierarchy((1.0, 1e-2, 1e-4)[:n], (1e6, 1e10)[: n - 1], 1e9) for n in (1, 2, 3))
    >>> [round(level.exponent * 27) for level in (smooth, once, twice)]      # 2/3, 8/9, 26/27
    [18, 24, 26]
    """

    radii: Sequence[float]
    densities: Sequence[float]
    modulus: float

    @property
    def exponent(self) -> float:
        """e of A = c P^e: 1 - 3^-n for n sizes."""
        return 1 - 3.0 ** -len(self.radii)

    def area(self, load: float) -> float:
        """True area (m^2) at ``load`` (N), in closed form, from the smallest size upwards."""
        exponent, factor = 2 / 3, np.pi * (3 * self.radii[-1] / (4 * self.modulus)) ** (2 / 3)
        for radius, density in zip(self.radii[-2::-1], self.densities[::-1], strict=True):
            # integral over the Hertz disc of m factor (p/m)^e: p0^e pi a^2 2/(2 + e)
            a2 = (3 * radius / (4 * self.modulus)) ** (2 / 3)  # contact radius squared at unit load
            peak = 3 / (2 * np.pi * a2)
            factor = density ** (1 - exponent) * factor * peak**exponent * np.pi * a2 * 2 / (2 + exponent)
            exponent = (exponent + 2) / 3
        return float(factor * load**exponent)

    def area_by_quadrature(self, load: float) -> float:
        """Compute the area (m^2) by integrating each level's Hertz pressure numerically."""
        a = (3 * load * self.radii[0] / (4 * self.modulus)) ** (1 / 3)
        if len(self.radii) == 1:
            return float(np.pi * a**2)
        small = Hierarchy(self.radii[1:], self.densities[1:], self.modulus)
        density = self.densities[0]

        def ring(s: float) -> float:
            """With r = a sqrt(1 - s^2) the pressure is p0 s, and r dr = a^2 s ds."""
            pressure = 3 * load / (2 * np.pi * a**2) * s
            return float(2 * np.pi * a**2 * s * density * small.area_by_quadrature(pressure / density))

        return float(quad(ring, 0, 1, epsabs=0, epsrel=1e-9)[0])

    @property
    def doubling(self) -> float:
        """Area at twice the load over area: 2^e."""
        return float(2**self.exponent)
