"""A study: a base scene, what varies, and the runs that follow."""

from __future__ import annotations

import itertools
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from refimpl.errors import InputError
from verification.sweep.run import COORDINATES, UNKNOWN_GRID, Run, code_digest, file_digest

SCENE_AXES = ("load", "sliding_direction", "sliding_offset")
FRICTION_AXES = ("tau", "beta")
ROUGHNESS_AXES = ("upper_rms", "lower_rms", "correlation_length")
AXES = ("grid", *ROUGHNESS_AXES, *SCENE_AXES, *FRICTION_AXES)
RANDOM = ("gaussian", "self_affine")  # kinds of surfaces that have realisations
MAX_RUNS = 1_000_000

Table = dict[str, Any]


@dataclass(frozen=True)
class Study:
    """A base scene and what varies. Bodies' random parts get the seeds ``first_seed + 2 k`` (upper) and
    ``first_seed + 2 k + 1`` (lower) in realisation k, so that all points are compared on the same surfaces;
    with a ``first_seed`` of None they keep the scene's.

    ``vary`` maps names of `AXES`, and full names (``lower.surface[0].hurst``, ``lower.material.E``, of
    measured surfaces ``lower.surface[0].path``), to values (SI, rad); an rms of 0 leaves that body's
    roughness out, and a varied ``seed`` takes the place of the realisation's. Where a point has no random
    roughness left, realisations are one and the same run. ``normalise`` overrides that of Gaussian parts
    unless None. ``settings`` go to `refimpl.solve`. ``files`` are those that the study was read from;
    ``notes`` say what was chosen for it; ``unusable`` has, by axis and path, why varied files were refused.
    """

    scene: Table
    realisations: int
    first_seed: int | None
    normalise: bool | None
    vary: Mapping[str, tuple[Any, ...]]
    settings: Mapping[str, Any]
    files: tuple[Path, ...] = ()
    notes: tuple[str, ...] = ()
    unusable: Mapping[tuple[str, str], str] = field(default_factory=dict)

    def runs(self) -> Iterator[Run]:
        """Yield all runs, realisations outermost, then the axes in the order of `AXES`."""
        files = self.measured
        axes = (*AXES, *self.own_axes)
        values = [self.vary.get(axis, (None,)) for axis in axes]
        for k in range(self.realisations):
            for point in itertools.product(*values):
                yield self._run(k, dict(zip(axes, point, strict=True)), files)

    @property
    def measured(self) -> dict[str, str]:
        """Digests of all measured surfaces of the study by path; InputError for a missing file."""
        varied = [path for axis, paths in self.vary.items() if axis.endswith(".path") for path in paths]
        return digests_of([*measured_paths(self.scene), *varied])

    @property
    def own_axes(self) -> tuple[str, ...]:
        """The varied numbers of materials and surfaces, by their full names."""
        return tuple(axis for axis in self.vary if axis not in AXES)

    @property
    def finest(self) -> int:
        """Elements along the longer side of the finest grid; a usual one where none is given."""
        return int(max(self.vary.get("grid", (UNKNOWN_GRID,))))

    @property
    def is_rough(self) -> bool:
        """True if realisations differ anywhere: at some point, a surface is random."""
        return any(
            _random(self.scene[side]) and any(self.vary.get(f"{side}_rms", (True,)))
            for side in ("upper", "lower")
        )

    @property
    def has_correlation_length(self) -> bool:
        """True if a surface of the scene has one correlation length."""
        lengths = (_random(self.scene[side]).get("correlation_length") for side in ("upper", "lower"))
        return any(isinstance(length, float) for length in lengths)

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
            seed = None if self.first_seed is None else self.first_seed + 2 * k + side
            scene[name] = self._body(name, seed, point)
        grid = None if point["grid"] is None else int(point["grid"])
        own = {axis: point[axis] for axis in self.own_axes}
        coordinates = (
            scene
            | scene["friction"]
            | {
                "realisation": k,
                "grid": grid,
                "upper_rms": _random(scene["upper"]).get("rms", 0.0),
                "lower_rms": _random(scene["lower"]).get("rms", 0.0),
                "correlation_length": _length(scene),
                "parameters": json.dumps(own) if own else None,
            }
        )
        inputs = {
            "scene": scene,
            "grid": grid,
            "solve": dict(self.settings),
            "code": code_digest(),
            "files": {path: files[path] for path in measured_paths(scene)},
        }
        return Run({name: coordinates[name] for name in COORDINATES}, inputs)

    def _body(self, name: str, seed: int | None, point: Mapping[str, Any]) -> Table:
        body: Table = self.scene[name]
        rms, length = point[f"{name}_rms"], point["correlation_length"]
        parts = []
        for k, part in enumerate(body["surface"]):
            own = {axis: point[axis] for axis in self.own_axes if axis.startswith(f"{name}.surface[{k}].")}
            part = _changed(part, {axis.partition("].")[2]: value for axis, value in own.items()})
            if part["kind"] not in RANDOM:
                parts.append(part)
            elif rms != 0:
                is_given = seed is None or f"{name}.surface[{k}].seed" in own
                change: Table = {} if is_given else {"seed": seed}
                change |= {} if rms is None else {"rms": float(rms)}
                if part["kind"] == "gaussian":
                    change |= {} if length is None else {"correlation_length": float(length)}
                    change |= {} if self.normalise is None else {"normalise": self.normalise}
                parts.append(part | change)
        head = f"{name}.material."
        own = {axis.removeprefix(head): point[axis] for axis in self.own_axes if axis.startswith(head)}
        material = body["material"] | own
        return body | {"material": material, "surface": parts or [{"kind": "flat"}]}


def _random(body: Table) -> Table:
    return next((part for part in body["surface"] if part["kind"] in RANDOM), {})


def _length(scene: Table) -> float | None:
    """Return the correlation length of the scene's roughness; None without one, or with several."""
    found = [_random(scene[name]).get("correlation_length") for name in ("upper", "lower")]
    lengths = [length for length in found if length is not None]
    same = lengths and isinstance(lengths[0], float) and lengths.count(lengths[0]) == len(lengths)
    return lengths[0] if same else None


def _changed(part: Table, own: Mapping[str, Any]) -> Table:
    """Return a surface's table with other values; ``key[j]`` is one of a list."""
    for name, value in own.items():
        key, _, place = name.partition("[")
        old = part.get(key, ())  # absent where it is the default
        new = [value if j == int(place[:-1]) else same for j, same in enumerate(old)] if place else value
        part = part | {key: new}
    return part


def measured_paths(scene: Table) -> list[str]:
    """Return the paths of a scene's measured surfaces."""
    parts = [part for name in ("upper", "lower") for part in scene[name]["surface"]]
    return [str(part["path"]) for part in parts if part["kind"] == "measured"]


def digests_of(paths: Iterable[str]) -> dict[str, str]:
    """Return the digests of measured surfaces by path; raise InputError for a missing file."""
    digests = {}
    for path in paths:
        if not os.path.isfile(path):  # no error for long names
            raise InputError("scene", path, "a measured surface's file")
        try:
            digests[path] = file_digest(Path(path))
        except OSError as refused:
            raise InputError("scene", path, f"a file that can be read ({refused.strerror})") from refused
    return digests
