"""Numbers at a prescribed approach that counts from the first contact of the surfaces themselves.

Approaches count from first contact, which a grid has at its highest elements only. The peak of the gap
turned over lies higher (`peak`), so at the prescribed approach the bodies indent each other less than on the
grid. The effect on a number is that of its power of the approach in Hertz contact.
"""

from __future__ import annotations

import math
import sys
from dataclasses import replace

from refimpl.accuracy.constants import constant
from refimpl.accuracy.grid_features import GridFeatures

# standard deviation of the peak of a gap, over its curvature drop; on a sharp crest, whose tip lies above it
PEAK_ERROR, CREST_ERROR = constant("first_contact_smooth"), constant("first_contact_crest")
HERTZ_EXPONENTS = {
    "normal_force": 1.5,
    "binormal_force": 1.5,
    "contact_area": 1.0,
    "contact_area_corrected": 1.0,
    "plastic_area": 1.0,
    "max_pressure": 0.5,
}
"""Exponents of the approach (Hertz 1882); friction is tau times the area plus a share of the force."""


def at_first_contact(features: GridFeatures) -> GridFeatures:
    """Return features at a prescribed approach, corrected for a first contact that lies too low."""
    approach = features.numbers["approach"]
    indentation = approach + features.first_contact.height
    if features.loaded or indentation == 0 or not features.numbers["normal_force"] > 0:
        return features
    share = approach / indentation
    return _at(features, share) if _presses(features, share) else features


def first_contact_bounds(features: GridFeatures) -> dict[str, float]:
    """Return 95 % bounds of the errors that first contact causes at a prescribed approach."""
    share = 2 * first_contact_share(features)
    if math.isinf(share) or not _presses(features, 1 / (1 + share)):
        return dict.fromkeys(features.numbers, math.inf)
    less = _at(features, 1 / (1 + share)).numbers
    return {name: abs(value - less[name]) for name, value in features.numbers.items()}


def first_contact_share(features: GridFeatures) -> float:
    """Return the standard deviation of the first contact, over the approach; infinite over none."""
    approach = abs(features.numbers["approach"])
    return first_contact_error(features) / approach if approach else math.inf


def first_contact_error(features: GridFeatures) -> float:
    """Return the standard deviation of the height of first contact (m)."""
    peak = features.first_contact
    drop = peak.curvature_drop
    return peak.widened(PEAK_ERROR * drop) if peak.smooth else CREST_ERROR * drop


def _presses(features: GridFeatures, share: float) -> bool:
    """Return whether the force at that share of the approach is a normal double."""
    force: float = features.numbers["normal_force"] * share ** HERTZ_EXPONENTS["normal_force"]
    return force > sys.float_info.min


def _at(features: GridFeatures, share: float) -> GridFeatures:
    numbers = {
        name: value * share ** HERTZ_EXPONENTS.get(name, 0.0) for name, value in features.numbers.items()
    }
    force, tau = features.numbers["normal_force"], features.dmu_dA * features.numbers["normal_force"]
    rest = features.numbers["friction_force"] - tau * features.numbers["contact_area"]
    numbers["friction_force"] = tau * numbers["contact_area"] + rest * numbers["normal_force"] / force
    numbers["friction_coefficient"] = numbers["friction_force"] / numbers["normal_force"]
    peak = replace(features.peak, height=features.peak.height * share ** HERTZ_EXPONENTS["max_pressure"])
    moved = replace(features, numbers=numbers, peak=peak, dmu_dA=tau / numbers["normal_force"])
    return replace(moved, numbers=numbers | moved.corrected)
