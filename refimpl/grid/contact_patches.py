"""Contact patches: elements in contact that touch one another, at corners too."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from refimpl.grid.fields import Mask


def patch_sizes(contact: Mask, *, periodic: bool = False) -> NDArray[np.intp]:
    """Return the number of elements of each patch; patches of a periodic contact go on beyond the border.

    >>> corners = np.pad(np.zeros((2, 2), dtype=bool), 1, constant_values=True) & np.eye(4, dtype=bool)
    >>> patch_sizes(corners).tolist(), patch_sizes(corners, periodic=True).tolist()
    ([1, 1], [2])
    """
    labels, count = ndimage.label(contact, np.ones((3, 3)))
    if periodic:
        pairs = np.concatenate([_across(labels), _across(labels.T)], axis=1)
        touching = coo_array((np.ones(pairs.shape[1]), (pairs[0], pairs[1])), (count + 1, count + 1))
        _, patches = connected_components(touching, directed=False)
        labels = patches[labels]
    sizes: NDArray[np.intp] = np.bincount(labels[contact])
    return sizes[sizes > 0]


def _across(labels: NDArray[np.integer]) -> NDArray[np.integer]:
    """Pairs of patches in the first and the last row that touch where these meet, shape ``(2, n)``."""
    pairs = np.concatenate([[labels[0], np.roll(labels[-1], k)] for k in (-1, 0, 1)], axis=1)
    return pairs[:, pairs.all(axis=0)]
