"""Enclosure files: one JSON document per scene with its problem, its proven solution and its provenance.

Numbers are a midpoint and a radius: the exact value lies within the radius of the midpoint, both doubles. The
problem's own numbers are exact. A pressure list follows the contact map's marks, row by row.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

import refimpl as rf
from refimpl.grid import Array, Mask
from verification.enclosures.proof import BITS, Ball, Proof
from verification.enclosures.scenes import SIDE, EnclosedScene
from verification.exact.kernel_reference import arb
from verification.output.files import to_json, write_text
from verification.output.provenance import provenance

FORMAT = "rough-friction golden scene, version 1"
_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Enclosed:
    """The exact value is within ``radius`` of ``mid``."""

    mid: float
    radius: float

    def misses(self, value: float) -> float:
        """Return the distance of ``value`` from the farthest point of the enclosure."""
        return abs(value - self.mid) + self.radius

    def meets(self, other: Enclosed) -> bool:
        """Return True if the enclosures have a common point, as true enclosures must."""
        return abs(self.mid - other.mid) <= self.radius + other.radius


@dataclass(frozen=True, eq=False)
class Enclosure:
    """A stored scene: contact set, pressure midpoints with their largest radius (Pa), enclosed numbers.

    ``numbers`` holds the approach (m, from first contact), the forces (N) and the friction coefficient.
    """

    scene: EnclosedScene
    contact: Mask
    pressure: Array
    radius: float
    numbers: Mapping[str, Enclosed]
    margins: Mapping[str, float | None]


def document(known: EnclosedScene, proof: Proof) -> dict[str, Any]:
    """Return the JSON document of a proof."""
    return {
        "format": FORMAT,
        "name": known.name,
        "stresses": known.stresses,
        "problem": _problem(known),
        "proof": {
            "arithmetic": f"python-flint arb, {BITS} bits",
            "contact": _drawn(proof.contact),
            **_margins(proof),
        },
        "solution": {
            "pressures": [asdict(enclosed(ball)) for ball in proof.pressures],
            "approach": asdict(enclosed(proof.approach)),
            **{name: asdict(enclosed(ball)) for name, ball in proof.forces.items()},
        },
        "provenance": provenance(),
    }


def enclosed(ball: Ball) -> Enclosed:
    """Return the ball in doubles: its midpoint, and a radius that covers the midpoint's rounding too."""
    mid = float(ball.mid())
    radius = float(abs(ball - arb().arb(mid)).upper())
    return Enclosed(mid, radius * (1 + 4 * _EPS))


def write(known: EnclosedScene, proof: Proof, folder: Path) -> Path:
    """Write ``folder/NAME.json`` in one step; its path."""
    path = folder / f"{known.name}.json"
    write_text(to_json(document(known, proof)), path)
    return path


@cache
def stored() -> tuple[Enclosure, ...]:
    """Return all enclosed scenes of the package, by name. Raises FileNotFoundError without any."""
    folder = resources.files("verification.enclosures")
    files = sorted((file for file in folder.iterdir() if file.name.endswith(".json")), key=lambda f: f.name)
    if not files:
        raise FileNotFoundError("no enclosed scenes: run python -m verification.enclosures --json DIR")
    return tuple(parsed(json.loads(file.read_text(encoding="utf-8"))) for file in files)


def named(name: str) -> Enclosure:
    """Return the stored scene of this name. Raises StopIteration for an unknown one."""
    return next(known for known in stored() if known.scene.name == name)


def parsed(content: Mapping[str, Any]) -> Enclosure:
    """Return a document read back. Raises ValueError for another format, KeyError for a missing part."""
    if content["format"] != FORMAT:
        raise ValueError(f"not a file of the format {FORMAT!r}")
    contact = np.array([[mark == "#" for mark in row] for row in content["proof"]["contact"]])
    solution = content["solution"]
    pressure = np.zeros(contact.shape)
    pressure[contact] = [entry["mid"] for entry in solution["pressures"]]
    numbers = {name: Enclosed(**entry) for name, entry in solution.items() if name != "pressures"}
    margins = {name: content["proof"][name] for name in ("smallest pressure", "smallest separation")}
    return Enclosure(
        scene=_scene(content),
        contact=contact,
        pressure=pressure,
        radius=max(entry["radius"] for entry in solution["pressures"]),
        numbers=numbers,
        margins=margins,
    )


_ARRAYS = ("heights", "tan_x", "tan_y")
_NUMBERS = ("approach", "direction", "periodic")


def _problem(known: EnclosedScene) -> dict[str, Any]:
    arrays = {name: getattr(known, name) for name in _ARRAYS}
    return {
        "M": known.M,
        "side": SIDE,
        "lower": {"E": known.lower.E, "nu": known.lower.nu},
        "upper": {"E": known.upper.E, "nu": known.upper.nu},
        "friction": {"tau": known.friction.tau, "beta": known.friction.beta},
        "load": known.load if known.approach is None else None,
        **{name: getattr(known, name) for name in _NUMBERS},
        **{name: None if array is None else array.tolist() for name, array in arrays.items()},
    }


def _scene(content: Mapping[str, Any]) -> EnclosedScene:
    problem = content["problem"]
    arrays: Any = {n: None if problem[n] is None else np.array(problem[n]) for n in _ARRAYS}
    return EnclosedScene(
        name=content["name"],
        stresses=content["stresses"],
        lower=rf.Material(**problem["lower"]),
        upper=rf.Material(**problem["upper"]),
        friction=rf.Friction(**problem["friction"]),
        load=1.0 if problem["load"] is None else problem["load"],
        **{name: problem[name] for name in _NUMBERS},
        **arrays,
    )


def _margins(proof: Proof) -> dict[str, float | None]:
    """Return the least pressure over the peak and w over the approach (None: full contact), proven."""
    pressures = [float(ball) for ball in proof.pressures]
    separations = [float(ball) for ball in proof.separations]
    return {
        "smallest pressure": min(pressures) / max(pressures),
        "smallest separation": min(separations) / float(proof.approach) if separations else None,
        "largest relative radius": max(
            float(ball.rad()) / abs(float(ball)) for ball in (*proof.pressures, *proof.separations)
        ),
    }


def _drawn(contact: Mask) -> list[str]:
    return ["".join("#" if touching else "." for touching in row) for row in contact]


def relative(value: float, exact: Enclosed, scale: float) -> float:
    """Return the largest distance of ``value`` from the enclosure over ``scale``; 0 of equal zeros.

    >>> relative(1.5, Enclosed(1.0, 0.25), 1.0)
    0.75
    """
    miss = exact.misses(value)
    return 0.0 if miss == 0 else miss / scale if scale else math.inf
