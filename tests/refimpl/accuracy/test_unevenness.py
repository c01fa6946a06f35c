"""What a grid's result keeps: how far slopes that bend leave mu open, which edge elements are alike."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.grid_features import GridFeatures, alike, unevenness
from refimpl.grid import Array
from refimpl.model.slopes import Slopes
from verification.coverage.scenes import random_scene


def test_unevenness_knows_no_direction_and_nothing_where_there_is_nothing() -> None:
    draw = np.random.default_rng(5)
    pressure = np.pad(draw.uniform(0, 1, (4, 6)), ((2, 3), (1, 4)))
    slopes = Slopes(draw.normal(size=pressure.shape), draw.normal(size=pressure.shape))
    found = unevenness(pressure, slopes)
    assert found == pytest.approx(unevenness(pressure.T, Slopes(slopes.tan_y.T, slopes.tan_x.T)))
    assert found == pytest.approx(unevenness(1e-3 * pressure, slopes))
    assert unevenness(np.zeros((4, 4)), Slopes(np.eye(4), np.eye(4))) == 0.0
    assert unevenness(np.ones((4, 4)), Slopes.flat((4, 4))) == 0.0
    assert unevenness(np.ones((2, 2)), Slopes(np.eye(2), np.eye(2))) == 0.0


def test_unevenness_sees_bends_alone_and_alternating_slopes() -> None:
    ramp, pressure = Slopes(np.arange(25.0).reshape(5, 5), np.zeros((5, 5))), np.ones((5, 5))
    assert unevenness(pressure, ramp) == pytest.approx(0.0, abs=1e-12)
    signs = np.indices((5, 5)).sum(axis=0) % 2 * 2.0 - 1
    assert unevenness(pressure, Slopes(signs, signs)) == pytest.approx(math.sqrt(32 / 6) / 5)


def test_unevenness_of_slopes_without_neighbours_is_their_means_error_and_four_tenths_more() -> None:
    draw = np.random.default_rng(6)
    slopes = Slopes(draw.normal(size=(200, 200)), draw.normal(size=(200, 200)))
    assert unevenness(np.ones((200, 200)), slopes) == pytest.approx(math.sqrt(2) / 200, rel=0.02)


def test_unevenness_of_a_resolved_surface_falls_as_the_cube_of_the_spacing() -> None:
    def waves(M: int) -> float:
        x = (np.arange(M) + 0.5) * 2 * math.pi / M
        return unevenness(
            np.ones((M, M)), Slopes(np.sin(x)[:, None] + 0 * x, np.cos(x)[None, :] + 0 * x[:, None])
        )

    assert waves(64) / waves(128) == pytest.approx(8, rel=0.02)


def bend(line: Array, k: int) -> float:
    """The second difference at an element, of its neighbour's where it is the last."""
    if len(line) < 3:
        return 0.0
    k = min(max(k, 1), len(line) - 2)
    return float(line[k - 1] - 2 * line[k] + line[k + 1])


@pytest.mark.parametrize("shape", [(5, 6), (2, 5), (5, 2), (1, 4)])
@pytest.mark.parametrize("everywhere", [True, False])
def test_unevenness_is_what_elements_one_by_one_add_up_to(shape: tuple[int, int], everywhere: bool) -> None:
    draw = np.random.default_rng(8)
    pressure = draw.uniform(0.5, 1, shape)
    pressure[-1, 1] = 0.0
    if not everywhere:
        pressure[0] = 0.0 if shape[0] > 1 else pressure[0]
    tans = draw.normal(size=(2, *shape))
    squares = sum(
        (pressure[i, j] * bend(line, k)) ** 2
        for i, j in np.ndindex(*shape)
        for tan in tans
        for line, k in ((tan[:, j], i), (tan[i], j))
    )
    assert unevenness(pressure, Slopes(*tans)) == pytest.approx(math.sqrt(squares / 12) / pressure.sum())


def test_images_that_differ_by_one_element_count_by_their_edge() -> None:
    """A square without a corner: two images of eight are itself, six lack another corner of 26 edges."""
    contact = np.zeros((9, 9), dtype=bool)
    contact[1:7, 2:8] = True
    contact[1, 2] = False
    assert alike(contact) == pytest.approx(2 + 6 * (1 - 4 * 2 / 26))
    assert alike(contact[:, ::-1]) == pytest.approx(alike(contact))
    assert alike(contact & False) == 1.0


def test_an_edge_has_sides_along_both_axes() -> None:
    """Three bars in a frame of 3 x 5 elements, open to one side: 10 sides within it, and 16 around."""
    comb = np.array([[True] * 5, [True, False, True, False, True], [True, False, True, False, True]])
    mirrored, upside_down = 1.0, 1 - 4 * 4 / (2 + 8 + 16)
    assert alike(np.pad(comb, 1)) == pytest.approx(2 * mirrored + 2 * upside_down)
    assert alike(np.pad(comb.T, 1)) == alike(np.pad(comb, 1))


def test_a_grids_result_keeps_what_the_solution_states_beside_its_discretisation() -> None:
    found = rf.solve(random_scene(2047).scene, 64)
    assert found.status is rf.Status.CYCLED
    kept = GridFeatures.of(found).parts["friction_coefficient"]
    assert set(kept) == {"iteration", "active_set"}
    assert kept["active_set"] == found.uncertainty["friction_coefficient"]["active_set"]


@pytest.mark.parametrize("seed", [14, 15])
def test_where_contact_repeats_a_bar_knows_no_beginning(seed: int) -> None:
    """Contact across the border is bent as anywhere, and has the images that it has elsewhere."""
    s = rf.solve(random_scene(seed).scene, 24)
    assert s.problem.grid.periodic
    found = []
    for shift in ((0, 0), (7, 0), (0, 13), (11, 5)):
        pressure, *tans = (np.roll(a, shift, (0, 1)) for a in (s.pressure, s.slopes.tan_x, s.slopes.tan_y))
        found.append((alike(pressure > 0, periodic=True), unevenness(pressure, Slopes(*tans), periodic=True)))
    assert found == [pytest.approx(found[0], rel=1e-12)] * 4
    assert (found[0][0] > 1) == (seed == 14)  # waves have images, roughness has none


def test_contact_that_repeats_has_its_own_images() -> None:
    square = np.zeros((12, 12), dtype=bool)
    square[3:7, 5:9] = True
    for shift in ((0, 0), (-5, 0), (5, -7)):
        assert alike(np.roll(square, shift, (0, 1)), periodic=True) == 8.0
    assert alike(np.roll(square, (-5, 0), (0, 1))) < 8.0
    assert alike(np.ones((3, 3), dtype=bool), periodic=True) == 8.0
