"""Heights given as an array over the domain: checked once, sampled at the element centres of any grid."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy

from refimpl.errors import InputError, size_text
from refimpl.grid import Array, Grid

# A cubic spline's memory of a far data point fades by 2 - sqrt(3) = 0.268 a point; 0.268^32 = 5e-19.
MEMORY = 32
_ALLOWED = "a 2-D array of finite heights in m over the domain, indexed [i, j] along x, y"
_SQUARE = 1.01  # ratio of a pixel's edges, up to which pixels without stated edges are taken for square
_SPANS = 1e-6  # relative, between the array's stated size and the domain: rounding of typed lengths


def resample(data: Array, x: Array, y: Array) -> Array:
    """Return the values at all pairs of ``x``, ``y``, ``(len(x), len(y))``.

    ``data[i, j]`` sits at ``(i, j)``, at least four points an axis; end pieces go on beyond the outermost.
    """
    rows, columns = _reach(x, data.shape[0]), _reach(y, data.shape[1])
    along_x = _spline(data[rows, columns], x - rows.start)
    return np.ascontiguousarray(_spline(along_x.T, y - columns.start).T)


def resample_periodic(data: Array, x: Array, y: Array) -> Array:
    """Return ``resample`` for data that repeat with the periods ``data.shape``."""
    nx, ny = data.shape
    wrapped = np.pad(data, MEMORY, mode="wrap")
    return resample(wrapped, np.mod(x, nx) + MEMORY, np.mod(y, ny) + MEMORY)


def _spline(values: Array, at: Array) -> Array:
    return np.asarray(scipy.interpolate.make_interp_spline(np.arange(len(values)), values, k=3)(at))


def _reach(at: Array, n: int) -> slice:
    low, high = int(np.floor(at.min())) - MEMORY, int(np.ceil(at.max())) + MEMORY + 1
    return slice(max(min(low, n - 4), 0), min(max(high, 4), n))


def checked(data: Any) -> Array:
    """Return a read-only copy of the heights (m); `InputError` for no 2-D array of finite numbers."""
    if not isinstance(data, np.ndarray) or data.ndim != 2 or data.size == 0:
        raise InputError("heights", getattr(data, "shape", data), _ALLOWED)
    if data.dtype.kind not in "fiu":
        raise InputError("heights", f"array of {data.dtype}", _ALLOWED)
    heights = np.array(data, dtype=np.float64)
    if isinstance(data, np.ma.MaskedArray):
        heights[np.ma.getmaskarray(data)] = np.nan
    bad = np.argwhere(~np.isfinite(heights))
    if len(bad):
        first = tuple(map(int, bad[0]))
        raise InputError(
            "heights", f"{len(bad)} of {heights.size} not finite, the first at {first}", _ALLOWED
        )
    heights.setflags(write=False)
    return heights


def sampled(data: Array, grid: Grid, offset: tuple[float, float]) -> Array:
    """Return the heights (m) of ``data`` at the element centres: copied, or resampled bicubically.

    Raises `InputError` for fewer than four points an axis, and an offset (m) out of a free domain.
    """
    if data.shape == grid.shape and offset == (0.0, 0.0):
        return data.copy()
    if min(data.shape) < 4:
        allowed = f"the grid's shape {grid.shape}, or at least 4 points an axis"
        raise InputError("heights", f"array of shape {data.shape}", allowed)
    if not grid.periodic:
        _refuse_leaving(grid, offset)
    (nx, ny), (Lx, Ly) = data.shape, grid.lengths
    x, y = (grid.x + offset[0]) * (nx / Lx) - 0.5, (grid.y + offset[1]) * (ny / Ly) - 0.5
    return resample_periodic(data, x, y) if grid.periodic else resample(data, x, y)


def check_domain(
    shape: tuple[int, int], pixel: tuple[float, float] | None, lengths: tuple[float, float]
) -> None:
    """Raise `InputError` unless pixels of the stated edges (m), or else square ones, fill a domain (m)."""
    edges = tuple(length / n for length, n in zip(lengths, shape, strict=True))
    if pixel is None:
        if max(edges) > _SQUARE * min(edges):
            found = f"array of shape {shape}, whose pixels here are {size_text(edges)} m"
            raise InputError("heights", found, "square pixels, or ArraySurface(z, pixel=(dx, dy))")
    elif any(abs(edge / own - 1) > _SPANS for edge, own in zip(edges, pixel, strict=True)):
        own = tuple(n * edge for n, edge in zip(shape, pixel, strict=True))
        found = f"array of {size_text(own)} m on a domain of {size_text(lengths)} m"
        raise InputError("pixel", found, "a domain that the array spans: it is never squeezed")


def _refuse_leaving(grid: Grid, offset: tuple[float, float]) -> None:
    room = tuple(edge / 2.0 for edge in grid.spacings)  # from the border to the outermost element centres
    if any(abs(o) > r * (1.0 + 1e-9) for o, r in zip(offset, room, strict=True)):  # 1e-9: rounding of h / 2
        allowed = f"at most {min(room):.6g} m either way: the array ends with the domain"
        raise InputError("offset", offset, allowed)
