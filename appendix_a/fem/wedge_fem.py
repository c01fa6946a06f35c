"""Wedge tip on a half-plane, pressed on both faces near the tip (paper, Fig. 13), by finite elements."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from appendix_a.errors import InputError, real, reals
from appendix_a.fem.departure import Departures, Setup, departure
from appendix_a.fem.geometry import ridge_boundary
from appendix_a.fem.mesh import Source
from appendix_a.fem.result import WavyResult

OUTER = 128.0  # outer radius over half base; a quarter of it is the smallest of the three radii


def setup_for(half_base: float, radius: float) -> Setup:
    """Return mesh parameters: graded to the strip's ends, the tip and the feet of the wedge."""
    foot = half_base / 64
    fine = ((-half_base, foot), (-1.0, 2.0**-7), (0.0, 2.0**-5), (1.0, 2.0**-7), (half_base, foot))
    return Setup(tuple(Source(x, x, size, 1.0) for x, size in fine), radius)


def wedge_tip(slope_deg: float, half_base: float, nu: float, *, offsets: ArrayLike) -> WavyResult:
    """Return a wedge tip's displacements, unit pressure on 0 < r < a of both faces, plane strain.

    slope_deg: slope of the faces, 0 to 45 degrees.
    half_base: half the wedge's base over a, a power of two >= 4.
    nu: -1 < nu <= 0.5.
    offsets: (m,) horizontal distances from the tip in units of a.
    Raises InputError.
    """
    where = np.atleast_1d(reals("offsets", offsets, "distances from the tip in half-widths"))
    if not 0.0 <= real(slope_deg) <= 45.0:
        raise InputError("slope_deg", slope_deg, "0 to 45 degrees")
    if not real(half_base) >= 4.0 or np.log2(half_base) % 1.0:
        raise InputError("half_base", half_base, "a power of two, at least 4 half-widths")
    if not -1.0 < real(nu) <= 0.5:
        raise InputError("nu", nu, "a Poisson ratio, -1 < nu <= 0.5")
    if not np.all(np.abs(where) < OUTER * half_base / 8):
        raise InputError("offsets", where, f"finite, less than {OUTER / 8:g} half bases from the tip")
    boundary = ridge_boundary(slope_deg, half_base)
    setups = [setup_for(half_base, OUTER * half_base * part) for part in (0.25, 0.5, 1.0)]
    radii = [departure(setup, 1, boundary, where) for setup in setups]
    meshes = [radii[-1], *(departure(setups[-1], level, boundary, where) for level in (2, 3))]
    return Departures(where, tuple(meshes), tuple(radii)).result(nu)
