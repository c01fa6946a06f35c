"""Strip of pressure on a sinusoidal boundary: surface displacement and its error (paper, Fig. 12)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from appendix_a.errors import InputError, real, reals
from appendix_a.fem.departure import Departure, Departures, Setup, departure
from appendix_a.fem.geometry import sinusoid_boundary
from appendix_a.fem.mesh import Source
from appendix_a.fem.result import WavyResult

Array = NDArray[np.float64]
END_SIZE = 2.0**-7  # cell at the strip's ends; 2^-10 changes displacements by less than 1e-4 % of flat
REACH = 3.0  # wavelengths kept on either side; 4 and 8 change less than 0.001 % of flat
OFFSETS = "a list of finite distances, at most 10000 half-widths"
OUTER = 8.0  # outer boundary over reach; 64 changes less than 0.001 % of flat
REACHES = (0.5, 0.5**0.5, 1.0)  # the three outer radii, in units of the one used
LEVELS = (1, 2, 3)  # the three meshes, coarse to fine; the coarsest on every radius
SOLVES = len(REACHES) + len(LEVELS) - 1


def sinusoid(
    slope_deg: float,
    wavelength: float,
    position: float,
    nu: float,
    *,
    offsets: ArrayLike,
    progress: Callable[[], None] | None = None,
) -> WavyResult:
    """Return displacements of profile (A2) under uniform p along the local normal, plane strain.

    slope_deg: maximum slope of y = 2 h_a sin^2(pi x / lambda), y into the body, so that its tangent is
        2 pi h_a / lambda; 0 to 45 degrees.
    wavelength: lambda / a, 4 to 10^4; a is half the strip's width measured along the surface.
    position: x / lambda of the strip's centre: crest 0, flank 0.25 (+x downhill), valley 0.5.
    nu: Poisson's ratio, -1 < nu <= 0.5.
    offsets: (m,) horizontal distances from the centre in units of a, at most 10^4.
    progress: called after each of the `SOLVES` solves: far offsets take a quarter of a minute and more.
    Raises InputError.
    """
    if not -1.0 < real(nu) <= 0.5:
        raise InputError("nu", nu, "a Poisson ratio, -1 < nu <= 0.5")
    return departures(slope_deg, wavelength, position, offsets, progress=progress).result(nu)


def departures(
    slope_deg: float,
    wavelength: float,
    position: float,
    offsets: ArrayLike,
    levels: Sequence[int] = LEVELS,
    *,
    progress: Callable[[], None] | None = None,
) -> Departures:
    """Return `sinusoid` for every Poisson ratio at once; `levels` are the three meshes, coarse to fine.

    >>> r = departures(6.5, 100.0, 0.25, [-3.0, 3.0], levels=(0, 0, 0)).result(nu=0.3)
    >>> ((r.wavy - r.flat) / r.flat * 100).round(1).tolist()  # percent: uphill less, downhill more
    [-2.8, 2.1]
    """
    where = np.atleast_1d(reals("offsets", offsets, OFFSETS))
    _check(slope_deg, wavelength, position, where)
    # fading waves must not touch the outermost offset at half the reach either: it begins at reach / 4 there
    reach = max(REACH * wavelength, 4.0 * float(np.max(np.abs(where), initial=1.0)))

    def solved(radius: float, level: int) -> Departure:
        boundary = sinusoid_boundary(slope_deg, wavelength, position, radius)
        found = departure(setup_for(wavelength, radius), level, boundary, where)
        if progress is not None:
            progress()
        return found

    radii = [solved(part * reach, levels[0]) for part in REACHES]
    meshes = [radii[-1], *(solved(reach, level) for level in levels[1:])]
    return Departures(where, tuple(meshes), tuple(radii))


def setup_for(wavelength: float, reach: float) -> Setup:
    """Return mesh parameters: graded to the strip's ends, lambda / 8 near it and lambda / 4 far."""
    ends = [Source(end, end, END_SIZE, 1.0) for end in (-1.0, 1.0)]
    near = min(reach, 1.5 * wavelength)
    waves = [Source(-near, near, wavelength / 8, 1.0), Source(-reach, reach, wavelength / 4, 1.0)]
    return Setup((*ends, *waves), float(2.0 ** np.ceil(np.log2(OUTER * reach))))


def _check(slope_deg: float, wavelength: float, position: float, offsets: Array) -> None:
    if not 0.0 <= real(slope_deg) <= 45.0:
        raise InputError("slope_deg", slope_deg, "a maximum slope of 0 to 45 degrees")
    if not 4.0 <= real(wavelength) <= 1e4:
        raise InputError("wavelength", wavelength, "4 to 10000 times the strip's half-width")
    if not np.isfinite(real(position)):
        raise InputError("position", position, "a finite fraction of the wavelength")
    if offsets.ndim != 1 or not np.all(np.abs(offsets) <= 1e4):
        raise InputError("offsets", offsets, OFFSETS)


def fem_json(found: WavyResult) -> dict[str, list[float] | float]:
    """Format the result of `sinusoid` for the command line."""
    return {
        "offsets": found.offsets.tolist(),
        "wavy": found.wavy.tolist(),
        "flat": found.flat.tolist(),
        "discretisation_error": found.discretisation_error,
    }
