"""Graded tensor meshes of half a block: fine under the load, coarser outwards, capped where it waves.

A coarse set of intervals is fixed first; `level` n then cuts every one of them in n, so that three levels
are three members of one refinement family. Lengths in units of a, half the loaded element's edge.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Nodes stand on the loaded element's edge and on the centres of its first three neighbours.
MARKS = (0.0, 1.0, 2.0, 4.0, 6.0)


@dataclass(frozen=True)
class Sizes:
    """Interval length wanted at distance s: `core` up to `even`, then `growth` more per unit, up to `cap`."""

    core: float
    even: float
    cap: float = np.inf
    growth: float = 0.7

    def intervals(self, marks: tuple[float, ...], level: int) -> Array:
        """Return the nodes on all marks and between them, at equal steps of the integral of 1 / size."""
        s = np.concatenate(([0.0], np.geomspace(1e-3, marks[-1], 4000)))
        middle = 0.5 * (s[1:] + s[:-1])
        size = np.minimum(self.core + self.growth * np.maximum(middle - self.even, 0.0), self.cap)
        count = np.concatenate(([0.0], np.cumsum(np.diff(s) / size)))
        nodes = [np.array([marks[0]])]
        for start, end in pairwise(marks):
            first, last = np.interp([start, end], s, count)
            steps = max(1, round(last - first)) * level
            piece = np.interp(np.linspace(first, last, steps + 1), count, s)[1:]
            piece[-1] = end
            nodes.append(piece)
        return np.concatenate(nodes)


@dataclass(frozen=True)
class Block:
    """Element boundaries along x (both sides), y (from the symmetry plane) and zeta (-radius to 0)."""

    x: Array
    y: Array
    zeta: Array

    @property
    def elements(self) -> int:
        """Number of hexahedra."""
        return (self.x.size - 1) * (self.y.size - 1) * (self.zeta.size - 1)


def block(
    radius: float,
    wavelength: float,
    level: int,
    *,
    waves_across: bool,
    edges: tuple[float, float] = (-1.0, 1.0),
) -> Block:
    """Return the half block |x|, y, -zeta <= radius around an element that spans `edges` in x and -1..1 in y.

    Intervals are at most half a wave where the surface waves, so level 2 has four quadratic elements a wave.
    """
    waving = Sizes(core=1.0, even=2.0, cap=0.5 * wavelength).intervals((*MARKS, radius), level)
    plain = Sizes(core=1.0, even=2.0).intervals((*MARKS, radius), level)
    depth = Sizes(core=0.5, even=0.0).intervals((0.0, radius), level)
    x = np.concatenate((-waving[:0:-1], waving))
    # moving the loaded element's edges stretches the intervals beside them and moves no other node
    places = (-radius, -2.0, edges[0], 0.0, edges[1], 2.0, radius)
    x = np.interp(x, (-radius, -2.0, -1.0, 0.0, 1.0, 2.0, radius), places)
    return Block(x, waving if waves_across else plain, -depth[::-1])
