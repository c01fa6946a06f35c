"""The first page: what was checked, what holds, what does not, how sure we are, and how to run it again."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.agreement import Number, by_quantity, fine, printed, ratio_and_scatter
from reports.claims import UNJUDGED, VERDICTS, Judged, of_the_conversion
from reports.drawing import COLOURS, INK, Data, Figure, label_ticks
from reports.evidence import Evidence
from reports.result_tables.code import JUDGED
from reports.results import Case
from reports.studies.experiments import sentences
from reports.studies.extremes import sentence
from reports.text import number, percent, unit_of

COVERED = {
    **JUDGED,
    "friction_coefficient_corrected": "corrected μ",
    "friction_coefficient": "μ summed over elements",
    "approach": "approach",
}
"""Numbers whose bars the first page sums up."""
HERTZ = {
    "hertz/peak-pressure": "peak pressure",
    "hertz/approach": "approach",
    "hertz/radius-corrected": "contact radius",
}


def front_page(evidence: Evidence, claims: Sequence[Judged], numbers: Sequence[Number]) -> dict[str, Any]:
    """Return the page's contents by the names that the template has; what is missing leaves its rows out."""
    table3, studies = fine(numbers), evidence.studies
    of_extremes = [sentence(studies["extremes"])] if "extremes" in studies else []
    return {
        "verdicts": {v: [c for c in claims if c.verdict == v] for v in VERDICTS},
        "judged": sum(c.verdict not in UNJUDGED for c in claims),
        "printed": _agreeing(numbers),
        "all_of_table3": _agreeing([n for n in numbers if n.part == "Table 3"]),
        "table3": table3,
        "table3_rows": _by_label(table3),
        "roughness": list(dict.fromkeys(n.label.partition(",")[0] for n in table3)),
        "unexplained": [n for n in table3 if not n.within],
        "by_inputs": _by_inputs(numbers),
        "worst": _worst(numbers),
        "hertz": [said for said in map(_hertz, evidence.cases) if said],
        "quantities": [_quantity(name, group) for name, group in by_quantity(numbers).items()],
        "conversion": sum(erratum["equation"] in of_the_conversion() for erratum in evidence.errata),
        "trust": [*_coverage(studies), *of_extremes],
        "experiments": sentences(studies["experiments"]) if "experiments" in studies else [],
    }


def _by_label(table3: Sequence[Number]) -> dict[str, list[Number]]:
    rows: dict[str, list[Number]] = {}
    for n in table3:
        name = n.quantity.removesuffix(", Table 3")
        rows.setdefault(f"{name} ({n.unit})" if n.unit else name, []).append(n)
    return rows


def _agreeing(numbers: Sequence[Number]) -> tuple[int, int]:
    """Return how many printed numbers agree within u, and how many have a computed counterpart."""
    within = printed(numbers).values()
    return sum(within), len(within)


def _by_inputs(numbers: Sequence[Number]) -> tuple[int, int]:
    """Return the numbers within u by inputs; of those the ones whose E R = 0.143 m more than halves."""
    found = [n for n in numbers if n.by_inputs]
    remains = [abs((n.rounded_radius or n.computed) - n.printed) for n in found]
    halved = [value < abs(n.difference) / 2 for value, n in zip(remains, found, strict=True)]
    return len(found), sum(halved)


EXPLAINED = ("rms slope", "ψ(0.5 µm), Eq. (12)")
"""Quantities whose printed number an erratum explains."""


def _worst(numbers: Sequence[Number]) -> list[Number]:
    """Return the number of the largest ratio, or its reciprocal, of each of the three worst quantities."""

    def distance(n: Number) -> float:
        return abs(math.log(n.ratio))

    beyond = [
        [n for n in group if not n.within]
        for name, group in by_quantity(numbers).items()
        if name not in EXPLAINED
    ]
    return sorted((max(group, key=distance) for group in beyond if group), key=distance, reverse=True)[:3]


def _hertz(case: Case) -> str:
    name = HERTZ.get(case["id"])
    if name is None or case["value"] is None or case["reference"] is None:
        return ""
    unit, scale = unit_of(case)
    value, reference = (f"{scale * case[key]:.6g}" for key in ("value", "reference"))
    return f"{name} {value} for {reference} {unit} ({case['error']:.1e})"


