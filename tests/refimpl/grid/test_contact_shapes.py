"""Shapes of a contact on a grid: images, straight edges, patches."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Grid, Mask
from refimpl.grid.contact_patches import patch_sizes
from refimpl.grid.straight_edges import NO_STRAIGHT_EDGES, StraightEdges, straight_edges
from refimpl.grid.symmetry import symmetry_multiplicity

SQUARE = {repeats: Grid((24, 24), (1.0, 1.0), repeats) for repeats in (False, True)}
OBLONG = {repeats: Grid((24, 24), (1.0, 2.0), repeats) for repeats in (False, True)}


def disc(n: int = 24, m: int = 24, radius: float = 7.2, stretch: float = 1.0) -> np.ndarray:
    """Elements within an ellipse about the middle: ``radius`` along x and ``radius stretch`` along y."""
    i, j = np.arange(n) - (n - 1) / 2, np.arange(m) - (m - 1) / 2
    return np.hypot(i[:, None], j[None, :] / stretch) < radius


@pytest.mark.parametrize("periodic", [False, True])
def test_a_disc_has_all_eight_images_on_square_elements_and_four_on_oblong_ones(periodic: bool) -> None:
    """A mirror image across a diagonal would exchange edges of different lengths."""
    assert symmetry_multiplicity(disc(), SQUARE[periodic]) == 8
    assert symmetry_multiplicity(disc(), OBLONG[periodic]) == 4


def images(contact: np.ndarray, *, periodic: bool = False) -> float:
    """The multiplicity on square elements."""
    n, m = contact.shape
    return symmetry_multiplicity(contact, Grid((n, m), (float(n), float(m)), periodic))


def test_images_that_differ_by_one_element_count_by_their_edge() -> None:
    """A square without a corner: two images of eight are itself, six lack another corner of 26 edges."""
    contact = np.zeros((9, 9), dtype=bool)
    contact[1:7, 2:8] = True
    contact[1, 2] = False
    assert images(contact) == pytest.approx(2 + 6 * (1 - 4 * 2 / 26))
    assert images(contact[:, ::-1]) == pytest.approx(images(contact))


def test_an_edge_has_sides_along_both_axes() -> None:
    """Three bars in a frame of 3 x 5 elements, open to one side: 10 sides within it, and 16 around."""
    comb = np.array([[True] * 5, [True, False, True, False, True], [True, False, True, False, True]])
    mirrored, upside_down = 1.0, 1 - 4 * 4 / (2 + 8 + 16)
    assert images(np.pad(comb, 1)) == pytest.approx(2 * mirrored + 2 * upside_down)
    assert images(np.pad(comb.T, 1)) == images(np.pad(comb, 1))


def test_a_free_contact_is_turned_within_its_box_and_a_periodic_one_with_its_domain() -> None:
    """On a rectangle a free disc has all images, and a periodic one only four."""
    contact = np.zeros((16, 24), dtype=bool)
    contact[4:12, 9:17] = np.hypot(*np.mgrid[-3.5:4, -3.5:4]) < 4
    assert images(contact) == 8.0
    for shift in ((0, 0), (6, 0), (3, -11)):
        assert images(np.roll(contact, shift, (0, 1)), periodic=True) == 4.0
    strip = np.zeros((16, 24), dtype=bool)
    strip[4:12, 3:20] = True
    assert images(strip) == 4.0


def test_nothing_in_contact_and_full_contact_have_none() -> None:
    for contact in (np.zeros((4, 6), dtype=bool), np.ones((4, 6), dtype=bool)):
        for periodic in (False, True):
            grid = Grid((4, 6), (1.0, 1.0), periodic)
            assert straight_edges(contact, grid) == NO_STRAIGHT_EDGES


def test_no_face_reaches_across_a_free_border() -> None:
    """Three elements, less than the longest step from opposite borders."""
    contact = np.zeros((5, 5), dtype=bool)
    contact[[1, 1, 4], [1, 3, 2]] = True
    assert straight_edges(contact, Grid.square(1.0, 5)) == NO_STRAIGHT_EDGES


@pytest.mark.parametrize("axis", [0, 1])
def test_a_strip_across_a_period_is_two_edges_of_its_length(axis: int) -> None:
    """Wherever it lies, also across the border."""
    grid = Grid((6, 9), (1.0, 1.0), periodic=True)
    contact = np.zeros((6, 9), dtype=bool)
    contact[(slice(1, 3),) if axis == 0 else (slice(None), slice(1, 3))] = True
    length = (9, 6)[axis]
    for shift in range(9):
        found = straight_edges(np.roll(contact, shift, axis), grid)
        assert found == StraightEdges(faces=2 * length, runs=2, squares=2 * length**2)


@pytest.mark.parametrize("v", [(1, 1), (2, -1), (3, 2)])
def test_a_strip_between_the_axes_is_two_edges_of_as_many_runs_as_it_has_periods(v: tuple[int, int]) -> None:
    """Lines along v close after 30 steps; on the same strip on a free square they end at the border."""
    i, j = np.indices((30, 30))
    contact = (v[1] * i - v[0] * j) % 30 < 10
    for shift in (0, 7):
        found = straight_edges(np.roll(contact, shift, 0), Grid.square(1.0, 30, periodic=True))
        assert found == StraightEdges(faces=0, runs=2, squares=2 * 30**2)
    free = straight_edges(contact, Grid.square(1.0, 30))
    assert free.faces == 0
    assert 0 < free.squares < found.squares


def test_a_staircase_counts_what_a_run_is_longer_than_its_neighbours() -> None:
    """Runs of 2, 7 and 3 in steps of one: 7 - 2 - 1 - 3 - 1 = 0; with a run of 9 it is 2."""
    for middle, straight in ((7, 0), (9, 2)):
        contact = np.zeros((4, 2 + middle + 3), dtype=bool)
        contact[0] = True
        contact[1, 2:] = True
        contact[2, 2 + middle :] = True
        found = straight_edges(contact, Grid(contact.shape, (1.0, 1.0)))
        assert found.squares == straight**2


@pytest.mark.parametrize("shift", [(0, 0), (5, 0), (0, 9), (15, 14)])
def test_a_patch_across_a_period_has_the_edges_of_one_inside(shift: tuple[int, int]) -> None:
    """Of 2 x 10 elements the long edges exceed the ends by 10 - 2 - 2 faces each, and two by 8."""
    contact = np.zeros((16, 16), dtype=bool)
    contact[3:5, 2:12] = True
    found = straight_edges(np.roll(contact, shift, (0, 1)), Grid.square(1.0, 16, periodic=True))
    assert found == straight_edges(contact, Grid.square(1.0, 16)) == StraightEdges(16, 2, 72)


def test_many_patches_have_the_edges_of_each() -> None:
    """As many elements as are not looked at all at once."""
    contact = np.tile(np.pad(np.ones((2, 10), dtype=bool), ((3, 11), (2, 4))), (40, 40))
    found = straight_edges(contact, Grid.square(1.0, 640, periodic=True))
    assert found == StraightEdges(1600 * 16, 1600 * 2, 1600 * 72)


def walked(contact: Mask, periodic: bool) -> list[int]:
    """Sizes of patches, found element by element."""
    left, sizes = {(int(i), int(j)) for i, j in np.argwhere(contact)}, []
    while left:
        front, size = [left.pop()], 0
        while front:
            i, j = front.pop()
            size += 1
            for di in (-1, 0, 1):
                for dj in (-1, 0, 1):
                    near = (i + di, j + dj)
                    if periodic:
                        near = near[0] % contact.shape[0], near[1] % contact.shape[1]
                    if near in left:
                        left.remove(near)
                        front.append(near)
        sizes.append(size)
    return sorted(sizes)


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("share", [0.1, 0.25, 0.4])
def test_patches_are_those_that_a_walk_finds(share: float, periodic: bool) -> None:
    rng = np.random.default_rng(3)
    for _ in range(30):
        contact = rng.random((9, 12)) < share
        assert sorted(patch_sizes(contact, periodic=periodic).tolist()) == walked(contact, periodic)
