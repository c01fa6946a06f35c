"""Measured friction as a table: rows of load, mu or friction force, and its standard uncertainty."""

from __future__ import annotations

import csv
import math
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median
from typing import Any

from refimpl.errors import MOST, InputError, require_number, require_regular, require_size
from refimpl.measured.measured_surface import MeasuredSurface
from refimpl.scene.scene import Body, Scene

MAX_ROWS, MAX_BYTES = 1000, 1_000_000
MIXED_FRICTION = 50.0  # ratio of two rows' mu from which one of them is taken to be in kN
MOST_FRICTION = 10.0  # mu of half of the rows: rubber under its own weight
LIKE_MU = 2.0  # mu of most dry contacts is below; loads (N) below beside mu above are exchanged columns
SWAPPED = 5.0  # ratio of friction at two loads against any law
MIXED_LOADS = 300.0  # ratio of neighbouring loads, the same: no loading series leaves such a gap
_FRICTION = {"mu": "u_mu", "friction_force": "u_friction_force"}
_FRAME, _FILES = ("sliding_direction", "sliding_offset"), ("upper_file", "lower_file")
_MARKED = re.compile(r"[+-]?\d*[.,][\d.,]*(e[+-]?\d+)?", re.I)  # number with a comma or a point
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}([.,]\d{3})+")
_UNITS = {
    "load": "N",
    "friction_force": "N",
    "u_friction_force": "N",
    "sliding_direction": "rad",
    "sliding_offset": "m",
}


@dataclass(frozen=True)
class Row:
    """One measurement: ``load`` (N), ``mu``, its standard uncertainty ``u_mu``, and overrides of the scene.

    sliding_direction : rad; sliding_offset : m; upper_file, lower_file : paths of measured surfaces. None
    keeps what the scene states.
    """

    load: float
    mu: float
    u_mu: float
    sliding_direction: float | None = None
    sliding_offset: float | None = None
    upper_file: str | None = None
    lower_file: str | None = None

    def of(self, scene: Scene) -> Scene:
        """Return the scene of this row. Raises `InputError` for a file where no surface is measured."""
        frame: dict[str, Any] = {name: value for name in _FRAME if (value := getattr(self, name)) is not None}
        changed = replace(scene, load=self.load, **frame)
        for name in _FILES:
            if (path := getattr(self, name)) is not None:
                body = name.removesuffix("_file")
                files: dict[str, Any] = {body: _from_file(getattr(scene, body), name, path)}
                changed = replace(changed, **files)
        return changed


def _from_file(body: Body, name: str, path: str) -> Body:
    parts: list[Any] = list(body.surface.parts)
    measured = [k for k, part in enumerate(parts) if isinstance(part, MeasuredSurface)]
    if len(measured) != 1:
        raise InputError(name, path, f"none: the scene's body has {len(measured)} measured surfaces, not one")
    parts[measured[0]] = replace(parts[measured[0]], path=path)
    return body.with_parts(parts)


Cells = list[tuple[str, list[str]]]
"""Rows of texts, the header first, each with its name in a refusal."""


def read_rows(table: str | Path | Any) -> tuple[Row, ...]:
    """Return the rows of a CSV file, a pandas DataFrame or a dict of columns.

    Columns are ``load,mu,u_mu`` or ``load,friction_force,u_friction_force``.

    SI units; ``u`` is a standard uncertainty (68 %). Optional columns: ``sliding_direction`` (rad),
    ``sliding_offset`` (m), ``upper_file`` and ``lower_file`` (relative to the CSV file, or
    to the working directory). In a file, semicolons or tabs may separate the columns; decimal commas are read
    then, unless all of them may separate thousands. Lines that begin with "#" are comments. An unnamed first
    column that counts the rows, as R and pandas write it, is dropped with a warning. Raises `InputError`,
    which names the line, for anything else.

    >>> measured = {"load": [5, 80], "friction_force": [1, 12], "u_friction_force": [0.1, 1]}
    >>> read_rows(measured)  # or pandas.DataFrame(measured)
    (Row(load=5.0, mu=0.2, u_mu=0.02, ...), Row(load=80.0, mu=0.15, u_mu=0.0125, ...))
    """
    is_file = isinstance(table, str | Path)
    cells, decimal = _of_file(Path(table)) if is_file else (_of_frame(table), ".")
    folder = Path(table).parent if is_file else Path()
    header = cells[0][1]
    quantity = _check_header(header)
    rows = tuple(_row(header, quantity, name, line, folder, decimal) for name, line in cells[1:])
    if quantity == "mu":
        _refuse_exchanged(rows)
    return check_rows(rows)


