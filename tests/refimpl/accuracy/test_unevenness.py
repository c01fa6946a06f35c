"""Features of a grid: how far slopes that bend within elements leave mu open, and what solutions state."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.grid_features import slope_sampling_error
from refimpl.grid import Array, Grid
from refimpl.grid.symmetry import symmetry_multiplicity
from refimpl.model.slopes import Slopes
from verification.coverage.scenes import random_scene


def sampling_error(pressure: Array, slopes: Slopes, *, periodic: bool = False) -> float:
    """The error on elements that are not square: tangents are what counts."""
    return slope_sampling_error(pressure, slopes, Grid(pressure.shape, (1.0, 0.3), periodic))


def test_slope_sampling_error_knows_no_direction_and_nothing_where_there_is_nothing() -> None:
    draw = np.random.default_rng(5)
    pressure = np.pad(draw.uniform(0, 1, (4, 6)), ((2, 3), (1, 4)))
    slopes = Slopes(draw.normal(size=pressure.shape), draw.normal(size=pressure.shape))
    found = sampling_error(pressure, slopes)
    assert found == pytest.approx(sampling_error(pressure.T, Slopes(slopes.tan_y.T, slopes.tan_x.T)))
    assert found == pytest.approx(sampling_error(1e-3 * pressure, slopes))
    assert sampling_error(np.zeros((4, 4)), Slopes(np.eye(4), np.eye(4))) == 0.0
    assert sampling_error(np.ones((4, 4)), Slopes.flat((4, 4))) == 0.0
    assert sampling_error(np.ones((2, 2)), Slopes(np.eye(2), np.eye(2))) == 0.0


def test_slope_sampling_error_sees_bends_alone_and_alternating_slopes() -> None:
    ramp, pressure = Slopes(np.arange(25.0).reshape(5, 5), np.zeros((5, 5))), np.ones((5, 5))
    assert sampling_error(pressure, ramp) == pytest.approx(0.0, abs=1e-12)
    signs = np.indices((5, 5)).sum(axis=0) % 2 * 2.0 - 1
    assert sampling_error(pressure, Slopes(signs, signs)) == pytest.approx(math.sqrt(32 / 6) / 5)


def test_slope_sampling_error_of_slopes_without_neighbours_is_their_means_error_and_four_tenths_more() -> (
    None
):
    draw = np.random.default_rng(6)
    slopes = Slopes(draw.normal(size=(200, 200)), draw.normal(size=(200, 200)))
    assert sampling_error(np.ones((200, 200)), slopes) == pytest.approx(math.sqrt(2) / 200, rel=0.02)


def test_slope_sampling_error_of_a_resolved_surface_falls_as_the_cube_of_the_spacing() -> None:
    def waves(M: int) -> float:
        x = (np.arange(M) + 0.5) * 2 * math.pi / M
        return sampling_error(
            np.ones((M, M)), Slopes(np.sin(x)[:, None] + 0 * x, np.cos(x)[None, :] + 0 * x[:, None])
        )

    assert waves(64) / waves(128) == pytest.approx(8, rel=0.02)


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


def test_a_grids_result_keeps_what_the_solution_states_beside_its_discretisation() -> None:
    found = rf.solve(random_scene(2047).scene, 64)
    assert found.status is rf.Status.CYCLED
    kept = found.features.parts["friction_coefficient"]
    assert set(kept) == {"iteration", "active set"}
    assert kept["active set"] == found.uncertainty["friction_coefficient"]["active set"]


@pytest.mark.parametrize("shape", [(12, 12), (12, 7), (5, 16)])
def test_slope_sampling_error_of_a_periodic_contact_has_no_border(shape: tuple[int, int]) -> None:
    """Rolled along either axis; a free contact that the roll cuts has another error."""
    draw = np.random.default_rng(9)
    pressure, tan_x, tan_y = draw.random(shape) * (draw.random(shape) < 0.4), *draw.normal(size=(2, *shape))
    for shift in ((3, 0), (0, 2), (-4, 5)):
        moved = [np.roll(a, shift, (0, 1)) for a in (pressure, tan_x, tan_y)]
        one, other = (
            sampling_error(p, Slopes(x, y), periodic=True) for p, x, y in ((pressure, tan_x, tan_y), moved)
        )
        assert other == pytest.approx(one, rel=1e-12)
        assert sampling_error(moved[0], Slopes(*moved[1:])) != pytest.approx(one, rel=1e-3)


@pytest.mark.parametrize("seed", [14, 15])
def test_where_contact_repeats_a_bar_has_no_border(seed: int) -> None:
    """Contact across the border is bent as anywhere, and has the images that it has elsewhere."""
    s = rf.solve(random_scene(seed).scene, 24)
    assert s.problem.grid.periodic
    found = []
    for shift in ((0, 0), (7, 0), (0, 13), (11, 5)):
        pressure, *tans = (np.roll(a, shift, (0, 1)) for a in (s.pressure, s.slopes.tan_x, s.slopes.tan_y))
        error = slope_sampling_error(pressure, Slopes(*tans), s.grid)
        found.append((symmetry_multiplicity(pressure > 0, s.grid), error))
    assert found == [pytest.approx(found[0], rel=1e-12)] * 4
    assert (found[0][0] > 1) == (seed == 14)  # waves have images, roughness has none
