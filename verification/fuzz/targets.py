"""What is fuzzed: readers of scenes, studies, heights and results, with valid files to start from."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

import numpy as np

import refimpl as rf
from refimpl.surfaces import MeasuredSurface
from reports.result_files import compact
from verification.cli.report import read_run
from verification.sweep.study_file import read_study

GRID, PIXEL = 8, 1e-6
SIDE = 8 * PIXEL
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
        Target("scene TOML", ".toml", tuple(_packaged("refimpl", "data/scenes")), _scene, 0.55),
        Target("study TOML", ".toml", tuple(_packaged("verification", "studies")), read_study, 0.1),
        Target("NumPy array", ".npy", (array.getvalue(),), _plain, 0.12),
        Target("table with commas", ".csv", (text.replace(b" ", b","),), _plain, 0.06),
        Target("table with blanks", ".txt", (text,), _plain, 0.05),
        Target("X3P", ".x3p", (_x3p(heights),), _instrument, 0.02),
        Target("X3P, damaged inside", ".x3p", (XML.encode(),), _rezipped, 0.02),
        Target("text with a header", ".asc", (header + turned.getvalue(),), _instrument, 0.02),
        Target("results", ".json", (_results(), _compact_results()), read_run, 0.06),
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


def _x3p(heights: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("main.xml", XML)
        archive.writestr("bindata/data.bin", heights.T.tobytes())
    return buffer.getvalue()


def _results() -> bytes:
    texts = ("id", "title", "claim", "source", "metric", "tolerance_reason", "status", "unit", "note", "tier")
    measured = ("value", "reference", "reference_uncertainty", "error", "tolerance", "seconds")
    case: dict[str, object] = dict.fromkeys(texts, "pass") | {"id": "a/b", "metric": "relative"}
    numbers = dict.fromkeys(measured, 1.0) | {"error": 0.0}
    provenance: dict[str, object] = dict.fromkeys(("command", "date", "commit"), "x")
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
