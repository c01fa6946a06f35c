"""Exact aperiodic convolution on a window by zero-padded real FFTs.

Transforms are those of `refimpl.operators.transforms`. Columns that are known to be zero
are not transformed, and columns of the result outside the target are not transformed back.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array, Grid, Shape, Window
from refimpl.grid.window import padded_length
from refimpl.operators.kernel_tables import signed_table, unit_table
from refimpl.operators.transforms import Complex, even_hat, fourier, odd_hat, threads

_COLUMNS = 64  # transformed at a time: 64 is quicker than 256 (SciPy, one thread, 256 to 2048 a side)


@dataclass
class Counter:
    """Count of operator applications, each with its ``n log2 n`` padded points.

    A kernel's own transform counts as the half of an application that it is, or by symmetry as an eighth for
    each of its parts.
    """

    point_logs: float = 0.0
    tally: dict[str, int] = field(default_factory=dict)

    def add(self, what: str, points: int) -> None:
        """Count one application of ``what`` with a transform of ``points`` points."""
        self.point_logs += points * math.log2(max(points, 2))
        self.tally[what] = self.tally.get(what, 0) + 1


class Convolution(ABC):
    """Influence convolutions by products with the kernels' transforms: one transform, counted, for each.

    Its methods are those of `refimpl.model.elasticity.WindowOperator`. Subclasses have the transforms of the
    kernels, along the sliding direction and across it, and the product.
    """

    counter: Counter
    _points: int  # points of a transform

    def normal(self, pressure: Array) -> Array:
        self.counter.add("normal", self._points)
        return self._convolve(pressure, self._normal_hat)

    def shear(self, traction: Array) -> Array:
        self.counter.add("shear", self._points)
        return self._convolve(traction, self._shear_hat)

    def shear_across(self, traction: Array) -> Array:
        self.counter.add("shear", self._points)
        return self._convolve(traction, self._across_hat)

    def coupled(self, ratio: float) -> Callable[[Array], Array]:
        hat = self._normal_hat + ratio * self._shear_hat

        def product(pressure: Array) -> Array:
            self.counter.add("normal and shear", self._points)
            return self._convolve(pressure, hat)

        return product

    @property
    @abstractmethod
    def _normal_hat(self) -> Array | Complex: ...

    @property
    @abstractmethod
    def _shear_hat(self) -> Complex: ...

    @property
    @abstractmethod
    def _across_hat(self) -> Complex: ...

    @abstractmethod
    def _convolve(self, source: Array, hat: Array | Complex) -> Array: ...


class FFTInfluence(Convolution):
    """Influence convolutions from a source window to a target window, by default the same one.

    The padded size holds every offset that occurs exactly once, so no periodic image reaches the
    target: the result is the dense product to rounding. Kernels are built when first used and never
    otherwise. Arguments have the source's shape, results the target's.
    """

    displaces_mean = True

    def __init__(
        self,
        grid: Grid,
        direction: float,
        *,
        source: Window | None = None,
        target: Window | None = None,
        counter: Counter | None = None,
        padded: tuple[int, int] | None = None,
    ) -> None:
        self.grid = grid
        self.direction = direction
        self.source = source or grid.window
        self.target = target or self.source
        self.counter = counter if counter is not None else Counter()
        self._padded = padded or _padded(self.source, self.target)
        self._points = math.prod(self._padded)
        shifts = self.target.i0 - self.source.i0, self.target.j0 - self.source.j0
        placed = map(_places, self._padded, shifts, self.source.shape, self.target.shape)
        self._from, self._to = zip(*placed, strict=True)

    @property
    def circle(self) -> tuple[int, int]:
        """Half the padded lengths: the least that a window needs where it may see its own image."""
        N, K = self._padded
        return N // 2, K // 2

    @property
    def symbol(self) -> Array:
        """The normal kernel's transform on `circle` (m), half along the first axis, for a window onto itself.

        Every second frequency of the padded circle's: real and positive (a test).
        """
        return self._normal_hat.real[::2, ::2]

    @cached_property
    def _offsets(self) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
        """Signed element offsets, target minus source, around the circle of each axis."""
        source, target = self.source, self.target
        rows = _circle(self._padded[0], target.i0 - source.i1 + 1, target.i1 - 1 - source.i0)
        return rows, _circle(self._padded[1], target.j0 - source.j1 + 1, target.j1 - 1 - source.j0)

    @property
    def _is_even(self) -> bool:
        """True if a circle contains both signs of every offset; the offset halfway around has one."""
        return all(map(_is_even, self._offsets))

    @property
    def _is_odd(self) -> bool:
        """True if the product does not use the offset halfway around a circle."""
        (N, K), (rows, columns) = self._padded, _farthest(self.source, self.target)
        return self._is_even and rows < N // 2 and columns < K // 2

    @cached_property
    def _normal_hat(self) -> Array | Complex:
        """The kernel's transform: of a quarter of it, and real, where the circles are even."""
        points = self._points
        if not self._is_even:
            self.counter.add("normal kernel", points // 2)
            return self._transformed(self._signed("normal"))
        self.counter.add("normal kernel", points // 8)
        return even_hat(self._quarter("normal"), threads(points))

    def _quarter(self, kind: str, axis: int = 0) -> Array:
        """Return a kernel (m) at offsets from 0 to half of each circle; rows along the axis of traction."""
        halves = [n // 2 + 1 for n in self._padded]
        table = self._unit_quarter(kind, (halves[axis], halves[1 - axis]), self._aspect(axis))
        return table * self.grid.spacings[axis]

    def _unit_quarter(self, kind: str, shape: Shape, aspect: float) -> Array:
        return unit_table(kind, shape, aspect)

    @cached_property
    def _shear_hat(self) -> Complex:
        return self._tangential_hat(self.direction)

    @cached_property
    def _across_hat(self) -> Complex:
        return self._tangential_hat(self.direction + math.pi / 2)

    def _tangential_hat(self, angle: float) -> Complex:
        """Return the transform: of quarters of the parts along x and y, unless offsets opposite 0 count."""
        points = self._points
        cos, sin = math.cos(angle), math.sin(angle)
        if self._is_odd:
            self.counter.add("shear kernel", points // 8 * (2 if sin else 1))
            along_x = cos * self._quarter("tangential")
            along_y = sin * self._quarter("tangential", axis=1).T if sin else None
            return odd_hat(along_x, along_y, threads(points))
        self.counter.add("shear kernel", points // 2)
        return self._transformed(
            cos * self._signed("tangential") + sin * self._signed("tangential", axis=1).T
        )

    def _signed(self, kind: str, axis: int = 0) -> Array:
        """Return a kernel at all offsets around the circles (m), rows along an axis."""
        table = signed_table(kind, self._offsets[axis], self._offsets[1 - axis], self._aspect(axis))
        return table * self.grid.spacings[axis]

    def _aspect(self, axis: int) -> float:
        """Return an element's other edge over that along an axis."""
        return self.grid.aspect if axis == 0 else 1 / self.grid.aspect

    def _transformed(self, kernel: Array) -> Complex:
        return fourier.plane(kernel, self._padded, threads(self._points))

    def _convolve(self, source: Array, hat: Array | Complex) -> Array:
        spectrum = self._forward(source)
        spectrum *= hat
        return self._backward(spectrum)

    def _forward(self, source: Array) -> Complex:
        (N, K), (along, place) = self._padded, self._from
        workers = threads(self._points)
        spectrum = np.empty((N // 2 + 1, K), dtype=np.complex128)
        spectrum[:, : place.start] = 0
        spectrum[:, place.stop :] = 0
        padded = np.zeros((N, min(_COLUMNS, source.shape[1])))
        for block in _blocks(source.shape[1]):
            columns = source[:, block]
            padded[along, : columns.shape[1]] = columns
            at = slice(place.start + block.start, place.start + block.stop)
            fourier.columns(padded[:, : columns.shape[1]], spectrum[:, at], workers)
        return fourier.rows(spectrum, workers, forward=True)

    def _backward(self, spectrum: Complex) -> Array:
        (N, _), (along, place) = self._padded, self._to
        workers = threads(self._points)
        spectrum = fourier.rows(spectrum, workers, forward=False)
        found = np.empty(self.target.shape)
        for block in _blocks(found.shape[1]):
            at = slice(place.start + block.start, place.start + block.stop)
            found[:, block] = fourier.columns_back(spectrum[:, at], N, workers)[along]
        return found


class WholeGridInfluence(FFTInfluence):
    """From a source window to the whole grid, with arguments of the grid's shape.

    Tractions outside the source are taken to be zero: the caller chose the source to hold them all. It is
    made for one product of each kind, and gives up what that took before the result needs room.
    """

    def _convolve(self, source: Array, hat: Array | Complex) -> Array:
        spectrum = self._forward(source[self.source.slices])
        spectrum *= hat
        del hat
        for spent in ("_normal_hat", "_shear_hat", "_across_hat"):
            vars(self).pop(spent, None)
        return self._backward(spectrum)


def _blocks(count: int) -> Iterator[slice]:
    """Yield the columns in blocks, so that no second array of all of them is needed."""
    for start in range(0, count, _COLUMNS):
        yield slice(start, min(start + _COLUMNS, count))


def _padded(source: Window, target: Window) -> tuple[int, int]:
    """Return fast lengths that hold every offset once, or also its opposite at few points more.

    A kernel's transform then costs an eighth of an application instead of a half, which is worth a third.
    """
    lengths = [n + m - 1 for n, m in zip(source.shape, target.shape, strict=True)]
    rows, columns = _farthest(source, target)
    least = padded_length(lengths[0]), padded_length(lengths[1])
    even = padded_length(max(lengths[0], 2 * rows)), padded_length(max(lengths[1], 2 * columns))
    return even if 3 * math.prod(even) <= 4 * math.prod(least) else least


def _farthest(source: Window, target: Window) -> tuple[int, int]:
    """Return the greatest offsets from source to target along each axis, either way."""
    rows = max(target.i1 - source.i0, source.i1 - target.i0) - 1
    return rows, max(target.j1 - source.j0, source.j1 - target.j0) - 1


def _circle(n: int, lowest: int, highest: int) -> NDArray[np.int_]:
    """Return the offsets around a circle that hold ``lowest ... highest`` once each; 0 comes first.

    Where there is room, each but that opposite 0 has its opposite: an even kernel then has a real transform.
    """
    if max(-lowest, highest) <= n // 2:
        lowest = min(lowest, 1 - n // 2)
    return lowest + (np.arange(n) - lowest) % n


def _is_even(circle: NDArray[np.int_]) -> bool:
    return bool(circle[0] == 0 and np.array_equal(np.abs(circle[1:]), np.abs(circle[:0:-1])))


def _places(n: int, shift: int, source: int, target: int) -> tuple[slice, slice]:
    """Return where source and target, ``shift`` further, lie on a circle of n points: neither across its end.

    >>> _places(8, -2, 3, 5)
    (slice(2, 5, None), slice(0, 5, None))
    """
    start = shift % n
    if start <= n - target:
        return slice(0, source), slice(start, start + target)
    return slice(n - start, n - start + source), slice(0, target)
