"""Motion of a contact's edge when its pressures change, from the pressures alone.

Pressure falls off as ``k sqrt(d)`` at a distance d from an edge, so an edge that moves by V changes it by
``k V / (2 sqrt d)``, and the relative change of the outermost elements, ``df / f = V / (2 d)``, beyond that
of the elements inside, measures V up to one factor, which a change whose area is known gives.
"""

from __future__ import annotations

import math

import numpy as np
import scipy

from refimpl.grid import Array
from refimpl.sensitivities.fixed_contact import FixedContact

_WIDTHS = 5, 9  # elements over which the change at an edge is compared with that inside


class EdgeMotion:
    """Motion of the contact's edge, calibrated by the load: the area's derivative from a pressure's."""

    def __init__(self, fixed: FixedContact, over_load: tuple[float, float], loaded: Array) -> None:
        self.fixed = fixed
        wrapped = np.pad(fixed.contact, 1, mode=fixed.problem.grid.continuation)
        self.elements = (wrapped & ~scipy.ndimage.binary_erosion(wrapped, border_value=1))[1:-1, 1:-1]
        derivative, counted = over_load
        self.everywhere = np.ones(fixed.contact.shape)
        self.factors = [
            derivative / growth if (growth := self._growth(loaded, size)) else 0.0 for size in _WIDTHS
        ]
        self.counted = counted / abs(derivative) if derivative else 0.0

    def derivative(self, pressure: Array) -> tuple[float, float]:
        """Return ``dA/dp`` (m^2 a unit) and its scatter for a derivative of the pressures."""
        near, far = (
            factor * self._growth(pressure, size) for factor, size in zip(self.factors, _WIDTHS, strict=True)
        )
        return near, math.hypot(self.counted * near, near - far)

    def _growth(self, pressure: Array, size: int) -> float:
        """Sum the relative change along the edge, less that of all ``size x size`` elements around."""
        mode = self.fixed.problem.grid.continuation

        def ratio(where: Array, width: int) -> Array:
            change, level = (
                scipy.ndimage.uniform_filter(where * field, width, mode=mode)[self.elements]
                for field in (pressure, self.fixed.pressure)
            )
            return np.asarray(change / level)

        return float(np.sum(ratio(self.elements.astype(np.float64), 3) - ratio(self.everywhere, size)))
