"""Accuracy and its cost: coverage of error bars, times, the cheapest configurations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.result_tables.markdown import Row, link, number, section
from reports.studies.benchmarks import newest_rows
from reports.text import percent


def coverage(documents: Mapping[str, Any]) -> str:
    """Coverage of the reference by error bars."""
    labels = {
        "friction_coefficient": "μ",
        "contact_area": "A",
        "contact_area_corrected": "A, perimeter-corrected",
        "max_pressure": "p_max",
    }
    rows: list[Row] = []
    for name in ("coverage", "coverage_fresh"):
        for entry in documents[name]["accuracies"]:
            for quantity, label in labels.items():
                found = entry["numbers"][quantity]
                rows.append(
                    (
                        label,
                        f"{entry['accuracy']:g}",
                        found["scenes"],
                        percent(found["met"]),
                        percent(found["covered"]),
                        percent(found["covered_at_worst"]),
                        number(found["median_bar_over_error"], ".1f"),
                        number(found["median_cost"], ".1f"),
                        link(name),
                    )
                )
    head = (
        "number", "accuracy", "scenes", "reached", "covered", "covered at worst", "error bar over error",
        "cost", "file",
    )  # fmt: skip
    text = (
        "Error bars of 95 % against far finer grids, on random scenes that the estimator was not fitted to. "
        "*Reached*: on grids up to 512². *At worst*: the reference is off by its own bound, against the "
        "error bar. *Error bar over error* and *cost* are medians. The cost is in transforms, over that of "
        "the cheapest grid that would have been enough."
    )
    return section("Coverage of error bars", text, head, rows)


def costs(benchmarks: Mapping[str, Any]) -> str:
    """Seconds of this code and of published solvers, newest run of each."""
    own = {
        "refimpl-solver": "solver",
        "refimpl": "with error bars",
        "refimpl+friction": "with friction",
        "refimpl+friction+slopes": "with friction and slopes",
    }
    peers = {"aspher": "ASPHER", "tamaas": "Tamaas", "ContactMechanics": "ContactMechanics"}
    rows: list[Row] = []
    for (kind, M), entries in newest_rows(benchmarks["runs"]).items():
        found = {row["code"]: row for row in entries}
        cells = [number(median(found.get(code), "seconds")) for code in own]
        cells += [number(median(found.get(code, {}).get("ratio"), "seconds")) for code in peers]
        rows.append((f"{kind} flat", f"{M}²", *cells, link("benchmarks")))
    head = (
        "surface",
        "grid",
        *(f"{label} (s)" for label in own.values()),
        *(f"ratio: {label}" for label in peers.values()),
        "file",
    )
    text = (
        "Table 1's contact to a relative duality gap of 1e-8, recomputed for every code. Seconds of this "
        "code: the solver alone; from a scene to numbers with error bars; with friction; with friction and "
        "slopes. Of other codes: ratio of their time to this code's with error bars, median of the newest "
        "run on that grid. Runs are of several machines."
    )
    return section("Time", text, head, rows)


def median(row: Mapping[str, Any] | None, clock: str) -> float | None:
    """The median of a benchmark's row; None for a code that was not timed."""
    return None if row is None or clock not in row else row[clock]["median"]


def accuracy_costs(costs: Mapping[str, Any]) -> str:
    """The coarsest grid for each accuracy, by class of scene."""
    labels = {"friction_coefficient": "μ", "contact_area": "A", "max_pressure": "p_max"}
    demands = sorted({entry["error"] for one in costs["classes"] for entry in one["prices"]}, reverse=True)
    rows: list[Row] = []
    for one in costs["classes"]:
        offers = {(entry["quantity"], entry["error"]): entry for entry in one["prices"]}
        for quantity, label in labels.items():
            cells = (_grid_and_seconds(offers[quantity, demand]) for demand in demands)
            rows.append((one["class"], label, *cells, link("accuracy_costs")))
    head = ("class of scenes", "number", *(f"{100 * demand:g} %" for demand in demands), "file")
    text = (
        "Coarsest grid (seconds) that keeps the relative error on itself and all finer ones, against a "
        "grid of 2048²; medians of three realisations, with friction and slopes."
    )
    return section("Cost and accuracy", text, head, rows)


def _grid_and_seconds(entry: Mapping[str, Any]) -> str:
    return "> 1024²" if entry["M"] is None else f"{entry['M']:.0f}² ({entry['seconds']:.2g})"
