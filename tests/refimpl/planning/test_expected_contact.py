"""The contact to expect: elements and pressures under a load and at an approach, symmetries."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.model.problem import Problem
from refimpl.planning.expected_contact import WITHIN, expected_contact
from refimpl.scene.discretise import discretise

pytestmark = pytest.mark.filterwarnings("ignore::refimpl.surfaces.SurfaceWarning")

STEEL = rf.Material(200e9, 0.3)
BALL = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(0.1)),
    lower=rf.Body(rf.Material(70e9, 0.33), rf.GaussianRoughness(3e-7, 1e-4, seed=3)),
    friction=rf.Friction(),
    load=20.0,
    side=1e-3,
    sliding_direction=0.4,
)
GRIDS = [
    BALL.grid(3),
    BALL.grid(31),
    BALL.grid(64),
    Grid((48, 20), (1e-3, 3e-4)),
    Grid((9, 64), (2e-4, 1e-3)),
    Grid((40, 24), (1e-3, 5e-4), periodic=True),
]
QUARTER_TURN = math.pi / 2


def posed(grid: Grid, gap: Array | None = None, **changes: object) -> Problem:
    problem = discretise(BALL, grid)
    return replace(problem, **({} if gap is None else {"gap": gap}), **changes)  # type: ignore[arg-type]


def carried(problem: Problem) -> Array:
    """What the lowest 1, 2, ... elements carry (N), by NumPy's gradients and a full sort."""
    if problem.grid.periodic:
        wrapped = np.gradient(np.pad(problem.gap, 1, mode="wrap"), *problem.grid.spacings)
        x, y = (tangent[1:-1, 1:-1] for tangent in wrapped)
    else:
        x, y = np.gradient(problem.gap, *problem.grid.spacings)
    squares = np.cumsum((x**2 + y**2).ravel()[np.argsort(problem.gap.ravel())])
    stiffness = 4 * math.sqrt(2) / (3 * math.pi) * problem.pair.reduced_modulus * problem.grid.element_area
    return np.asarray(stiffness * np.sqrt(squares * np.arange(1, squares.size + 1)))


@pytest.mark.parametrize("share", [1e-6, 0.24, 0.26, 1.5])
@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_the_fewest_of_the_lowest_elements_that_carry_the_load_touch(grid: Grid, share: float) -> None:
    """Whether a quarter of the elements is enough for the load or not."""
    problem = posed(grid, np.random.default_rng(1).uniform(1e-6, 2e-6, grid.shape))
    loads = carried(problem)
    load = share * float(loads[-1])
    found = expected_contact(replace(problem, load=load))
    assert found.elements == min(int(np.searchsorted(loads, load)) + 1, grid.elements)
    assert found.mean_pressure == pytest.approx(load / (found.elements * grid.element_area), rel=1e-12)


@pytest.mark.parametrize("approach", [2e-7, 4e-7, 1e-5])
@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_at_an_approach_half_of_the_elements_that_interfere_touch(grid: Grid, approach: float) -> None:
    problem = posed(grid, load=None, approach=approach)
    found, half = expected_contact(problem), max(1, np.count_nonzero(problem.gap < approach) // 2)
    assert half <= found.elements <= half + 7  # of a symmetric ball eight touch at once
    mean = carried(problem)[found.elements - 1] / (found.elements * grid.element_area)
    assert found.mean_pressure == pytest.approx(mean, rel=1e-9)


@pytest.mark.parametrize("approach", [0.0, -1e-6])
def test_an_approach_that_hardly_loads_anything_has_a_least_pressure(approach: float) -> None:
    problem = posed(BALL.grid(8), np.zeros((8, 8)), load=None, approach=approach)
    found = expected_contact(problem)
    assert found.elements == 64  # flat surfaces touch as a whole
    assert found.mean_pressure == pytest.approx(1e-12 * problem.pair.reduced_modulus)


@pytest.mark.parametrize(("direction", "axis"), [(0.0, 1), (QUARTER_TURN, 0), (math.pi, 1), (0.3, None)])
@pytest.mark.parametrize("shape", [(8, 8), (8, 5)])
def test_mirror_images_across_the_sliding_line(
    direction: float, axis: int | None, shape: tuple[int, int]
) -> None:
    """Both surfaces must be, and a sliding line that is no grid axis has no images."""
    rough = np.random.default_rng(3).uniform(1e-6, 2e-6, shape)
    for mirrored in (0, 1):
        gap = rough + np.flip(rough, mirrored)
        problem = posed(Grid(shape, (1e-3, 1e-3)), gap, mean_surface=gap, direction=direction)
        assert expected_contact(problem).mirrored is (mirrored == axis)
        assert not expected_contact(replace(problem, mean_surface=rough)).mirrored
        assert not expected_contact(problem).symmetric


@pytest.mark.parametrize("shape", [(512, 96), (80, 512)])
def test_symmetry_is_decided_by_all_heights(shape: tuple[int, int]) -> None:
    """One element off, between those of the coarse heights."""
    x, y = (np.linspace(-1, 1, n) for n in shape)
    bowl = 1e-6 * (x[:, None] ** 2 + y[None, :] ** 2)
    level = np.zeros_like(bowl)
    whole = posed(Grid(shape, (1e-3, 1e-3)), bowl, mean_surface=level, direction=0.0)
    assert expected_contact(whole).symmetric
    assert expected_contact(whole).mirrored
    bowl, level = bowl.copy(), level.copy()
    bowl[8, 16] += 1e-9
    odd = expected_contact(replace(whole, gap=bowl))
    assert (odd.symmetric, odd.mirrored) == (False, False)
    level[8, 16] += 1e-9
    odd = expected_contact(replace(whole, mean_surface=level))
    assert (odd.symmetric, odd.mirrored) == (False, False)


def drawn(seed: int) -> rf.Scene:
    """A rough plane, or ball: Gaussian or self-affine, waves from 1/125 to a quarter of the side."""
    rng = np.random.default_rng(seed)
    length = 1e-3 * math.exp(rng.uniform(math.log(0.008), math.log(0.25)))
    longest = min(4 * length, 0.9e-3)
    waves = {"roll_off": longest, "long_cut": longest, "short_cut": length}
    rough = (
        rf.GaussianRoughness(3e-7, length, seed)
        if seed % 2
        else rf.SelfAffineRoughness(hurst=0.8, rms=3e-7, seed=seed, **waves)
    )
    modulus = 0.5 * STEEL.plane_strain_modulus
    if ball := seed % 5 == 4:
        load = 4 * modulus * (1e-3 * rng.uniform(0.1, 0.3)) ** 3 / (3 * 0.1)
    else:  # 1 to 60 % of contact, about
        load = math.exp(rng.uniform(math.log(0.01), math.log(0.6)))
        load *= 0.6 * modulus * math.sqrt(2) * rough.rms_slope * 1e-6
    shape = rf.Sphere(0.1) if ball else rf.Flat()
    bodies = rf.Body(STEEL, shape), rf.Body(STEEL, rough)
    return rf.Scene(*bodies, rf.Friction(), load, 1e-3, periodic=bool(seed % 3) and not ball)


def test_the_area_of_25_rough_scenes_is_within_its_factor() -> None:
    """And not far within: the factor is that of the worst scene, whose waves 64 x 64 heights miss."""
    ratios = []
    for seed in range(25):
        scene = drawn(seed)
        solved = rf.solve(scene, 128, oblique=False)
        expected = expected_contact(discretise(scene, solved.grid))
        ratios.append(expected.elements / np.count_nonzero(solved.contact))
    assert 0.9 * WITHIN < max(*ratios, 1 / min(ratios)) < WITHIN
