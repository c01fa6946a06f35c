"""Random draws: whether they keep to a range and use it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def fills(values: Sequence[float], low: float, high: float, *, logarithmic: bool = True) -> bool:
    """Whether values lie between the bounds, some in each outer fifth (40 draws miss one in 1 of 7500)."""
    places = np.log(values) if logarithmic else np.array(values)
    ends = np.log([low, high]) if logarithmic else np.array([low, high])
    place = (places - ends[0]) / (ends[1] - ends[0])
    return bool(place.min() >= -1e-9 and place.max() <= 1 + 1e-9 and place.min() < 0.2 and place.max() > 0.8)