def _of_frame(table: Any) -> Cells:
    """Return the cells of a data frame; missing ones are empty."""
    try:
        names = list(getattr(table, "columns", table))
        columns = [["" if cell is None or cell != cell else str(cell) for cell in table[k]] for k in names]
    except (TypeError, KeyError, IndexError) as alien:
        raise InputError("data", type(table).__name__, "a CSV file's path, or a data frame") from alien
    rows = zip(*columns, strict=True)
    return [("header", list(map(str, names))), *((f"row {k}", list(row)) for k, row in enumerate(rows, 1))]


def _of_file(path: Path) -> tuple[Cells, str]:
    require_regular("data", path, MAX_BYTES)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as refused:
        raise InputError("data", str(path), f"a file that can be read ({refused.strerror})") from refused
    except UnicodeDecodeError as alien:
        raise InputError("data", str(path), "a CSV file in UTF-8") from alien
    lines = [
        (f"line {k}", line)
        for k, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    separator = next((mark for mark in ";\t" if lines and mark in lines[0][1]), ",")
    try:
        read = ((name, next(csv.reader([line], delimiter=separator, strict=True))) for name, line in lines)
        cells = [(name, [cell.strip() for cell in row]) for name, row in read]
    except csv.Error as alien:
        raise InputError("data", str(path), f"a CSV file ({alien})") from alien
    if not cells:
        raise InputError("data", str(path), "a header line and rows: the file is empty")
    cells = _without_index(cells)
    _refuse_thousands(cells[1:])
    return cells, "." if separator == "," else ","


def _without_index(cells: Cells) -> Cells:
    header, counts = cells[0][1], [row[0] for _, row in cells[1:]]
    if header[0] or counts not in ([str(k + first) for k in range(len(counts))] for first in (0, 1)):
        return cells
    said = "data: the unnamed first column, which counts the rows, was dropped"
    warnings.warn(said, UserWarning, stacklevel=4)
    return [(name, row[1:]) for name, row in cells]


def _refuse_thousands(cells: Cells) -> None:
    """Refuse 1,320 where no comma is surely a decimal one; likewise points, where there are commas."""
    numbers = [(name, cell) for name, row in cells for cell in row if _MARKED.fullmatch(cell)]
    commas = [(name, cell) for name, cell in numbers if "," in cell]
    points = [(name, cell) for name, cell in numbers if "." in cell]
    for found in (commas, points if commas else []):
        if found and all(_THOUSANDS.fullmatch(cell) for _, cell in found):
            name, cell = found[0]
            allowed = "a decimal point, and no mark between thousands: this one may be either"
            raise InputError(f"data {name}", cell, allowed)


def _check_header(header: Sequence[str]) -> str:
    """Return the quantity measured, "mu" or "friction_force"."""
    shown = ",".join(header)
    known = {"load", *_FRICTION, *_FRICTION.values(), *_FRAME, *_FILES}
    if unknown := [name for name in header if name not in known]:
        allowed = "columns load,mu,u_mu or load,friction_force,u_friction_force, in SI units"
        raise InputError("data column", unknown[0], allowed)
    if len(set(header)) < len(header):
        raise InputError("data columns", shown, "each column once")
    given = [name for name in _FRICTION if name in header]
    if "load" not in header or len(given) != 1:
        raise InputError("data columns", shown, "load (N) and one of mu and friction_force (N)")
    if _FRICTION[given[0]] not in header:
        allowed = f"{_FRICTION[given[0]]}, the standard uncertainty of {given[0]}, as well"
        raise InputError("data columns", shown, allowed)
    return given[0]


def _row(
    header: Sequence[str], quantity: str, where: str, cells: Sequence[str], folder: Path, decimal: str
) -> Row:
    if len(cells) != len(header):
        allowed = f"{len(header)} cells, as many as columns"
        if decimal == "." and len(cells) > len(header):
            allowed += " (decimal commas need ; between the columns)"
        raise InputError(f"data {where}", ",".join(cells), allowed)
    found = dict(zip(header, cells, strict=True))
    numbers = {
        name: _number(where, name, text.replace(decimal, "."))
        for name, text in found.items()
        if name not in _FILES and (text or name not in _FRAME)
    }
    load, value, spread = (numbers[name] for name in ("load", quantity, _FRICTION[quantity]))
    for name, number in (("load", load), (_FRICTION[quantity], spread)):
        require_size(f"data {where}: {name}", number, "a positive number")
    allowed = f"a number that is not negative, at most {MOST}"
    require_number(f"data {where}: {quantity}", value, allowed, at_least=0, at_most=MOST)
    scale = 1.0 if quantity == "mu" else load
    files = {name: str(folder / text) for name in _FILES if (text := found.get(name))}
    frame = {name: numbers[name] for name in _FRAME if name in numbers}
    return Row(load, value / scale, spread / scale, **frame, **files)  # type: ignore[arg-type]  # names of fields


def _number(where: str, name: str, text: str) -> float:
    unit = f" in {_UNITS[name]}, without its unit" if name in _UNITS else ""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number) or "_" in text or not text.isascii():
        raise InputError(f"data {where}: {name}", text, f"a finite number{unit}")
    return number


