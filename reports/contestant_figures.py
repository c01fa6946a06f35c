"""The suite for other people's solvers: which of its cases sees which fault."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, Data, Figure

BLUE, RED = COLOURS[:2]


def matrix(canvas: Canvas, data: Data) -> None:
    """Cases over faults: a full square where a case fails a fault that it names, an open one elsewhere."""
    axes = canvas.add_subplot()
    verdict, named = np.array(data["verdict"]), np.array(data["named"], dtype=bool)
    kinds = (
        (named & (verdict == "fail"), "fails, as its description says", "s", BLUE, BLUE),
        (~named & (verdict == "fail"), "fails as well", "s", "none", BLUE),
        (~named & (verdict == "error"), "refused", "D", "none", RED),
        (named & (verdict != "fail"), "named, and not seen", "D", RED, RED),
    )
    for where, label, marker, face, edge in kinds:
        rows, columns = np.nonzero(where)
        if len(rows):
            axes.scatter(columns, rows, s=26, marker=marker, facecolors=face, edgecolors=edge, label=label)
    axes.set_xticks(range(len(data["fault"])), data["fault"], rotation=60, ha="right", fontsize=8)
    axes.set_yticks(range(len(data["case"])), data["case"], fontsize=8)
    axes.set_xlabel("fault of the solver")
    axes.set_ylabel("case of the suite")
    axes.invert_yaxis()
    axes.legend(loc="lower center", bbox_to_anchor=(0.4, 1.0), ncols=3)


CONTESTANTS = (
    Figure(
        "contestants/each-case-earns-its-place",
        ("case", "fault", "verdict", "named"),
        matrix,
        "Verdicts of the suite on solvers with one fault each, all of which claim success.",
        (7.6, 10.5),
    ),
)
