"""Error of a flat half-space's influence coefficients on a slope, in the plane: Appendix A's table.

The table (``data/coefficient_error.json``, made by ``rough-friction appendix-a map``) holds what
finite elements found for a strip of half-width ``a`` on a sinusoidal boundary in plane strain. The
first-order part is known in closed form; the table has the rest. Displacements count from the
strip's own centre, in units of ``p a / E``, because a plane displacement has no datum.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib import resources

import numpy as np
import scipy

from refimpl.errors import InputError, require_number
from refimpl.grid import Array
from refimpl.half_space.influence_error_3d import element_error, steepest_tabulated
from refimpl.model.materials import Material, Pair
from refimpl.model.slopes import Slopes

_NEIGHBOUR = 2.0  # offset of the next element in half-widths


@dataclass(frozen=True)
class SlopeError:
    """Slopes of a contact and the coefficient error at each; None beyond the table.

    rms_gradient, max_slope : angles (rad) whose tangents are the rms and the largest of |grad z|
    at_rms, at_max : error of the neighbours in line with the slope
    across_at_rms, across_at_max : of the element itself and of its neighbours across, the larger; None for
        surfaces that are constant along a direction, for a plane displacement has no datum
    """

    rms_gradient: float
    max_slope: float
    at_rms: float | None
    at_max: float | None
    across_at_rms: float | None = None
    across_at_max: float | None = None


def coefficient_error(
    slope: float,
    lower: Material,
    upper: Material | None = None,
    *,
    wavelength: float | None = None,
    position: float | None = None,
) -> float:
    """Return the largest relative error of the two neighbour coefficients in line with a slope.

    Parameters
    ----------
    slope : maximum slope of the waviness (rad), up to the table's 30 degrees
    lower, upper : the pair; one body alone when ``upper`` is None. In a pair the first-order parts
        enter as lower minus upper.
    wavelength : of the waviness in element half-widths; the table's largest by default. On longer waves what
        the table adds to first order is that of its largest, which is more.
    position : of the element on the waviness, 0 crest to 0.5 valley as the lower body sees it; the
        worst one by default

    Raises
    ------
    InputError
        steeper slopes and shorter waves than the table's

    Examples
    --------
    >>> steel = Material(E=200e9, nu=0.3)
    >>> coefficient_error(0.02, steel) > coefficient_error(0.02, steel, steel)
    True
    """
    table = _table()
    top = math.radians(table["slope_deg"][-1])
    require_number("slope", slope, f"an angle of 0 to {top:.4g} rad", at_least=0, at_most=top)
    wavelength = table["wavelength"][-1] if wavelength is None else wavelength
    least = table["wavelength"][0]
    require_number("wavelength", wavelength, f"at least {least:g} half-widths", at_least=least)
    if all(body.is_rigid for body in (lower, upper or lower)):
        raise InputError("lower", lower, "an elastic body: a rigid one has no influence coefficients")
    if position is not None:
        require_number("position", position, "a share of the wavelength, 0 to 1", at_least=0, at_most=1)
    positions = np.array(table["position"] if position is None else [position])
    return float(_errors(np.array([slope]), wavelength, positions, lower, upper)[0])


def slope_error(slopes: Slopes, pressure: Array, pair: Pair, *, plane: bool = False) -> SlopeError:
    """Return the error at a contact's rms gradient, weighted by pressure, and at its steepest element.

    By the table of square elements; by that of strips for ``plane`` surfaces and negative nu.
    """
    loaded = pressure > 0
    squared = slopes.tan_x[loaded] ** 2 + slopes.tan_y[loaded] ** 2
    if not squared.any():
        return SlopeError(0.0, 0.0, 0.0, 0.0)
    rms = math.atan(math.sqrt(float(np.average(squared, weights=pressure[loaded]))))
    steepest = math.atan(math.sqrt(float(squared.max())))
    if plane or min(pair.lower.nu, pair.upper.nu) < 0:
        return SlopeError(rms, steepest, *_plane_errors(np.array([rms, steepest]), pair))
    at = [
        element_error(angle, pair.lower, pair.upper) if angle <= steepest_tabulated() else None
        for angle in (rms, steepest)
    ]
    in_line = [None if one is None else one.in_line for one in at]
    across = [None if one is None else max(one.self_coefficient, one.across) for one in at]
    return SlopeError(rms, steepest, *in_line, *across)


def constant_along_an_axis(*heights: Array) -> bool:
    """Return whether all surfaces are constant along x, or all along y, on more than one element."""
    return any(
        all(len(z) > 1 and np.array_equal(z[1:], z[:-1]) for z in turned)
        for turned in (heights, [z.T for z in heights])
    )


def _plane_errors(angles: Array, pair: Pair) -> list[float | None]:
    table = _table()
    top = math.radians(table["slope_deg"][-1])
    positions = np.array(table["position"])
    found = _errors(np.minimum(angles, top), table["wavelength"][-1], positions, pair.lower, pair.upper)
    return [float(error) if angle <= top else None for angle, error in zip(angles, found, strict=True)]


def _errors(
    slopes: Array, wavelength: float, positions: Array, lower: Material, upper: Material | None
) -> Array:
    """Return the worst ``|flat - rough| / |flat|`` of both neighbours, bodies weighted by ``1 / E``."""
    bodies = [(lower, positions)]
    if upper is not None:  # a crest of one body is a valley of the other
        bodies.append((upper, (positions + 0.5) % 1.0))
    tabulated = min(wavelength, _table()["wavelength"][-1])
    along = _along_slopes(tabulated, tuple(np.concatenate([at for _, at in bodies])))
    rests = along(np.maximum(np.tan(slopes), along.t[0]))  # (slopes, positions, 4)
    rough = np.zeros((len(slopes), len(positions), 2))
    for (body, at), rest in zip(bodies, np.split(rests, len(bodies), axis=1), strict=True):
        rough += _departure(np.tan(slopes), wavelength, at, body.nu, rest) / body.E
    flat = sum(_flat(body.nu) / body.E for body, _ in bodies)
    return np.asarray(np.abs(rough).max(axis=(1, 2)) / abs(flat))


@lru_cache(maxsize=16)
def _along_slopes(wavelength: float, positions: tuple[float, ...]) -> scipy.interpolate.BSpline:
    """Return the parts there over the slope's tangent: cubic splines, harmonics in the position."""
    crest_to_valley = np.moveaxis(_over_wavenumber()(1 / wavelength), 1, 0)
    # 1 - position changes the neighbours' places: the other half of the turn
    turn = np.concatenate([crest_to_valley, crest_to_valley[-2:0:-1][..., [1, 0, 3, 2]]])
    harmonics = np.fft.rfft(turn, axis=0) / len(turn)
    weights = np.full(len(harmonics), 2.0)
    weights[[0, -1]] = 1.0
    at = np.minimum(positions, 1 - np.array(positions))
    phases = np.exp(2j * math.pi * at[:, None] * np.arange(len(weights)))
    parts = np.real(np.tensordot(weights * phases, harmonics, axes=1))
    return scipy.interpolate.make_interp_spline(
        np.tan(np.radians(_table()["slope_deg"])), np.moveaxis(parts, 0, 1)
    )


