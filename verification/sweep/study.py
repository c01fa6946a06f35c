"""The definition of a study: one TOML file, checked in full before anything is solved."""

from __future__ import annotations

import itertools
import math
import os
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any

from refimpl import read_scene
from refimpl.errors import InputError, require_number
from refimpl.planning.plan import METHODS
from refimpl.planning.terms import Forced
from refimpl.scene.scene_file import scene_to_dict
from verification.sweep import posable
from verification.sweep.run import COORDINATES, Run, code_digest, file_digest

SCENE_AXES = ("load", "sliding_direction", "sliding_offset")
FRICTION_AXES = ("tau", "beta")
ROUGHNESS_AXES = ("upper_rms", "lower_rms", "correlation_length")
AXES = ("grid", *ROUGHNESS_AXES, *SCENE_AXES, *FRICTION_AXES)
KEYS = ("scene", "realisations", "first_seed", "normalise", "vary", "solve")
SOLVE_KEYS = ("method", "oblique", "slope_correction", "tolerance")
MAX_RUNS = 1_000_000
_MAX_BYTES = 1_000_000  # a study is a page of text

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
    """

    scene: Table
    realisations: int
    first_seed: int
    normalise: bool | None
    vary: Mapping[str, tuple[float, ...]]
    settings: Mapping[str, Any]
    files: tuple[Path, ...] = ()

    def runs(self) -> Iterator[Run]:
        """All runs, realisations outermost, then the axes in the order of `AXES`."""
        files = _measured_files(self.scene)
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


def read_study(path: str | Path) -> Study:
    """The study of a TOML file, or a shipped study by its name (see `shipped_studies`).

    The scene is a shipped one's name or a path relative to the file. Raises InputError naming the field.
    """
    path = Path(path)
    if not os.path.isfile(path):  # of any name, however long
        if str(path) not in shipped_studies():
            raise InputError("study", str(path), f"a TOML file, or one of {', '.join(shipped_studies())}")
        path = Path(str(resources.files("verification").joinpath("studies", f"{path}.toml")))
    if path.stat().st_size > _MAX_BYTES:
        raise InputError("study", str(path), f"a TOML file of at most {_MAX_BYTES} bytes")
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as refused:
        raise InputError("study", str(path), f"a file that can be read ({refused.strerror})") from refused
    except (ValueError, RecursionError) as error:  # TOML, UTF-8, or a number of thousands of digits
        raise InputError("study", str(path), f"valid TOML ({error})") from error
    study = study_from_dict(table, path.parent)
    return replace(study, files=(path, *study.files))


def shipped_studies() -> tuple[str, ...]:
    """Names of the studies that ship as package data.

    >>> "table3" in shipped_studies()
    True
    """
    folder = resources.files("verification").joinpath("studies")
    return tuple(sorted(item.name[:-5] for item in folder.iterdir() if item.name.endswith(".toml")))


def study_from_dict(table: Mapping[str, Any], folder: Path = Path()) -> Study:
    """The study of a parsed TOML table, with all that its runs would be refused for refused (`posable`)."""
    _refuse_unknown("study", table, KEYS)
    name = table.get("scene")
    if not isinstance(name, str) or not name:
        raise InputError("scene", name, "a shipped scene's name or the path of a scene file")
    beside = folder / name
    scene_file = beside if os.path.isfile(beside) else Path(name)
    vary, settings = table.get("vary", {}), table.get("solve", {})
    for key, value in (("vary", vary), ("solve", settings)):
        if not isinstance(value, Mapping):
            raise InputError(key, value, f"a [{key}] table")
    _refuse_unknown("vary", vary, AXES)
    _check_settings(settings)
    normalise = table.get("normalise")
    if normalise is not None and not isinstance(normalise, bool):
        raise InputError("normalise", normalise, "true or false")
    scene = scene_to_dict(read_scene(scene_file))
    study = Study(
        scene=scene,
        realisations=_whole("realisations", table.get("realisations", 1), at_least=1),
        first_seed=_whole("first_seed", table.get("first_seed", 1), at_least=0),
        normalise=normalise,
        vary={axis: _values(axis, vary[axis]) for axis in vary},
        settings=dict(settings),
        files=(scene_file, *map(Path, _measured_files(scene))),
    )
    _check(study)
    return study


def _check(study: Study) -> None:
    if "grid" not in study.vary:
        raise InputError("vary.grid", None, "a list of elements per side")
    runs = math.prod([study.realisations, *map(len, study.vary.values())])
    if runs > MAX_RUNS:
        raise InputError("vary", f"{runs} runs", f"at most {MAX_RUNS} runs")
    for side in ("upper", "lower"):
        gaussian = sum(part["kind"] == "gaussian" for part in study.scene[side]["surface"])
        if gaussian > 1:
            raise InputError(f"scene.{side}.surface", f"{gaussian} Gaussian parts", "at most one in a study")
        if f"{side}_rms" in study.vary and not gaussian:
            raise InputError(f"vary.{side}_rms", study.vary[f"{side}_rms"], "a scene with such a roughness")
    if study.realisations > 1 and not study.is_rough:
        raise InputError("realisations", study.realisations, "1: no surface of the scene is Gaussian")
    if "correlation_length" in study.vary and not study.is_rough:
        lengths = study.vary["correlation_length"]
        raise InputError("vary.correlation_length", lengths, "a scene with a Gaussian surface")
    for M in study.vary["grid"]:
        _whole("vary.grid", M, at_least=1)
    if study.scene["periodic"] and study.settings.get("method") == "paper":
        raise InputError("solve.method", "paper", "dense or fft for a periodic scene")
    _whole("first_seed", study.first_seed, at_least=0, below=2**63 - 2 * study.realisations)
    posable.check(study)


def _check_settings(settings: Mapping[str, Any]) -> None:
    """The [solve] table: what `refimpl.solve` would refuse, before there is a store or a worker."""
    _refuse_unknown("solve", settings, SOLVE_KEYS)
    if settings.get("method", "fft") not in METHODS:
        raise InputError("solve.method", settings["method"], f"one of {', '.join(METHODS)}")
    for name in ("oblique", "slope_correction"):
        if not isinstance(settings.get(name, True), bool):
            raise InputError(f"solve.{name}", settings[name], "true or false")
    if "tolerance" in settings:
        require_number("solve.tolerance", settings["tolerance"], "a number between 0 and 1", above=0, below=1)
    Forced(oblique=settings.get("oblique"), slope_correction=settings.get("slope_correction", False)).check()


def _values(axis: str, values: object) -> tuple[float, ...]:
    allowed = "a list of different finite numbers"
    if not isinstance(values, list) or not values:
        raise InputError(f"vary.{axis}", values, allowed)
    for value in values:
        require_number(f"vary.{axis}", value, allowed)
    if len(set(values)) != len(values):
        raise InputError(f"vary.{axis}", values, allowed)
    # 14 and 14.0 are one load, and must be one run; the grid is checked to be whole elsewhere.
    return tuple(values if axis == "grid" else map(float, values))


def _whole(name: str, value: object, *, at_least: int, below: int | None = None) -> int:
    whole = isinstance(value, int) and not isinstance(value, bool)
    if not whole or value < at_least or (below is not None and value >= below):  # type: ignore[operator]  # whole
        bound = "" if below is None else f" and below {below}"
        raise InputError(name, value, f"a whole number, at least {at_least}{bound}")
    return int(value)  # type: ignore[call-overload, no-any-return]  # checked above


def _gaussian(body: Table, key: str) -> float:
    return next((part[key] for part in body["surface"] if part["kind"] == "gaussian"), 0.0)


def _length(scene: Table) -> float | None:
    """The correlation length of the scene's roughness; None without roughness or where the bodies differ."""
    lengths = {_gaussian(scene[name], "correlation_length") for name in ("upper", "lower")} - {0.0}
    return lengths.pop() if len(lengths) == 1 else None


def _measured_files(scene: Table) -> dict[str, str]:
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


def _refuse_unknown(name: str, table: Mapping[str, Any], known: tuple[str, ...]) -> None:
    for key in table:
        if key not in known:
            raise InputError(f"{name}.{key}", table[key], f"no such key; known are {', '.join(known)}")
