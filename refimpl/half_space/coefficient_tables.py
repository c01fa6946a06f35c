"""Reader of the shipped tables of coefficient errors: strips in the plane, square elements in space."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from itertools import product
from typing import Any

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array


@dataclass(frozen=True)
class Axis:
    """Values that a table's axis must have, besides rising.

    least : number of values
    holds : values that must be among them
    even : whether the values are equally spaced from the first to the last of ``holds``
    """

    least: int
    holds: tuple[float, ...] = ()
    even: bool = False

    def refusal(self, values: Sequence[float]) -> str | None:
        """Return what is expected instead of these values; None if they will do."""
        if len(values) < self.least or not np.all(np.diff(values) > 0):
            return f"{self.least} rising values at least"
        if self.even:
            first, last = self.holds[0], self.holds[-1]
            if not np.allclose(values, np.linspace(first, last, len(values)), rtol=0, atol=1e-12):
                return f"equal steps from {first} to {last}"
        elif not set(self.holds) <= set(values):
            return f"{', '.join(map(str, self.holds))} among the values"
        return None


@dataclass(frozen=True)
class Layout:
    """Form of one table.

    file : its name in ``refimpl/data``
    version : the only version that is read
    axes : by name, in the order of the arrays' axes
    arrays : names of the arrays; each has the axes' shape, and may have more axes after these
    points : where the file lists points instead of arrays: what a point must have to count; else None
    """

    file: str
    version: int
    axes: Mapping[str, Axis]
    arrays: tuple[str, ...]
    points: Mapping[str, object] | None = None


PLANE = Layout(
    file="coefficient_error.json",
    version=1,
    axes={
        "slope_deg": Axis(least=4),  # cubic splines over the slope and the wavenumber
        "wavelength": Axis(least=4),
        "position": Axis(least=2, holds=(0.0, 0.5), even=True),  # crest to valley; harmonics between
        "offset": Axis(least=2, holds=(-2.0, 2.0)),  # both neighbours
    },
    arrays=("kappa_part", "constant_part"),
)
SPACE = Layout(
    file="coefficient_error_3d.json",
    version=1,
    axes={
        "nu": Axis(least=3),  # quadratic in Poisson's ratio
        "position": Axis(least=3, holds=(0.0, 0.25, 0.5)),  # crest, flank, valley
        "slope_deg": Axis(least=2),
    },
    arrays=("error",),
    points={"wavelength": 20.0, "kind": "ridge", "width": "projected"},
)


def shipped_table(layout: Layout) -> dict[str, Array]:
    """Return the table that comes with this package, axes and arrays by name."""
    file = resources.files("refimpl").joinpath("data", layout.file)
    return read_table(file.read_text(encoding="utf-8"), layout)


def read_table(text: str, layout: Layout) -> dict[str, Array]:
    """Return a table's axes and arrays by name; `InputError` for another version, axis or shape."""
    document: dict[str, Any] = json.loads(text)
    if document.get("version") != layout.version:
        raise InputError(layout.file, document.get("version"), f"version {layout.version}")
    if layout.points is not None:
        document = _gridded(document["points"], layout, layout.points)
    for name, axis in layout.axes.items():
        values = document.get(name)
        expected = axis.refusal(values) if isinstance(values, list) else "a list of numbers"
        if expected is not None:
            raise InputError(name, values, expected)
    shape = tuple(len(document[name]) for name in layout.axes)
    for name in layout.arrays:
        found = np.shape(document.get(name, ()))
        if found[: len(shape)] != shape:
            raise InputError(name, found, f"the shape of its axes, {shape}")
    return {name: np.array(document[name]) for name in (*layout.axes, *layout.arrays)}


def _gridded(
    points: Sequence[Mapping[str, Any]], layout: Layout, wanted: Mapping[str, object]
) -> dict[str, Any]:
    """Return axes and arrays of the points that count, without values that lack points or are not asked."""
    rows = {
        tuple(point[name] for name in layout.axes): point
        for point in points
        if all(point[name] == value for name, value in wanted.items())
    }
    axes = [sorted(set(values)) for values in zip(*rows, strict=True)] or [[] for _ in layout.axes]
    asked = [axis.holds or found for axis, found in zip(layout.axes.values(), axes, strict=True)]
    axes = [[v for v in found if v in kept] for found, kept in zip(axes, asked, strict=True)]
    *outer, last = axes
    axes = [*outer, [v for v in last if all((*place, v) in rows for place in product(*outer))]]
    shape = tuple(len(values) for values in axes)
    nodes = list(product(*axes))
    arrays = {
        name: np.reshape([rows[node][name] for node in nodes], (*shape, -1)) if nodes else ()
        for name in layout.arrays
    }
    return dict(zip(layout.axes, axes, strict=True)) | arrays
