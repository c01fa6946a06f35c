"""The three-dimensional answer, read: errors over the slope, slopes of 2 %, one body and a pair.

`python -m appendix_a.fem3d.table STUDY.json TABLE.json` condenses the study's table to what `refimpl` ships:
of each point the best result, its errors as fractions of flat and the largest stated uncertainty.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from appendix_a.errors import InputError, reals
from appendix_a.fem3d import study
from appendix_a.fem3d.coefficients import LABELS

Array = NDArray[np.float64]
VERSION = 1
ARGUMENTS = ("slope_deg", "wavelength", "position", "nu", "kind", "width")
MIRRORED = [0, 4, 5, 6, 1, 2, 3, 7, 8, 9]  # +x and -x change places


@dataclass(frozen=True)
class Series:
    """Identification of a row of errors over the slope."""

    wavelength: float
    position: float
    nu: float
    kind: str = "ridge"
    width: str = "projected"


@dataclass(frozen=True)
class Table3D:
    """Errors (fractions of flat, in the order of LABELS) by series and slope, and how uncertain they are."""

    errors: dict[Series, dict[float, Array]]
    uncertainty: dict[Series, dict[float, float]]

    def slopes(self, series: Series) -> Array:
        """Return the tabulated slopes (degrees), rising; `InputError` for a series not computed."""
        if series not in self.errors:
            raise InputError("series", series, "one that the table holds")
        return np.array(sorted(self.errors[series]))

    def error(self, series: Series, slope_deg: float | Array) -> Array:
        """Return the errors (..., 10) of one body: quotients by tan(slope), linear in it.

        Below the first slope the quotient is the first one's, where second order is 4 % of it.
        `position` beyond 0.5 is the mirrored one. Raises InputError for a slope beyond the last.
        """
        known = Series(series.wavelength, 1 - series.position, series.nu, series.kind, series.width)
        turned = series.position > 0.5
        slopes = self.slopes(known if turned else series)
        allowed = f"0 to {slopes[-1]:g} degrees"
        degrees = reals("slope_deg", slope_deg, allowed)
        if not np.all((degrees >= 0) & (degrees <= slopes[-1])):
            raise InputError("slope_deg", slope_deg, allowed)
        wanted = np.tan(np.radians(degrees))
        tangents = np.tan(np.radians(slopes))
        rows = self.errors[known if turned else series]
        quotients = np.array([rows[float(s)] for s in slopes]) / tangents[:, None]
        columns = [wanted * np.interp(wanted, tangents, column) for column in quotients.T]
        found: Array = np.stack(columns, axis=-1)
        return found[..., MIRRORED] if turned else found

    def pair_error(
        self, series: Series, slope_deg: float | Array, lower: tuple[float, float], upper: tuple[float, float]
    ) -> Array:
        """Return `error` for bodies (E, nu) on one wave; `position` as the lower body sees it.

        What is a crest to one is a valley to the other; `series.nu` is not used.
        """
        total, flat = np.zeros((*np.shape(slope_deg), len(LABELS))), 0.0
        for (modulus, nu), shift in ((lower, 0.0), (upper, 0.5)):
            weight = (1 - nu * nu) / modulus  # flat coefficients of one offset are in this proportion
            place = (series.position + shift) % 1.0
            own = Series(series.wavelength, place, nu, series.kind, series.width)
            total, flat = total + weight * self.error(own, slope_deg), flat + weight
        result: Array = total / flat
        return result

    @classmethod
    def read(cls, path: Path) -> Table3D:
        """Return the condensed table. Raises InputError for another kind or version."""
        document = json.loads(path.read_text(encoding="utf-8"))
        if document.get("table") != "coefficient_error_3d" or document.get("version") != VERSION:
            raise InputError("table", str(path), f"coefficient_error_3d, version {VERSION}")
        table = cls({}, {})
        for row in document["points"]:
            slope, *rest = (row[name] for name in ARGUMENTS)
            table.errors.setdefault(Series(*rest), {})[slope] = np.array(row["error"])
            table.uncertainty.setdefault(Series(*rest), {})[slope] = row["uncertainty"]
        return table


def slope_of(error: Array, slopes: Array, limit: float = 0.02) -> list[float | None]:
    """Return per column of `error` (slopes, labels) the least slope with |error| >= limit, or None.

    >>> slope_of(np.array([[0.0, 0.0], [0.03, 0.0], [0.01, 0.01]]), np.array([0.0, 1.0, 2.0]))
    [1.0, None]
    """
    reached = np.abs(error) >= limit
    return [float(slopes[np.argmax(column)]) if column.any() else None for column in reached.T]


def condensed(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return each point's row of least stated uncertainty, without the fields that only the study needs."""
    best: dict[tuple[object, ...], dict[str, Any]] = {}
    for row in rows:
        stated = float(np.add(row["discretisation"], row["truncation"]).max())
        key = tuple(row[name] for name in ARGUMENTS)
        if key not in best or stated < best[key]["uncertainty"]:
            error = [float(f"{value:.4g}") for value in row["error"]]
            best[key] = {name: row[name] for name in ARGUMENTS} | {
                "error": error,
                "uncertainty": float(f"{stated:.2g}"),
            }
    return [best[key] for key in sorted(best)]


def write(path: Path, rows: Sequence[dict[str, Any]]) -> None:
    """Return the condensed table as JSON, a line a point."""
    head = {
        "table": "coefficient_error_3d",
        "version": VERSION,
        "what": "wavy over flat displacement minus 1, one square element of pressure on a wavy elastic body",
        "labels": list(LABELS),
        "units": "lengths in half the element edge; slope_deg: maximum slope; errors: fraction of flat",
        "provenance": "python -m appendix_a.fem3d.study, condensed by python -m appendix_a.fem3d.table",
    }
    lines = ",\n".join(json.dumps(row, separators=(",", ":")) for row in condensed(rows))
    top = json.dumps(head, indent=1).removesuffix("\n}")
    path.write_text(f'{top},\n "points": [\n{lines}\n]}}\n', encoding="utf-8")


def equivalent_slope(rms_deg: float) -> float:
    """Return the maximum slope (degrees) of a sinusoid of that rms slope: tan(rms) is tan(max) over root 2.

    >>> round(equivalent_slope(2.5), 2)
    3.53
    """
    return math.degrees(math.atan(math.sqrt(2) * math.tan(math.radians(rms_deg))))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; exit status 0, or InputError for a table that is not the study's."""
    parser = argparse.ArgumentParser(description="Condense the three-dimensional study's table.")
    parser.add_argument("study", type=Path)
    parser.add_argument("table", type=Path)
    options = parser.parse_args(arguments)
    write(options.table, study.load(options.study))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
