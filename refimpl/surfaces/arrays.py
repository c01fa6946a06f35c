"""Arrays of heights over the scene's domain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.surfaces.bicubic import resample, resample_periodic
from refimpl.surfaces.surface import Surface, positive

_ALLOWED = "a 2-D array of finite heights in m over the scene's domain, indexed [i, j] along x, y"
_PIXEL = "a positive length in m, or two (x, y)"
_SQUARE = 1.01  # ratio of a pixel's edges, up to which pixels without stated edges are taken for square
_SPANS = 1e-6  # relative, between the array's stated size and the domain: rounding of typed lengths


@dataclass(frozen=True, eq=False)
class ArraySurface(Surface):
    """Heights (m) at the centres of ``shape[0] x shape[1]`` equal cells of the scene's domain.

    Used as they are, positive upwards on either body, on a grid of the same shape; otherwise resampled
    bicubically to the element centres (sampled, not averaged). Within the outermost half cell the spline's
    end piece goes on. An offset that leaves the domain is refused unless the scene is periodic. Cells more
    than 1 % from square are refused unless ``pixel`` states their edges (m); heights are never squeezed into
    a domain of another size.
    """

    data: NDArray[np.float64]
    pixel: tuple[float, float] | None = None
    kind: ClassVar[str] = "array"

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", _checked(self.data))
        if self.pixel is not None:
            object.__setattr__(self, "pixel", pixel_edges("pixel", self.pixel))

    def extent(self, offset: tuple[float, float]) -> tuple[float, float] | None:
        if self.pixel is None:
            return None
        (nx, ny), (dx, dy) = self.data.shape, self.pixel
        return nx * dx, ny * dy

    def _check_domain(self, lengths: tuple[float, float]) -> None:
        """Refuse a domain that the array's pixels do not fill."""
        own = self.extent((0.0, 0.0))
        if own is None:
            dx, dy = (length / n for length, n in zip(lengths, self.data.shape, strict=True))
            if max(dx / dy, dy / dx) > _SQUARE:
                found = f"array of shape {self.data.shape}, whose pixels here are {_metres((dx, dy))} m"
                raise InputError("heights", found, "square pixels, or ArraySurface(z, pixel=(dx, dy))")
        elif any(abs(length / whole - 1) > _SPANS for length, whole in zip(lengths, own, strict=True)):
            found = f"array of {_metres(own)} m on a domain of {_metres(lengths)} m"
            raise InputError("pixel", found, "a domain that the array spans: it is never squeezed")

    def _sample(self, grid: Grid, offset: tuple[float, float]) -> Array:
        self._check_domain(grid.lengths)
        if self.data.shape == grid.shape and offset == (0.0, 0.0):
            return self.data.copy()
        if min(self.data.shape) < 4:
            shape = f"array of shape {self.data.shape}"
            raise InputError("heights", shape, f"the grid's shape {grid.shape}, or at least 4 points an axis")
        if not grid.periodic:
            _refuse_leaving(grid, offset)
        (nx, ny), (Lx, Ly) = self.data.shape, grid.lengths
        x, y = (grid.x + offset[0]) * (nx / Lx) - 0.5, (grid.y + offset[1]) * (ny / Ly) - 0.5
        return resample_periodic(self.data, x, y) if grid.periodic else resample(self.data, x, y)

    def describe(self, grid: Grid) -> tuple[str, ...]:
        if self.data.shape == grid.shape:
            return (f"the array of {_by(self.data.shape)} heights is used as it is",)
        return (
            f"the array of {_by(self.data.shape)} heights is resampled bicubically to {grid}",
            *self.cautions(grid),
        )

    def pitch(self, lengths: tuple[float, float]) -> float:
        nx, ny = self.data.shape
        return float(min(lengths[0] / nx, lengths[1] / ny))

    def cautions(self, grid: Grid) -> tuple[str, ...]:
        if all(points >= n for points, n in zip(self.data.shape, grid.shape, strict=True)):
            return ()
        return (
            f"the grid of {grid} is finer than the array of {_by(self.data.shape)} heights: "
            "what lies between them is interpolated",
        )

    def to_dict(self) -> dict[str, Any]:
        allowed = 'a surface that has a TOML form; save the array as .npy and read it by kind = "measured"'
        raise InputError("surface", f"array of shape {self.data.shape}", allowed)

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, ArraySurface)
            and self.pixel == other.pixel
            and np.array_equal(self.data, other.data)
        )

    def __hash__(self) -> int:
        return hash((self.data.shape, float(self.data.sum())))


def _checked(data: NDArray[Any]) -> Array:
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


def _refuse_leaving(grid: Grid, offset: tuple[float, float]) -> None:
    room = tuple(edge / 2.0 for edge in grid.spacings)  # from the border to the outermost element centres
    if any(abs(o) > r * (1.0 + 1e-9) for o, r in zip(offset, room, strict=True)):  # 1e-9: rounding of h / 2
        allowed = f"at most {min(room):.6g} m either way: the array ends with the domain"
        raise InputError("offset", offset, allowed)


def pixel_edges(field: str, value: object) -> tuple[float, float]:
    """Edges (m) of a pixel from a length or two; else InputError."""
    pair = tuple(value) if isinstance(value, list | tuple) else (value, value)
    if len(pair) != 2:
        raise InputError(field, value, _PIXEL)
    return positive(field, pair[0], _PIXEL), positive(field, pair[1], _PIXEL)


def _metres(lengths: tuple[float, ...]) -> str:
    return " x ".join(f"{length:.6g}" for length in lengths)


def _by(shape: tuple[int, ...]) -> str:
    return " x ".join(map(str, shape))
