"""Spots of contact: elements that touch one another, at corners too."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from refimpl.model.friction import Mask


def spot_sizes(contact: Mask, *, periodic: bool = False) -> NDArray[np.intp]:
    """Number of elements of each spot; where contact repeats, spots go on beyond the border.

    >>> corners = np.pad(np.zeros((2, 2), dtype=bool), 1, constant_values=True) & np.eye(4, dtype=bool)
    >>> spot_sizes(corners).tolist(), spot_sizes(corners, periodic=True).tolist()
    ([1, 1], [2])
    """
    labels, count = ndimage.label(contact, np.ones((3, 3)))
    if periodic:
        pairs = np.concatenate([_across(labels), _across(labels.T)], axis=1)
        touching = coo_array((np.ones(pairs.shape[1]), (pairs[0], pairs[1])), (count + 1, count + 1))
        _, spots = connected_components(touching, directed=False)
        labels = spots[labels]
    sizes: NDArray[np.intp] = np.bincount(labels[contact])
    return sizes[sizes > 0]


def _across(labels: NDArray[np.integer]) -> NDArray[np.integer]:
    """Pairs of spots in the first and the last row that touch where these meet, shape ``(2, n)``."""
    pairs = np.concatenate([[labels[0], np.roll(labels[-1], k)] for k in (-1, 0, 1)], axis=1)
    return pairs[:, pairs.all(axis=0)]
