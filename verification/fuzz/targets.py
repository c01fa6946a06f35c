"""Targets of fuzzing: readers of scenes, studies, heights and results, with valid files to start from."""

from __future__ import annotations

import importlib
import io
import json
import random
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.surfaces import MeasuredSurface
from reports.result_files import compact
from verification.cli.report import read_run, rendered
from verification.sweep.engine import sweep
from verification.sweep.export import to_csv
from verification.sweep.store import files_of
from verification.sweep.study import Study
from verification.sweep.study_file import read_study, study_from_dict

GRID, PIXEL = 8, 1e-6
SIDE = 8 * PIXEL
VALUES: tuple[Any, ...] = (
    None, True, -1, 0, 5, 10**400, 1e308, float("nan"), float("inf"), "", "x", "pass", "\ud800", "\x1b", "'",
    [], [1], [[]], ["x"], {}, {"x": 1}, {"x": {"y": []}},
)  # fmt: skip
"""What one value of a result file is replaced by."""
XML = """<?xml version="1.0" encoding="UTF-8"?><p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>
<CX><AxisType>I</AxisType><DataType>L</DataType><Increment>1e-6</Increment><Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>L</DataType><Increment>1e-6</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>D</DataType></CZ></Axes></Record1><Record3><MatrixDimension>
<SizeX>9</SizeX><SizeY>10</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink></Record3></p:ISO5436_2>"""


@dataclass(frozen=True)
class Target:
    """A reader that returns or raises ``refusals``; valid files of its suffix; its share of inputs."""

    name: str
    suffix: str
    valid: tuple[bytes, ...]
    read: Callable[[Path], object]
    share: float
    refusals: tuple[type[Exception], ...] = (rf.InputError,)


def targets() -> tuple[Target, ...]:
    """All readers; shares add up to 1. Files that need SurfaceTopography cost most and get least."""
    heights = 1e-8 * np.random.default_rng(5).standard_normal((9, 10))
    table = io.BytesIO()
    np.savetxt(table, heights * 1e9, fmt="%.9g")
    text = table.getvalue()
    turned = io.BytesIO()
    np.savetxt(turned, heights.T * 1e9, fmt="%.9g")  # rows of constant y
    array = io.BytesIO()
    np.save(array, heights * 1e9)
    header = b"h=10 w=9\npixel size=1.0e-006 m\ndata unit=rad\nheight conversion factor (-> m)=1e-9\n"
    return (
        Target("scene TOML", ".toml", tuple(_packaged("refimpl", "data/scenes")), _scene, 0.05),
        Target("study TOML", ".toml", tuple(_packaged("verification", "studies")), read_study, 0.01),
        Target("NumPy array", ".npy", (array.getvalue(),), _plain, 0.03),
        Target("table with commas", ".csv", (text.replace(b" ", b","),), _plain, 0.01),
        Target("table with blanks", ".txt", (text,), _plain, 0.01),
        Target("X3P", ".x3p", (_x3p(heights),), _instrument, 0.004),
        Target("X3P, damaged inside", ".x3p", (XML.encode(),), _rezipped, 0.004),
        Target("text with a header", ".asc", (header + turned.getvalue(),), _instrument, 0.002),
        Target("results", ".json", (_results(), _compact_results()), read_run, 0.34),
        Target("results, one field changed", ".json", (_results(),), _changed_results, 0.34),
        Target("results, shown", ".json", (_results(),), _shown_results, 0.003),
        Target("sweep store", ".sqlite", (_store(),), _swept, 0.16),
        Target("MATLAB", ".mat", (_matlab(heights),), _binary, 0.015),
        Target("HDF5", ".h5", (_hdf5(heights),), _binary, 0.017),
        Target("NetCDF", ".nc", (_netcdf(heights),), _binary, 0.005),
    )  # fmt: skip


def _packaged(package: str, folder: str) -> Iterator[bytes]:
    for item in sorted(resources.files(package).joinpath(folder).iterdir(), key=lambda f: f.name):
        yield item.read_bytes()


def _scene(path: Path) -> None:
    """Read a scene, and ask its surfaces for heights where the file is a scene."""
    scene = rf.read_scene(path)
    scene.heights(scene.grid(GRID))


def _plain(path: Path) -> None:
    MeasuredSurface(path, unit="nm", pixel_size=PIXEL, max_missing=0.5).heights(rf.Grid.square(SIDE, GRID))


