"""Arrays of heights over the scene's square."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from refimpl.errors import InputError
from refimpl.grid import Array, Grid
from refimpl.surfaces.bicubic import resample, resample_periodic
from refimpl.surfaces.surface import Surface

_ALLOWED = "a 2-D array of finite heights in m over the scene's square, indexed [i, j] along x, y"


@dataclass(frozen=True, eq=False)
class ArraySurface(Surface):
    """Heights (m) at the centres of ``shape[0] x shape[1]`` equal cells of the scene's square.

    Used as they are on a grid of the same shape; otherwise resampled bicubically to the element centres
    (sampled, not averaged). Within the outermost half cell the spline's end piece goes on. An offset that
    leaves the square is refused unless the scene is periodic.
    """

    data: NDArray[np.float64]
    kind: ClassVar[str] = "array"

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", _checked(self.data))

    def _sample(self, grid: Grid, offset: tuple[float, float]) -> Array:
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
        return isinstance(other, ArraySurface) and np.array_equal(self.data, other.data)

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


def _by(shape: tuple[int, ...]) -> str:
    return " x ".join(map(str, shape))