def _departure(tangents: Array, wavelength: float, positions: Array, nu: float, parts: Array) -> Array:
    """Return rough minus flat displacement of both neighbours (``p a / E``): (slopes, positions, 2)."""
    tangent, at = tangents[:, None, None], positions[:, None]
    ends = 2 * math.pi * (np.array([-1.0, 1.0]) / wavelength + at)
    climb = tangent * wavelength / (2 * math.pi) * (np.cos(2 * math.pi * at) - np.cos(ends))
    rest = tangent**2 * (1 + nu) * ((3 - 4 * nu) * parts[..., :2] + parts[..., 2:])
    rest = np.where(at > 0.5, rest[..., ::-1], rest)  # mirrored: the neighbours change places
    return np.asarray(rest - (1 + nu) * (1 - 2 * nu) * climb)


def _flat(nu: float) -> float:
    """Return ``u(x) - u(0)`` at a flat strip's neighbour, ``p a / E`` (Johnson 1985, 2.30)."""
    x = _NEIGHBOUR
    return -2 * (1 - nu**2) / math.pi * ((x + 1) * math.log(x + 1) - (x - 1) * math.log(x - 1))


@cache
def _table() -> dict[str, Array]:
    """Return the table's axes and, over these, both parts of the rest."""
    file = resources.files("refimpl").joinpath("data", "coefficient_error.json")
    document = json.loads(file.read_text(encoding="utf-8"))
    names = "slope_deg", "wavelength", "position", "offset", "kappa_part", "constant_part"
    return {name: np.array(document[name]) for name in names}


@cache
def _over_wavenumber() -> scipy.interpolate.BSpline:
    """Return both parts of the rest at both neighbours over 1 / wavelength, ``(slopes, positions, 4)``.

    Waves of one offset and place repeat over the wavenumber, and not over the wavelength's logarithm.
    """
    table = _table()
    neighbours = [int(np.flatnonzero(table["offset"] == side * _NEIGHBOUR)[0]) for side in (-1, 1)]
    parts = np.concatenate(
        [table[part][..., neighbours] for part in ("kappa_part", "constant_part")], axis=-1
    )
    rising = slice(None, None, -1)
    return scipy.interpolate.make_interp_spline(
        1 / table["wavelength"][rising], np.moveaxis(parts, 1, 0)[rising]
    )
