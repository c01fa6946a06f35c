"""Straight edges along the grid: runs of faces that are longer than what follows them."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Grid
from refimpl.grid.straight_edges import NO_STRAIGHT_EDGES, StraightEdges, straight_edges


def test_nothing_in_contact_and_full_contact_have_none() -> None:
    for contact in (np.zeros((4, 6), dtype=bool), np.ones((4, 6), dtype=bool)):
        for periodic in (False, True):
            grid = Grid((4, 6), (1.0, 1.0), periodic)
            assert straight_edges(contact, grid) == NO_STRAIGHT_EDGES


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


def test_a_strip_that_ends_counts_less_what_is_at_its_ends() -> None:
    """Two rows of ten elements: each long edge meets faces across of length 2 at both ends, 10 - 4."""
    contact = np.zeros((8, 16), dtype=bool)
    contact[3:5, 2:12] = True
    assert straight_edges(contact, Grid.square(1.0, 8).refined((8, 16))) == StraightEdges(12, 2, 72)


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
    """Of 2 x 10 elements the long edges exceed the ends by 10 - 2 - 2 faces each."""
    contact = np.zeros((16, 16), dtype=bool)
    contact[3:5, 2:12] = True
    found = straight_edges(np.roll(contact, shift, (0, 1)), Grid.square(1.0, 16, periodic=True))
    assert found == straight_edges(contact, Grid.square(1.0, 16))
    assert (found.faces, found.runs) == (12, 2)
