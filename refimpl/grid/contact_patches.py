"""Contact patches: elements in contact that touch one another, at corners too."""

from __future__ import annotations

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid.fields import Array, Mask


def patch_sizes(contact: Mask, *, periodic: bool = False) -> NDArray[np.intp]:
    """Return the number of elements of each patch; patches of a periodic contact go on beyond the border.

    >>> corners = np.pad(np.zeros((2, 2), dtype=bool), 1, constant_values=True) & np.eye(4, dtype=bool)
    >>> patch_sizes(corners).tolist(), patch_sizes(corners, periodic=True).tolist()
    ([1, 1], [2])
    """
    sizes: NDArray[np.intp] = np.bincount(patch_labels(contact, periodic=periodic)[contact])
    return sizes[sizes > 0]


def patch_labels(contact: Mask, *, periodic: bool = False) -> NDArray[np.intp]:
    """Return the patch of each element, numbered from 1 in the order of the array; 0 without contact."""
    labels, count = scipy.ndimage.label(contact, np.ones((3, 3)))
    if periodic:
        pairs = np.concatenate([_across(labels), _across(labels.T)], axis=1)
        touching = scipy.sparse.coo_array(
            (np.ones(pairs.shape[1]), (pairs[0], pairs[1])), (count + 1, count + 1)
        )
        _, patches = scipy.sparse.csgraph.connected_components(touching, directed=False)
        labels = patches[labels]
    _, first, numbered = np.unique(labels[contact], return_index=True, return_inverse=True)
    order = np.argsort(np.argsort(first)) + 1
    result = np.zeros(contact.shape, dtype=np.intp)
    result[contact] = order[numbered]
    return result


def patch_centres(labels: NDArray[np.intp], f: Array, along: Array, length: float, periodic: bool) -> Array:
    """Return the mean place of each patch along one axis (m), weighted by ``f``; all arrays are flat.

    A patch that spans the whole period has no centre along it; the mean of its angles is returned.
    """
    total = np.bincount(labels, f)[1:]
    if not periodic:
        return np.asarray(np.bincount(labels, f * along)[1:] / total)
    angle = 2 * math.pi / length * along
    middle = np.arctan2(np.bincount(labels, f * np.sin(angle)), np.bincount(labels, f * np.cos(angle)))
    off = (along - middle[labels] * length / (2 * math.pi) + length / 2) % length - length / 2
    corrected = np.bincount(labels, f * off)[1:] / total
    return np.asarray((middle[1:] * length / (2 * math.pi) + corrected) % length)


def _across(labels: NDArray[np.integer]) -> NDArray[np.integer]:
    """Return the pairs of patches ``(2, n)`` that touch where the first and the last row meet."""
    pairs = np.concatenate([[labels[0], np.roll(labels[-1], k)] for k in (-1, 0, 1)], axis=1)
    return pairs[:, pairs.all(axis=0)]
