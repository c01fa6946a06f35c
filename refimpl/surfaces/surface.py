"""Surfaces: heights at the element centres of any grid; arrays of heights, and sums of surfaces."""

from __future__ import annotations

import math
import warnings
from abc import ABC, abstractmethod
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from refimpl.errors import InputError, is_whole, require_size, size_text
from refimpl.grid import Array, Grid
from refimpl.surfaces.arrays import check_domain, checked, sampled


class SurfaceWarning(UserWarning):
    """Heights were delivered, but a user should know how: resampled finer than measured, points filled in."""


@dataclass(frozen=True)
class Detail:
    """The finest detail of a random roughness, and how a grid resolves it.

    name, length : of the detail's length (m)
    resolved : elements per length from which slopes count as resolved
    curvature : rms of the Laplacian over rms of the gradient, times the length
    gradient : rms of the surface's gradient
    unresolved : share of its mean square in waves shorter than two elements of the given spacing
    missed : what a grid of the given spacing misses, in words; empty where that has no simple number
    """

    name: str
    length: float
    resolved: float
    curvature: float
    gradient: float
    unresolved: float
    missed: str = ""

    def required(self, accuracy: float) -> float:
        """Return the elements per length at which differences miss ``accuracy`` of the rms slope.

        Of the mean square slope ``(h curvature / length)^2 / 4`` is missing.
        """
        return self.curvature / math.sqrt(8.0 * accuracy)


