"""Figures of the study of extremes: heat maps of digits, counts of lawful states, condition numbers."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.patches import Patch
from matplotlib.ticker import NullLocator

from reports.drawing import COLOURS, INK, MARKERS, Data, Figure

Numbers = np.ndarray[tuple[int, ...], np.dtype[np.float64]]
NO_NUMBER = "#b0b0b0"


def _map(axes: Axes, values: Numbers, rows: Sequence[str], colours: str, most: float) -> Any:
    """A heat map of rows; cells without a number stay blank."""
    image = axes.imshow(np.ma.masked_invalid(values), cmap=colours, vmin=0, vmax=most, aspect="auto")
    axes.set_yticks(range(len(rows)), rows, fontsize=7.5)
    axes.grid(visible=False)
    return image


def _lost(canvas: Canvas, data: Data) -> None:
    """Digits lost per quantity and arithmetic, with the number in each cell."""
    rows = list(data["digits lost"])
    values = np.array([[np.nan if v is None else v for v in data["digits lost"][row]] for row in rows])
    axes = canvas.add_subplot()
    image = _map(axes, values, rows, "cividis_r", 9.0)
    axes.set_xticks(range(len(data["arithmetic"])), data["arithmetic"])
    axes.set_xlabel("arithmetic")
    for (i, j), value in np.ndenumerate(values):
        text = "none" if np.isnan(value) else f"{value:.1f}"
        colour = INK if np.isnan(value) else "white" if value > 4 else "black"
        axes.text(j, i, text, ha="center", va="center", fontsize=7, color=colour)
    canvas.colorbar(image, ax=axes, label="decimal digits lost", shrink=0.6)


def _kept(canvas: Canvas, data: Data) -> None:
    """Digits kept along each series, first state left; honest failures, crashes and wrong ones apart."""
    rows = list(data["digits kept"])
    columns = max(len(values) for values in data["digits kept"].values())
    values, fails = np.full((len(rows), columns), np.nan), []
    for i, row in enumerate(rows):
        series = data["digits kept"][row]
        edges = np.linspace(0, columns, len(series) + 1).round().astype(int)
        for k, (low, high) in enumerate(pairwise(edges)):
            if isinstance(series[k], str):
                fails.append((i, low, high, series[k]))
            else:
                values[i, low:high] = series[k]
    axes = canvas.add_subplot()
    image = _map(axes, values, rows, "viridis", 16.0)
    styles = {"honest failure": NO_NUMBER, "crash": COLOURS[5], "wrong": COLOURS[1]}
    for i, low, high, verdict in fails:
        axes.axhspan(
            i - 0.5,
            i + 0.5,
            low / columns,
            high / columns,
            facecolor=styles[verdict],
            edgecolor=INK,
            lw=0.2,
        )
    axes.set_xticks([-0.5, columns - 0.5], ["first state", "last state"])
    axes.set_xlabel("along the axis, to the end given in the table")
    present = {fail[3] for fail in fails}
    legend = [
        Patch(facecolor=colour, edgecolor=INK, label=name)
        for name, colour in styles.items()
        if name in present
    ]
    if legend:
        canvas.legend(handles=legend, loc="outside upper right", ncols=len(legend))
    canvas.colorbar(image, ax=axes, label="decimal digits kept", shrink=0.6)


def _lawful(canvas: Canvas, data: Data) -> None:
    """Shares of scenes with no, one, several lawful states over tau."""
    axes = canvas.add_subplot()
    bottom = np.zeros(len(data["tau / mean pressure"]))
    for k, name in enumerate(("one", "several", "none")):
        height = np.array(data[name], dtype=float)
        axes.bar(
            range(len(bottom)), height, bottom=bottom, color=COLOURS[k], label=f"{name} lawful", width=0.75
        )
        bottom += height
    axes.plot(range(len(bottom)), data["not converged"], MARKERS[0], color=INK, label="not CONVERGED")
    axes.set_xticks(range(len(bottom)), [f"{tau:g}" for tau in data["tau / mean pressure"]])
    axes.set(xlabel=r"$\tau$ / mean pressure", ylabel="scenes")
    canvas.legend(loc="outside upper center", ncols=4)


def _condition(canvas: Canvas, data: Data) -> None:
    """Condition number and CG iterations over the grid; digits lost on a second axis."""
    left, right = canvas.subplots(1, 2)
    left.loglog(data["M"], data["condition"], marker=MARKERS[0], color=COLOURS[0], label="condition number")
    left.loglog(data["M"], data["CG iterations"], marker=MARKERS[1], color=COLOURS[1], label="CG iterations")
    guide = 1.66 * np.array(data["M"], dtype=float)
    left.loglog(data["M"], guide, "--", color=INK, label="1.66 M")
    left.set(xlabel="elements per side", ylabel="number")
    left.legend()
    lost = np.array(data["digits lost by a direct solve"], dtype=float)
    right.semilogx(data["M"], lost, marker=MARKERS[2], color=COLOURS[2], label="measured")
    bound = np.log10(np.array(data["condition"], dtype=float))
    right.semilogx(data["M"], bound, "--", color=INK, label="log10 of the condition number")
    right.set(xlabel="elements per side", ylabel="decimal digits lost by a direct solve")
    right.legend()
    for axes in (left, right):
        axes.set_xticks([2, 4, 8, 16, 32], ["2", "4", "8", "16", "32"])
        axes.xaxis.set_minor_locator(NullLocator())


LOST = Figure(
    "*",
    ("arithmetic", "digits lost"),
    _lost,
    "Digits lost, quantity by quantity: a tenth means rounding, nine that a float32 has nothing left.",
    (8.6, 7.0),
)
KEPT = Figure(
    "*",
    ("digits kept",),
    _kept,
    "Digits that results of the production solver keep along each series, against the oracle.",
    (8.6, 7.2),
)
LAWFUL = Figure(
    "*",
    ("tau / mean pressure", "none", "one", "several", "not converged"),
    _lawful,
    "Lawful states of 40 rough flats on 3 x 3 elements, counted by trying all contact sets.",
)
CONDITION = Figure(
    "*",
    ("M", "condition", "CG iterations", "digits lost by a direct solve"),
    _condition,
    "Condition number of the dense flexibility, and its price.",
    (8.6, 3.6),
)
