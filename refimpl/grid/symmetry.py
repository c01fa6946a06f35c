"""Symmetry of a contact: how many of its edge elements are images of one another."""

from __future__ import annotations

import numpy as np
import scipy

from refimpl.grid.fields import Mask
from refimpl.grid.grid import Grid


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
