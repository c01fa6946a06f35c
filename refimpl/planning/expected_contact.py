"""The contact to expect, from the heights alone; and the same description of a solved contact.

64 x 64 heights are enough for the expectation: on random scenes the estimates from them differ from those of
all heights far less than the latter differ from the effects (`test_expected_contact.py`).

Elements touch in the order of their gap until they carry the load. A patch whose gap has the rms
gradient g carries the mean pressure ``0.6 E* g``: of Hertz's paraboloid this is exact
(``4 sqrt(2) / (3 pi) = 0.600``), of light contact on Gaussian roughness Persson's theory has 0.63
(Persson 2001, J. Chem. Phys. 115, 3840). The area comes out at 0.6 to 2.4 of the solver's on 100
rough planes and balls of 128 x 128 elements, at 1 to 60 % of contact (25 of them in `test_expected_contact`):
too large where 64 x 64 heights miss slopes.

In contact ``u_lower + u_upper = approach - h``, and each body takes its share of that by its compliance:
without shear the common surface there is the mean of both heights, each weighted by the other body's
compliance (the rigid body's own shape, if one is rigid). Beside the contact each body ends at its own side of
the clearance g, and the mean of both deformed surfaces is that same sum plus ``(upper share - 1/2) g``: where
contact ends at a wall, the slope across its edge is this jump's.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array, Mask, Window, resampled
from refimpl.grid.contact_patches import patch_sizes
from refimpl.model.forces import EDGE_SHARE
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes

_STIFFNESS = 4 * math.sqrt(2) / (3 * math.pi)  # mean pressure over E* times the gap's rms gradient
_PEAKED = 9 / 8  # pressure-weighted over mean pressure: Hertz's; 0.9 to 1.3 of the expected on random scenes
_COARSE = 64  # elements per side from which the contact is estimated
WITHIN = 2.5  # ratio of the estimated to the solved area, or its inverse, at most on 25 scenes (2.40)
_LEAST = 1e-12  # mean pressure over E*, of a contact at an approach that hardly loads it
_ROUNDING = 1e-9  # share of a surface's range: heights that differ by less are mirror images of each other


@dataclass(frozen=True)
class ExpectedContact:
    """A contact in thirteen numbers; pressures in Pa, lengths in m, slopes as tangents.

    ``elements`` in contact, in ``patches`` of equal weight; ``mean_pressure``, and ``pressure`` weighted by
    itself; ``approach`` from first contact; ``slope_squared`` mean square of the common surface's;
    ``least_slope`` and ``least_mean_slope`` are the smaller of both bodies' rms and mean slopes along the
    sliding direction; ``border`` share of the contact that lies on the domain's border; ``extent`` share of
    the grid in the rectangle around the contact.
    """

    elements: int
    patches: float
    mean_pressure: float
    pressure: float
    approach: float
    slope_squared: float
    least_slope: float
    least_mean_slope: float
    border: float
    extent: float
    symmetric: bool
    mirrored: bool
    window: tuple[int, int]

    @property
    def edge_error(self) -> float:
        """Relative error of A by whole elements at the patches' edges: on a circle 0.30 spacing / r."""
        return 8 / math.pi * EDGE_SHARE * math.sqrt(math.pi * self.patches / self.elements)


