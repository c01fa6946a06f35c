"""Multilevel ensembles: whether their intervals cover, and what they cost."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, Data, Figure
from reports.exhibit import Document, Exhibit, Table

NAMES = {"friction_coefficient": "mu", "contact_area": "A"}


def build(document: Document) -> Exhibit:
    """Coverage of all repetitions, samples and seconds by term, and cost over plain sampling's."""
    rows = [
        (
            NAMES[name],
            q["mean"],
            f"{q['standard error']:.2%}",
            f"{q['covered']} of {document['repetitions']}",
            f"{q['cost over plain']:.1%}",
            f"{(q['mean of the finest solves alone'] - q['mean']) / q['its standard error']:+.2f}",
        )
        for name, q in document["quantities"].items()
    ]
    grids = zip(document["grids"], document["samples"], document["seconds of a sample"], strict=True)
    terms = [(grid, number or "dropped", seconds or "-") for grid, number, seconds in grids]
    series = {
        name: [list(pair) for pair in zip(q["means"], q["half widths"], strict=True)]
        for name, q in document["quantities"].items()
    }
    centres = {name: q["mean"] for name, q in document["quantities"].items()}
    return Exhibit(
        "Ensembles at a stated accuracy",
        (
            f"{document['scene']}, relative standard error of {document['target']:.2%} required of mean mu "
            f"and A on {document['grids'][-1]} elements a side, {document['repetitions']} repetitions with "
            f"seeds of their own, {document['seconds']:.1f} s of processor time each. Plain sampling with "
            "the same solver settings, to the same standard error, is the measure of cost.",
        ),
        [
            Table(
                "Means, and 95 % intervals that hold the mean of all repetitions.",
                (
                    "mean",
                    "value",
                    "standard error",
                    "covered",
                    "cost over plain sampling",
                    "mean of the finest solves alone, off by standard errors",
                ),
                rows,
            ),
            Table(
                "Mean number of realisations and processor seconds of one, by term (the first: its grid "
                "alone; others: two grids).",
                ("grid", "realisations", "seconds"),
                terms,
            ),
        ],
        [(INTERVALS, {"intervals": series, "mean of all": centres})],
    )


def _draw(canvas: Canvas, data: Data) -> None:
    panels = canvas.subplots(1, len(data["intervals"]), squeeze=False)[0]
    for axes, (name, pairs) in zip(panels, data["intervals"].items(), strict=True):
        means, widths = np.array(pairs).T / data["mean of all"][name]
        missed = np.abs(means - 1) > widths
        for chosen, colour, label in ((~missed, COLOURS[0], "covers"), (missed, COLOURS[1], "misses")):
            k = np.flatnonzero(chosen)
            axes.errorbar(k, means[k], widths[k], fmt="o", color=colour, markersize=3, label=label)
        axes.axhline(1.0, color=INK, linewidth=1)
        axes.set(xlabel="repetition", ylabel=f"mean {NAMES[name]} over that of all")
        axes.legend()


INTERVALS = Figure(
    "*",
    ("intervals", "mean of all"),
    _draw,
    "Every repetition's mean and 95 % interval, over the mean of all repetitions.",
    (9.0, 3.8),
)
