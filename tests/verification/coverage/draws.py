"""Random draws: whether they keep to a range and use it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np


def fills(values: Sequence[float], low: float, high: float, *, logarithmic: bool = True) -> bool:
    """Whether values lie between the bounds, some in each outer fifth (40 draws miss one in 1 of 7500)."""
    places = np.log(values) if logarithmic else np.array(values)
    ends = np.log([low, high]) if logarithmic else np.array([low, high])
    place = (places - ends[0]) / (ends[1] - ends[0])
    return bool(place.min() >= -1e-9 and place.max() <= 1 + 1e-9 and place.min() < 0.2 and place.max() > 0.8)


class Range(NamedTuple):
    """A number of the scenes of a class, None of a scene without it, and the ends that its draws fill."""

    kind: str
    name: str
    of: Callable[[Any], float | None]
    low: float
    high: float
    logarithmic: bool = True

    def filled_by(self, drawn: Iterable[Any]) -> bool:
        """Whether the numbers of these scenes fill the range."""
        values = [value for one in drawn if (value := self.of(one)) is not None]
        return fills(values, self.low, self.high, logarithmic=self.logarithmic)
