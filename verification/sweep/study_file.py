"""Studies from TOML files: every field checked before anything is solved."""

from __future__ import annotations

import math
import os
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Any

from refimpl import Scene, read_scene
from refimpl.errors import InputError, require_number
from refimpl.model.problem import Terms
from refimpl.planning.plan import METHODS
from refimpl.scene.parameters import parameters
from refimpl.scene.scene_file import read_toml, refuse_unknown, scene_to_dict
from verification.sweep import posable
from verification.sweep.study import AXES, FRICTION_AXES, MAX_RUNS, RANDOM, ROUGHNESS_AXES, Study

TEXTS = tomllib.loads(resources.files("verification").joinpath("sweep", "study_keys.toml").read_text("utf-8"))
KEYS, SOLVE_KEYS = tuple(TEXTS["study"]), tuple(TEXTS["solve"])
_PLACES = {"the top of a study": KEYS, "[vary]": AXES, "[solve]": SOLVE_KEYS}


def read_study(path: str | Path, *, keep_going: bool = False) -> Study:
    """Return the study of a TOML file, or a shipped study by its name (see `shipped_studies`).

    With ``keep_going``, varied files that cannot be used are skipped, and listed in ``unusable``.
    The scene is a shipped one's name or a path relative to the file. Raises InputError naming the field.
    """
    path = Path(path)
    if not os.path.isfile(path):  # no error for long names
        if str(path) not in shipped_studies():
            raise InputError("study", str(path), f"a TOML file, or one of {', '.join(shipped_studies())}")
        path = Path(str(resources.files("verification").joinpath("studies", f"{path}.toml")))
    study = study_from_dict(read_toml(path, "study"), path.parent, keep_going=keep_going)
    return replace(study, files=(path, *study.files))


def shipped_studies() -> tuple[str, ...]:
    """Return the names of the studies that ship as package data."""
    folder = resources.files("verification").joinpath("studies")
    return tuple(sorted(item.name[:-5] for item in folder.iterdir() if item.name.endswith(".toml")))


def study_from_dict(table: Mapping[str, Any], folder: Path = Path(), *, keep_going: bool = False) -> Study:
    """Return the study of a parsed TOML table, refused for all that its runs would be (`posable`)."""
    refuse_unknown("study", table, KEYS, _PLACES)
    name = table.get("scene")
    if not isinstance(name, str) or not name:
        raise InputError("scene", name, "a shipped scene's name or the path of a scene file")
    beside = folder / name
    scene_file = beside if os.path.isfile(beside) else Path(name)
    vary, settings = table.get("vary", {}), table.get("solve", {})
    for key, value in (("vary", vary), ("solve", settings)):
        if not isinstance(value, Mapping):
            raise InputError(key, value, f"a [{key}] table")
    _check_settings(settings)
    normalise = table.get("normalise")
    if normalise is not None and not isinstance(normalise, bool):
        raise InputError("normalise", normalise, "true or false")
    base = read_scene(scene_file)
    vary = _by_axis(vary)
    refuse_unknown("vary", vary, (*AXES, *varied_names(base)), _PLACES)
    _refuse_doubles(vary)
    scene = scene_to_dict(base)
    realisations = _whole("realisations", table.get("realisations", 1), at_least=1)
    first_seed = table.get("first_seed", 1 if realisations > 1 else None)
    study = Study(
        scene=scene,
        realisations=realisations,
        first_seed=None if first_seed is None else _whole("first_seed", first_seed, at_least=0),
        normalise=normalise,
        vary={axis: _values(axis, vary[axis], folder) for axis in vary},
        settings=dict(settings),
        files=(scene_file,),
    )
    study = _with_usable_files(study, keep_going)
    study = replace(study, files=(scene_file, *map(Path, study.measured)))
    if "side" not in scene and "size" not in scene:
        (x, y), limited = posable.covered_size(study)
        covered = "the largest that all measured surfaces cover at all offsets"
        note = f"no size given: {x:.6g} x {y:.6g} m, {covered}{limited}"
        study = replace(study, scene=scene | {"size": [x, y]}, notes=(note,))
    _check(study)
    return study


def _with_usable_files(study: Study, keep_going: bool) -> Study:
    """Return the study without refused files; without ``keep_going`` all are refused at once."""
    unusable = posable.unusable_files(study)
    if unusable and not keep_going:
        said = "".join(f"\n  {reason}" for reason in unusable.values())
        raise InputError("vary", f"{len(unusable)} files", f"usable ones (--keep-going runs the rest):{said}")
    usable = {
        axis: tuple(value for value in values if (axis, value) not in unusable)
        for axis, values in study.vary.items()
    }
    if not all(usable.values()):
        raise InputError("vary", [path for _, path in unusable], "a usable file on each axis")
    return replace(study, vary=usable, unusable=unusable)


def varied_names(scene: Scene) -> tuple[str, ...]:
    """Return the full names that a study of a scene may vary beside `AXES`: of surfaces and materials.

    >>> varied_names(read_scene("hertz"))[:3]
    ('upper.material.E', 'upper.material.nu', 'upper.surface[0].radius')
    """
    numbers = (name for name in parameters(scene) if ".surface[" in name or ".material." in name)
    table = scene_to_dict(scene)
    files = (
        f"{side}.surface[{k}].path"
        for side in ("upper", "lower")
        for k, part in enumerate(table[side]["surface"])
        if part["kind"] == "measured"
    )
    return (*numbers, *files)


