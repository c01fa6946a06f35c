"""Features of states by their definitions; numbers at an approach by its powers, and without a touch."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.discretisation_error import estimates
from refimpl.accuracy.first_contact import at_first_contact, first_contact_bounds, first_contact_error
from refimpl.accuracy.grid_features import GridFeatures, slope_sampling_error
from refimpl.accuracy.peak import NO_PEAK, Peak, deepest, highest
from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid
from refimpl.grid.straight_edges import NO_STRAIGHT_EDGES
from refimpl.grid.symmetry import symmetry_multiplicity
from refimpl.model.certificate import State
from refimpl.model.forces import EDGE_SHARE
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.scene.discretise import discretise
from refimpl.solution.quantities import REPORTED

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
    return problem, solve_reference(problem)


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


def sampling_error(pressure: Array, slopes: Slopes, *, periodic: bool = False) -> float:
    """The error on elements that are not square: tangents are what counts."""
    return slope_sampling_error(pressure, slopes, Grid(pressure.shape, (1.0, 0.3), periodic))[0]


def test_along_a_straight_wall_errors_of_slopes_add_before_they_are_squared() -> None:
    """A wall along y on n elements is in phase all along: n times the variance. Random slopes are not."""
    n = 32
    wall = np.zeros((9, n))
    wall[4] = 1.0
    grid, zero = Grid((9, n), (9.0, float(n)), periodic=True), np.zeros((9, n))
    apart, in_phase = slope_sampling_error(zero + 1, Slopes(wall, zero), grid)
    assert in_phase == pytest.approx(apart * math.sqrt(n))
    noise = np.random.default_rng(5).standard_normal((64, 64))
    apart, in_phase = slope_sampling_error(np.ones((64, 64)), Slopes(noise, noise), Grid.square(1.0, 64))
    assert in_phase < 0.5 * apart


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


RADIUS, SIDE, APPROACH = 0.01, 1e-3, 3e-6
FRICTION = rf.Friction(tau=200e6, beta=0.1)
MODULUS = STEEL.E / (2 * (1 - STEEL.nu**2))
FORCE = 4 / 3 * MODULUS * math.sqrt(RADIUS) * APPROACH**1.5


@cache
def pressed(
    M: int, direction: float = 0.0, share: float = 0.0, approach: float | None = APPROACH
) -> GridFeatures:
    """A ball below a flat of the same steel, beside the grid's middle by a share of an element of 32 x 32."""
    scene = rf.Scene(
        upper=rf.Body(STEEL, rf.Flat()),
        lower=rf.Body(STEEL, rf.Sphere(radius=-RADIUS)),
        friction=FRICTION,
        load=FORCE,
        side=SIDE,
        sliding_direction=direction,
        sliding_offset=share * SIDE / 32,
    )
    return rf.solve(scene, M, approach=approach, oblique=False, tolerance=1e-8).details.features


def test_under_a_load_only_the_approach_hangs_on_the_touch() -> None:
    loaded = pressed(64, 0.0, 0.0, None)
    assert at_first_contact(loaded) is loaded
    deeper = replace(
        loaded, first_contact=replace(loaded.first_contact, height=2 * loaded.first_contact.height)
    )
    one, other = (estimates([result]) for result in (loaded, deeper))
    assert other["approach"].value - one["approach"].value == pytest.approx(loaded.first_contact.height)
    assert all(one[name] == other[name] for name in one if name != "approach")
    assert abs(one["approach"].value - APPROACH) < abs(loaded.numbers["approach"] - APPROACH)


def test_a_touch_that_nothing_is_known_of_leaves_everything_open() -> None:
    lone = replace(pressed(64), first_contact=Peak(0.0, 1e-9, 1.0), hardness=2e9)
    assert math.isinf(first_contact_error(lone))
    assert all(math.isinf(bound) for bound in first_contact_bounds(lone).values())
    assert all(math.isinf(estimate.half_width) for estimate in estimates([lone]).values())
    without_hardness = estimates([replace(lone, hardness=None)])
    assert {name for name, e in without_hardness.items() if e.half_width == 0} == {"plastic_area"}


def test_shear_that_bears_the_whole_force_leaves_everything_open() -> None:
    """On slopes the normal force may vanish, or pull."""
    for force in (0.0, -1.0):
        pulled = replace(pressed(64), numbers={**pressed(64).numbers, "normal_force": force}, dmu_dA=0.0)
        assert at_first_contact(pulled) is pulled
        assert all(math.isinf(bound) for bound in first_contact_bounds(pulled).values())


@pytest.mark.parametrize("unit", [1e-9, 1.0])
def test_powers_of_the_approach_in_any_unit_of_force(unit: float) -> None:
    """Down to a share ``s`` of the approach, and what two standard deviations of the touch take of that."""
    numbers = dict.fromkeys(REPORTED, unit) | {
        "approach": 1e-6,
        "contact_area": 3.0,
        "friction_force": 0.5 * unit,
    }
    found = replace(
        pressed(64),
        numbers=numbers,
        dmu_dA=0.1,
        edge=0.3,
        straight=NO_STRAIGHT_EDGES,
        peak=Peak(2 * unit, 1.0, 0.0),
        first_contact=Peak(1e-6 / 3, 5e-6, 0.0),
    )
    s = 0.75
    force, area = unit * s**1.5, 3.0 * s
    friction = 0.1 * unit * area + (0.5 - 0.3) * unit * s**1.5
    got = at_first_contact(found)
    corrected = friction - 0.1 * unit * got.excess
    assert got.numbers == pytest.approx(
        {
            "approach": 1e-6,
            "normal_force": force,
            "binormal_force": force,
            "contact_area": area,
            "contact_area_corrected": area - got.excess,
            "plastic_area": unit * s,
            "max_pressure": unit * s**0.5,
            "friction_force": friction,
            "friction_coefficient": friction / force,
            "friction_force_corrected": corrected,
            "friction_coefficient_corrected": corrected / force,
        }
    )
    assert got.peak.height == pytest.approx(2 * unit * s**0.5)
    assert got.dmu_dA == pytest.approx(0.1 * unit / force)
    less = 1 / 1.2  # 2 x 0.02 x 5e-6 of 1e-6
    assert first_contact_bounds(found)["contact_area"] == pytest.approx(3.0 * (1 - less))
    assert first_contact_bounds(found)["normal_force"] == pytest.approx(unit * (1 - less**1.5))
