"""Lay: coordinates in which roughness with a length along a lay and another across it is isotropic.

With x' along the lay and y' across it, ``x'^2 / lx^2 + y'^2 / ly^2 = A x^2 + 2 B x y + C y^2``. Completing
the square in x gives ``A (x + s y)^2 + D y^2`` with ``s = B / A`` and ``D = C - B^2 / A``. So an isotropic
field of unit length, evaluated at ``((x + s y) / a, y / b)`` with ``a = A^(-1/2)`` and ``b = D^(-1/2)``, has
the given lengths and lay exactly. Sums in these coordinates stay separable on a grid: along y first, then
along x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Lay:
    """Lengths ``along`` and ``across`` (m, or ratios), and the angle from x to the direction along (rad)."""

    along: float
    across: float
    angle: float

    @property
    def is_isotropic(self) -> bool:
        """True if both lengths are equal; the angle then has no effect."""
        return self.along == self.across

    @property
    def sheared(self) -> tuple[float, float, float]:
        """``(a, s, b)`` of the coordinates above; exact where both lengths are equal or the angle is 0."""
        cosine, sine, ratio = self._turn
        stretch = math.hypot(cosine, sine * ratio)
        shear = cosine * sine * (1.0 - ratio * ratio) / stretch / stretch
        return self.along / stretch, shear, self.across * stretch

    @property
    def on_axes(self) -> tuple[float, float]:
        """Lengths ``A^(-1/2), C^(-1/2)`` of the correlation along x and along y."""
        cosine, sine, ratio = self._turn
        return self.along / math.hypot(cosine, sine * ratio), self.along / math.hypot(sine, cosine * ratio)

    @property
    def extents(self) -> tuple[float, float]:
        """Half-widths along x and y of the ellipse with both lengths as semi-axes."""
        cosine, sine, _ = self._turn
        return (
            math.hypot(self.along * cosine, self.across * sine),
            math.hypot(self.along * sine, self.across * cosine),
        )

    @property
    def _turn(self) -> tuple[float, float, float]:
        angle = 0.0 if self.is_isotropic else self.angle
        return math.cos(angle), math.sin(angle), self.along / self.across
