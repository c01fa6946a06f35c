"""First order in the slope: displacement of a wavy boundary under a strip of normal pressure.

Move the conditions on y = eta(x) to y = 0 (eta from the strip's centre level, a the half-width, p the
pressure on the strip and zero elsewhere). With equilibrium, ``d tau/dy = - d sigma_x/dx``, the first-order
field must carry

    tau_1 = d(eta sigma_x)/dx + p eta' = - eta dp/dx,        sigma_y1 = d(eta tau)/dx = 0      on y = 0,

as sigma_x = -p on a flat boundary: two tangential point forces at the strip's ends, ``p eta(-a)`` at -a and
``- p eta(a)`` at +a, and nothing else. A unit tangential force lifts or lowers a half-plane's boundary by
the constant ``(1+nu)(1-2nu)/(2E)`` on either side (Flamant). With the strain under the strip,
``-(1+nu)(1-2nu) p/E`` times eta, for reading the displacement on the wavy line, the whole first-order
change relative to the centre is

    u_wavy - u_flat = - (1+nu)(1-2nu) (p/E) eta(x clipped to the strip).

The boundary outside the strip has no first-order effect, at any distance: unloaded, it carries no stress to
tilt.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from appendix_a.errors import InputError, real, reals
from appendix_a.strip.field import flat_displacement
from appendix_a.strip.profile import Sinusoid

Real = NDArray[np.float64]


def first_order(
    slope_deg: float, wavelength: float, position: float, nu: float, *, offsets: ArrayLike
) -> tuple[Real, Real]:
    """Return (wavy, flat) displacements at ``offsets`` (m,), vertical, relative to the centre.

    Profile (A2) with maximum slope ``slope_deg``, the strip's centre at x = position * wavelength (crest 0,
    flank 0.25 with +x downhill, trough 0.5), unit pressure along the local normal; lengths in the strip's
    half-width a, displacements into the body in units of p a / E, plane strain. Correct to first order in
    the slope. Raises InputError.

    On a flank the neighbours downhill lose what the neighbours uphill gain:

    >>> wavy, flat = first_order(1.0, 1e4, 0.25, 0.3, offsets=[-3.0, 3.0])
    >>> [round(float(d), 4) for d in wavy - flat]
    [0.0091, -0.0091]
    """
    if not -1 < real(nu) <= 0.5:
        raise InputError("nu", nu, "a Poisson ratio, -1 < nu <= 0.5")
    profile = Sinusoid(slope_deg, wavelength, position)
    offsets = reals("offsets", offsets, "distances from the centre in half-widths")
    flat = flat_displacement(offsets, nu)
    return flat - (1 + nu) * (1 - 2 * nu) * profile.depth(np.clip(offsets, -1, 1)), flat
