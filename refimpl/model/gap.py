"""What solvers stop by and certificates state: the complementarity gap over the elastic energy."""

from __future__ import annotations

import math


def relative_gap(duality: float, energy: float) -> float:
    """Complementarity gap over elastic energy; an exact state without energy has none."""
    if duality == 0:
        return 0.0
    return duality / energy if energy > 0 else math.inf
