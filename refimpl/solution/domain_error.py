"""Parts of error bars by what a grid does not see: beyond its domain, between points of data, short waves."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from refimpl.accuracy.iteration_error import Uncertainty, reported_numbers
from refimpl.grid import Array, Grid, mean_square, repeated
from refimpl.model.certificate import State
from refimpl.model.friction import friction_per_area
from refimpl.model.problem import Problem
from refimpl.scene.scene import Scene
from refimpl.surfaces import Sphere
from refimpl.surfaces.surface import Detail

_MOST_OUTSIDE = 0.5  # share of the contact found
MOST_ELEMENTS = 4  # between points of the data: the surface between them is interpolated, and smooth there
_FACTOR = 1.5  # on that share: all errors of mu of ten maps that are self-affine to the pitch are covered
_MOST_POINTS = 2048  # a side, of a map whose gradients are computed
_LEAST_POINTS = 8  # along an axis, for a cubic through every second one
_LEAST = 1e-6  # share of the mean square gradient that is worth a part of a bar


def unseen_parts(problem: Problem, state: State, scene: Scene | None) -> Uncertainty:
    """Return the parts "border", "data" and "short waves" of each number not prescribed, in its unit.

    Without a scene nothing is known of either. A maximum pressure that is the hardness is exact.
    """
    if scene is None or not state.contact.any():
        return {}
    beyond = _outside(problem, state, scene)
    data, waves = (
        _by_area(problem, state, missed(scene, problem.grid)) for missed in (data_error, unresolved_slope)
    )
    exact = "max_pressure" if state.plastic_area else None
    prescribed = "normal_force" if problem.load is not None else "approach"
    return {
        name: {"border": beyond * abs(number), "data": data.get(name, 0.0) * abs(number)}
        | ({"short waves": waves[name] * abs(number)} if waves.get(name) else {})
        for name, number in reported_numbers(problem, state).items()
        if number and name not in (exact, prescribed) and (beyond or data.get(name) or waves.get(name))
    }


def _outside(problem: Problem, state: State, scene: Scene) -> float:
    """Return the share that the domain cuts off, as dense as along the border; infinite from half on."""
    grid = problem.grid
    border = grid.on_border(state.contact) if scene.continues else 0
    outside = border / (2 * sum(grid.shape)) * grid.nominal_area / state.contact_area
    return outside if outside < _MOST_OUTSIDE else math.inf


def _by_area(problem: Problem, state: State, share: float) -> dict[str, float]:
    """Return the shares of the numbers that move with the contact area; of mu tau's part moves."""
    per_area = friction_per_area(problem.friction, state.forces.normal)
    mu = state.friction_coefficient
    of_mu = min(per_area * state.contact_area / mu, 1.0) if mu > 0 else 0.0
    moved = dict.fromkeys(("contact_area", "plastic_area", "approach"), share)
    moved |= dict.fromkeys(("friction_coefficient", "friction_force"), of_mu * share)
    return moved | {"max_pressure": 2 * share}


def data_error(scene: Scene, grid: Grid) -> float:
    """Return the share of the contact area that the data leave open; 0 without measured parts.

    A rough contact area goes as ``P / (E* g)`` with the rms gradient g (Bush, Gibson and Thomas 1975).
    Elements wider than the pitch miss what g gains from their spacing to the pitch, which the data say. What
    no point says is taken from the data as well: of every second point the others are interpolated, and the
    gradients of the differences are what a pitch twice as wide does not see; likewise for every fourth. From
    the second to the first of these shares they go on to the pitch itself: on a surface without waves below a
    few points they fall by an order of magnitude or more, on a self-affine one hardly. The approach and,
    twice over, the maximum pressure are taken to move by the same share.
    """
    parts = [part for name in ("lower", "upper") for part in scene.parts(name)]
    measured = [part for part in parts if part.pitch(grid.lengths) is not None]
    if not measured:
        return 0.0
    formulas = [part for part in parts if part not in measured and not isinstance(part, Sphere)]
    other = sum(_squared_gradient(part.sample(grid), grid.spacings, grid.periodic) for part in formulas)
    at_grid = at_pitch = between = 0.0
    for part in measured:
        z, spacings = part.data_points(grid)
        z = z[:_MOST_POINTS, :_MOST_POINTS]
        own = _squared_gradient(z, spacings, grid.periodic)
        wider = max(grid.spacings) > min(spacings)
        at_grid += _squared_gradient(part.sample(grid), grid.spacings, grid.periodic) if wider else own
        at_pitch += own
        between += own * unseen_share(z, grid.periodic)
    seen = at_pitch + other
    if seen == 0:
        return 0.0
    missed = 1 - math.sqrt(min(1.0, (at_grid + other) / seen))
    return missed + _FACTOR * (1 - math.sqrt(seen / (seen + between)))


