"""Building scenes of the error bars: solved on grids and a reference, their features stored by JSON lines.

A killed run goes on where it was. `pack` makes of the lines the file that is committed, which the fit reads.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import refimpl as rf
from refimpl.accuracy.contact_edge import NO_FACES
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.peak import Peak
from refimpl.errors import InputError
from refimpl.grid.straight_edges import StraightEdges
from refimpl.model.materials import Pair
from verification.coverage.class_scenes import CLASSES, GRIDS, scene
from verification.coverage.textures import RoundedPunch
from verification.output.files import Progress, appending
from verification.output.provenance import provenance
from verification.output.result_files import read_result, write_result

REFERENCE = 384  # elements along the longer side
_KEPT = 3  # grids of a scene in the packed file at most
WAVES = "short waves"  # part of an error bar
FITTED = (
    "friction_coefficient",
    "friction_force",
    "contact_area",
    "plastic_area",
    "approach",
    "normal_force",
    "binormal_force",
)
"""Numbers of the features that are kept: those that errors are fitted of, and corrected ones are made of."""


@dataclass(frozen=True)
class Solved:
    """A scene of a class and seed on its grids, the reference last; ``exact`` are numbers in closed form."""

    kind: str
    seed: int
    grids: tuple[GridFeatures, ...]
    exact: Mapping[str, float]


def features_of(record: dict[str, Any]) -> GridFeatures:
    """Return the features that `dataclasses.asdict` made plain."""
    peaks = {name: Peak(**record[name]) for name in ("peak", "first_contact")}
    straight = {name: StraightEdges(**record[name]) for name in ("straight", "plastic_straight")}
    tuples = {name: tuple(record[name]) for name in ("faces", "highest_areas")}
    grid = record["grid"]
    restored = rf.Grid(tuple(grid["shape"]), tuple(grid["lengths"]), grid["periodic"])
    return GridFeatures(**{**record, **peaks, **straight, **tuples, "grid": restored})


def exact_numbers(one: rf.Scene) -> dict[str, float]:
    """Return contact area and mu of a punch with a rounded rim; nothing of other scenes."""
    punch, pair = one.lower.surface, Pair(lower=one.lower.material, upper=one.upper.material)
    if not isinstance(punch, RoundedPunch) or one.load is None:
        return {}
    area = math.pi * punch.contact_radius(one.load, pair.reduced_modulus) ** 2
    mu = one.friction.tau * area / one.load + one.friction.beta
    return {"contact_area": area, "friction_coefficient": mu}


def solve_all(path: Path, seeds: Iterable[int], kinds: Iterable[str] = tuple(CLASSES)) -> None:
    """Solve what the file has not yet, seed by seed; each finished scene is appended at once."""
    known = {(one["kind"], one["seed"]) for one in records(path)}
    todo = [(kind, seed) for seed in seeds for kind in kinds if (kind, seed) not in known]
    progress = Progress(len(todo))
    path.parent.mkdir(parents=True, exist_ok=True)
    with appending(path) as lines:
        for kind, seed in todo:
            lines.write(json.dumps(_solved(kind, seed)) + "\n")
            lines.flush()
            progress.tick(f"{kind}, {seed}")
    progress.close()


def _solved(kind: str, seed: int) -> dict[str, Any]:
    """Return one line: without grids where one of them did not converge or has no contact."""
    one, found = scene(kind, seed), list[dict[str, Any]]()
    for M in (*GRIDS, REFERENCE):
        try:
            solution = rf.solve(one, grid=M)
        except InputError:  # a grid that holds no wave of the spectrum
            continue
        if not solution.converged or not solution.contact_area:
            if M == REFERENCE:
                found = []
            continue
        found.append(asdict(solution.details.features))
    return {"kind": kind, "seed": seed, "grids": found, "exact": exact_numbers(one)}


def records(path: Path) -> Iterator[dict[str, Any]]:
    """Yield the whole lines of a file of JSON lines; none where there is no file."""
    if not path.exists():
        return
    for line in path.read_text(encoding="utf-8").splitlines():
        try:
            yield json.loads(line)
        except json.JSONDecodeError:
            continue


def solved(path: Path) -> list[Solved]:
    """Return the scenes of a file of lines that were solved on the reference and a grid at least."""
    found = []
    for one in records(path):
        grids = tuple(as_corrected(features_of(grid)) for grid in one["grids"])
        if len(grids) > 1:
            found.append(Solved(one["kind"], one["seed"], grids, one["exact"]))
    return found


def pack(scenes: Iterable[Solved], path: Path) -> None:
    """Write scenes as the committed file: features in columns, every second grid of more than three."""
    rows = []
    for one in scenes:
        kept = one.grids if len(one.grids) <= _KEPT else (*one.grids[one.seed % 2 : -1 : 2], one.grids[-1])
        rows.append((one.kind, one.seed, one.exact, [_plain(grid) for grid in kept]))
    names = list(rows[0][3][0])
    columns = {name: [grid[name] for *_, grids in rows for grid in grids] for name in names}
    index = [[kind, seed, len(grids), dict(exact)] for kind, seed, exact, grids in rows]
    write_result({"provenance": provenance(), "scenes": index, "columns": columns}, path)


def merged(stored: Iterable[Solved], new: Iterable[Solved]) -> list[Solved]:
    """Return the stored scenes with new ones added, or in their place by class and seed."""
    return list({(one.kind, one.seed): one for one in (*stored, *new)}.values())


def unpacked(path: Path) -> list[Solved]:
    """Return the scenes of a packed file."""
    document = read_result(path)
    columns = document["columns"]
    records = iter(
        [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    )
    return [
        Solved(kind, seed, tuple(_restored(next(records)) for _ in range(count)), exact)
        for kind, seed, count, exact in document["scenes"]
    ]


# significant ones of features whose differences count
_DIGITS = {"numbers": 6, "first_contact": 5, "peak": 5, "faces": 5}


def _plain(grid: GridFeatures) -> dict[str, Any]:
    """Return short plain values: shares of faces to 0.01, parts of error bars summed but for waves'."""
    record = asdict(grid)
    record["highest_areas"] = ()
    record["faces"] = [[k, round(n, 2)] for k, n in enumerate(grid.faces) if n >= 0.005]
    record["numbers"] = {name: grid.numbers[name] for name in FITTED}
    waves = grid.parts.get("contact_area", {}).get(WAVES, 0.0)
    record["parts"] = {"contact_area": {WAVES: waves}} if waves else {}
    return {name: _short(value, _DIGITS.get(name, 3)) for name, value in record.items()}


def _restored(record: dict[str, Any]) -> GridFeatures:
    faces = [0.0] * len(NO_FACES)
    for k, n in record["faces"]:
        faces[k] = n
    return features_of(record | {"faces": faces})


def as_corrected(features: GridFeatures) -> GridFeatures:
    """Return stored features with the numbers that today's edge rule corrects."""
    return replace(features, numbers=dict(features.numbers) | features.corrected)


def _short(value: Any, digits: int) -> Any:
    if isinstance(value, Mapping):
        return {name: _short(one, digits) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [_short(one, digits) for one in value]
    return float(f"{value:.{digits}g}") if isinstance(value, float) else value