def _instrument(path: Path) -> None:
    MeasuredSurface(path, max_missing=0.5).heights(rf.Grid.square(SIDE, GRID))


def _rezipped(path: Path) -> None:
    """An archive whose description is the mutated text, so that mutations get past the zip format."""
    xml = path.read_bytes()
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("main.xml", xml)
        archive.writestr("bindata/data.bin", bytes(8 * 90))
    _instrument(path)


def _binary(path: Path) -> None:
    MeasuredSurface(path, unit="nm", pixel_size=PIXEL, max_missing=0.5).heights(Grid.square(SIDE, GRID))


def _matlab(heights: Array) -> bytes:
    buffer = io.BytesIO()
    scipy.io.savemat(buffer, {"heights": heights * 1e9})
    return buffer.getvalue()


def _hdf5(heights: Array) -> bytes:
    """Empty without the library, which SurfaceTopography brings: nothing reads such files then."""
    try:
        h5py = importlib.import_module("h5py")
    except ImportError:
        return b"\x89HDF\r\n\x1a\n"
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        file["heights"] = heights * 1e9
    return buffer.getvalue()


def _netcdf(heights: Array) -> bytes:
    buffer = io.BytesIO()
    with scipy.io.netcdf_file(buffer, "w", mmap=False) as file:
        for name, size in zip("xy", heights.shape, strict=True):
            file.createDimension(name, size)
        file.createVariable("heights", "d", ("x", "y"))[:] = heights * 1e9
        file.flush()
        return buffer.getvalue()


def _changed_results(path: Path) -> None:
    """A valid file with one value replaced by another, seeded by the mutated bytes where they are any."""
    content, document = path.read_bytes(), json.loads(_results())
    if content != _results():
        source = random.Random(content)
        holder, key = source.choice(list(_places(document)))
        holder[key] = source.choice(VALUES)
    path.write_text(json.dumps(document), encoding="utf-8")
    read_run(path)


def _places(item: Any) -> Iterator[tuple[Any, Any]]:
    """Every value of a document by its holder and its key there."""
    entries = item.items() if isinstance(item, dict) else enumerate(item) if isinstance(item, list) else ()
    for key, entry in list(entries):
        yield item, key
        yield from _places(entry)


def _shown_results(path: Path) -> None:
    """A report of the file with one value changed, where it is one."""
    _changed_results(path)
    rendered(read_run(path), path, {}, path.parent)


def _study() -> Study:
    return study_from_dict({"scene": "hertz", "realisations": 1, "vary": {"grid": [2, 3, 4]}})


@cache
def _store() -> bytes:
    """A store of three runs on grids of a few elements."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "s.sqlite"
        sweep(_study(), path, workers=0)
        return path.read_bytes()


@cache
def _table() -> str:
    with tempfile.TemporaryDirectory() as folder:
        return to_csv(sweep(_study(), Path(folder) / "s.sqlite", workers=0).rows)


def _swept(path: Path) -> None:
    """A sweep from the file, whose table must be the right one."""
    try:
        if to_csv(sweep(_study(), path, workers=0).rows) != _table():
            raise AssertionError("a wrong table")
    finally:
        for file in files_of(path):
            file.unlink(missing_ok=True)


def _x3p(heights: Array) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("main.xml", XML)
        archive.writestr("bindata/data.bin", heights.T.tobytes())
    return buffer.getvalue()


def _results() -> bytes:
    texts = ("id", "title", "claim", "source", "metric", "tolerance_reason", "status", "unit", "note", "tier")
    measured = ("value", "reference", "reference_uncertainty", "error", "tolerance", "seconds")
    case = dict.fromkeys(texts, "pass") | {"id": "a/b", "metric": "relative"}
    numbers = dict.fromkeys(measured, 1.0) | {"error": 0.0}
    provenance: dict[str, object] = {**dict.fromkeys(("command", "date", "commit"), "x")}
    provenance |= {"dirty": False, "versions": {"python": "3", "x": None}, "machine": {"cores": 2}}
    counts = {"pass": 1, "fail": 0, "error": 0, "unavailable": 0}
    return json.dumps(
        {
            "format": "rough-friction results, version 1",
            "tier": "quick",
            "only": [],
            "counts": counts,
            "seconds": 1.0,
            "cases": [case | numbers | {"tags": [], "data": {}}],
            "errata": [],
            "provenance": provenance,
        }
    ).encode()


def _compact_results() -> bytes:
    return compact(json.loads(_results()))[0].encode()
