"""Ends of a contact, between the nodes of its pressure.

At the trailing end of a sliding contact the pressure rises as distance^g, at the leading end as
distance^(1 - g), with cot(pi g) = coupling * beta (Galin 1953); g = 1/2 without coupling.  So f^(1/g) rises
linearly: a cubic fitted to it where it is between 2 % and 30 % of its maximum, away from the outermost
nodes' wiggles, is continued to zero.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LOW, HIGH = 0.02, 0.30  # shares of the maximum of f^(1/g); others move ends by 1e-4 of the length
WIGGLY = 4  # nodes per degree of the fitted polynomial, up to the cubic: fewer swing on coarse meshes
REACH = 2.0  # the end is within so many edges of the last loaded node


def contact_ends(
    x: Array, pressure: Array, slip: float = 0.0, nodes_per_degree: int = WIGGLY
) -> tuple[float, float]:
    """Return both ends (abscissae) for pressures >= 0 at nodes x (n,); `slip` = coupling * beta.

    Smooth pressures do with 2 `nodes_per_degree` of the fit.

    >>> x = np.linspace(-1.0, 1.0, 401)
    >>> [round(end, 4) for end in contact_ends(x, np.sqrt(np.maximum(0.0, 0.63**2 - x**2)))]
    [-0.63, 0.63]
    """
    g = 0.5 - math.atan(slip) / math.pi
    peak = int(np.argmax(pressure))
    left = _end(-x[peak::-1], pressure[peak::-1] ** (1.0 / g), nodes_per_degree)
    return -left, _end(x[peak:], pressure[peak:] ** (1.0 / (1.0 - g)), nodes_per_degree)


def _end(x: Array, power: Array, nodes_per_degree: int) -> float:
    """Return the zero to the right of `power`'s peak; the last loaded node if there are few."""
    share = power / power[0]
    fitted = (share > LOW) & (share < HIGH)
    last = int(np.flatnonzero(share > 0)[-1])
    degree = min(3, int(np.count_nonzero(fitted)) // nodes_per_degree)
    if degree == 0:
        return float(x[last])
    # x as a polynomial of the share: its value at share 0 needs no root
    end = float(np.polynomial.Polynomial.fit(share[fitted], x[fitted], degree)(0.0))
    slack = REACH * float(x[last] - x[last - 1])
    return float(np.clip(end, x[last] - slack, x[last] + slack))
