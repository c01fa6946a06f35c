"""The price list: work-precision diagrams, the cheapest way to every error, growth with size."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, MARKERS, Data, Figure
from reports.exhibit import Document, Exhibit, Table

NAMES = {"friction_coefficient": "mu", "contact_area": "A", "max_pressure": "f_max"}


def _dense_reach(dense: Data) -> str:
    """Where the dense reference stops being affordable, if three of its grids say so."""
    if dense["M"] is None:
        return (
            "On how large a grid the dense reference is affordable takes three of its grids to say, "
            "and seconds that grow."
        )
    return f"The dense reference takes {dense['seconds']:.0f} s at about {dense['M']} elements a side."


def _left_out(study: Mapping[str, Any]) -> str:
    """What the study of this scene does without, and why; older files left nothing out."""
    told = "; ".join(f"{NAMES.get(what, what)}: {why}" for what, why in study.get("left out", {}).items())
    return f" Left out: {told}." if told else ""


def build(document: Document) -> Exhibit:
    """Of every scene studied: diagrams over time and over convolutions, prices, growth."""
    tables: list[Table] = []
    figures: list[tuple[Figure, Data]] = []
    notes: list[str] = []
    notes.append(
        "A way is a method, its tolerance and what it neglects: flat (no slopes), uncoupled (shear closes no "
        "gap), one grid (no nesting), single (the solver's convolutions in single precision; the "
        "certificate is of double precision and does not pass a tolerance that single cannot reach)."
    )
    for study in document["studies"]:
        doubt = ", ".join(f"{NAMES[q]} {value:.1e}" for q, value in study["reference"]["doubt"].items())
        notes.append(
            f"{study['scene']}: reference on {study['reference']['M']} elements a side (its own doubt: "
            f"{doubt}). {_dense_reach(study['dense up to'])}{_left_out(study)}"
        )
        tables.append(
            Table(
                f"{study['scene']}: the cheapest way to an error, kept on all finer grids tried.",
                ("number", "error", "way", "grid", "processor time (s)", "convolutions"),
                [
                    (
                        NAMES[r["quantity"]],
                        f"{r['error']:.1%}",
                        r["way"],
                        r["M"],
                        r["seconds"],
                        r["convolutions"],
                    )
                    for r in study["prices"]
                ],
            )
        )
        tables.append(
            Table(
                f"{study['scene']}: time and memory grow like M^p; finest grid's time over a convolution's.",
                ("way", "time", "memory", "grids", "distance from the limit"),
                [
                    (
                        g["way"],
                        g["time"],
                        g["memory"],
                        ", ".join(map(str, g["grids"])),
                        _distance(study, g["way"]),
                    )
                    for g in study["growth"]
                ],
            )
        )
        figures += [
            (_diagram(study["scene"], quantity), _series(study, quantity))
            for quantity in study["reference"]["numbers"]
        ]
    return Exhibit("What an error costs", notes, tables, figures)


def _distance(study: Mapping[str, Any], way: str) -> float:
    runs = [r for r in study["runs"] if r["way"] == way]
    return float(max(runs, key=lambda r: r["M"])["distance from the limit"])


def _series(study: Mapping[str, Any], quantity: str) -> dict[str, Any]:
    data: dict[str, Any] = {}
    for run in study["runs"]:
        key = f"{run['way']}: seconds, convolutions, error"
        data.setdefault(key, []).append([run["seconds"], run["convolutions"], run["errors"][quantity]])
    data["front"] = [[r["seconds"], r["error"]] for r in study["front"][quantity]]
    return {"runs": data}


def _diagram(scene: str, quantity: str) -> Figure:
    def draw(canvas: Canvas, data: Data) -> None:
        left, right = canvas.subplots(1, 2, sharey=True)
        ways = {key.partition(":")[0]: rows for key, rows in data["runs"].items() if key != "front"}
        for k, (way, rows) in enumerate(ways.items()):
            seconds, convolutions, error = np.array(rows).T
            style = {"marker": MARKERS[k % 6], "color": COLOURS[k % 6], "linestyle": ("-", "--")[k // 6 % 2]}
            left.plot(seconds, error, label=way, **style)
            right.plot(convolutions, error, **style)
        front = np.array(data["runs"]["front"])
        left.step(*front.T, where="post", color=INK, linewidth=3, alpha=0.35, label="Pareto front")
        for axes, label in ((left, "processor time (s)"), (right, "convolution-equivalents")):
            axes.set(xscale="log", yscale="log", xlabel=label)
        left.set_ylabel(f"relative error of {NAMES[quantity]}")
        canvas.legend(loc="outside right upper", fontsize=8)

    caption = f"{scene}: error of {NAMES[quantity]} against work, by way; points along a line are grids."
    return Figure("*", ("runs",), draw, caption, (9.2, 4.0))
