"""The summit of a field as its elements know it: where parabolas through them peak, and how well they fit.

The highest element lies up to half an element beside the summit, along either axis. The parabola through it
and its neighbours knows by how much; fourth differences tell whether there is one. Where a field is resolved
drop and roughness fall as h^2; of an element that stands alone the roughness is 1 on every grid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.grid.window import Window
from refimpl.model.friction import Mask

_RIVAL = 0.5  # of the highest element: lower maxima have no say in how well a summit is known
_NEAR = np.arange(-2, 3)[:, None]


@dataclass(frozen=True)
class Summit:
    """A field's summit; ``height`` and ``drop`` have the field's unit.

    height : of the parabola through the highest elements and their neighbours along x and y
    drop : how far the four neighbours together fall short of that element: minus h^2 times the Laplacian
    roughness : fourth differences over three times the drop: 0 on a parabola, 1 of elements that stand alone
    """

    height: float
    drop: float
    roughness: float

    @property
    def openness(self) -> float:
        """How many times less is known of it than of a parabola's summit; infinite if nothing is.

        A measure, not a law: on the training scenes, on surfaces of noise and on measured ones what the
        parabola misses, over the drop, grows about as this does.

        >>> [round(Summit(1.0, 1.0, roughness).openness, 1) for roughness in (0.0, 0.5, 0.8, 1.0)]
        [1.0, 3.2, 59.5, inf]
        """
        known = (1 - self.roughness**2) ** 4
        return 1 / known if known > 0 else math.inf

    def widened(self, size: float, power: float = 1.0) -> float:
        """Size of an error that goes with a power of the openness; infinite where that is, even if it is 0.

        >>> Summit(1.0, 1.0, 0.0).widened(2.0), Summit(1.0, 1.0, 1.0).widened(0.0, 0.5)
        (2.0, inf)
        """
        return math.inf if math.isinf(self.openness) else size * self.openness**power


LEVEL = Summit(0.0, 0.0, 0.0)
"""Of a field without relief."""


def highest(field: Array, *, periodic: bool = False) -> Summit:
    """The summit of a field ``(M, M)``, not negative; beyond its border it repeats itself or stays as it is.

    A field without relief, or one that ran off to infinity, has `LEVEL`. Fewer than three elements a side
    know of no parabola: their roughness is 1.
    The roughness is the largest of all maxima that reach half of the highest: a summit that is resolved says
    nothing of one beside it that is not.

    >>> x = np.arange(7.0) - 2.75
    >>> found = highest(50 - x[:, None] ** 2 - 0 * x)
    >>> round(found.height, 12), round(found.drop, 12), round(found.roughness, 12)
    (50.0, 2.0, 0.0)
    >>> highest(np.pad([[3.0]], 3))
    Summit(height=3.0, drop=12.0, roughness=1.0)
    """
    top = float(field.max())
    if not 0 < top < math.inf:
        return LEVEL
    if len(field) < 3:
        return Summit(top, 0.0, 1.0)
    high = field >= _RIVAL * top
    if not periodic:
        box = Window.around(high, margin=2).slices  # all that is looked at
        field, high = field[box], high[box]
    i, j = np.nonzero(_maxima(field, periodic) & high)
    heights, drops, roughness = _parabolas(_lines(field, i, j, periodic))
    best = int(np.argmax(heights))
    return Summit(float(heights[best]), float(drops[best]), float(roughness.max()))


def deepest(field: Array) -> Summit:
    """The summit of the field turned over, of which no other one counts.

    >>> deepest(-np.pad([[3.0]], 3)) == highest(np.pad([[3.0]], 3))
    True
    """
    i, j = np.unravel_index([np.argmin(field)], field.shape)
    height, drop, roughness = (float(value[0]) for value in _parabolas(-_lines(field, i, j, periodic=False)))
    return Summit(height, drop, roughness)


def _maxima(field: Array, periodic: bool) -> Mask:
    """Elements that no neighbour along x or y exceeds."""
    found = np.ones(field.shape, dtype=bool)
    for values, kept in ((field, found), (field.T, found.T)):
        kept[1:] &= values[1:] >= values[:-1]
        kept[:-1] &= values[:-1] >= values[1:]
        if periodic:
            kept[0] &= values[0] >= values[-1]
            kept[-1] &= values[-1] >= values[0]
    return found


def _lines(field: Array, i: NDArray[np.intp], j: NDArray[np.intp], periodic: bool) -> Array:
    """The five elements about each place, along x and along y: shape ``(2, 5, n)``."""
    n, m = field.shape
    rows, columns = i + _NEAR, j + _NEAR
    rows = rows % n if periodic else rows.clip(0, n - 1)
    columns = columns % m if periodic else columns.clip(0, m - 1)
    return np.array([field[rows, j], field[i, columns]])


def _parabolas(lines: Array) -> tuple[Array, Array, Array]:
    """Height, drop and roughness of each place with ``lines`` (2, 5, n) about it, a maximum along both."""
    farther_back, back, top, ahead, farther = lines.swapaxes(0, 1)
    bends, rise = 2 * top - back - ahead, ahead - back
    gains = np.zeros_like(bends)
    np.divide(rise, 8 * bends, out=gains, where=bends > 0)
    gains *= rise  # in this order no number leaves its range
    drops = bends.sum(axis=0)
    rest = np.abs(farther_back + farther - 4 * (back + ahead) + 6 * top).sum(axis=0)
    roughness = np.zeros_like(drops)
    np.divide(rest, 3 * drops, out=roughness, where=drops > 0)
    return top[0] + gains.sum(axis=0), drops, np.minimum(roughness, 1.0)
