"""Four scenes, their numbers by the one-file reference, and by whichever `refimpl` is imported."""

from __future__ import annotations

import json
import math
import sys
from typing import Any

import numpy as np

from tests.refimpl.test_plain import drawn

SEEDS = {"periodic approach": 64, "cap of the upper body": 61, "steep": 113, "cycled": 313}
"""Seeds of `drawn`."""

Record = dict[str, Any]


def expected(name: str) -> Record:
    """Numbers by the one-file reference, with the status that production should end with."""
    scene = drawn(SEEDS[name])
    s = scene.plain()
    assert s.ended == "converged"
    cycled = scene.tau > 0 and bool(((s.pressure > 0) & ~s.active).any())
    numbers = {key: getattr(s, key) for key in SCALES}
    return {"status": "cycled" if cycled else "converged"} | numbers


def found(name: str) -> Record:
    try:
        s = drawn(SEEDS[name]).production()
    except Exception as raised:  # whatever a fault makes of the solver
        return {"status": f"{type(raised).__name__}: {raised}"[:200]}
    return {
        "status": s.status.value,
        "pressure": s.pressure.tolist(),
        "traction": s.traction.tolist(),
        "mu": s.friction_coefficient,
        "normal": s.normal_force,
        "friction": s.friction_force,
        "transverse": s.binormal_force,
        "area": s.contact_area,
        "plastic_area": s.plastic_area,
        "approach": s.approach,
        "p_max": s.max_pressure,
    }


SCALES = {
    "pressure": "p_max",
    "traction": "p_max",
    "mu": "mu",
    "normal": "normal",
    "friction": "normal",
    "transverse": "normal",
    "area": "area",
    "plastic_area": "area",
    "approach": "approach",
    "p_max": "p_max",
}
"""Numbers compared, and what their differences are relative to."""


def difference(record: Record, reference: Record) -> float:
    """Return the largest relative difference; infinite if a number is missing or NaN."""
    if "mu" not in record:
        return math.inf
    errors = [
        np.abs(np.subtract(record[key], reference[key])).max() / abs(reference[scale])
        for key, scale in SCALES.items()
    ]
    return float(max(errors)) if np.all(np.isfinite(errors)) else math.inf


if __name__ == "__main__":
    json.dump({name: found(name) for name in SEEDS}, sys.stdout)
