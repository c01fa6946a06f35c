"""The peak of a field between its elements: where parabolas through them peak, and how well they fit.

The highest element lies up to half an element beside the peak, along either axis. The parabola through it and
its neighbours gives the peak; fourth differences tell whether the field is parabolic there. Where a field is
resolved, curvature drop and non-parabolicity fall as h^2; of an element that stands alone the
non-parabolicity is 1 on every grid. At a sharp crest of the surface the pressure has no limit (`on_crest`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from refimpl.accuracy.constants import constant
from refimpl.grid import Array, Grid, Mask

_RIVAL, _CREST_RIVAL = constant("peak_rival"), constant("crest_rival")  # shares of the highest element
_REACH = 2  # elements on either side of a maximum that fourth differences need
_FAR = 5  # elements on either side of a maximum that sixth differences beside it need
# largest sixth over fourth differences of a kink at a share t between two elements, whose second differences
# are (1 - t, t) and zero: 3 at t = 0 and 1/2, least at t = 2/5 and 3/5 with 2.5, and 2 % for curvature beside
# it; of a wave of number q 4 sin(q h / 2)^2, so that waves of more than 3.5 elements are none
_KINK_RATIO = 2.45, 3.05
_LEAST_KINK = constant("least_kink")
_ERROR_POWER = constant("peak_error_power")


@dataclass(frozen=True)
class Peak:
    """A field's peak; ``height`` and ``curvature_drop`` have the field's unit.

    height : of the parabola through the highest elements and their neighbours along x and y
    curvature_drop : four times the highest element minus its four neighbours: minus h^2 times the Laplacian
    non_parabolicity : fourth differences over three times the drop: 0 on a parabola, 1 of single elements
    smooth : whether a pressure has a limit there: not on a sharp crest, at a sharp edge or a free border
    """

    height: float
    curvature_drop: float
    non_parabolicity: float
    smooth: bool = True

    @property
    def error_factor(self) -> float:
        """By how much the error exceeds that of a parabola's peak; infinite if nothing is known.

        An empirical measure: on the training scenes, on surfaces of noise and on measured ones the error of
        the parabola, over the drop, grows about as this factor does.

        >>> [round(Peak(1.0, 1.0, q).error_factor, 1) for q in (0.0, 0.5, 0.8, 1.0)]
        [1.0, 3.2, 59.5, inf]
        """
        resolved = (1 - self.non_parabolicity**2) ** _ERROR_POWER
        return 1 / resolved if resolved > 0 else math.inf

    def widened(self, size: float, power: float = 1.0) -> float:
        """Return the size of an error times a power of the error factor; infinite where the factor is.

        >>> Peak(1.0, 1.0, 0.0).widened(2.0), Peak(1.0, 1.0, 1.0).widened(0.0, 0.5)
        (2.0, inf)
        """
        return math.inf if math.isinf(self.error_factor) else size * self.error_factor**power


NO_PEAK = Peak(0.0, 0.0, 0.0)
"""Peak of a field without relief: no height, no curvature, no error."""


def highest(field: Array, grid: Grid) -> Peak:
    """Return the peak of a field that is not negative; `NO_PEAK` of one that vanishes or is not finite.

    The non-parabolicity is the largest of all maxima that reach half of the highest: a resolved peak says
    nothing about one beside it that is not. A peak has no limit if such a maximum lies beside an element
    without contact or beside a free border: the contact is narrower than a parabola there, or the pressure
    is singular. Along an axis of fewer than three elements there is no parabola, and the non-parabolicity
    is 1.

    >>> x = np.arange(7.0) - 2.75
    >>> found = highest(50 - x[:, None] ** 2 - 0 * x, Grid.square(1.0, 7, periodic=True))
    >>> round(found.height, 12), round(found.curvature_drop, 12), round(found.non_parabolicity, 12)
    (50.0, 2.0, 0.0)
    >>> highest(np.pad([[3.0]], 3), Grid.square(1.0, 7))
    Peak(height=3.0, curvature_drop=12.0, non_parabolicity=1.0, smooth=False)
    """
    top = float(field.max())
    if not 0 < top < math.inf:
        return NO_PEAK
    if min(field.shape) < 3:
        return Peak(top, 0.0, 1.0)
    box = grid.window_around(field >= _RIVAL * top, margin=_REACH).slices
    contact = np.pad(field[box] > 0, _REACH, mode=grid.continuation)
    return _peak(grid.padded(field[box], _REACH), contact, _RIVAL * top)


def deepest(field: Array) -> Peak:
    """Return the peak of the field turned over, without regard to others or to contact."""
    i, j = np.unravel_index(np.argmin(field), field.shape)
    near = np.arange(-_REACH, _REACH + 1)
    along, across = (np.clip(at + near, 0, n - 1) for at, n in zip((i, j), field.shape, strict=True))
    lines = -np.array([field[along, j], field[i, across]])
    height, drop, rest = (float(value[0]) for value in _parabolas(lines[:, :, None]))
    return Peak(height, drop, rest)


def on_crest(field: Array, surface: Array, grid: Grid, share: float = _CREST_RIVAL) -> bool:
    """Return whether a maximum of that share lies on a sharp crest of ``surface`` (m, either sign).

    A kink's second differences vanish but at the two elements beside it, whatever curvature is added to it.
    Lines that leave a free domain are not looked at.

    >>> x = np.arange(16.0) - 7.7
    >>> waves, roofs = (np.outer(z, np.ones(16)) for z in (np.cos(np.pi * x / 4), -np.abs(x) - x**2 / 9))
    >>> grid = Grid.square(1.0, 16, periodic=True)
    >>> on_crest(waves + 1, waves, grid), on_crest(roofs - roofs.min(), roofs, grid)
    (False, True)
    """
    top = float(field.max())
    if not 0 < top < math.inf:
        return False
    box = grid.window_around(field >= share * top, margin=_FAR).slices
    i, j = _maxima(grid.padded(field[box], _FAR), _FAR, share * top)
    lines = _lines(grid.padded(surface[box], _FAR), i, j, _FAR)
    second, fourth, sixth = (np.abs(np.diff(lines, n, axis=1)) for n in (2, 4, 6))
    known = _lines(np.pad(np.ones(field[box].shape), _FAR, mode=grid.continuation), i, j, _FAR).all(axis=1)
    kinks, bends = known * fourth[:, 1:-1].max(axis=1), second[:, 2:-2].max(axis=1).sum(axis=0)
    sharper = np.argmax(kinks, axis=0), np.arange(len(i))
    kink, change = kinks[sharper], sixth.max(axis=1)[sharper]
    rounding = 64 * np.finfo(float).eps * np.abs(lines).max(axis=(0, 1))
    shaping = kink > np.maximum(rounding, 3 * _LEAST_KINK * bends)
    least, most = _KINK_RATIO
    return bool((shaping & (least * kink <= change) & (change <= most * kink)).any())


def _peak(padded: Array, contact: Mask, least: float) -> Peak:
    """Return the peak of all maxima of at least ``least``; fields have a frame of `_REACH` elements."""
    i, j = _maxima(padded, _REACH, least)
    heights, drops, rests = _parabolas(_lines(padded, i, j, _REACH))
    around = contact[i - 1, j] & contact[i + 1, j] & contact[i, j - 1] & contact[i, j + 1]
    best = int(np.argmax(heights))
    return Peak(float(heights[best]), float(drops[best]), float(rests.max()), bool(around.all()))


def _maxima(padded: Array, frame: int, least: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the places in a framed field: at least ``least``, and no lower than those beside."""
    inner, back, ahead = slice(frame, -frame), slice(frame - 1, -frame - 1), slice(frame + 1, 1 - frame)
    field = padded[inner, inner]
    maxima: Mask = field >= least
    for neighbour in (padded[back, inner], padded[ahead, inner], padded[inner, back], padded[inner, ahead]):
        maxima &= field >= neighbour
    i, j = np.divmod(np.flatnonzero(maxima), maxima.shape[1])
    return i + frame, j + frame


def _lines(padded: Array, i: NDArray[np.intp], j: NDArray[np.intp], reach: int) -> Array:
    """Return the elements to ``reach`` about each place, along x and y: ``(2, 2 reach + 1, n)``."""
    near = np.arange(-reach, reach + 1)[:, None]
    return np.array([padded[i + near, j], padded[i, j + near]])


def _parabolas(lines: Array) -> tuple[Array, Array, Array]:
    """Return the height, drop and non-parabolicity of maxima with ``lines`` (2, 5, n) about them."""
    farther_back, back, top, ahead, farther = lines.swapaxes(0, 1)
    bends, rise = 2 * top - back - ahead, ahead - back
    gains = np.zeros_like(bends)
    np.divide(rise, 8 * bends, out=gains, where=bends > 0)
    gains *= rise  # in this order no number leaves its range
    drops = bends.sum(axis=0)
    rest = np.abs(farther_back + farther - 4 * (back + ahead) + 6 * top).sum(axis=0)
    shares = np.zeros_like(drops)
    np.divide(rest, 3 * drops, out=shares, where=drops > 0)
    return top[0] + gains.sum(axis=0), drops, np.minimum(shares, 1.0)
