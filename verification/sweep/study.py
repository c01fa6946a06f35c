"""A study: a base scene, what varies, and the runs that follow."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from refimpl.errors import InputError
from verification.sweep.run import COORDINATES, Run, code_digest, file_digest

SCENE_AXES = ("load", "sliding_direction", "sliding_offset")
FRICTION_AXES = ("tau", "beta")
ROUGHNESS_AXES = ("upper_rms", "lower_rms", "correlation_length")
AXES = ("grid", *ROUGHNESS_AXES, *SCENE_AXES, *FRICTION_AXES)
MAX_RUNS = 1_000_000

Table = dict[str, Any]


@dataclass(frozen=True)
class Study:
    """A base scene and what varies. Bodies' Gaussian parts get the seeds ``first_seed + 2 k`` (upper) and
    ``first_seed + 2 k + 1`` (lower) in realisation k, whatever else varies, so that roughnesses, loads and
    directions are compared on the same surfaces.

    ``vary`` maps names of `AXES` to their values (SI, rad); an rms of 0 leaves that body's roughness out.
    Realisations are of Gaussian roughness: where a point has none left, they are all one and the same run.
    ``normalise`` overrides that of the base scene's Gaussian parts unless None. ``settings`` go to
    `refimpl.solve`. ``files`` are those that the study was read from: its own, its scene's, its surfaces'.
    ``notes`` say what was chosen for it. ``grid`` counts elements along the longer side of a rectangle.
    """

    scene: Table
    realisations: int
    first_seed: int
    normalise: bool | None
    vary: Mapping[str, tuple[float, ...]]
    settings: Mapping[str, Any]
    files: tuple[Path, ...] = ()
    notes: tuple[str, ...] = ()

    def runs(self) -> Iterator[Run]:
        """All runs, realisations outermost, then the axes in the order of `AXES`."""
        files = measured_files(self.scene)
        values = [self.vary.get(axis, (None,)) for axis in AXES]
        for k in range(self.realisations):
            for point in itertools.product(*values):
                yield self._run(k, dict(zip(AXES, point, strict=True)), files)

    @property
    def is_rough(self) -> bool:
        """Whether realisations differ anywhere: at some point, a surface is Gaussian."""
        return any(
            _gaussian(self.scene[side], "rms") and any(self.vary.get(f"{side}_rms", (True,)))
            for side in ("upper", "lower")
        )

    def __len__(self) -> int:
        number = self.realisations
        for values in self.vary.values():
            number *= len(values)
        return number

    def _run(self, k: int, point: Mapping[str, Any], files: Mapping[str, str]) -> Run:
        scene = {name: value for name, value in self.scene.items() if name not in ("upper", "lower")}
        scene |= {axis: point[axis] for axis in SCENE_AXES if point[axis] is not None}
        friction = {axis: point[axis] for axis in FRICTION_AXES if point[axis] is not None}
        scene["friction"] = self.scene["friction"] | friction
        for side, name in enumerate(("upper", "lower")):
            scene[name] = self._body(name, self.first_seed + 2 * k + side, point)
        coordinates = {
            "realisation": k,
            "grid": int(point["grid"]),
            "load": scene["load"],
            "upper_rms": _gaussian(scene["upper"], "rms"),
            "lower_rms": _gaussian(scene["lower"], "rms"),
            "correlation_length": _length(scene),
            "sliding_direction": scene["sliding_direction"],
            "sliding_offset": scene["sliding_offset"],
            "tau": scene["friction"]["tau"],
            "beta": scene["friction"]["beta"],
        }
        inputs = {
            "scene": scene,
            "grid": int(point["grid"]),
            "solve": dict(self.settings),
            "code": code_digest(),
            "files": dict(files),
        }
        return Run({name: coordinates[name] for name in COORDINATES}, inputs)

    def _body(self, name: str, seed: int, point: Mapping[str, Any]) -> Table:
        body: Table = self.scene[name]
        rms, length = point[f"{name}_rms"], point["correlation_length"]
        parts = []
        for part in body["surface"]:
            if part["kind"] != "gaussian":
                parts.append(part)
            elif rms != 0:
                change: Table = {"seed": seed}
                change |= {} if rms is None else {"rms": float(rms)}
                change |= {} if length is None else {"correlation_length": float(length)}
                change |= {} if self.normalise is None else {"normalise": self.normalise}
                parts.append(part | change)
        return body | {"surface": parts or [{"kind": "flat"}]}


def _gaussian(body: Table, key: str) -> float:
    return next((part[key] for part in body["surface"] if part["kind"] == "gaussian"), 0.0)


def _length(scene: Table) -> float | None:
    """The correlation length of the scene's roughness; None without roughness or where the bodies differ."""
    lengths = {_gaussian(scene[name], "correlation_length") for name in ("upper", "lower")} - {0.0}
    return lengths.pop() if len(lengths) == 1 else None


def measured_files(scene: Table) -> dict[str, str]:
    """Return the digests of a scene's measured surfaces by path; raise InputError for a missing file."""
    parts = [part for name in ("upper", "lower") for part in scene[name]["surface"]]
    paths = [Path(part["path"]) for part in parts if part["kind"] == "measured"]
    digests = {}
    for path in paths:
        if not os.path.isfile(path):  # of any name, however long
            raise InputError("scene", str(path), "a measured surface's file")
        try:
            digests[str(path)] = file_digest(path)
        except OSError as refused:
            raise InputError("scene", str(path), f"a file that can be read ({refused.strerror})") from refused
    return digests
