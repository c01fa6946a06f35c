"""The table of all three-dimensional points: `python -m appendix_a.fem3d.study TABLE.json --seconds 1500`.

Every point is written as soon as it is known, and an existing table is continued: a run may be cut off
anywhere.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

import numpy as np

from appendix_a.errors import InputError
from appendix_a.fem3d.coefficients import LABELS, Coefficients3D, coefficients
from appendix_a.fem3d.wavy import Kind, Waviness

TABLE_VERSION = 2
CREST, FLANK, VALLEY = 0.0, 0.25, 0.5
SLOPES = (2.5, 6.5, 10.0, 15.0, 30.0)


@dataclass(frozen=True)
class Point:
    """The arguments of `coefficients`."""

    slope_deg: float
    wavelength: float
    position: float
    nu: float
    kind: str = "ridge"
    width: str = "projected"
    quality: str = "quick"

    @property
    def surface(self) -> Waviness:
        """The wavy surface of this point."""
        return Waviness(self.slope_deg, self.wavelength, self.position, Kind(self.kind))


def grid(
    slopes: Iterable[float],
    wavelength: float,
    nu: float,
    positions: Sequence[float] = (CREST, FLANK, VALLEY),
    kind: str = "ridge",
    width: str = "projected",
    quality: str = "quick",
) -> list[Point]:
    """Return all pairs of slope and position."""
    return [Point(s, wavelength, p, nu, kind, width, quality) for s in slopes for p in positions]


def points() -> list[Point]:
    """Return the whole study, most wanted first; those sharing flat solutions stand together."""
    first = [
        *grid(SLOPES, 20.0, 0.3),
        *grid((6.5, 10.0, 30.0), 20.0, 0.3, (FLANK,), width="facet"),
        *grid((6.5, 10.0), 20.0, 0.0, (FLANK, CREST)),
        *grid((10.0, 30.0), 20.0, 0.45, (FLANK, CREST)),
        *grid((10.0,), 20.0, 0.3, kind="egg-box"),
        *grid((10.0,), 50.0, 0.3, (FLANK, CREST)),
        *grid((6.5, 10.0), 100.0, 0.3, (FLANK,)),
        *grid((10.0,), 100.0, 0.3, (CREST,)),
        *grid((10.0,), 20.0, 0.3, (FLANK,), quality="full"),
        *grid((30.0,), 20.0, 0.45, (FLANK,), quality="full"),
        *grid((30.0,), 20.0, 0.3, (VALLEY,), quality="full"),
    ]
    rest = [
        *grid(SLOPES, 20.0, 0.0),
        *grid(SLOPES, 20.0, 0.45),
        *grid((30.0,), 20.0, 0.45, (VALLEY,), quality="full"),
        *grid(SLOPES, 50.0, 0.3),
        *grid(SLOPES, 20.0, 0.3, kind="egg-box"),
        *grid((30.0,), 20.0, 0.3, (VALLEY,), kind="egg-box", quality="full"),
        *grid(SLOPES, 20.0, 0.3, (FLANK,), width="facet"),
        *grid((30.0,), 20.0, 0.0, (FLANK, VALLEY), quality="full"),
        *grid((20.0,), 20.0, 0.3),
        *grid((20.0,), 20.0, 0.0),
        *grid((20.0,), 20.0, 0.45),
        *grid(SLOPES, 20.0, 0.3, (0.125, 0.375)),
        *grid((10.0, 30.0), 50.0, 0.0),
        *grid((10.0, 30.0), 50.0, 0.45),
        *grid(SLOPES, 100.0, 0.3),
        *grid((30.0,), 50.0, 0.45, (FLANK,), quality="full"),
        *grid((30.0,), 20.0, 0.45, (CREST,), quality="full"),
        *grid((30.0,), 20.0, 0.3, (0.125,), quality="full"),
    ]
    return list(dict.fromkeys(first + rest))


def row(point: Point, result: Coefficients3D, seconds: float) -> dict[str, object]:
    """Return one line of the table; errors and bounds over flat, in the order of the labels.

    Exact flat coefficients and first-order theory are not in it: closed forms of the arguments give both.
    """

    def listed(values: np.ndarray, digits: int) -> list[float]:
        return [float(f"{v:.{digits}g}") + 0.0 for v in values]  # + 0.0 makes -0.0 a 0.0

    return {
        **asdict(point),
        "error": listed(result.error, 6),
        "discretisation": listed(result.discretisation, 3),
        "truncation": listed(result.truncation, 3),
        "flat_error": listed(result.flat_error, 3),
        "residual": float(f"{result.residual:.2g}"),
        "elements": result.elements,
        "seconds": round(seconds, 1),
    }


def header(command: str) -> dict[str, object]:
    """Return the provenance of the table."""
    packages = ("numpy", "scipy", "scikit-fem")
    return {
        "table": "appendix_a_3d",
        "version": TABLE_VERSION,
        "command": command,
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "python": platform.python_version(),
        "packages": {name: version(name) for name in packages},
        "labels": list(LABELS),
        "units": {"lengths": "a, half the element's edge", "errors": "fraction of flat"},
    }


def load(path: Path) -> list[dict[str, object]]:
    """Return the rows of a table, none if there is no file. Raises InputError for a file of another kind."""
    if not path.exists():
        return []
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
        known = table["table"] == "appendix_a_3d" and table["version"] == TABLE_VERSION
        rows: list[dict[str, object]] = table["points"]
    except (ValueError, KeyError, TypeError) as broken:
        raise InputError("table", str(path), "a table written by this study") from broken
    if not known:
        raise InputError("table", str(path), f"table appendix_a_3d, version {TABLE_VERSION}")
    return rows


def save(path: Path, command: str, rows: list[dict[str, object]]) -> None:
    """Replace the table in one step: a reader sees the old one or the new one."""
    part = path.with_suffix(".part")
    lines = ",\n".join(json.dumps(line, separators=(",", ":")) for line in rows)
    top = json.dumps(header(command), indent=1).removesuffix("\n}")
    part.write_text(f'{top},\n "points": [\n{lines}\n]}}\n', encoding="utf-8")
    os.replace(part, path)


def run(
    path: Path,
    wanted: Sequence[Point],
    seconds: float,
    command: str = "",
    compute: Callable[..., Coefficients3D] = coefficients,
) -> int:
    """Add the `wanted` points that the table lacks, until `seconds` have passed; returns how many."""
    rows, start, added = load(path), time.monotonic(), 0
    known = {tuple(line[name] for name in asdict(wanted[0])) for line in rows} if wanted else set()
    for point in wanted:
        if time.monotonic() - start > seconds:
            break
        if tuple(asdict(point).values()) in known:
            continue
        begun = time.monotonic()
        result = compute(**asdict(point))
        rows.append(row(point, result, time.monotonic() - begun))
        save(path, command, rows)
        added += 1
        if sys.stderr.isatty():
            print(f"{len(rows)} of {len(wanted)}: {point}", file=sys.stderr)
    return added


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; exit status 0, or 2 for a table that is not one."""
    parser = argparse.ArgumentParser(description="Extend the table of influence coefficients in 3-D.")
    parser.add_argument("table", type=Path)
    parser.add_argument("--seconds", type=float, default=1500.0, help="start no new point after this long")
    options = parser.parse_args(arguments)
    command = f"python -m appendix_a.fem3d.study {options.table.as_posix()}"
    try:
        run(options.table, points(), options.seconds, command)
    except InputError as refused:
        print(refused, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
