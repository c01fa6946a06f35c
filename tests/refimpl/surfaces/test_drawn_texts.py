"""Sixty text files drawn from the product of strangers' habits, verdicts by rule before any was read.

All sixty were as listed. The seed was not chosen by its texts: of 20 seeds, 60 to 79, all 1200 are as listed.
"""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from refimpl.measured.reading import ARRAY, IMAGE
from tests.refimpl.surfaces import made_texts as made

SEED = 69
SEPARATORS = (",", ";", "\t", " ", ", ", "; ", "  ")
FORMS = ("{:.2f}", "{:.3f}", "{:.4e}", "{:+.2f}", "{:9.4f}") * 2 + ("thousands",)
KNOWN = ("", "nan", "NaN", "BAD", "n/a", "***", "---", "1.#QNAN", "-1.#IND", "#N/A", "#DIV/0!", "NULL")
UNKNOWN = ("?", "void", "fehlt", "x")
SIZED = "# {}: 10{m}0 µm\n# {}: 12{m}0 µm\n# {}: um\n"
LABELS = (
    ("Width", "Height", "Value units"),
    ("Breite", "Höhe", "Werteeinheit"),
    ("Largeur", "Hauteur", "Unités des valeurs"),
    ("Anchura", "Altura", "Unidades de valor"),
)
CUT_KEYS = [made.KEYS[: 20 * k] + "\n" for k in (2, 5)]
HEADERS = ("", "", "Sample 7\n", made.KEYS, "# by hand\n", "sized", *CUT_KEYS)
FOOTERS = ("",) * 6 + ("\n\n", "# end of data\n", "end of data\n", "Sq = 1.2\n")
KINDS = ("map",) * 10 + ("points", "points with units", "frame", "counted") * 2 + ("two maps",)


def drawn(number: int) -> made.File:
    """One file; it is refused where two readings are possible or a word is unknown.

    Draws that cannot be written are replaced: between blanks an empty entry by nan and an empty corner by 0,
    sizes above points or a frame by nothing. Decimal commas between commas, all refused, are made rare.
    """
    rng = random.Random(1000 * SEED + number)
    kind, separator, form = rng.choice(KINDS), rng.choice(SEPARATORS), rng.choice(FORMS)
    header, footer = rng.choice(HEADERS), rng.choice(FOOTERS)
    mark = "." if "," in separator and rng.random() < 0.8 else rng.choice(".,")
    missing = rng.choice((None, *rng.choices(KNOWN, k=4), rng.choice(UNKNOWN))) if kind == "map" else None
    sized = header == "sized" and kind in ("map", "counted", "two maps")
    if header == "sized":
        header = SIZED.format(*rng.choice(LABELS), m=mark) if sized else ""
    if missing == "" and separator.strip(" ") == "":
        missing = "nan"
    given, verdict, note = made.BOTH, IMAGE if header.strip() else ARRAY, ""
    shape = "{:.2f}" if form == "thousands" else form
    rows = made.image(missing, shape) if verdict == IMAGE else made.cells(form=shape, missing=missing)
    if kind.startswith("points"):
        rows, given, verdict = made.points(), made.UM, made.POINTS
        rng.shuffle(rows)
        if kind == "points with units":
            rows, given = made.points(2e-3, 3e-3), {}
            header = separator.join(("x [mm]", "y [mm]", "z [um]")) + "\n"
            note = "units mm, mm, um"
    elif kind == "frame":
        rows = made.framed(rng.choice(("", "0", "y/x")), made.UPWARD, made.X, made.Y)
        given, verdict = made.UM, made.POINTS
        if separator.strip(" ") == "":
            rows[0][0] = "0"
        note = "first row and column"
    elif kind == "counted":
        rows = [[str(k), *row] for k, row in enumerate(rows, 1)]
        note = "index column"
    if form == "thousands":
        rows = [[("1'" if mark == "," else "1,") + f"{k}20" for k, _ in enumerate(row)] for row in rows]
    body = made.text(rows, separator, mark)
    body += f"\n{body}" if kind == "two maps" else ""
    two_ways = mark == "," and "," in separator
    refused = two_ways or form == "thousands" or missing in UNKNOWN or kind == "two maps"
    if refused or footer[:1] in ("e", "S"):
        verdict = "refused"
    name = f"{number}: {kind}, {separator!r}, {mark!r}, {form}, missing {missing!r}, below {footer!r}"
    content, hole = header + body + footer, missing is not None
    return made.File(f"{name}, above {header[:20]!r}", content, verdict, given, note, hole)


DRAWN = tuple(drawn(number) for number in range(60))


def test_a_third_is_refused() -> None:
    verdicts = [file.verdict == "refused" for file in DRAWN]
    assert (verdicts.count(True), verdicts.count(False)) == (21, 39)


@pytest.mark.parametrize("file", DRAWN, ids=[file.name for file in DRAWN])
def test_a_drawn_text_is_read_right_or_refused(tmp_path: Path, file: made.File) -> None:
    made.check(tmp_path / "map.txt", file)
