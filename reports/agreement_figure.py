"""The first page's figure: every printed number against ours, as ratios by quantity with 95 % intervals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, Data, Figure, label_ticks

WIDEST = 2.0  # ratios beyond it, or below its reciprocal, are written at the border
TICKS = (0.5, 0.7, 1.0, 1.4, 2.0)


def _draw(canvas: Canvas, data: Data) -> None:
    axes = canvas.add_subplot()
    quantities = list(dict.fromkeys(data["quantity"]))
    ratio = np.array(data["computed / printed"], dtype=float)
    half = np.array(data["uncertainty 95 %"], dtype=float) / np.array(data["printed"], dtype=float)
    shift = dict.fromkeys(quantities, 0)
    count = {q: data["quantity"].count(q) for q in quantities}
    for k, quantity in enumerate(data["quantity"]):
        y = quantities.index(quantity) + 0.55 * ((shift[quantity] + 0.5) / count[quantity] - 0.5)
        shift[quantity] += 1
        inside = abs(ratio[k] - 1) <= half[k]
        style: dict[str, Any] = {
            "color": COLOURS[0] if inside else COLOURS[1],
            "marker": "o" if inside else "D",
        }
        if abs(math.log(ratio[k])) > math.log(WIDEST):
            where: dict[str, Any] = {"xycoords": ("axes fraction", "data"), "ha": "right", "va": "center"}
            axes.annotate(f"{ratio[k]:.3g} →", (0.99, y), color=COLOURS[1], fontsize=9, **where)
        else:
            axes.errorbar(ratio[k], y, xerr=min(half[k], 0.99 * ratio[k]), capsize=2, markersize=4, **style)
    axes.axvline(1.0, color=INK, linestyle="--", linewidth=1)
    axes.set_xscale("log")
    axes.set_xlim(0.9 / WIDEST, 1.05 * WIDEST)
    label_ticks(axes, TICKS)
    axes.set_yticks(range(len(quantities)), quantities)
    axes.set_ylim(len(quantities) - 0.5, -0.5)
    axes.set_xlabel("computed / printed")
    for inside, label in ((True, "within u"), (False, "beyond u")):
        axes.plot([], [], "o" if inside else "D", color=COLOURS[0] if inside else COLOURS[1], label=label)
    canvas.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=2)


AGREEMENT = Figure(
    "*",
    ("quantity", "label", "printed", "computed", "uncertainty 95 %", "computed / printed"),
    _draw,
    "Printed numbers against ours, by quantity (Table 3: fine mesh). Bars are u at 95 %: "
    "the sampling of random surfaces, the paper's and ours, and the rounding of printed numbers and inputs.",
    5.6,
)
