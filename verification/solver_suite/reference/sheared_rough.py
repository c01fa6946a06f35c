"""Two sheared rough contacts with their fields and active sets, as reference data for any code.

    python -m verification.solver_suite.reference.sheared_rough

writes `sheared_rough.json.gz`: a ball on a rough flat of 24 x 24 elements, once with a settled contact edge,
once with an alternating one (`CYCLED`). No code of others has friction with tau on slopes, so the answer is
that of `refimpl/plain.py`, whose rule for tau decides where the edge alternates.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import refimpl as rf
from verification.output.result_files import write_result

FILE = Path(__file__).with_name("sheared_rough.json.gz")
SCENES = {"settled edge": 1, "alternating edge": 28}  # seeds of the flat
GRID, SIDE, LOAD, RADIUS = 24, 1.61e-3, 70.0, 0.14  # elements per side, m, N, m
STEEL, COPPER = rf.Material(E=200e9, nu=0.30), rf.Material(E=118e9, nu=0.30)
LAW = rf.Friction(tau=15e6, beta=0.08)
FIELDS = ("pressure", "traction")
NUMBERS = ("approach", "normal_force", "friction_force", "friction_coefficient", "contact_area")


def scene(seed: int) -> rf.Scene:
    """Return Table 1's pair with a rough flat of its own, coarse enough for dense matrices."""
    rough = rf.GaussianRoughness(rms=0.5e-6, correlation_length=300e-6, seed=seed)
    return rf.Scene(rf.Body(STEEL, rf.Sphere(RADIUS)), rf.Body(COPPER, rough), LAW, LOAD, SIDE)


def entry(seed: int, method: Literal["dense", "fft"] = "dense") -> dict[str, Any]:
    """Return problem and answer: heights (m, upwards), p and traction (Pa), mask of tau, numbers (SI).

    Row i along x, the direction of sliding of the upper body, column j along y.
    """
    posed = scene(seed)
    found = rf.solve(posed, GRID, method=method)
    lower, upper = posed.heights(found.grid)
    sheared = found.traction - LAW.beta * found.pressure > LAW.tau / 2
    return {
        "z_lower": lower.tolist(),
        "z_upper": upper.tolist(),
        **{name: getattr(found, name).tolist() for name in FIELDS},
        "active set of tau": sheared.astype(int).tolist(),
        "status": found.status.name,
        **{name: getattr(found, name) for name in NUMBERS},
    }


def document() -> dict[str, Any]:
    """Return the content of the file."""
    problem = {"load": LOAD, "lengths": [SIDE, SIDE], "tau": LAW.tau, "beta": LAW.beta}
    problem |= {"lower": [COPPER.E, COPPER.nu], "upper": [STEEL.E, STEEL.nu]}
    return {"problem": problem, "contacts": {name: entry(seed) for name, seed in SCENES.items()}}


if __name__ == "__main__":
    write_result(document(), FILE)