def _check(study: Study) -> None:
    if "accuracy" in study.settings and "grid" in study.vary:
        raise InputError(
            "vary.grid", study.vary["grid"], "none beside solve.accuracy, which chooses the grid"
        )
    runs = math.prod([study.realisations, *map(len, study.vary.values())])
    if runs > MAX_RUNS:
        raise InputError("vary", f"{runs} runs", f"at most {MAX_RUNS} runs")
    for side in ("upper", "lower"):
        random = [part for part in study.scene[side]["surface"] if part["kind"] in RANDOM]
        if len(random) > 1:
            raise InputError(f"scene.{side}.surface", f"{len(random)} random parts", "at most one in a study")
        if f"{side}_rms" in study.vary and not (random and "rms" in random[0]):
            raise InputError(f"vary.{side}_rms", study.vary[f"{side}_rms"], "a scene with such a roughness")
    if study.realisations > 1 and not study.is_rough:
        raise InputError("realisations", study.realisations, "1: no surface of the scene is random")
    seeds = [axis for axis in study.vary if axis.endswith(".seed")]
    if study.realisations > 1 and seeds:
        raise InputError("realisations", study.realisations, f"1 where {seeds[0]} varies")
    if "correlation_length" in study.vary and not (study.is_rough and study.has_correlation_length):
        lengths = study.vary["correlation_length"]
        allowed = "a scene with a Gaussian surface of one correlation length"
        raise InputError("vary.correlation_length", lengths, allowed)
    for M in study.vary.get("grid", ()):
        _whole("vary.grid", M, at_least=1)
    if study.scene["periodic"] and study.settings.get("method") == "paper":
        raise InputError("solve.method", "paper", "dense or fft for a periodic scene")
    _whole("first_seed", study.first_seed or 0, at_least=0, below=2**63 - 2 * study.realisations)
    posable.check(study)


def _check_settings(settings: Mapping[str, Any]) -> None:
    """Check the [solve] table: what `refimpl.solve` would refuse, before there is a store or a worker."""
    refuse_unknown("solve", settings, SOLVE_KEYS, _PLACES)
    if settings.get("method", "fft") not in METHODS:
        raise InputError("solve.method", settings["method"], f"one of {', '.join(METHODS)}")
    for name in ("oblique", "slope_correction"):
        if not isinstance(settings.get(name, True), bool):
            raise InputError(f"solve.{name}", settings[name], "true or false")
    for name in ("tolerance", "accuracy"):
        if name in settings:
            require_number(f"solve.{name}", settings[name], "a number between 0 and 1", above=0, below=1)
    if "quantity" in settings and "accuracy" not in settings:
        raise InputError("solve.quantity", settings["quantity"], "none without an accuracy")
    Terms(oblique=settings.get("oblique"), slope_correction=settings.get("slope_correction", False)).check()


def _by_axis(vary: Mapping[str, Any]) -> dict[str, Any]:
    axes = {f"friction.{axis}": axis for axis in FRICTION_AXES}
    for name, axis in axes.items():
        if name in vary and axis in vary:
            raise InputError(f"vary.{name}", vary[name], f"one of {name} and {axis}, which are the same")
    return {axes.get(name, name): values for name, values in vary.items()}


def _refuse_doubles(vary: Mapping[str, Any]) -> None:
    """Raise InputError for a number that two axes set: by its full name, and for all surfaces of its kind."""
    for name in vary:
        body, part, key = name.partition(".surface[")
        key = key.partition("].")[2].partition("[")[0]
        for axis in (key, f"{body}_{key}"):
            if part and axis in ROUGHNESS_AXES and axis in vary:
                raise InputError(f"vary.{name}", vary[name], f"one of {name} and {axis}, which set the same")


def _values(axis: str, values: object, folder: Path) -> tuple[Any, ...]:
    if axis.endswith(".path"):
        return _paths(axis, values, folder)
    allowed = "a finite number, or a list of different ones"
    if isinstance(values, int | float) and not isinstance(values, bool):
        values = [values]
    for value in values if isinstance(values, list) else ():
        require_number(f"vary.{axis}", value, allowed)
    if not isinstance(values, list) or not values or len(set(values)) != len(values):
        raise InputError(f"vary.{axis}", values, allowed)
    if axis.endswith(".seed"):
        return tuple(_whole(f"vary.{axis}", value, at_least=0, below=2**63) for value in values)
    # 14 and 14.0 are one load, and must be one run; the grid is checked to be whole elsewhere.
    return tuple(values if axis == "grid" else map(float, values))


def _paths(axis: str, values: object, folder: Path) -> tuple[str, ...]:
    names = [values] if isinstance(values, str) else values
    if not isinstance(names, list) or not names or not all(isinstance(name, str) and name for name in names):
        raise InputError(f"vary.{axis}", values, "a file's name, or a list of different ones")
    if len(set(names)) != len(names):
        raise InputError(f"vary.{axis}", values, "different files")
    return tuple(str(folder / name) for name in names)


def _whole(name: str, value: object, *, at_least: int, below: int | None = None) -> int:
    whole = isinstance(value, int) and not isinstance(value, bool)
    if not whole or value < at_least or (below is not None and value >= below):  # type: ignore[operator]  # whole
        bound = "" if below is None else f" and below {below}"
        raise InputError(name, value, f"a whole number, at least {at_least}{bound}")
    return int(value)  # type: ignore[call-overload, no-any-return]  # checked above
