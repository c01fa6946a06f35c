"""Spots of contact: counted one by one, across corners, and across the border of what repeats."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid.contact_patches import spot_sizes
from refimpl.model.friction import Mask


def walked(contact: Mask, periodic: bool) -> list[int]:
    """Sizes by walking from element to element."""
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
def test_spots_are_those_that_a_walk_finds(share: float, periodic: bool) -> None:
    rng = np.random.default_rng(3)
    for _ in range(30):
        contact = rng.random((9, 9)) < share
        assert sorted(spot_sizes(contact, periodic=periodic).tolist()) == walked(contact, periodic)


def test_where_contact_repeats_spots_have_no_beginning() -> None:
    contact = np.random.default_rng(4).random((16, 16)) < 0.2
    found = sorted(spot_sizes(contact, periodic=True))
    for shift in ((3, 0), (0, 11), (7, 5)):
        assert sorted(spot_sizes(np.roll(contact, shift, (0, 1)), periodic=True)) == found
    assert spot_sizes(contact & False, periodic=True).size == 0
