"""Features of states on squares and rectangles, free and periodic: by their definitions, turned and moved."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.grid_features import GridFeatures, slope_sampling_error
from refimpl.accuracy.peak import NO_PEAK, deepest, highest
from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid
from refimpl.grid.symmetry import symmetry_multiplicity
from refimpl.model.certificate import State
from refimpl.model.forces import EDGE_SHARE
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.scene.discretise import discretise

STEEL, POLYMER = rf.Material(E=200e9, nu=0.3), rf.Material(E=2.5e9, nu=0.38)
BALL = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(radius=0.02)),
    lower=rf.Body(POLYMER, rf.GaussianRoughness(rms=1e-6, correlation_length=300e-6, seed=3)),
    friction=rf.Friction(tau=1e6, beta=0.2),
    load=5.0,
    side=1e-3,
    sliding_direction=0.7,
)
GRIDS = [
    Grid((16, 16), (1e-3, 1e-3)),
    Grid((20, 12), (1e-3, 6e-4)),
    Grid((14, 20), (1e-3, 8e-4)),  # oblong elements
    Grid((18, 12), (1e-3, 5e-4), periodic=True),
]


def solved(grid: Grid, approach: float | None = None) -> tuple[Problem, State]:
    problem = discretise(BALL, grid, approach=approach)
    return problem, solve_reference(problem)[1]


@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_features_are_those_of_the_state(grid: Grid) -> None:
    problem, state = solved(grid)
    found = GridFeatures.of(problem, state, {"approach": {"iteration": 1.0}}, {"approach": {"x": 2.0}})
    contact, force, dA = state.pressure > 0, state.forces.normal, math.prod(grid.spacings)
    n = np.count_nonzero(contact)
    assert found.grid == grid
    assert found.numbers["contact_area"] == pytest.approx(n * dA)
    assert found.numbers["approach"] == state.approach - problem.datum
    assert found.numbers["max_pressure"] == state.pressure.max()
    around = np.pad(contact, 1, mode="wrap" if grid.periodic else "edge")
    faces = [np.count_nonzero(around[1:-1, 1:] != around[1:-1, :-1])]
    faces.append(np.count_nonzero(around[1:, 1:-1] != around[:-1, 1:-1]))
    if grid.periodic:  # either end of a row is padded with the other: its face is there twice
        faces[0] -= np.count_nonzero(contact[:, 0] != contact[:, -1])
        faces[1] -= np.count_nonzero(contact[0] != contact[-1])
    assert found.edge == pytest.approx(EDGE_SHARE * sum(faces) * dA)
    assert found.edge_fraction == pytest.approx(EDGE_SHARE * sum(faces) / n)
    assert found.symmetry_multiplicity == symmetry_multiplicity(contact, grid)
    assert found.peak == highest(state.pressure, grid)
    assert found.first_contact == (NO_PEAK if grid.periodic else deepest(problem.gap))
    assert found.dmu_dA == pytest.approx(1e6 / force)
    ratio = abs(problem.pair.shear_compliance) / problem.pair.normal_compliance
    assert found.shear_to_normal_ratio == pytest.approx(ratio * 1e6 * n * dA / force)
    depth = float(np.sum(state.pressure * (state.approach - problem.gap)) / np.sum(state.pressure))
    assert found.depth == pytest.approx(depth)
    assert found.parts == {"approach": {"iteration": 1.0, "x": 2.0}}
    assert found.loaded
    assert found.touching


def turned(a: Array) -> Array:
    return a.T


def upside_down(a: Array) -> Array:
    return a[::-1, ::-1]


@pytest.mark.parametrize("grid", GRIDS[2:], ids=str)
@pytest.mark.parametrize(("moved", "direction"), [(turned, math.pi / 2 - 0.7), (upside_down, 0.7 + math.pi)])
def test_a_turned_problem_has_the_same_features(
    grid: Grid, moved: Callable[[Array], Array], direction: float
) -> None:
    """Transposed heights slide along the mirrored direction; Q then has the other sign."""
    problem = discretise(BALL, grid)
    swapped = slice(None, None, -1) if moved is turned else slice(None)
    image = replace(
        problem,
        grid=replace(grid, shape=grid.shape[swapped], lengths=grid.lengths[swapped]),
        gap=np.ascontiguousarray(moved(problem.gap)),
        mean_surface=np.ascontiguousarray(moved(problem.mean_surface)),
        direction=direction,
    )
    one, other = (GridFeatures.of(p, solve_reference(p)[1]) for p in (problem, image))
    assert_same(one, other)
    sign = -1 if moved is turned else 1
    assert other.numbers["binormal_force"] == pytest.approx(sign * one.numbers["binormal_force"], rel=1e-7)


@pytest.mark.parametrize("shift", [(9, 0), (0, 5), (-3, 7)])
def test_a_periodic_problem_has_the_same_features_wherever_it_begins(shift: tuple[int, int]) -> None:
    """Its peak may lie across the border."""
    problem = discretise(BALL, GRIDS[-1])
    gap, mean_surface = (np.roll(z, shift, (0, 1)) for z in (problem.gap, problem.mean_surface))
    rolled = replace(problem, gap=gap, mean_surface=mean_surface)
    one, other = (GridFeatures.of(p, solve_reference(p)[1]) for p in (problem, rolled))
    assert_same(one, other)
    assert other.numbers["binormal_force"] == pytest.approx(one.numbers["binormal_force"], rel=1e-7)


def assert_same(one: GridFeatures, other: GridFeatures) -> None:
    """All but Q, to what the solutions are converged to."""
    for name in ("edge", "symmetry_multiplicity", "slope_sampling_error", "dmu_dA", "depth"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-7), name
    for name in ("peak", "first_contact"):
        assert vars(getattr(other, name)) == pytest.approx(vars(getattr(one, name)), rel=1e-7), name
    for name in set(one.numbers) - {"binormal_force"}:
        assert other.numbers[name] == pytest.approx(one.numbers[name], rel=1e-7), name


def sampling_error(pressure: Array, slopes: Slopes, *, periodic: bool = False) -> float:
    """The error on elements that are not square: tangents are what counts."""
    return slope_sampling_error(pressure, slopes, Grid(pressure.shape, (1.0, 0.3), periodic))


def test_where_there_is_nothing_slopes_leave_nothing_open() -> None:
    none, bent = np.zeros((4, 4)), Slopes(np.eye(4), np.eye(4))
    assert sampling_error(none, bent) == 0.0
    assert sampling_error(none + 1, Slopes.flat((4, 4))) == 0.0
    assert sampling_error(np.ones((2, 2)), Slopes(np.eye(2), np.eye(2))) == 0.0


def bend(line: Array, k: int, periodic: bool) -> float:
    """The second difference at an element, at a free border that of its neighbour."""
    if len(line) < 3:
        return 0.0
    if periodic:
        return float(line[k - 1] - 2 * line[k] + line[(k + 1) % len(line)])
    k = min(max(k, 1), len(line) - 2)
    return float(line[k - 1] - 2 * line[k] + line[k + 1])


@pytest.mark.parametrize("shape", [(5, 6), (2, 5), (5, 2), (1, 4)])
@pytest.mark.parametrize("everywhere", [True, False])
@pytest.mark.parametrize("periodic", [False, True])
def test_slope_sampling_error_is_what_elements_one_by_one_add_up_to(
    shape: tuple[int, int], everywhere: bool, periodic: bool
) -> None:
    draw = np.random.default_rng(8)
    pressure = draw.uniform(0.5, 1, shape)
    pressure[-1, 1] = 0.0
    if not everywhere:
        pressure[0] = 0.0 if shape[0] > 1 else pressure[0]
    tans = draw.normal(size=(2, *shape))
    squares = sum(
        (pressure[i, j] * bend(line, k, periodic)) ** 2
        for i, j in np.ndindex(*shape)
        for tan in tans
        for line, k in ((tan[:, j], i), (tan[i], j))
    )
    found = sampling_error(pressure, Slopes(*tans), periodic=periodic)
    assert found == pytest.approx(math.sqrt(squares / 12) / pressure.sum())
