"""Sixty further text files, listed with their verdict before any of them was read; see `test_sixty_texts`.

55 were as listed. Doubled tabs made empty columns, a fourth column of intensities made a map of points, two
tables one map: refused since, as are full-width digits. No-break blanks had been listed as refused, and are
read right.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from refimpl.measured.reading import ARRAY, IMAGE
from tests.refimpl.surfaces.test_sixty_texts import (
    BOTH,
    GWYDDION,
    POINTS,
    UM,
    UPWARD,
    File,
    X,
    Y,
    Z,
    cells,
    check,
    framed,
    image,
    points,
    text,
)

ESRI = "ncols 5\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 2\n"
NM = BOTH | {"unit": "nm"}
TOP = "".join(f"line {k} of the header\n" for k in range(12))

MORE = (
    # delimiters, decimal marks, line ends
    File("tabs", text(cells(), "\t"), ARRAY),
    File("two tabs", text(cells(), "\t\t"), "refused"),
    File("semicolon and blank", text(cells(), "; "), ARRAY),
    File("semicolon, blank, decimal comma", text(cells(), " ; ", ","), ARRAY, note="decimal comma"),
    File("no-break blanks", text(cells(), "\xa0"), ARRAY),
    File("colons", text(cells(), ":"), "refused"),
    File("slashes between", text(cells(), "/"), "refused"),
    File("CR alone", text(cells(), end="\r"), ARRAY),
    File("blank line after each", text(cells(), ";", end="\n\n"), ARRAY),
    File("indented", text([["", *row] for row in cells()], "\t"), ARRAY, note="first column"),
    File("tab at the end", text(cells(), "\t", end="\t\n"), ARRAY, note="last column"),
    File("plus signs", text(cells(form="{:+.2f}"), ","), ARRAY),
    File("no zero before the point", text(cells(), ",").replace("0.", "."), ARRAY),
    File("decimal comma, exponents", text(cells(form="{:.4e}"), "\t", ","), ARRAY, note="decimal comma"),
    File("typographic minus", text(cells()).replace("-", "\u2212"), "refused"),
    File("full-width digits", text(cells()).replace("1", "\uff11"), "refused"),
    File("hexadecimal", "0x1f 0x2a 0x10 0x33\n" * 5, "refused"),
    File("brackets of Python", "[" + text(cells(), ", ", end="],\n["), "refused"),
    File("braces of C", text(cells(), ", ", end="},\n"), "refused"),
    File("MATLAB's semicolons", text(cells(), " ", end=";\n"), "refused"),
    # thousands
    File("whole nanometres, no marks", text(cells(1000 * Z, "{:.0f}"), ";"), ARRAY, NM),
    File("thousands by narrow blanks", "1\u202f320;2\u202f345;1\u202f118;1\u202f902\n" * 5, "refused"),
    File("Swiss", "1\u2019320.5;2\u2019345.1;998.2;1\u2019002.7\n" * 5, "refused"),
    File("English thousands and points", "1,320.5\t2,345.1\t998.2\t1,002.7\n" * 5, "refused"),
    File("Indian thousands", "1,20,320;2,34,500;1,11,118;9,99,902\n" * 5, "refused"),
    File("thousands by points, late", "998;997;996;995\n" * 60 + "1.002;1.003;998;1.001\n", "refused"),
    File("three decimals below a thousand whole", text(cells(100 + Z, "{:.3f}"), "\t", ","), "refused"),
    # headers, 0 to 30 lines
    File("twelve lines", TOP + text(image(), "\t"), IMAGE),
    File("JSON above", '{"unit": "um",\n "n": 5}\n' + text(image(), " "), IMAGE),
    File("a date alone", "2024-05-01 12:30:00\n" + text(image(), " "), IMAGE),
    File("a row count alone", "4\n" + text(image(), " "), "refused"),
    File("names of another width", "height;um\n" + text(image(), ";"), IMAGE),
    File("numbered names", "c1,c2,c3,c4,c5\n" + text(image()), IMAGE),
    File("underlined title", "Heights\n=======\n" + text(image(), "\t"), IMAGE),
    File("dashes below a title", "Heights\n-----\n" + text(image(), "\t"), IMAGE),
    File("Gwyddion, nanometres", GWYDDION.format("z").replace("um", "nm") + text(image(), "\t"), IMAGE, UM,
         "the file states"),
    File("ESRI, its missing value named", ESRI + "NODATA_value -32768\n" + text(image("-32768"), " "), IMAGE,
         note="-32768", hole=True),
    File("ESRI, decimal comma", ESRI + text(image(), " ", ","), IMAGE),
    # footers
    File("a sum below", text(cells(), ";") + ";;;\nsum;1;2;3\n", "refused"),
    File("a second table below", text(cells()) + "\n" + text(cells()[:2], ",")[:-1] + ",1.0\n", "refused"),
    File("statistics below", text(cells()) + "Sq = 1.32\n", "refused"),
    File("control-Z below", text(cells()) + "\x1a", "refused"),
    File("comment in mid-table", text(cells()[:2]) + "# measured twice\n" + text(cells()[2:]), ARRAY),
    # coordinates
    File("frame, corner NaN", text(framed("nan", UPWARD, X, Y), ";"), POINTS, UM, "first row and column"),
    File("frame, decimal commas", text(framed("0.0", UPWARD, X, Y), ";", ","), POINTS, UM, "first row and"),
    File("frame from the right", text(framed("0", [row[::-1] for row in UPWARD], X[::-1], Y)), POINTS, UM,
         "first row and column"),
    File("frame below a title", "Heights in um\n" + text(framed("", UPWARD, X, Y), "\t"), POINTS, UM,
         "first row"),
    File("y counted from one", text([[str(k), *row] for k, row in enumerate(cells(), 1)], ";"), ARRAY,
         note="index column"),
    File("points by y first", text(sorted(points(), key=lambda p: (float(p[1]), float(p[0])))), POINTS, UM),
    File("points, decimal commas", text(points(), ";", ","), POINTS, UM),
    File("points and intensity", text([[*p, "7.5"] for p in points()], "\t"), "refused"),
    File("points in metres", text(points(2e-6, 3e-6, 1e-6), " "), POINTS, {"unit": "m"}),
    File("points y, x, z, as stated", text([[p[1], p[0], p[2]] for p in points()]), "transposed", UM),
    File("a line scan", text([[x, z] for x, z in zip(X, image()[0], strict=True)]), "refused"),
    # missing points
    File("INF", text(cells(missing="INF"), "\t"), ARRAY, hole=True),
    File("***", text(cells(missing="***"), " "), ARRAY, hole=True),
    File("#VALUE!", text(cells(missing="#VALUE!"), ","), ARRAY, hole=True),
    File("a question mark", text(cells(missing="?"), ","), "refused"),
    File("void", text(cells(missing="void"), ";"), "refused"),
    # blocks
    File("two tables, a blank line between", text(cells()) + "\n" + text(cells(2 * Z)), "refused"),
)  # fmt: skip


def test_sixty_more_are_listed() -> None:
    assert len({file.name for file in MORE}) == len(MORE) == 60


@pytest.mark.parametrize("file", MORE, ids=[file.name for file in MORE])
def test_another_strangers_text_is_read_right_or_refused(tmp_path: Path, file: File) -> None:
    check(tmp_path / "map.txt", file)
