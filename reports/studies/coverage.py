"""Error bars of ``accuracy=`` against far finer grids: how often they hold, their length, their cost."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, Data, Figure, look
from reports.exhibit import Column, Document, Exhibit, Table, table

NAMES = {
    "friction_coefficient": "mu",
    "contact_area": "A",
    "contact_area_corrected": "A, corrected",
    "max_pressure": "f_max",
}
BY_NUMBER: dict[str, Column] = {
    "number": "number",
    "accuracy": "accuracy",
    "scenes": "scenes",
    "reached (%)": lambda row: _percent(row["met"]),
    "covered (%)": lambda row: _percent(row["covered"]),
    "covered, reference off by its bound (%)": lambda row: _percent(row["covered_at_worst"]),
    "error bar / error, median": lambda row: _rounded(row["median_bar_over_error"]),
    "cost / cheapest, median": lambda row: _rounded(row["median_cost"]),
    "cost within 2x (%)": lambda row: _percent(row["cost_at_most_2"]),
}
LOWEST = 1e-6  # errors below are drawn there: they are rounding and iteration
LONGEST = 0.5  # bars beyond are drawn there, and those that have no end


def build(document: Document) -> Exhibit:
    """Summary by number and accuracy, coverage by class, and every bar beside its error."""
    first, last = document["seeds"]
    solves = document["solves"]
    summary = (
        f"{last - first + 1} random scenes (seeds {first} to {last}, eight classes in turn); the estimator "
        f"was fitted to none of them. {solves['count']} solves in {solves['seconds'] / 60:.0f} minutes of "
        f"processor time, worst residual {solves['worst_residual']:.1e}. The reference is the finest grid "
        "(1024, periodic scenes 512) less its edge's mean share, for p_max the height of the parabola "
        "through its peak; the estimator uses both as well. Only grids at most half as fine are requested. A "
        "bar covers the reference when it exceeds the value's distance from the reference; in the next "
        "column the reference is moved by its whole bound, against the bar. Where the accuracy was not "
        "reached on these grids, the end is reported as such, with the bar that was. Each grid of a "
        "refinement sequence starts from the answer before, which changes its cost and no number by more "
        f"than {solves['worst_apart']:.1e} of it; the cheapest grid is solved afresh."
    )
    return Exhibit(
        "Accuracy requested, and kept",
        (summary, *_reference(document)),
        (_by_number(document), *(_by_class(judged) for judged in document["accuracies"])),
        tuple((_figure(document, judged), _series(judged)) for judged in document["accuracies"]),
    )


def _reference(document: Document) -> tuple[str, ...]:
    """Sentence on the change of the references on a finer grid, if that was computed."""
    checked = document["reference_check"]
    if not checked["seeds"]:
        return ()
    return (
        f"On {checked['grid']} x {checked['grid']} elements the references of {len(checked['seeds'])} scenes "
        f"move by at most {checked['worst_over_bound']:.2f} of the stated bounds.",
    )


def _by_number(document: Document) -> Table:
    rows = [
        {**found, "number": NAMES[number], "accuracy": judged["accuracy"]}
        for judged in document["accuracies"]
        for number, found in judged["numbers"].items()
    ]
    caption = "Error bars by number and accuracy; cost in transforms, all grids over the cheapest."
    return table(caption, rows, BY_NUMBER)


def _by_class(judged: dict[str, Any]) -> Table:
    rows = [
        (kind, *(_percent(found["covered"]) if found["scenes"] else None for found in numbers.values()))
        for kind, numbers in judged["classes"].items()
    ]
    caption = (
        f"Share of error bars that cover the reference at accuracy {judged['accuracy']:g}, by class (%)."
    )
    return Table(caption, ("class", *NAMES.values()), rows)


def _percent(share: float | None) -> float | None:
    return None if share is None else round(100 * share, 1)


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 2)


def _series(judged: dict[str, Any]) -> dict[str, Any]:
    """Columns over all verdicts, and the accuracy."""
    columns: dict[str, Any] = {name: [] for name in ("number", "class", "error", "bar", "reached")}
    for number, verdicts in judged["verdicts"].items():
        columns["number"] += [NAMES[number]] * len(verdicts["seed"])
        columns["class"] += verdicts["class"]
        columns["error"] += verdicts["error"]
        columns["bar"] += verdicts["bar"]
        columns["reached"] += verdicts["met"]
    return {**columns, "accuracy": judged["accuracy"]}


def _draw(canvas: Canvas, data: Data) -> None:
    """True error over bar for each number; above the line the bar does not cover."""
    number, kind = np.array(data["number"]), np.array(data["class"])
    error = np.maximum(np.array(data["error"], dtype=float), LOWEST)
    bar = np.array(data["bar"], dtype=float)
    holds = np.isnan(bar) | (error <= bar)  # one without end is no number
    bar = np.clip(np.where(np.isnan(bar), np.inf, bar), LOWEST, LONGEST)
    classes = list(dict.fromkeys(data["class"]))
    all_axes = canvas.subplots(1, len(NAMES), sharex=True, sharey=True)
    for axes, name in zip(all_axes, NAMES.values(), strict=True):
        for k, group in enumerate(classes):
            here = (number == name) & (kind == group)
            style = {"linestyle": "none", "markersize": 3.5, "label": group, **look(k)}
            face = style["color"] if k < len(COLOURS) else "none"
            axes.plot(bar[here], error[here], markerfacecolor=face, **style)
        axes.plot([LOWEST, 1], [LOWEST, 1], color=INK, linewidth=1)
        axes.axvline(data["accuracy"], color=INK, linewidth=1, linestyle=":")
        held = np.mean(holds[number == name])
        limits = LOWEST / 1.5, 1.5 * LONGEST
        axes.set(xscale="log", yscale="log", xlim=limits, ylim=limits, xlabel="relative error bar")
        axes.set_title(f"{name}: {100 * held:.1f} % covered")
    all_axes[0].set_ylabel("relative error against the reference")
    handles, labels = all_axes[0].get_legend_handles_labels()
    canvas.legend(handles, labels, loc="outside lower center", ncols=8, fontsize=8)


def _figure(document: Document, judged: dict[str, Any]) -> Figure:
    first, last = document["seeds"]
    return Figure(
        "*",
        ("number", "class", "error", "bar", "reached", "accuracy"),
        _draw,
        f"Accuracy {judged['accuracy']:g} requested of scenes {first} to {last}: true error over the bar; "
        f"bars above {LONGEST:g}, and those without end, are drawn there. Dotted: the accuracy.",
        (11.0, 3.8),
    )
