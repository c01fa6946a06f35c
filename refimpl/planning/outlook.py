"""The contact to expect, from the heights alone; and the same description of a contact that was found.

Elements touch in the order of their gap until they carry the load. A patch whose gap has the rms
gradient g carries the mean pressure ``0.6 E* g``: of Hertz's paraboloid this is exact
(``4 sqrt(2) / (3 pi) = 0.600``), of light contact on Gaussian roughness Persson's theory has 0.63
(Persson 2001, J. Chem. Phys. 115, 3840). On random scenes the area comes out at 0.6 to 1.0 of the solver's.

In contact ``u_lower + u_upper = approach - h``, and each body takes its share of that by its compliance:
without shear the common surface there is the mean of both heights, each weighted by the other body's
compliance (the rigid body's own shape, if one is rigid).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from refimpl.friction import Mask
from refimpl.grid import Array
from refimpl.operators.window import Window
from refimpl.problem import Problem
from refimpl.slopes import Slopes

Indices = NDArray[np.intp]

_STIFFNESS = 4 * math.sqrt(2) / (3 * math.pi)  # mean pressure over E* times the gap's rms gradient
_PEAKED = 9 / 8  # pressure-weighted over mean pressure: Hertz's; 0.9 to 1.3 of the expected on random scenes
_SAMPLED = 32  # elements a side, at least, from which the contact to expect is guessed before it is counted
_LEAST = 1e-12  # mean pressure over E*, of a contact at an approach that hardly loads it
_ROUNDING = 1e-9  # of a surface's range: heights that differ by less are mirror images of each other


@dataclass(frozen=True)
class Outlook:
    """A contact in a dozen numbers; pressures in Pa, lengths in m, slopes as tangents.

    ``elements`` in contact, in ``spots`` of equal weight; ``mean_pressure``, and ``pressure`` weighted by
    itself; ``approach`` from first touch; ``slope_squared`` mean square of the common surface's;
    ``least_slope`` and ``least_mean_slope`` are the smaller of both bodies' rms and mean slopes along the
    sliding direction; ``border`` share of the contact that lies on the domain's border.
    """

    elements: int
    spots: float
    mean_pressure: float
    pressure: float
    approach: float
    slope_squared: float
    least_slope: float
    least_mean_slope: float
    border: float
    symmetric: bool
    mirrored: bool
    window: tuple[int, int]

    @property
    def edge_error(self) -> float:
        """Relative error of A that whole elements make along the edges of the spots.

        On a circle of radius r the excess of `refimpl.forces.perimeter_corrected_area` is 0.30 spacing / r.
        """
        return 0.30 * math.sqrt(math.pi * self.spots / self.elements)


def expected(problem: Problem) -> Outlook:
    """The contact to expect of a problem under its load, or at its approach."""
    gap, dA = problem.gap, problem.grid.element_area
    modulus = problem.pair.reduced_modulus
    stiffness = _STIFFNESS * modulus * dA
    if problem.load is not None:
        contact = _touched(problem, stiffness, problem.load)
        elements = int(np.count_nonzero(contact))
        mean_pressure = problem.load / (elements * dA)
    else:
        # half of what interferes: a sphere's contact circle has half the area of its interference
        elements = max(1, int(np.count_nonzero(gap < (problem.approach or 0.0))) // 2)
        contact = _lowest(gap, elements)
        squares = float(_gradient_squared(problem, np.flatnonzero(contact)).sum())
        mean_pressure = stiffness * math.sqrt(squares * elements) / (elements * dA)
        mean_pressure = max(mean_pressure, _LEAST * modulus)
    # a sphere's gap at the contact's edge is half the approach
    approach = problem.approach or 2 * float(gap[contact].max())
    near = gap < 2 * approach
    window = Window.around(near, margin=1).shape if near.any() else (0, 0)
    del near  # a large array, before the next ones
    seen = _Seen(approach, *_symmetries(problem), window)
    return _described(problem, contact, np.ones(elements), mean_pressure, _PEAKED * mean_pressure, seen)


def _touched(problem: Problem, stiffness: float, load: float) -> Mask:
    """The fewest of the lowest elements that carry the load, or all: only those near the last are sorted."""
    heights = problem.gap.ravel()
    lowest, highest = _bracket(problem, stiffness, load)
    while True:
        touched = heights <= lowest
        order = np.flatnonzero((heights > lowest) & (heights <= highest))
        order = order[np.argsort(heights[order], kind="stable")]  # ties in the grid's order
        surely = np.flatnonzero(touched)
        squares = _gradient_squared(problem, surely).sum() + np.cumsum(_gradient_squared(problem, order))
        carried = stiffness * np.sqrt(squares * np.arange(surely.size + 1, surely.size + order.size + 1))
        last = int(np.searchsorted(carried, load))
        if last == 0 and surely.size:
            lowest = -np.inf
        elif last == order.size and highest < np.inf:
            highest = np.inf
        else:
            touched[order[: last + 1]] = True
            found: Mask = touched.reshape(problem.gap.shape)
            return found


def _bracket(problem: Problem, stiffness: float, load: float) -> tuple[float, float]:
    """Heights between which the last element lies that the load needs, by a sample of 32 to 63 a side."""
    n, m = problem.gap.shape
    stride = max(1, min(n, m) // _SAMPLED)
    sample = (m * np.arange(0, n, stride)[:, None] + np.arange(0, m, stride)).ravel()
    if sample.size == problem.gap.size:
        return -np.inf, np.inf
    heights = problem.gap.ravel()[sample]
    order = np.argsort(heights)
    squares = np.cumsum(_gradient_squared(problem, sample[order]))
    carried = stiffness * stride**2 * np.sqrt(squares * np.arange(1, sample.size + 1))
    found = int(np.searchsorted(carried, load))
    spread = found // 8 + 8
    lowest = heights[order[found - spread]] if found >= spread else -np.inf
    highest = heights[order[found + spread]] if found + spread < sample.size else np.inf
    return float(lowest), float(highest)


def _lowest(gap: Array, count: int) -> Mask:
    """The ``count`` elements of the least gap; of equal ones the first in the grid's order."""
    heights = gap.ravel()
    last = np.partition(heights, count - 1)[count - 1]
    chosen = heights < last
    level = np.flatnonzero(heights == last)
    chosen[level[: count - np.count_nonzero(chosen)]] = True
    found: Mask = chosen.reshape(gap.shape)
    return found


