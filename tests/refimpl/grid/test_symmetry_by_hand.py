"""Images of a contact's edge, counted by hand."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Grid, Mask
from refimpl.grid.symmetry import symmetry_multiplicity


def images(contact: Mask, *, periodic: bool = False) -> float:
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
    assert images(contact & False) == 1.0


def test_an_edge_has_sides_along_both_axes() -> None:
    """Three bars in a frame of 3 x 5 elements, open to one side: 10 sides within it, and 16 around."""
    comb = np.array([[True] * 5, [True, False, True, False, True], [True, False, True, False, True]])
    mirrored, upside_down = 1.0, 1 - 4 * 4 / (2 + 8 + 16)
    assert images(np.pad(comb, 1)) == pytest.approx(2 * mirrored + 2 * upside_down)
    assert images(np.pad(comb.T, 1)) == images(np.pad(comb, 1))


def test_contact_that_repeats_has_its_own_images() -> None:
    square = np.zeros((12, 12), dtype=bool)
    square[3:7, 5:9] = True
    for shift in ((0, 0), (-5, 0), (5, -7)):
        assert images(np.roll(square, shift, (0, 1)), periodic=True) == 8.0
    assert images(np.roll(square, (-5, 0), (0, 1))) < 8.0
    assert images(np.ones((3, 3), dtype=bool), periodic=True) == 8.0


def test_on_a_free_rectangle_a_round_contact_has_all_images_and_a_periodic_one_its_four() -> None:
    """Free contacts are turned within their bounding box; what repeats is turned with its domain."""
    disc = np.zeros((16, 24), dtype=bool)
    disc[4:12, 9:17] = np.hypot(*np.mgrid[-3.5:4, -3.5:4]) < 4
    assert images(disc) == 8.0
    for shift in ((0, 0), (6, 0), (3, -11)):
        assert images(np.roll(disc, shift, (0, 1)), periodic=True) == 4.0
    strip = np.zeros((16, 24), dtype=bool)
    strip[4:12, 3:20] = True
    assert images(strip) == 4.0