class Surface(ABC):
    """The shape of one body's surface: heights in m, positive upwards.

    Immutable. Surfaces and arrays of heights add up: ``Sphere(0.14) + GaussianRoughness(...) + array``. A new
    one is a frozen dataclass with the method `heights_on`; all else has defaults.
    """

    kind: ClassVar[str] = ""
    __array_ufunc__ = None  # so that `array + surface` asks the surface, not each number of the array

    @abstractmethod
    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        """Return heights (m, positive upwards) at ``(grid.x[i] + offset[0], grid.y[j] + offset[1])``.

        Called by `heights`, which users call. All grids must sample one continuous surface; on a periodic one
        it repeats with ``grid.lengths``.

        Parameters
        ----------
        grid : ``grid.x`` (Mx,) and ``grid.y`` (My,) are the element centres (m) from the domain's corner
        offset : along x and y (m)

        Returns
        -------
        array of ``grid.shape``, (Mx, My)
        """

    def heights(self, grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> Array:
        """Return heights (m, positive upwards) at ``(x_i + offset_x, y_j + offset_y)``, in the grid's shape.

        ``x_i`` and ``y_j`` are the element centres; ``offset`` in m. On a periodic grid heights repeat with
        the grid's lengths. Raises `InputError` where the surface is not defined there; warns
        (`SurfaceWarning`) of everything in ``notes(grid)``.
        """
        z = self.sample(grid, offset)
        for caution in self.notes(grid):
            warnings.warn(caution, SurfaceWarning, stacklevel=2)
        return z

    @np.errstate(under="ignore")  # tails of exponentials end as zeros, whatever the caller's settings
    def sample(self, grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> Array:
        """Return the `heights` without a warning: Python's warning filters are shared by all threads."""
        ox, oy = offset
        if not (math.isfinite(ox) and math.isfinite(oy)):
            raise InputError("offset", offset, "two finite lengths in m")
        z = np.asarray(self.heights_on(grid, (float(ox), float(oy))))
        if z.shape != grid.shape or z.dtype.kind not in "fiu":
            found = f"{z.dtype} of shape {z.shape} from {type(self).__name__}.heights_on"
            raise InputError("heights", found, f"heights (m) of the grid's shape {grid.shape}")
        return z

    def describe(self, grid: Grid) -> tuple[str, ...]:
        """Return how heights are read, cut, levelled, resampled or normalised here, one sentence each."""
        return self.notes(grid)

    def notes(self, grid: Grid) -> tuple[str, ...]:
        """Return the part of ``describe`` that a user should be warned of."""
        return ()

    def pitch(self, lengths: tuple[float, float]) -> float | None:
        """Return the finest distance of data points on such a domain (m); None for a formula."""
        return None

    def data_points(self, grid: Grid) -> tuple[Array, tuple[float, float]]:
        """Return the data's heights (m; missing: NaN) and distances (m), by default at about the `pitch`."""
        pitch = self.pitch(grid.lengths) or min(grid.spacings)
        counts = [max(2, round(length / pitch)) for length in grid.lengths]
        fine = Grid((counts[0], counts[1]), grid.lengths, grid.periodic)
        return self.sample(fine), fine.spacings

    def detail(self, spacing: float) -> Detail | None:
        """Return the finest detail of a random roughness on elements of a spacing (m); None for others."""
        return None

    def parameters(self) -> dict[str, float]:
        """Return the numbers that a study may vary, by name, SI."""
        return {}

    def with_parameter(self, name: str, value: float) -> Self:
        """Return the surface with one of its `parameters` changed; a whole number may come as a float."""
        if name == "seed" and float(value).is_integer():
            value = int(value)
        return replace(self, **{name: value})  # type: ignore[type-var]  # dataclasses all

    def same_realisation(self, periodic: bool) -> tuple[str, ...]:
        """Return those of the `parameters` on which heights depend smoothly: there are derivatives."""
        return tuple(self.parameters())

    def extent(self, offset: tuple[float, float]) -> tuple[float, float] | None:
        """Return the largest rectangle (m) that the surface's data cover at an offset; None for a formula."""
        return None

    @property
    def label(self) -> str:
        """Name of the surface in messages."""
        return self.kind or type(self).__name__

    def on_upper_body(self) -> Surface:
        """Return the surface as it lies on the upper body."""
        return self

    @property
    def parts(self) -> tuple[Surface, ...]:
        """The surfaces that add up to this one."""
        return (self,)

    def __add__(self, other: Surface | NDArray[Any]) -> SurfaceSum:
        return SurfaceSum((*self.parts, *as_surface(other).parts))

    def __radd__(self, other: NDArray[Any]) -> SurfaceSum:
        return SurfaceSum((*as_surface(other).parts, *self.parts))

    def to_dict(self) -> dict[str, Any]:
        """Return a plain table for TOML: ``kind`` and every parameter that is set."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}  # type: ignore[arg-type]  # dataclasses all
        return {"kind": self.kind, **{name: v for name, v in values.items() if v is not None}}

    @classmethod
    def from_table(cls, table: dict[str, Any], folder: Path) -> Self:
        """Return the surface of ``table`` (without its ``kind``); relative paths start at ``folder``."""
        return cls(**table)


@dataclass(frozen=True)
class SurfaceSum(Surface):
    """The sum of surfaces' heights; sums of sums are one flat sum."""

    terms: tuple[Surface, ...]
    kind: ClassVar[str] = "sum"

    @property
    def parts(self) -> tuple[Surface, ...]:
        return self.terms

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        z = grid.zeros
        for term in self.terms:
            z += term.heights_on(grid, offset)
        return z

    def describe(self, grid: Grid) -> tuple[str, ...]:
        return tuple(line for term in self.terms for line in term.describe(grid))

    def notes(self, grid: Grid) -> tuple[str, ...]:
        return tuple(line for term in self.terms for line in term.notes(grid))

    def to_dict(self) -> dict[str, Any]:
        return {"kind": self.kind, "terms": [term.to_dict() for term in self.terms]}


@dataclass(frozen=True, eq=False)
class ArraySurface(Surface):
    """Heights (m) at the centres of ``shape[0] x shape[1]`` equal cells of the domain.

    Used as they are, positive upwards on either body, on a grid of the same shape; otherwise resampled
    bicubically to the element centres (sampled, not averaged). Within the outermost half cell the spline's
    end piece goes on. An offset that leaves the domain is refused unless the scene is periodic. Cells more
    than 1 % from square are refused unless ``pixel`` states their edges (m): heights are never squeezed.
    """

    data: NDArray[np.float64]
    pixel: tuple[float, float] | None = None
    kind: ClassVar[str] = "array"

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", checked(self.data))
        if self.pixel is not None:
            object.__setattr__(self, "pixel", pixel_edges("pixel", self.pixel))

    def extent(self, offset: tuple[float, float]) -> tuple[float, float] | None:
        if self.pixel is None:
            return None
        return self.data.shape[0] * self.pixel[0], self.data.shape[1] * self.pixel[1]

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        check_domain((self.data.shape[0], self.data.shape[1]), self.pixel, grid.lengths)
        return sampled(self.data, grid, offset)

    def describe(self, grid: Grid) -> tuple[str, ...]:
        used = "used as it is" if self.data.shape == grid.shape else f"resampled bicubically to {grid}"
        return f"the array of {size_text(self.data.shape)} heights is {used}", *self.notes(grid)

    def notes(self, grid: Grid) -> tuple[str, ...]:
        if all(points >= n for points, n in zip(self.data.shape, grid.shape, strict=True)):
            return ()
        finer = f"the grid of {grid} is finer than the array of {size_text(self.data.shape)} heights"
        return (f"{finer}: what lies between them is interpolated",)

    def pitch(self, lengths: tuple[float, float]) -> float:
        nx, ny = self.data.shape
        return float(min(lengths[0] / nx, lengths[1] / ny))

    def data_points(self, grid: Grid) -> tuple[Array, tuple[float, float]]:
        nx, ny = self.data.shape
        return self.data, (grid.lengths[0] / nx, grid.lengths[1] / ny)

    def to_dict(self) -> dict[str, Any]:
        allowed = 'a surface that has a TOML form; save the array as .npy and read it by kind = "measured"'
        raise InputError("surface", f"array of shape {self.data.shape}", allowed)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ArraySurface):
            return False
        return self.pixel == other.pixel and np.array_equal(self.data, other.data)

    def __hash__(self) -> int:
        return hash((self.data.shape, float(self.data.sum())))


def as_surface(value: Surface | NDArray[Any]) -> Surface:
    """Return ``value`` if it is a surface, an `ArraySurface` of it if it is an array; else InputError."""
    if isinstance(value, Surface):
        return value
    if isinstance(value, np.ndarray):
        return ArraySurface(value)
    raise InputError("surface", value, "a surface, a sum of surfaces or a 2-D array of heights in m")


def require_seed(seed: Any) -> int:
    """Return the seed of a random roughness as a whole number; else InputError."""
    if not is_whole(seed) or not 0 <= seed < 2**63:
        raise InputError("seed", seed, "a whole number, 0 <= seed < 2^63")
    return int(seed)


def pixel_edges(field: str, value: object) -> tuple[float, float]:
    """Return the edges (m) of a pixel from one length or two; else InputError."""
    allowed = "a positive length in m, or two (x, y)"
    pair = tuple(value) if isinstance(value, list | tuple) else (value, value)
    if len(pair) != 2:
        raise InputError(field, value, allowed)
    return require_size(field, pair[0], allowed), require_size(field, pair[1], allowed)
