"""Text files made as strangers write them, and whether each is read as its verdict says."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.measured.readers import read

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
KEYS = "".join(f"Key {k}: value {k / 7:.3f} of {k}\n" for k in range(30))


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
    """Read the file, or see it refused, as its verdict says."""
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
