"""Seconds beside the published solvers, at the same recomputed error; of each code the newest run counts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from reports.drawing import Data, Figure, curves
from reports.exhibit import Cell, Column, Document, Exhibit, Table, table

OURS = "refimpl"
NAMES = {OURS: "this code, error bars", "refimpl-solver": "this code, solver alone", "aspher": "ASPHER"}
NAMES |= {"aspher+options": "ASPHER, options set", "tamaas": "Tamaas"}
"""Names of the codes in figures."""
Row = Mapping[str, Any]


def build(document: Document) -> Exhibit:
    """Return a table for each surface, and seconds over the grid."""
    runs = document["runs"]
    newest = newest_rows(runs)
    kinds = list(dict.fromkeys(kind for kind, _ in newest))
    last = runs[-1]["conditions"]
    named = dict.fromkeys(v for run in runs for v in run["conditions"]["versions"].values())
    versions = [version for version in named if not version.endswith(" None")]  # None: commit alone
    return Exhibit(
        "Speed beside published solvers",
        (
            "Table 1's paraboloid under 70 N on a smooth and on a rough flat (0.5 um), in free space. The "
            "codes take turns, each in a process of its own, and each stops at the loosest of its own "
            f"tolerances whose result has a {last['target']}.",
            f"Clock: {last['clock']}. Seconds are medians with the least and the most; ratios are medians of "
            "the ratios within rounds. A second solve in the same process follows (warm-run time), as the "
            "next ones of a sweep.",
            f"Versions: {', '.join(versions)}.",
        ),
        [_table(kind, newest) for kind in kinds],
        [_seconds(kind, newest) for kind in kinds],
    )


def newest_rows(runs: Sequence[Row]) -> dict[tuple[str, int], list[Row]]:
    """Return each code's newest row by surface and grid, with its run's ratios and conditions."""
    found: dict[tuple[str, int], dict[str, Row]] = {}
    for run in runs:
        ratios = {(entry["kind"], entry["M"]): entry for entry in run["ratios"]}
        for row in run["rows"]:
            key = (row["kind"], row["M"])
            origin = {"ratio": ratios[key].get(row["code"]), "commit": run["provenance"]["commit"]}
            found.setdefault(key, {})[row["code"]] = {**run["conditions"], **row, **origin}
    ordered = sorted(found.items(), key=lambda item: (item[0][0] != "smooth", item[0]))
    return {key: list(rows.values()) for key, rows in ordered}


def _table(kind: str, newest: Mapping[tuple[str, int], Sequence[Row]]) -> Table:
    caption = (
        f"{kind.capitalize()} flat. A convolution is rfft2 and irfft2 on the padded bounding box of the "
        "final contact; others count by n log n. Ratios are of a code's own run."
    )
    return table(caption, [row for (of, _), rows in newest.items() if of == kind for row in rows], TIMES)


def _measured(column: Callable[[Row], Cell]) -> Callable[[Row], Cell]:
    return lambda row: column(row) if "seconds" in row else None


def _spread(values: Row) -> str:
    return f"{values['median']:.3g} ({values['least']:.2g} to {values['most']:.2g})"


def _ratio(clock: str) -> Callable[[Row], Cell]:
    return _measured(lambda row: _spread(row["ratio"][clock]) if row["ratio"] else None)


TIMES: dict[str, Column] = {
    "grid": "{M}²",
    "code": "code",
    "seconds": lambda row: _spread(row["seconds"]) if "seconds" in row else row["failure"],
    "warm-run time": _measured(lambda row: row.get("seconds again", {"median": None})["median"]),
    "ratio to this code": _ratio("seconds"),
    "ratio of processor times": _ratio("processor seconds"),
    "recomputed gap": _measured(lambda row: None if row["code"].startswith(f"{OURS}+") else row["gap"]),
    "area (mm²)": _measured(lambda row: f"{1e6 * row['area']:.5f}"),
    "peak (MPa)": _measured(lambda row: f"{1e-6 * row['peak']:.3f}"),
    "peak memory (MB)": _measured(lambda row: round(1e-6 * row["peak memory"]["median"])),
    "convolutions in all": _measured(lambda row: row.get("convolution equivalents")),
    "rounds, threads, load": lambda row: (
        f"{row['rounds']}, {row['threads']}, {row['load average']['before'][0]:.0f}"
    ),
    "commit": "{commit!s:.12}",
}


def _seconds(kind: str, newest: Mapping[tuple[str, int], Sequence[Row]]) -> tuple[Figure, Data]:
    """Return the median seconds over the grid, a curve for each code; this code's terms are in the tables."""
    timed = [row for (of, _), rows in newest.items() if of == kind for row in rows if "seconds" in row]
    codes = list(dict.fromkeys(row["code"] for row in timed if not row["code"].startswith(f"{OURS}+")))
    grids = sorted({row["M"] for row in timed})
    medians = {(row["code"], row["M"]): row["seconds"]["median"] for row in timed}
    grids_of: dict[int, set[int]] = {}
    for row in timed:
        grids_of.setdefault(row["threads"], set()).add(row["M"])
    threads = ", ".join(
        f"{n} at {', '.join(f'{M}²' for M in sorted(found))}" for n, found in sorted(grids_of.items())
    )
    figure = curves(
        "*",
        f"Seconds over the grid at a recomputed gap of 1e-8, {kind} flat. Threads: {threads}.",
        "M",
        {code: NAMES.get(code, code) for code in codes},
        xlabel="elements per side",
        ylabel="seconds",
        height=4.6,
        log="xy",
        marker=True,
    )
    return figure, {"M": grids, **{code: [medians.get((code, M)) for M in grids] for code in codes}}
