"""Text files as strangers write them, listed with their verdict before any was read.

Each is read with heights and pixel right, what was assumed a note, or refused. Of the first sixty every
second one, from the first, was used to build the reader; the others were looked at once: 29 of 30 were as
listed. "y beside alone" had been listed with uneven y (1.5, 3, 6, 9), which nothing tells from heights; even
ones are refused since.

Of sixty more 55 were as listed. Doubled tabs made empty columns, a fourth column of intensities made a map of
points, two tables one map: refused since, as are full-width digits. No-break blanks had been listed as
refused, and are read right.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from refimpl.measured.reading import ARRAY, IMAGE
from tests.refimpl.surfaces.made_texts import (
    BOTH,
    GWYDDION,
    KEYS,
    PIXEL,
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

SIXTY = (
    # delimiters, decimal marks
    File("commas", text(cells()), ARRAY),
    File("semicolons, decimal commas", text(cells(), ";", ","), ARRAY, note="decimal comma"),
    File("tabs, decimal commas", text(cells(), "\t", ","), ARRAY, note="decimal comma"),
    File("blanks, decimal commas", text(cells(), " ", ","), ARRAY, note="decimal comma"),
    File("aligned by blanks", text(cells(form="{:9.3f}"), ""), ARRAY),
    File("comma and blank", text(cells(), ", "), ARRAY),
    File("bars", text(cells(), "|"), "refused"),
    File("semicolon at the end", text(cells(), ";", end=";\n"), ARRAY, note="last column"),
    File("commas twice", text(cells(), ",", ","), "refused"),
    File("quotes", text([[f'"{c}"' for c in row] for row in cells()], ",", ","), "refused"),
    File("exponents with commas", text(cells(form="{:.3E}"), ";", ","), ARRAY),
    File("exponents of Fortran", text(cells(form="{:.3E}"), " ").replace("E", "D"), ARRAY),
    File("whole nanometres", text(cells(1000 * Z, "{:.0f}")), ARRAY, BOTH | {"unit": "nm"}),
    File("byte order mark, CRLF", "\ufeff" + text(cells(), end="\r\n"), ARRAY),
    File("UTF-16, tabs", text(cells(), "\t"), ARRAY, encoding="utf-16"),
    # thousands
    File("either thousands or decimals", "1,320;2,345;1,118;1,902\n" * 5, "refused"),
    File("points of thousands", "1.320,5;2.345,1;998,2;1.002,7\n" * 5, "refused"),
    File("thousands by points, whole", "998;1.002;1.010;987\n1.011;995;1.003;1.120\n" * 3, "refused"),
    File("thousands by blanks", "1 320;2 345;1 118;1 902\n" * 5, "refused"),
    File("thousands by apostrophes", "1'320;2'345;1'118;1'902\n" * 5, "refused"),
    File("thousands in quotes", '"1,320.5","2,345.1","998.2","1,002.7"\n' * 5, "refused"),
    File("comma, blank and decimal comma", "1,320, 2,345, 1,118, 1,902\n" * 5, "refused"),
    File("three decimals, some below one", text(cells(form="{:.3f}"), ";", ","), ARRAY, note="decimal comma"),
    # headers
    File("a title", "Sample 7\n" + text(image()), IMAGE),
    File("thirty keys", KEYS + text(image(), "\t"), IMAGE),
    File("keys and a unit", "Z unit: um\nPoints: 5 4\n\n" + text(image(), " "), IMAGE),
    File("two lines of numbers", "5 4\n10.0 12.0\n" + text(image(), " "), "refused"),
    File("percent signs", "% made by hand\n% 5 x 4\n" + text(image(), " "), IMAGE),
    File("slashes", "// made by hand\n// 5; 4\n" + text(image(), ";"), IMAGE),
    File("names of columns", "a;b;c;d;e\n" + text(image(), ";"), IMAGE),
    File("Gwyddion", GWYDDION.format("z") + text(image(), "\t"), IMAGE, {}),
    File("Gwyddion, decimal commas", GWYDDION.format("z") + text(image(), "\t", ","), IMAGE, {}),
    File("h and w", "h=4 w=5\npixel size=2.0e-6 m\nheight conversion factor (-> m)=1e-6\n"
         + text(image(), " "), IMAGE, {"pixel_size": PIXEL}, "pixel of"),
    File("ESRI grid", "ncols 5\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 2\nNODATA_value -9999\n"
         + text(image("-9999"), " "), IMAGE, note="-9999", hole=True),
    # footers
    File("a word below", text(cells()) + "end of data\n", "refused"),
    File("a comment below", text(cells()) + "# end of data\n", ARRAY),
    File("means below", text(cells(), ";") + "mean;0.2;0.1;0.3\n", "refused"),
    File("blank lines below", text(cells()) + "\n\n\n", ARRAY),
    File("a unit below", text(cells()) + "[um]\n", "refused"),
    # coordinates
    File("frame, corner 0", text(framed("0", UPWARD, X, Y), ";"), POINTS, UM, "first row and column"),
    File("frame, corner empty", text(framed("", UPWARD, X, Y)), POINTS, UM, "first row and column"),
    File("frame, corner a word", text(framed("y/x", UPWARD, X, Y), "\t"), POINTS, UM, "first row and column"),
    File("frame, corner a count", text(framed("5", UPWARD, X, Y), " "), POINTS, UM, "first row and column"),
    File("frame from the top", text(framed("0.00", image(), X, Y[::-1])), POINTS, UM, "first row and column"),
    File("x above alone", text([X, *image()]), "refused"),
    File("y beside alone", text([[y, *row] for y, row in zip(Y, image(), strict=True)], ";"),
         "refused"),
    File("uneven frame", text(framed("", UPWARD, X, ["0.0", "1.0", "6.0", "9.0"])), "refused"),
    File("frame of counts", text(framed("", cells(), ["0", "1", "2", "3"], list("01234"))), ARRAY,
         note="index"),
    # units
    File("units below names", "x;y;z\nmm;mm;um\n" + text(points(2e-3, 3e-3), ";"), POINTS, UM),
    File("units in brackets", "x [um],y [um],z [nm]\n" + text(points(z=1e3)), POINTS, {"unit": "nm"}),
    File("a unit in each cell", text(cells(form="{:.2f} um"), ";"), "refused"),
    # missing points
    File("1.#QNAN", text(cells(missing="1.#QNAN")), ARRAY, hole=True),
    File("-1,#IND", text(cells(missing="-1.#IND"), ";", ","), ARRAY, hole=True),
    File("#N/A", text(cells(missing="#N/A"), "\t"), ARRAY, hole=True),
    File("-nan(ind)", text(cells(missing="-nan(ind)"), " "), ARRAY, hole=True),
    File("empty", text(cells(missing=""), ";"), ARRAY, hole=True),
    File("-9999", text(cells(missing="-9999")), ARRAY, note="-9999"),
    # points and blocks
    File("points, the first lacking", text(points(lacks=1), " "), POINTS, UM),
    File("counted points", text([[str(k), *p] for k, p in enumerate(points(), 1)]), POINTS, UM, "index"),
    File("two images", GWYDDION.format("a") + text(image(), "\t") + GWYDDION.format("b")
         + text(image(), "\t"), IMAGE, {}),
)  # fmt: skip

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


@pytest.mark.parametrize("listed", [SIXTY, MORE])
def test_sixty_are_listed(listed: tuple[File, ...]) -> None:
    assert len({file.name for file in listed}) == len(listed) == 60


@pytest.mark.parametrize("file", [*SIXTY, *MORE], ids=lambda file: file.name)
def test_a_strangers_text_is_read_right_or_refused(tmp_path: Path, file: File) -> None:
    check(tmp_path / "map.txt", file)
