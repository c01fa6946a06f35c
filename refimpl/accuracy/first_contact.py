"""Numbers at a prescribed approach, as if it counted from where the surfaces themselves touch first.

Approaches count from first touch, of which a grid knows its highest elements only. The gap's summit lies
higher (`refimpl.accuracy.peak`), so at the approach prescribed the bodies are less far into one another than
on the grid. What that takes of a number is foretold by its power of the approach in Hertz' contact.
"""

from __future__ import annotations

import math
import sys
from dataclasses import replace

from refimpl.accuracy.grid_features import GridResult

TOUCH = 0.02  # of its drop: how far off the summit of a gap is found (one standard deviation)
POWERS = {
    "normal_force": 1.5,
    "binormal_force": 1.5,
    "contact_area": 1.0,
    "contact_area_corrected": 1.0,
    "max_pressure": 0.5,
}
"""Of the approach (Hertz 1882); friction goes as the area with tau's share, as the force with the rest."""


def touched(result: GridResult) -> GridResult:
    """A result at a prescribed approach, less what the grid's first touch lies below the surfaces' own."""
    if result.loaded or not result.numbers["normal_force"] > 0:
        return result
    approach = result.numbers["approach"]
    share = approach / (approach + result.touch.height)
    return _at(result, share) if _presses(result, share) else result


def missed(result: GridResult) -> dict[str, float]:
    """95 % bounds of what numbers at a prescribed approach may be off by for it."""
    share = 2 * missed_share(result)
    if math.isinf(share) or not _presses(result, 1 / (1 + share)):
        return dict.fromkeys(result.numbers, math.inf)
    less = _at(result, 1 / (1 + share)).numbers
    return {name: abs(value - less[name]) for name, value in result.numbers.items()}


def missed_share(result: GridResult) -> float:
    """Standard deviation of the first touch, over the approach."""
    return first_touch(result) / abs(result.numbers["approach"])


def first_touch(result: GridResult) -> float:
    """Standard deviation of the first touch (m)."""
    return result.touch.widened(TOUCH * result.touch.drop)


def _presses(result: GridResult, share: float) -> bool:
    """Whether a force that numbers can hold is left at that share of the approach."""
    force: float = result.numbers["normal_force"] * share ** POWERS["normal_force"]
    return force > sys.float_info.min


def _at(result: GridResult, share: float) -> GridResult:
    """The result at that share of its approach, by Hertz' powers."""
    numbers = {name: value * share ** POWERS.get(name, 0.0) for name, value in result.numbers.items()}
    force, tau = result.numbers["normal_force"], result.slip * result.numbers["normal_force"]
    rest = result.numbers["friction_force"] - tau * result.numbers["contact_area"]
    numbers["friction_force"] = tau * numbers["contact_area"] + rest * numbers["normal_force"] / force
    numbers["friction_coefficient"] = numbers["friction_force"] / numbers["normal_force"]
    peak = replace(result.peak, height=result.peak.height * share ** POWERS["max_pressure"])
    return replace(result, numbers=numbers, peak=peak, slip=tau / numbers["normal_force"])