def _gradient_squared(problem: Problem, where: Indices) -> Array:
    """Squared gradient of the gap on some elements, by the differences of `Slopes.of_surface`."""
    gap, total = problem.gap, np.zeros(len(where))
    at = np.unravel_index(where, gap.shape)
    for axis, (k, n) in enumerate(zip(at, gap.shape, strict=True)):
        if problem.periodic:
            before, after, steps = (k - 1) % n, (k + 1) % n, np.full(len(where), 2)
        else:
            before, after = np.maximum(k - 1, 0), np.minimum(k + 1, n - 1)
            steps = np.maximum(after - before, 1)
        high, low = ((*at[:axis], side, *at[axis + 1 :]) for side in (after, before))
        total += ((gap[high] - gap[low]) / (steps * problem.grid.spacing)) ** 2
    return total


def found(problem: Problem, pressure: Array, before: Outlook) -> Outlook:
    """The same description of a solved contact; what the heights alone say is taken from ``before``."""
    contact: Mask = pressure > 0
    loaded = pressure[contact]
    total = float(loaded.sum())
    seen = _Seen(before.approach, before.symmetric, before.mirrored, before.window)
    weighted = float(np.sum(loaded**2)) / total
    return _described(problem, contact, loaded, total / loaded.size, weighted, seen)


class _Seen(NamedTuple):
    """What does not depend on where contact is."""

    approach: float
    symmetric: bool
    mirrored: bool
    window: tuple[int, int]


def _described(
    problem: Problem, contact: Mask, loads: Array, mean_pressure: float, pressure: float, seen: _Seen
) -> Outlook:
    """``loads`` weighs the elements in contact, in their order. Sums are not BLAS's: bits vary there."""
    window = Window.full(len(contact)) if problem.periodic else Window.around(contact, margin=1)
    near, where = problem.windowed(window), contact[window.slices]
    lower, upper = near.heights
    weights = loads / loads.sum()
    share = problem.pair.upper.normal_compliance / problem.pair.normal_compliance
    slopes = [_on(where, near, z) for z in (lower, upper)]
    along, across = (share * below + (1 - share) * above for below, above in zip(*slopes, strict=True))
    tangents = [tan for tan, _ in slopes]
    elements = loads.size
    border = int(np.count_nonzero(contact)) - int(np.count_nonzero(contact[1:-1, 1:-1]))
    return Outlook(
        elements=elements,
        spots=_spots(where),
        mean_pressure=mean_pressure,
        pressure=pressure,
        slope_squared=float(np.sum(weights * (along**2 + across**2))),
        least_slope=min(math.sqrt(float(np.sum(weights * tan**2))) for tan in tangents),
        least_mean_slope=min(abs(float(np.sum(weights * tan))) for tan in tangents),
        border=0.0 if problem.periodic else border / elements,
        **seen._asdict(),
    )


def _on(where: Mask, problem: Problem, heights: Array) -> tuple[Array, Array]:
    """Slopes along and across the sliding direction on the marked elements."""
    slopes = _slopes(problem, heights)
    return slopes.tan_x[where], slopes.tan_y[where]


def _symmetries(problem: Problem) -> tuple[bool, bool]:
    lower, upper = problem.heights
    turned = all(_alike(z, z[::-1, ::-1]) for z in (lower, upper))
    return turned, _mirrored(problem, lower, upper)


def _slopes(problem: Problem, heights: Array) -> Slopes:
    return Slopes.of_surface(heights, problem.grid.spacing, problem.direction, periodic=problem.periodic)


def _spots(contact: Mask) -> float:
    """How many spots of equal size weigh as much: ``(sum n)^2 / sum n^2`` over the connected ones."""
    labels, _ = ndimage.label(contact, np.ones((3, 3)))
    sizes = np.bincount(labels.ravel())[1:].astype(np.float64)
    return float(sizes.sum() ** 2 / np.sum(sizes**2))


def _alike(z: Array, image: Array) -> bool:
    """Whether a surface is its image, which pairs the first half of its rows with the second."""
    half = (len(z) + 1) // 2
    apart = float(np.abs(z[:half] - image[:half]).max())
    return apart == 0 or apart <= _ROUNDING * float(np.ptp(z))


def _mirrored(problem: Problem, lower: Array, upper: Array) -> bool:
    """Whether both surfaces are mirror images of themselves across the sliding line, a grid axis."""
    quarter = problem.direction / (math.pi / 2)
    if abs(quarter - round(quarter)) > _ROUNDING:
        return False
    axis = 1 if round(quarter) % 2 == 0 else 0
    across = (lower, upper) if axis == 0 else (lower.T, upper.T)
    return all(_alike(z, z[::-1]) for z in across)
