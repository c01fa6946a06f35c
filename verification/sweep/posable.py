"""Refusals of runs, found before any run: each limit where the study comes closest to it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from refimpl.driver.options import Options
from refimpl.errors import InputError, size_text
from refimpl.model.problem import Terms
from refimpl.planning.plan import memory_of
from refimpl.scene.scene import Scene
from refimpl.scene.scene_file import scene_from_dict, scene_to_dict
from verification.sweep.study import Study, measured_paths

FINEST = 256  # elements a side that heights are sampled on: 0.01 s, and 0.4 % from where the domain ends
_SWITCHES = ("oblique", "slope_correction")
_SMALL, _LARGE, _BOTH = (min,), (max,), (min, max)
_CLOSEST = {"upper_rms": _LARGE, "lower_rms": _LARGE, "correlation_length": _BOTH, "sliding_offset": _BOTH}


def check(study: Study) -> None:
    """Raise InputError, naming the field, for what `refimpl.solve` would refuse of any run but its memory.

    Options are made of every point of one realisation (0.1 ms each). Heights are sampled, of the first
    realisation, only where a limit may be met, 8 times at most, and twice as often for each number of a
    surface that varies by its full name: the largest roughness (peak-to-valley), the
    shortest and the longest correlation (noise nodes; period), the farthest slides either way in the
    directions nearest to the axes (measured area). What remains for the runs: other realisations' peaks,
    and windows on the way of a slide that miss too many points.
    """
    options = {key: value for key, value in study.settings.items() if key not in _SWITCHES}
    requested = Terms(**{key: study.settings[key] for key in _SWITCHES if key in study.settings})
    for run in replace(study, realisations=1).runs():
        scene = scene_from_dict(run.inputs["scene"], Path())
        Options(scene=scene, grid=run.inputs["grid"], requested=requested, **options)
    if not _files(study):  # sampled, each with the others' limits, by `unusable_files`
        _sample(study)


def unusable_files(study: Study) -> dict[tuple[str, str], str]:
    """Return why varied files are refused, by axis and path. Raises the first InputError where all are."""
    refused: dict[tuple[str, str], InputError] = {}
    for axis, path in _files(study):
        others = {name: values for name, values in study.vary.items() if not name.endswith(".path")}
        try:
            _sample(replace(study, vary=others | {axis: (path,)}))
        except InputError as refusal:
            refused[axis, path] = refusal
    if refused and len(refused) == len(_files(study)):
        raise next(iter(refused.values()))
    return {file: f"{Path(file[1]).name}: {refusal}" for file, refusal in refused.items()}


def _files(study: Study) -> list[tuple[str, str]]:
    return [(axis, path) for axis, paths in study.vary.items() if axis.endswith(".path") for path in paths]


def _sample(study: Study) -> None:
    for scene in _closest(study):
        scene.sampled(scene.grid(min(FINEST, study.finest)))


def check_memory(study: Study) -> None:
    """Raise InputError where the finest grid does not fit into this machine's free memory."""
    scene = next(_closest(study))
    memory_of(
        study.settings.get("method", "fft"), scene.grid(max(study.vary.get("grid", (scene.default_grid,))))
    )


def covered_size(study: Study) -> tuple[tuple[float, float], str]:
    """Return the largest rectangle (m) that all measured surfaces cover over all offsets of a study.

    The text names the files of the smallest scene, where another is larger.
    """
    scenes = list(_closest(study))
    least, most = (choose(scenes, key=lambda scene: math.prod(scene.lengths)) for choose in (min, max))
    size = min(scene.lengths[0] for scene in scenes), min(scene.lengths[1] for scene in scenes)
    if least.lengths == most.lengths:
        return size, ""
    files = (Path(path).name for path in measured_paths(scene_to_dict(least)))
    shown = ", ".join(dict.fromkeys(files))
    return size, f", by {shown}; the largest scene has {size_text(most.lengths)} m"


def _closest(study: Study) -> Iterator[Scene]:
    """Yield the scenes closest to a limit of their heights; slides of one scene share its surfaces."""
    turns = study.vary.get("sliding_direction", (study.scene["sliding_direction"],))
    nearest = (max(turns, key=lambda phi: abs(component(phi))) for component in (math.cos, math.sin))
    directions = tuple(dict.fromkeys(nearest))
    offsets = _ends("sliding_offset", study.vary.get("sliding_offset", (study.scene["sliding_offset"],)))
    axes = {axis: _ends(axis, values) for axis, values in study.vary.items()}
    axes |= {"sliding_direction": directions[:1], "sliding_offset": offsets[:1]}
    for run in replace(study, realisations=1, vary=axes).runs():
        scene = scene_from_dict(run.inputs["scene"], Path())
        for direction, offset in itertools.product(directions if any(offsets) else directions[:1], offsets):
            yield replace(scene, sliding_direction=direction, sliding_offset=offset)


def _ends(axis: str, values: Sequence[Any]) -> tuple[Any, ...]:
    """Return an axis' values closest to a limit: all files, all angles; one where no limit depends on it."""
    if axis.endswith((".path", ".rotate_deg")):
        return tuple(values)
    if axis.endswith(".seed"):
        return tuple(values[:1])
    ends = _CLOSEST.get(axis, _BOTH if ".surface[" in axis else _SMALL)
    return tuple(dict.fromkeys(end(values) for end in ends))
