"""Text files as strangers write them, listed with their verdict before any was read.

Each is read with heights and pixel right, what was assumed a note, or refused. These are half of 120. Thirty
were used to build the reader; of the others 84 were as listed when they were first read, and all are since.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.measured.readers import read
from refimpl.measured.reading import ARRAY, IMAGE

POINTS = "coordinates as the file states them"
PIXEL = (2e-6, 3e-6)
BOTH: dict[str, Any] = {"unit": "um", "pixel_size": PIXEL}
UM: dict[str, Any] = {"unit": "um"}
Z = np.array(
    [[0.31, -1.27, 2.05, 0.44], [1.18, 0.09, -0.73, 1.62], [-2.4, 0.58, 1.91, -0.36],
     [0.77, -1.55, 0.12, 2.83], [1.46, 0.25, -0.94, -1.08]]
)  # fmt: skip
"""Heights (um), five along x, four along y."""
HOLE = (3, 1)


def cells(z: np.ndarray = Z, form: str = "{:.2f}", missing: str | None = None) -> list[list[str]]:
    """Rows along x, as a plain array is written; one point missing where a mark is given."""
    out = [[form.format(v) for v in row] for row in z]
    if missing is not None:
        out[HOLE[0]][HOLE[1]] = missing
    return out


def image(missing: str | None = None, form: str = "{:.2f}") -> list[list[str]]:
    """Lines along x, the first at the top."""
    return [list(line) for line in zip(*cells(form=form, missing=missing), strict=True)][::-1]


def text(rows: list[list[str]], separator: str = ",", mark: str = ".", end: str = "\n") -> str:
    return "".join(separator.join(row).replace(".", mark) + end for row in rows)


def framed(corner: str, rows: list[list[str]], x: list[str], y: list[str]) -> list[list[str]]:
    return [[corner, *x], *([at, *row] for at, row in zip(y, rows, strict=True))]


def points(x: float = 2.0, y: float = 3.0, z: float = 1.0, lacks: int = 0) -> list[list[str]]:
    listed = [[f"{i * x:g}", f"{j * y:g}", f"{Z[i, j] * z:.7g}"] for i in range(5) for j in range(4)]
    return listed[lacks:]


X, Y = ["0.0", "2.0", "4.0", "6.0", "8.0"], ["0.0", "3.0", "6.0", "9.0"]
UPWARD = image()[::-1]
GWYDDION = "# Channel: {}\n# Width: 10.0 µm\n# Height: 12.0 µm\n# Value units: um\n"


@dataclass(frozen=True)
class File:
    """Content; ``verdict``: the orientation it is read with, or a pattern of the refusal; a note it gives."""

    name: str
    content: str
    verdict: str
    given: dict[str, Any] = field(default_factory=lambda: BOTH)
    note: str = ""
    hole: bool = False
    encoding: str = "utf-8"


def check(path: Path, file: File) -> None:
    path.write_bytes(file.content.encode(file.encoding))
    if file.verdict == "refused":
        with pytest.raises(InputError) as refused:
            read(path, **file.given)
        assert "\n" not in str(refused.value)
        return
    found = read(path, **file.given)
    expected, pixel, verdict = 1e-6 * Z, PIXEL, file.verdict
    if verdict == "transposed":
        expected, pixel, verdict = expected.T, PIXEL[::-1], POINTS
    if file.hole:
        expected[HOLE] = np.nan
    if file.name == "points, the first lacking":
        expected[0, 0] = np.nan
    if file.name == "-9999":
        expected[HOLE] = -9999e-6
    assert found.orientation == verdict
    np.testing.assert_allclose(found.heights, expected, rtol=0, atol=1e-15)
    np.testing.assert_allclose(found.pixel, pixel, rtol=1e-9)
    assert file.note in " ".join(found.notes)


ESRI = "ncols 5\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 2\n"

LISTED = (
    # delimiters, decimal marks
    File("commas", text(cells()), ARRAY),
    File("semicolons, decimal commas", text(cells(), ";", ","), ARRAY, note="decimal comma"),
    File("aligned by blanks", text(cells(form="{:9.3f}"), ""), ARRAY),
    File("bars", text(cells(), "|"), "refused"),
    File("semicolon at the end", text(cells(), ";", end=";\n"), ARRAY, note="last column"),
    File("commas twice", text(cells(), ",", ","), "refused"),
    File("exponents with commas", text(cells(form="{:.3E}"), ";", ","), ARRAY),
    File("exponents of Fortran", text(cells(form="{:.3E}"), " ").replace("E", "D"), ARRAY),
    File("whole nanometres", text(cells(1000 * Z, "{:.0f}")), ARRAY, BOTH | {"unit": "nm"}),
    File("UTF-16, tabs", text(cells(), "\t"), ARRAY, encoding="utf-16"),
    # thousands
    File("either thousands or decimals", "1,320;2,345;1,118;1,902\n" * 5, "refused"),
    File("thousands by points, whole", "998;1.002;1.010;987\n1.011;995;1.003;1.120\n" * 3, "refused"),
    File("thousands by apostrophes", "1'320;2'345;1'118;1'902\n" * 5, "refused"),
    File("thousands in quotes", '"1,320.5","2,345.1","998.2","1,002.7"\n' * 5, "refused"),
    File("three decimals, some below one", text(cells(form="{:.3f}"), ";", ","), ARRAY, note="decimal comma"),
    # headers
    File("a title", "Sample 7\n" + text(image()), IMAGE),
    File("keys and a unit", "Z unit: um\nPoints: 5 4\n\n" + text(image(), " "), IMAGE),
    File("two lines of numbers", "5 4\n10.0 12.0\n" + text(image(), " "), "refused"),
    File("slashes", "// made by hand\n// 5; 4\n" + text(image(), ";"), IMAGE),
    File("names of columns", "a;b;c;d;e\n" + text(image(), ";"), IMAGE),
    File("Gwyddion", GWYDDION.format("z") + text(image(), "\t"), IMAGE, {}),
    File("h and w", "h=4 w=5\npixel size=2.0e-6 m\nheight conversion factor (-> m)=1e-6\n"
         + text(image(), " "), IMAGE, {"pixel_size": PIXEL}, "the file states 2e-06 x 2e-06 m"),
    File("ESRI grid", "ncols 5\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 2\nNODATA_value -9999\n"
         + text(image("-9999"), " "), IMAGE, note="-9999", hole=True),
    # footers
    File("a word below", text(cells()) + "end of data\n", "refused"),
    File("a comment below", text(cells()) + "# end of data\n", ARRAY),
    File("blank lines below", text(cells()) + "\n\n\n", ARRAY),
    # coordinates
    File("frame, corner empty", text(framed("", UPWARD, X, Y)), POINTS, UM, "first row and column"),
    File("frame, corner a word", text(framed("y/x", UPWARD, X, Y), "\t"), POINTS, UM, "first row and column"),
    File("frame from the top", text(framed("0.00", image(), X, Y[::-1])), POINTS, UM, "first row and column"),
    File("x above alone", text([X, *image()]), "refused"),
    File("uneven frame", text(framed("", UPWARD, X, ["0.0", "1.0", "6.0", "9.0"])), "refused"),
    File("frame of counts", text(framed("", cells(), ["0", "1", "2", "3"], list("01234"))), ARRAY,
         note="index"),
    # units
    File("units below names", "x;y;z\nmm;mm;um\n" + text(points(2e-3, 3e-3), ";"), POINTS, UM),
    File("units in brackets", "x [um],y [um],z [nm]\n" + text(points(z=1e3)), POINTS, {"unit": "nm"}),
    File("a unit in each cell", text(cells(form="{:.2f} um"), ";"), "refused"),
    # missing points
    File("1.#QNAN", text(cells(missing="1.#QNAN")), ARRAY, hole=True),
    File("#N/A", text(cells(missing="#N/A"), "\t"), ARRAY, hole=True),
    File("empty", text(cells(missing=""), ";"), ARRAY, hole=True),
    File("-9999", text(cells(missing="-9999")), ARRAY, note="-9999"),
    # points and blocks
    File("points, the first lacking", text(points(lacks=1), " "), POINTS, UM),
    File("counted points", text([[str(k), *p] for k, p in enumerate(points(), 1)]), POINTS, UM, "index"),
    File("two images", GWYDDION.format("a") + text(image(), "\t") + GWYDDION.format("b")
         + text(image(), "\t"), IMAGE, {}),
    # delimiters, decimal marks, line ends
    File("tabs", text(cells(), "\t"), ARRAY),
    File("two tabs", text(cells(), "\t\t"), "refused"),
    File("no-break blanks", text(cells(), "\xa0"), ARRAY),
    File("CR alone", text(cells(), end="\r"), ARRAY),
    File("blank line after each", text(cells(), ";", end="\n\n"), ARRAY),
    File("indented", text([["", *row] for row in cells()], "\t"), ARRAY, note="first column"),
    File("no zero before the point", text(cells(), ",").replace("0.", "."), ARRAY),
    File("typographic minus", text(cells()).replace("-", "\u2212"), "refused"),
    File("full-width digits", text(cells()).replace("1", "\uff11"), "refused"),
    File("hexadecimal", "0x1f 0x2a 0x10 0x33\n" * 5, "refused"),
    File("MATLAB's semicolons", text(cells(), " ", end=";\n"), "refused"),
    # thousands
    File("Swiss", "1\u2019320.5;2\u2019345.1;998.2;1\u2019002.7\n" * 5, "refused"),
    File("thousands by points, late", "998;997;996;995\n" * 60 + "1.002;1.003;998;1.001\n", "refused"),
    File("three decimals below a thousand whole", text(cells(100 + Z, "{:.3f}"), "\t", ","), "refused"),
    # headers, 0 to 30 lines
    File("a date alone", "2024-05-01 12:30:00\n" + text(image(), " "), IMAGE),
    File("a row count alone", "4\n" + text(image(), " "), "refused"),
    File("dashes below a title", "Heights\n-----\n" + text(image(), "\t"), IMAGE),
    File("Gwyddion, nanometres", GWYDDION.format("z").replace("um", "nm") + text(image(), "\t"), IMAGE, UM,
         "the file states"),
    File("ESRI, its missing value named", ESRI + "NODATA_value -32768\n" + text(image("-32768"), " "), IMAGE,
         note="-32768", hole=True),
    # footers
    File("a second table below", text(cells()) + "\n" + text(cells()[:2], ",")[:-1] + ",1.0\n", "refused"),
    File("comment in mid-table", text(cells()[:2]) + "# measured twice\n" + text(cells()[2:]), ARRAY),
    # coordinates
    File("frame, decimal commas", text(framed("0.0", UPWARD, X, Y), ";", ","), POINTS, UM, "first row and"),
    File("frame from the right", text(framed("0", [row[::-1] for row in UPWARD], X[::-1], Y)), POINTS, UM,
         "first row and column"),
    File("points by y first", text(sorted(points(), key=lambda p: (float(p[1]), float(p[0])))), POINTS, UM),
    File("points and intensity", text([[*p, "7.5"] for p in points()], "\t"), "refused"),
    File("points y, x, z, as stated", text([[p[1], p[0], p[2]] for p in points()]), "transposed", UM),
    File("a line scan", text([[x, z] for x, z in zip(X, image()[0], strict=True)]), "refused"),
    # missing points
    File("***", text(cells(missing="***"), " "), ARRAY, hole=True),
    File("a question mark", text(cells(missing="?"), ","), "refused"),
    # blocks
)  # fmt: skip


@pytest.mark.parametrize("file", LISTED, ids=lambda file: file.name)
def test_a_strangers_text_is_read_right_or_refused(tmp_path: Path, file: File) -> None:
    check(tmp_path / "map.txt", file)