def _refuse_mixed_loads(rows: Sequence[Row]) -> None:
    order = sorted(range(len(rows)), key=lambda k: rows[k].load)
    jump, k = max((rows[order[k]].load / rows[order[k - 1]].load, k) for k in range(1, len(order)))
    if jump > MIXED_LOADS:
        apart = order[:k] if 2 * k < len(order) else order[k:]  # the fewer
        named = ", ".join(f"row {one + 1} ({rows[one].load:.4g} N)" for one in sorted(apart)[:5])
        raise InputError(
            "data: load", f"{named}, {jump:.0f} times from the next", "loads in N (mN, kN mixed?)"
        )


def _refuse_exchanged(rows: Sequence[Row]) -> None:
    """Refuse loads that are all as small as mu, beside values of mu that are all larger and vary more.

    Soft adhesive bodies under light loads have such a mu, but it varies less than the load does.
    """
    if not rows:
        return
    (least, most), (low, high) = (
        (min(values), max(values)) for values in ([row.load for row in rows], [row.mu for row in rows])
    )
    if most < LIKE_MU < low and high / low > most / least:
        said = f"load {least:.3g} to {most:.3g}, mu {low:.3g} to {high:.3g}"
        allowed = f"mu below {LIKE_MU:g} (are the columns load and mu exchanged? mu in per cent?)"
        raise InputError("data: load and mu", said, allowed)


def _refuse_swapped(rows: Sequence[Row]) -> None:
    """Refuse friction that falls with the load, and mu that rises with it: no law has them."""
    known = [row for row in rows if row.mu > 3 * row.u_mu]
    if not known:
        return
    light, heavy = min(known, key=lambda row: row.load), max(known, key=lambda row: row.load)
    if heavy.mu * heavy.load * SWAPPED < light.mu * light.load:
        said = f"friction falls from {light.mu * light.load:.3g} to {heavy.mu * heavy.load:.3g} N"
        raise InputError("data", f"{said} as the load rises", "columns load and mu in this order (swapped?)")
    if heavy.mu > SWAPPED * light.mu > 0:
        said = f"mu rises from {light.mu:.3g} to {heavy.mu:.3g} with the load"
        raise InputError("data: mu", said, "mu = F / load (friction_force is a column of its own)")


def check_rows(rows: Sequence[Row], unknowns: int = 2) -> tuple[Row, ...]:
    """Return the rows; `InputError` where they cannot determine the unknowns or their units are mixed."""
    known = all(isinstance(row, Row) for row in rows)
    if not known or len(rows) > MAX_ROWS:
        found = f"{len(rows)} rows" if known else type(rows).__name__
        raise InputError("data", found, f"at most {MAX_ROWS} rows as of read_rows(table)")
    cases = {replace(row, mu=0.0, u_mu=0.0) for row in rows}
    if len(cases) < unknowns:
        count = "two" if unknowns == 2 else f"{unknowns}"
        loads_found = f"{len(rows)} rows at {len(cases)} load{'s' if len(cases) > 1 else ''}"
        raise InputError("data", loads_found, f"at least {count} different loads")
    _refuse_mixed_loads(rows)
    mus = sorted(row.mu for row in rows if row.mu > 0)
    if mus and mus[-1] > MIXED_FRICTION * mus[0]:
        allowed = "forces in N alone (N and kN mixed?), mu as a number under mu (per cent?)"
        raise InputError("data: mu", f"{mus[0]:.3g} to {mus[-1]:.3g}", allowed)
    _refuse_swapped(rows)
    if mus and median(mus) > MOST_FRICTION:
        raise InputError(
            "data: mu",
            f"{mus[0]:.3g} to {mus[-1]:.3g}",
            "friction and load in N (mN, kN mixed?), mu as a number (per cent?)",
        )
    if all(row.u_mu > row.mu for row in rows):
        least = min(row.u_mu for row in rows)
        allowed = "uncertainties below mu itself (in per cent? columns swapped?)"
        raise InputError("data: u_mu", f"{least:.3g} or more", allowed)
    return tuple(rows)
