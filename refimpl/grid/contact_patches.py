"""Shapes of a contact: patches of elements that touch, at corners too, and symmetry of its edge."""

from __future__ import annotations

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid.fields import Array, Mask
from refimpl.grid.grid import Grid


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


def symmetry_multiplicity(contact: Mask, grid: Grid) -> float:
    """Return how many edge elements are one another's images: 8 for a square's symmetries, 1 for none.

    A sum over the mirrorings and turns of the contact's bounding box, each by the share of the edge that it
    leaves as it is. A periodic contact is mirrored where its rows and columns match best. Oblong elements
    have no images across a diagonal.

    >>> disc = np.hypot(*np.mgrid[-7.5:8, -7.5:8]) < 6
    >>> free, periodic = (Grid.square(1.0, 16, periodic=repeats) for repeats in (False, True))
    >>> symmetry_multiplicity(disc, free)
    8.0
    >>> symmetry_multiplicity(disc | (np.indices((16, 16)).sum(axis=0) < 4), free)
    2.0
    >>> symmetry_multiplicity(np.roll(disc, (5, 9), (0, 1)), periodic)
    8.0
    """
    if not contact.any():
        return 1.0
    rows, columns = np.flatnonzero(contact.any(axis=1)), np.flatnonzero(contact.any(axis=0))
    if grid.periodic:
        box, lines = contact, rows.size + columns.size
    else:
        box = contact[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        lines = sum(box.shape)
    turned = (box, box.T) if grid.aspect == 1 else (box,)
    images = [image[::i, ::j] for image in turned for i in (1, -1) for j in (1, -1)]
    images = [image for image in images if image.shape == box.shape]
    if grid.periodic:
        images = [_matched(box, image) for image in images]
    edge = sum(_steps(box, axis, grid.periodic) for axis in (0, 1)) + 2 * lines
    misfits = [np.count_nonzero(image != box) for image in images]
    return float(sum(max(0.0, 1 - 4 * misfit / edge) for misfit in misfits))


def _steps(contact: Mask, axis: int, periodic: bool) -> int:
    """Return how often contact begins or ends along an axis."""
    if periodic:
        return int(np.count_nonzero(contact != np.roll(contact, 1, axis)))
    return int(np.count_nonzero(np.diff(contact, axis=axis)))


def _matched(contact: Mask, image: Mask) -> Mask:
    """Return a periodic contact's image, moved to where rows and columns match the contact best."""
    shifts = []
    for axis in (0, 1):
        counts, found = (scipy.fft.rfft(np.count_nonzero(m, axis=1 - axis)) for m in (contact, image))
        overlaps = np.rint(scipy.fft.irfft(counts * np.conj(found), contact.shape[axis]))
        shifts.append(int(np.argmax(overlaps)))
    return np.asarray(np.roll(image, shifts, (0, 1)))