def expected_contact(problem: Problem) -> ExpectedContact:
    """Return the contact to expect of a problem under its load, or at its approach."""
    coarse = _coarse(problem)
    gap, dA = coarse.gap, coarse.grid.element_area
    modulus = problem.pair.reduced_modulus
    stiffness = _STIFFNESS * modulus * dA
    if problem.load is not None:
        contact = _bearing(coarse, stiffness, problem.load)
        mean_pressure = problem.load / (int(np.count_nonzero(contact)) * dA)
    else:
        # half of what interferes: a sphere's contact circle has half the area of its interference
        elements = max(1, int(np.count_nonzero(gap < (problem.approach or 0.0))) // 2)
        contact = _first(_rising(gap), elements, gap)
        elements = int(np.count_nonzero(contact))
        squares = float(_gradient_squared(coarse)[contact].sum())
        mean_pressure = stiffness * math.sqrt(squares * elements) / (elements * dA)
        mean_pressure = max(mean_pressure, _LEAST * modulus)
    elements, level = int(np.count_nonzero(contact)), float(gap[contact].max())
    # a sphere's gap at the contact's edge is half the approach
    approach = problem.approach or 2 * level
    near = gap < 2 * approach
    window = Window.around(near, margin=1).shape if near.any() else (0, 0)
    seen_heights = [z for p in (coarse, problem) for z in (p.gap, p.mean_surface)]
    symmetric = all(_is_image(z, z[::-1, ::-1]) for z in seen_heights)  # after half a turn
    mirrored = _mirrored(problem.direction, seen_heights)
    weights, clearance = np.ones(elements), np.maximum(gap - level, 0.0)
    seen = _described(coarse, contact, weights, clearance, mean_pressure, _PEAKED * mean_pressure)
    finer = [n / m for n, m in zip(problem.grid.shape, coarse.grid.shape, strict=True)]
    rows, columns = (math.ceil(f * n) for f, n in zip(finer, window, strict=True))
    seen["elements"] = round(math.prod(finer) * elements)
    return ExpectedContact(
        **seen, approach=approach, symmetric=symmetric, mirrored=mirrored, window=(rows, columns)
    )


def _coarse(problem: Problem) -> Problem:
    n, m = problem.grid.shape
    grid = problem.grid.refined((min(n, _COARSE), min(m, _COARSE)))
    gap, mean_surface = (resampled(z, grid.shape) for z in (problem.gap, problem.mean_surface))
    return replace(problem, grid=grid, gap=gap, mean_surface=mean_surface)


def _bearing(problem: Problem, stiffness: float, load: float) -> Mask:
    """Return the smallest number of lowest elements that carry the load, or all."""
    order = _rising(problem.gap)
    squares = np.cumsum(_gradient_squared(problem).ravel()[order])
    carried = stiffness * np.sqrt(squares * np.arange(1, order.size + 1))
    return _first(order, 1 + int(np.searchsorted(carried, load)), problem.gap)


def _first(order: NDArray[np.intp], count: int, gap: Array) -> Mask:
    """Return the first ``count`` elements of an order, and those as low as the last of them."""
    last = order[min(count, order.size) - 1]
    return np.asarray(gap <= gap.flat[last] + _ROUNDING * np.ptp(gap))


def _rising(gap: Array) -> NDArray[np.intp]:
    return np.argsort(gap, axis=None, kind="stable")


def _gradient_squared(problem: Problem) -> Array:
    slopes = _slopes(problem, problem.gap)
    return np.asarray(slopes.tan_x**2 + slopes.tan_y**2)


def solved_contact(
    problem: Problem, pressure: Array, clearance: Array, before: ExpectedContact
) -> ExpectedContact:
    """Return a solved contact's description by pressure (Pa), clearance (m), and ``before``'s heights."""
    contact: Mask = pressure > 0
    loaded = pressure[contact]
    total = float(loaded.sum())
    weighted = float(np.sum(loaded**2)) / total
    return replace(before, **_described(problem, contact, loaded, clearance, total / loaded.size, weighted))


def _described(
    problem: Problem, contact: Mask, loads: Array, clearance: Array, mean_pressure: float, pressure: float
) -> dict[str, Any]:
    """Return what depends on the contact set, weighted by ``loads``. Bits vary in BLAS's sums."""
    window = problem.grid.window_around(contact, margin=1)
    near, where = problem.windowed(window), contact[window.slices]
    lower, upper = near.heights
    weights = loads / loads.sum()
    share = problem.pair.upper_share
    tangents = [_on(where, near, z)[0] for z in (lower, upper)]
    common = share * lower + (1 - share) * upper + (share - 0.5) * clearance[window.slices]
    along, across = _on(where, near, common)
    sizes = patch_sizes(where, periodic=problem.grid.periodic).astype(np.float64)
    return {
        "elements": loads.size,
        "patches": float(sizes.sum() ** 2 / np.sum(sizes**2)),  # equal ones of the same weight
        "mean_pressure": mean_pressure,
        "pressure": pressure,
        "slope_squared": float(np.sum(weights * (along**2 + across**2))),
        "least_slope": min(math.sqrt(float(np.sum(weights * tan**2))) for tan in tangents),
        "least_mean_slope": min(abs(float(np.sum(weights * tan))) for tan in tangents),
        "border": problem.grid.on_border(contact) / loads.size,
        "extent": math.prod(window.shape) / problem.grid.elements,
    }


def _on(where: Mask, problem: Problem, heights: Array) -> tuple[Array, Array]:
    """Return the slopes along and across the sliding direction on the marked elements."""
    slopes = _slopes(problem, heights)
    return slopes.tan_x[where], slopes.tan_y[where]


def _slopes(problem: Problem, heights: Array) -> Slopes:
    return Slopes.of_surface(heights, problem.grid, problem.direction)


def _is_image(z: Array, image: Array) -> bool:
    """Return whether a surface is its image, which pairs the first half of its rows with the second."""
    half = (len(z) + 1) // 2
    apart = float(np.abs(z[:half] - image[:half]).max())
    return apart == 0 or apart <= _ROUNDING * float(np.ptp(z))


def _mirrored(direction: float, surfaces: Sequence[Array]) -> bool:
    """Return whether surfaces are mirror images of themselves across the sliding line, a grid axis."""
    quarter = direction / (math.pi / 2)
    if abs(quarter - round(quarter)) > _ROUNDING:
        return False
    if round(quarter) % 2 == 0:
        surfaces = [z.T for z in surfaces]
    return all(_is_image(z, z[::-1]) for z in surfaces)
