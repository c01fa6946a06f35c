"""Published experiments: prediction and measurement of each, after ASME V&V 20."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import INK, Data, Figure, below, look
from reports.exhibit import Column, Document, Exhibit, table
from reports.text import decimals, interval, symbols

COLUMNS: dict[str, Column] = {
    "D, measured": lambda row: interval(row["measured"], row["measured_half_width"]),
    "S, predicted": lambda row: _rounded(row, "predicted"),
    "U_num": "{numerical:.2g}",
    "U_input": "{input:.2g}",
    "E = S - D": lambda row: _rounded(row, "error", "+"),
    "U_val": lambda row: _rounded(row, "uncertainty"),
    "|E| <= U_val": "within",
}


def _rounded(row: Mapping[str, float], key: str, sign: str = "") -> str:
    """Return a number with the decimals of U_val's two digits."""
    return f"{row[key]:{sign}.{decimals(row['uncertainty'])}f}"


INTRODUCTION = (
    "E is the predicted number S less the measured one D. U_val joins, in squares, the uncertainties of the "
    "solver, U_num, of the inputs, U_input, and of the measurement, U_D: half-widths at 95 %. Where a "
    "parameter is fitted to data of the same experiment, the trend alone is judged."
)


def build(document: Document) -> Exhibit:
    """Return paragraphs and a table for each experiment, and a figure for those of several points."""
    found = document["experiments"]
    return Exhibit(
        "Experiments",
        [INTRODUCTION, *(_text(one) for one in found)],
        [
            table(
                f"{one['title']}: {one['quantity']}{_unit(one)}.",
                one["points"],
                {one["over"]: lambda row: row["at"], **COLUMNS},
            )
            for one in found
        ],
        [(_figure(one), _data(one)) for one in found if len(one["points"]) > 1],
    )


def sentences(document: Document) -> list[str]:
    """Return what the first page states: what was compared, what lies within U_val, where the model fails.

    >>> one = {"title": "Ball on film", "trend_only": True, "failure": "", "points": [{"within": True}] * 2}
    >>> sentences({"experiments": [one]})
    ['1 experiments: ball on film', '2 of 2 points lie within U_val, 2 with ... experiment', 'No failure']
    """
    found = document["experiments"]
    points = [(one, point["within"]) for one in found for point in one["points"]]
    held = [one for one, within in points if within]
    fitted = sum(one["trend_only"] for one in held)
    failed = sum(bool(one["failure"]) and not one["trend_only"] for one in held)
    kinds = [f"{fitted} with a parameter fitted to the same experiment"] if fitted else []
    kinds += [f"{failed} in an experiment whose other points the model misses"] if failed else []
    titles = [one["title"][0].lower() + one["title"][1:] for one in found]
    failures = " and ".join(
        f"{title} ({one['failure']})" for title, one in zip(titles, found, strict=True) if one["failure"]
    )
    return [
        f"{len(found)} experiments: {', '.join(titles)}",
        ", ".join([f"{len(held)} of {len(points)} points lie within U_val", *kinds]),
        f"The model fails for {failures}" if failures else "No failure",
    ]


def _text(one: dict[str, Any]) -> str:
    parts = f"{one['fitted']} Data: {one['reduction']} Neglected: {one['left_out']} Source: {one['source']}."
    return f"{one['title']}. {parts}"


def _unit(one: dict[str, Any]) -> str:
    return f" ({one['unit']})" if one["unit"] else ""


def _data(one: dict[str, Any]) -> Data:
    points = one["points"]
    numbers = {key: [p[key] for p in points] for key in points[0] if key != "at"}
    return {"at": [str(p["at"]) for p in points], **numbers}


def _figure(one: dict[str, Any]) -> Figure:
    def draw(canvas: Canvas, data: Data) -> None:
        axes, places = canvas.add_subplot(), np.arange(len(data["at"]))
        scale = np.array(data["measured"], dtype=float)
        for shift, number, half, label, k in (
            (-0.06, "measured", "measured_half_width", "measured, with U_D", 1),
            (0.06, "predicted", "uncertainty", "predicted, with U_val", 0),
        ):
            style: dict[str, Any] = {"linestyle": "none", "capsize": 3, "label": label, **look(k)}
            axes.errorbar(places + shift, data[number] / scale, data[half] / abs(scale), **style)
        axes.axhline(1.0, color=INK, linestyle=":", linewidth=1)
        axes.set(xlabel=one["over"], ylabel="number / measured number", xlim=(-0.5, len(places) - 0.5))
        texts = [isinstance(p["at"], str) for p in one["points"]]
        mixed = len(set(texts)) > 1  # loads, and a ratio of two numbers
        for place in places[texts] if mixed else ():
            axes.axvline(place - 0.5, color=INK, linewidth=1)
        ticks = [
            f"ratio,\n{at}" if mixed and text else at for at, text in zip(data["at"], texts, strict=True)
        ]
        axes.set_xticks(places, [symbols(tick) for tick in ticks])
        below(canvas, axes)

    needs = ("at", "measured", "measured_half_width", "predicted", "uncertainty")
    return Figure("*", needs, draw, f"{one['title']}: {one['quantity']}, over the measured number.")