def _quantity(name: str, group: Sequence[Number]) -> tuple[str, int, str, str, int]:
    mean, scatter = ratio_and_scatter(group)
    return (
        name,
        len(group),
        f"{mean:.3g}" if mean >= 2 else f"{mean:.3f}",
        "" if scatter is None else f"{scatter:.3f}",
        sum(n.within for n in group),
    )


LEVEL = 0.92
"""Share of bars of 95 % that must cover; tests compare it with `verification.coverage.classes.LEVEL`."""
MISSED = 0.01
"""Probability of a class's coverage, if it were `LEVEL`, below which the class is named."""


def _coverage(studies: Mapping[str, Any]) -> list[str]:
    """Return the coverage of error bars over all classes of random scenes, and the classes that bars miss."""
    table = studies.get("coverage_corrected", {}).get("table", ())
    table = [row for row in table if row["number"] in COVERED]
    said = [
        f"{COVERED[row['number']]} {percent(row['held'])}{_of_bounded(row)}, {percent(row['usable'])}, "
        f"{number(row['median_bar_over_error'], 2)}"
        for row in table
        if row["class"] is None
    ]
    missed = [
        f"{COVERED[row['number']]} of {row['class']} ({percent(row['held'])})"
        for row in table
        if row["class"] is not None and row["p"] < MISSED
    ]
    if not said:
        return []
    return [
        "95 % error bars of single grids against far finer grids of the same solver, on random scenes: "
        "share that covers (an unbounded bar does), share that is usable (at most half of the number), "
        f"median of bar over error: {'; '.join(said)}. "
        f"Classes where fewer than {percent(LEVEL)} cover, beyond chance (probability below "
        f"{percent(MISSED)}): {', '.join(missed) or 'none'}"
    ]


def _of_bounded(row: Mapping[str, Any]) -> str:
    """Return the share of the bounded bars that cover, where some are unbounded.

    >>> _of_bounded({"held": 0.9, "unbounded": 0.5}), _of_bounded({"held": 0.9, "unbounded": 0.0})
    (' (80 % of the bounded)', '')
    """
    bounded = 1 - row["unbounded"]
    covering = row["held"] - row["unbounded"]
    return f" ({percent(covering / bounded)} of the bounded)" if 0 < bounded < 1 else ""


WIDEST = 2.0  # ratios beyond it, or below its reciprocal, are written at the border
TICKS = (0.5, 0.7, 1.0, 1.4, 2.0)
LOOK = {True: (COLOURS[0], "o", "within u"), False: (COLOURS[1], "D", "beyond u")}


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
        colour, marker, _ = LOOK[bool(abs(ratio[k] - 1) <= half[k])]
        if abs(math.log(ratio[k])) > math.log(WIDEST):
            where: dict[str, Any] = {"xycoords": ("axes fraction", "data"), "ha": "right", "va": "center"}
            axes.annotate(f"{ratio[k]:.3g} →", (0.99, y), color=COLOURS[1], fontsize=9, **where)
        else:
            bar: dict[str, Any] = {"xerr": min(half[k], 0.99 * ratio[k]), "capsize": 2, "markersize": 4}
            axes.errorbar(ratio[k], y, color=colour, marker=marker, **bar)
    axes.axvline(1.0, color=INK, linestyle="--", linewidth=1)
    axes.set_xscale("log")
    axes.set_xlim(0.9 / WIDEST, 1.05 * WIDEST)
    label_ticks(axes, TICKS)
    axes.set_yticks(range(len(quantities)), quantities)
    axes.set_ylim(len(quantities) - 0.5, -0.5)
    axes.set_xlabel("computed / printed")
    for colour, marker, label in LOOK.values():
        axes.plot([], [], marker, color=colour, label=label)
    canvas.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=2)


AGREEMENT = Figure(
    "*",
    ("quantity", "label", "printed", "computed", "uncertainty 95 %", "computed / printed"),
    _draw,
    "Printed numbers against ours, by quantity (Table 3: fine mesh). Bars are u at 95 %: "
    "the sampling of random surfaces, the paper's and ours, and the rounding of printed numbers and inputs.",
    5.6,
)