def finest_by_data(scene: Scene) -> float:
    """Return the elements along the longer side at four a pitch; infinite without measured parts."""
    return math.inf if scene.pitch is None else MOST_ELEMENTS * max(scene.lengths) / scene.pitch


def unseen_share(z: Array, periodic: bool = False) -> float:
    """Return the mean square gradient that waves between the points add, over that of the points.

    >>> x = 2 * np.pi * np.arange(64) / 16  # sixteen points a wave, and uncorrelated heights
    >>> bool(unseen_share(np.add.outer(np.sin(x), np.sin(x))) < 1e-3)
    True
    >>> round(unseen_share(np.random.default_rng(0).normal(size=(64, 64))), 1)
    0.8
    """
    second = _interpolation_loss(z, periodic)
    few = min(z.shape) < 2 * _LEAST_POINTS  # every fourth point says nothing
    quarters = [z[i::2, j::2].copy() for i in (0, 1) for j in (0, 1)]  # a mirror image has the same share
    fourth = 0.0 if few else float(np.mean([_interpolation_loss(quarter, periodic) for quarter in quarters]))
    return second * (min(1.0, second / fourth) if fourth > 0 else 1.0)


def _interpolation_loss(z: Array, periodic: bool) -> float:
    """Return the share of the mean square gradient that cubics through every second point miss."""
    missed = total = 0.0
    for values in (z, z.T):
        if len(values) < _LEAST_POINTS:
            missed, total = missed + mean_square(values, 0.0), total + mean_square(values, 0.0)
            continue
        total += mean_square(np.diff(repeated(values, 0, 1, periodic=periodic), axis=0), 0.0)
        values = repeated(values, 3, 3, periodic=periodic)
        left = values[2:-4] + values[4:-2]  # in one array: a map has many points
        left *= -9
        left += values[:-6]
        left += values[6:]
        left /= 16
        left += values[3:-3]
        missed += mean_square(left, 0.0)
    return missed / total if total > 0 else 0.0


def _squared_gradient(z: Array, spacings: tuple[float, float], periodic: bool) -> float:
    """Return the mean square of neighbouring points' differences over their distance, both axes."""
    total = 0.0
    for values, spacing in zip((z, z.T), spacings, strict=True):
        total += mean_square(np.diff(repeated(values, 0, 1, periodic=periodic), axis=0), 0.0) / spacing**2
    return total


@dataclass(frozen=True)
class Resolution:
    """The finest detail of a scene's roughness, elements per length on the grid, and the number required."""

    detail: Detail
    elements: float
    required: float


def resolution(scene: Scene, grid: Grid, accuracy: float) -> Resolution | None:
    """Return the resolution of the roughness that is resolved worst; None without random roughness.

    Contact area goes as the inverse of the slope seen. For Eq. (9): ``l/h >= sqrt(2.3 / accuracy)``.
    """
    spacing = max(grid.spacings)
    found = [
        Resolution(detail, detail.length / spacing, detail.required(accuracy))
        for detail in _details(scene, spacing)
    ]
    return min(found, key=lambda one: one.elements / one.required, default=None)


def unresolved_slope(scene: Scene, grid: Grid) -> float:
    """Return the share of the rms gradient that the grid does not hold (Bush, Gibson and Thomas 1975)."""
    details = _details(scene, max(grid.spacings))
    squares = [detail.gradient**2 for detail in details]
    missed = sum(detail.unresolved * square for detail, square in zip(details, squares, strict=True))
    return 1 - math.sqrt(max(1 - missed / sum(squares), 0.0)) if missed > _LEAST * sum(squares) else 0.0


def _details(scene: Scene, spacing: float) -> list[Detail]:
    parts = (*scene.lower.surface.parts, *scene.upper.surface.parts)
    return [detail for part in parts if (detail := part.detail(spacing)) is not None]
