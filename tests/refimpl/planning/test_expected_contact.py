"""The contact to expect, against a plain description by all heights: a full sort and NumPy's gradients."""

from __future__ import annotations

import math
from dataclasses import asdict, replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid, Window
from refimpl.grid.contact_patches import patch_sizes
from refimpl.model.problem import Problem
from refimpl.planning import term_effects
from refimpl.planning.expected_contact import ExpectedContact, expected_contact
from refimpl.planning.term_effects import Scales
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


def gradient(problem: Problem, heights: Array) -> tuple[Array, Array]:
    """Derivatives along and across the sliding direction, by NumPy."""
    if problem.grid.periodic:
        wrapped = np.gradient(np.pad(heights, 1, mode="wrap"), *problem.grid.spacings)
        x, y = (tangent[1:-1, 1:-1] for tangent in wrapped)
    else:
        x, y = np.gradient(heights, *problem.grid.spacings)
    cos, sin = math.cos(problem.direction), math.sin(problem.direction)
    return cos * x + sin * y, cos * y - sin * x


def carried_in_order(problem: Problem) -> tuple[Array, Array]:
    """All elements from the lowest on, and what the first 1, 2, ... of them carry (N)."""
    along, across = gradient(problem, problem.gap)
    order = np.argsort(problem.gap.ravel(), kind="stable")
    squares = np.cumsum((along**2 + across**2).ravel()[order])
    stiffness = 4 * math.sqrt(2) / (3 * math.pi) * problem.pair.reduced_modulus * problem.grid.element_area
    return order, stiffness * np.sqrt(squares * np.arange(1, order.size + 1))


def is_image(z: Array, image: Array) -> bool:
    return bool(np.abs(z - image).max() <= 1e-9 * np.ptp(z))


def by_all_heights(problem: Problem) -> ExpectedContact:
    """The module's text, word by word."""
    gap, grid = problem.gap, problem.grid
    order, carried = carried_in_order(problem)
    if problem.load is not None:
        count = min(int(np.searchsorted(carried, problem.load)) + 1, order.size)
    else:
        count = max(1, np.count_nonzero(gap < (problem.approach or 0.0)) // 2)
    contact = gap <= gap.ravel()[order[count - 1]] + 1e-9 * np.ptp(gap)
    count = np.count_nonzero(contact)
    carries = problem.load if problem.load is not None else carried[count - 1]
    mean_pressure = carries / (count * grid.element_area)
    approach = problem.approach or 2 * gap[contact].max()
    stiff = [body.E / (1 - body.nu**2) for body in (problem.pair.lower, problem.pair.upper)]
    upper_share = stiff[0] / sum(stiff)
    bodies = [gradient(problem, problem.mean_surface + sign * gap / 2) for sign in (-1, 1)]
    beside = gradient(problem, np.maximum(gap - gap[contact].max(), 0) * (upper_share - 0.5))
    parts = zip(*bodies, beside, strict=True)
    common = [upper_share * low + (1 - upper_share) * up + edge for low, up, edge in parts]
    along = [tangent[contact] for tangent, _ in bodies]
    sizes = patch_sizes(contact, periodic=grid.periodic).astype(float)
    border = contact.copy()
    border[1:-1, 1:-1] = False
    near, surfaces = gap < 2 * approach, (gap, problem.mean_surface)
    turns = problem.direction / QUARTER_TURN
    flip = 1 if round(turns) % 2 == 0 else 0
    return ExpectedContact(
        elements=count,
        patches=sizes.sum() ** 2 / (sizes**2).sum(),
        mean_pressure=mean_pressure,
        pressure=9 / 8 * mean_pressure,
        approach=approach,
        slope_squared=sum(np.mean(tangent[contact] ** 2) for tangent in common),
        least_slope=min(math.sqrt(np.mean(tangent**2)) for tangent in along),
        least_mean_slope=min(abs(np.mean(tangent)) for tangent in along),
        extent=math.prod(grid.window_around(contact, margin=1).shape) / contact.size,
        border=0.0 if grid.periodic else np.count_nonzero(border) / count,
        symmetric=all(is_image(z, z[::-1, ::-1]) for z in surfaces),
        mirrored=abs(turns - round(turns)) < 1e-9 and all(is_image(z, np.flip(z, flip)) for z in surfaces),
        window=Window.around(near, margin=1).shape if near.any() else (0, 0),
    )


def assert_described(problem: Problem) -> ExpectedContact:
    """The expectation is that of all heights, to rounding."""
    found, expected = expected_contact(problem), by_all_heights(problem)
    stated = asdict(expected)
    least = stated.pop("least_mean_slope"), asdict(found)["least_mean_slope"]
    assert least[1] == pytest.approx(least[0], rel=1e-9, abs=1e-15)  # by symmetry a sum of rounding errors
    described = {name: asdict(found)[name] for name in stated}
    assert described == {name: pytest.approx(value, rel=1e-9) for name, value in stated.items()}
    return found


@pytest.mark.parametrize("share", [1e-6, 0.1, 0.24, 0.26, 0.999, 1.5])
@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_the_fewest_of_the_lowest_elements_that_carry_the_load_touch(grid: Grid, share: float) -> None:
    """Whether a quarter of the elements is enough for the load or not."""
    for gap in (None, np.random.default_rng(1).uniform(1e-6, 2e-6, grid.shape)):
        problem = posed(grid, gap)
        problem = replace(problem, load=share * float(carried_in_order(problem)[1][-1]))
        found = assert_described(problem)
        assert (found.elements == grid.elements) == (share > 1 or found.elements == grid.elements)


@pytest.mark.parametrize("approach", [2e-7, 4e-7, 1e-5])
@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_at_an_approach_half_of_the_elements_that_interfere_touch(grid: Grid, approach: float) -> None:
    problem = posed(grid, load=None, approach=approach)
    found, half = assert_described(problem), max(1, np.count_nonzero(problem.gap < approach) // 2)
    assert half <= found.elements <= half + 7  # of a symmetric ball eight touch at once


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


def estimates(problem: Problem, contact: ExpectedContact) -> Array:
    """How much three terms would change, by that contact."""
    scales = Scales(contact, problem.pair, problem.friction)
    terms = (term_effects.coupled, term_effects.oblique, term_effects.tilted)
    return np.array([term(scales).larger for term in terms])


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("shape", [(128, 64), (64, 192), (160, 80)])
def test_a_rectangle_of_more_elements_is_described_as_by_all_its_heights(
    shape: tuple[int, int], periodic: bool
) -> None:
    """Coarse heights may lie on oblong elements; counts and windows are the grid's."""
    grid = Grid(shape, (shape[0] * 1e-5, shape[1] * 1e-5), periodic)
    problem = discretise(BALL, grid)
    coarse, whole = expected_contact(problem), by_all_heights(problem)
    assert estimates(problem, coarse) == pytest.approx(estimates(problem, whole), rel=0.25)
    assert coarse.elements == pytest.approx(whole.elements, rel=0.15)
    assert coarse.mean_pressure == pytest.approx(whole.mean_pressure, rel=0.15)
    assert np.abs(np.subtract(coarse.window, whole.window) / shape).max() < 0.1
