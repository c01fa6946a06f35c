"""Lines of a text file: encoding, missing points that begin like comments, header words, blocks of Wyko."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

NOT_MEASURED = (
    "nan", "bad", "na", "n/a", "inf", "-inf", "null", "none", "---", "--", "***", "**", "*", "-",
)  # fmt: skip
_PIECE = 2**20  # characters read at a time
# Windows prints 1.#QNAN and -1.#IND00, spreadsheets #N/A, #DIV/0! and #WERT!, newer compilers -nan(ind)
_HASHED = r"[-+]?\d[.,]#[a-z][-+\w]*|#¡?(?:div/0!|n/[ad]|nv|[^\W\d_]+[!?])|[-+]?nan\(\w*\)"
_MISSING = re.compile(rf"(?<![^\s,;])(?:{_HASHED})(?![^\s,;])", re.IGNORECASE)
WYKO = "Wyko ASCII Data File Format"
_WYKO_BLOCK = re.compile(r"(?!bad\b)([a-z]\w*)\s+\d+\s+\d+\b", re.IGNORECASE)
WYKO_HEIGHTS = ("RAW_DATA", "OPD", "Raw", "SAMPLE_DATA")  # others are intensities and processed arrays

# The library's words, and those of Gwyddion and of profilometers in German, French and Spanish. Version
# 1.27.1 knows most of Gwyddion's, but only with the unit behind the value and a decimal point.
_WORDS = {
    "Channel": "channel|kanal|canal",
    "Width": "width|breite|largeur|anchura|ancho",
    "Height": "height|höhe|hoehe|hauteur|altura|alto",
    "Value units": r"value units?|(?:werte?|z)-?einheit(?:en)?|einheiten|unités"
    r"|unités? des? valeurs?|unidad(?:es)? de(?: los)? valor(?:es)?",
}
_STATED = re.compile(
    "#?\\s*(?:" + "|".join(f"({spellings})" for spellings in _WORDS.values()) + ")"
    r"(?:\s*[\[(](\w+)[\])])?\s*[:=;\t]\s*(.*)",
    re.IGNORECASE,
)
_DECIMAL_COMMA = re.compile(r"^(0|\d+(?!,\d{3}\b)),(?=\d)")  # 1,024 may be thousands


def in_english(line: str) -> str:
    """Return a header's line as the library knows it: English words, a decimal point, the unit at the end."""
    if (found := _STATED.fullmatch(line)) is None:
        return line
    word = next(word for word, spelled in zip(_WORDS, found.groups(), strict=False) if spelled)
    *_, unit, value = found.groups()
    value = _DECIMAL_COMMA.sub(r"\1.", value.replace(";", " ").strip())
    return f"# {word}: {value} {unit or ''}".rstrip()


def encoding_of(path: Path) -> str:
    """Return UTF-8 or UTF-16 by the file's mark, UTF-8 if it is valid, else Latin-1."""
    with path.open("rb") as file:
        if file.read(2) in (b"\xff\xfe", b"\xfe\xff"):
            return "utf-16"
    try:
        with path.open(encoding="utf-8-sig") as text:
            while text.read(_PIECE):
                pass
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8-sig"


def lines_of(path: Path, encoding: str) -> Iterator[tuple[int, str]]:
    """Yield number and text of each line, one at a time: a list takes several times the memory."""
    with path.open(encoding=encoding) as file:
        lines = (
            (number, _spelled(part.strip(" \xa0")))
            for number, line in enumerate(file, 1)
            for part in line.splitlines()
        )
        first = next(lines, (1, ""))
        yield first
        yield from _heights(lines) if first[1].startswith(WYKO) else lines


def _spelled(line: str) -> str:
    """Return the line with its missing points spelled nan; one of nothing else is a comment."""
    if "#" not in line and "(" not in line:
        return line
    return line if _MISSING.fullmatch(line) else _MISSING.sub("nan", line)


def _heights(lines: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Yield Wyko's text without arrays that are no heights: a block's line states name and length."""
    keeps = True
    for number, line in lines:
        if block := _WYKO_BLOCK.match(line):
            is_array = not line[block.end() :].strip()
            keeps = not is_array or block.group(1) in WYKO_HEIGHTS
        if keeps:
            yield number, line
