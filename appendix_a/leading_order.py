"""Influence coefficient of a strip on a gentle slope: the first-order error, its cure, and the slope of 2 %.

Body y > s(x), unit pressure along the normal on the strip, plane strain, E = 1.  Expand about the flat
boundary.  The flat field has sigma_xx = sigma_yy = -1 under the strip, 0 beside it, and no shear.  On
y = s(x) this leaves, to first order in s, the shear (s sigma_xx)' + s' (s' on the strip alone), which is
s(a) delta(x - a) - s(-a) delta(x + a): two tangential point forces at the strip's ends.  A tangential force
Q shifts the surface normally by (1 + nu)(1 - 2 nu) Q / 2 ahead of it, and as much the other way behind it,
whatever the distance.  With the change
s u_y,y = -(1 + nu)(1 - 2 nu) s from evaluating on y = s(x) under the strip, all of it becomes one line:

    u(x) - u(0)  =  flat  -  (1 + nu)(1 - 2 nu) [s(clip(x, -a, a)) - s(0)]  +  second order in the slope.

So the first-order error depends on the facet alone and not on the waviness around it, does not decay with
distance in the plane, vanishes at nu = 1/2, and enters a pair as lower minus upper, like the coupling c.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.special import xlogy

Array = NDArray[np.float64]


def coupling(nu: float) -> float:
    """Return (1 + nu)(1 - 2 nu), twice the normal shift per tangential force (E = 1); 0 if incompressible."""
    return (1.0 + nu) * (1.0 - 2.0 * nu)


def first_order(height: Callable[[Array], Array], offsets: Array, nu: float) -> Array:
    """Return the first-order part (m,) of rough minus flat u(x) - u(0), in units of p a / E.

    height: profile s(x), into the body; offsets: (m,) horizontal distances from the strip's centre; in a.

    >>> float(first_order(lambda x: 0.1 * x, np.array([50.0]), nu=0.0)[0])
    -0.1
    """
    return -coupling(nu) * (height(np.clip(offsets, -1.0, 1.0)) - height(np.zeros_like(offsets)))


def facet_prediction(
    offsets: Array, nu: float, slope_deg: float, *, half_width: float | None = None
) -> Array:
    """Return u(x) - u(0) (m,) of a flat half-plane under the facet's exact tractions, in units of p a / E.

    A facet under pressure p passes, per projected area, p down and p tan(slope) uphill (+x is downhill).
    `half_width` is that of the loaded projection, cos(slope) by default: with it the prediction is exact
    on a plane slope.
    """
    a = math.cos(math.radians(slope_deg)) if half_width is None else half_width
    pressed = -2.0 * (1.0 - nu**2) / np.pi * _strip_profile(offsets, a)
    return pressed - math.tan(math.radians(slope_deg)) * coupling(nu) * np.clip(offsets, -a, a)


def plane_slope(offsets: Array, nu: float, slope_deg: float) -> Array:
    """Return the exact u(x) - u(0) (m,) on a plane at `slope_deg`: the flat solution in its frame.

    Along the slope the offset is x / cos; vertical is cos times the normal plus sin times the downhill part.
    """
    cosine, sine = math.cos(math.radians(slope_deg)), math.sin(math.radians(slope_deg))
    along = offsets / cosine
    normal = -2.0 * (1.0 - nu**2) / np.pi * _strip_profile(along, 1.0)
    return cosine * normal - sine * coupling(nu) * np.clip(along, -1.0, 1.0)


def slope_of_error(offset: float, nu: float, error: float = 0.02) -> float:
    """Return the slope (degrees) whose first-order error is `error` of the flat coefficient.

    >>> round(slope_of_error(2.0, 0.3), 1)  # the next element
    4.2
    """
    flat = 2.0 * (1.0 - nu**2) / np.pi * float(_strip_profile(np.array([offset]), 1.0)[0])
    reach = coupling(nu) * min(abs(offset), 1.0)
    return math.degrees(math.atan2(error * flat, reach))


def _strip_profile(x: Array, a: float) -> Array:
    """Return the integral of ln|x - t| - ln|t| over |t| < a."""
    profile: Array = xlogy(x + a, np.abs(x + a) / a) - xlogy(x - a, np.abs(x - a) / a)
    return profile
