"""Contact patches: connected across corners, and across the border of a periodic grid."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Mask
from refimpl.grid.contact_patches import patch_sizes


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
