"""Tables of this code: coverage of error bars, times and costs, checks, studies of them, other codes."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from reports.evidence import Evidence
from reports.exhibit import Column
from reports.result_tables import Row, link, listing, number, section
from reports.results import FORMAT, RECORDED, STATUSES, Case, shown_status
from reports.studies.benchmarks import newest_rows
from reports.text import percent

MU = "friction_coefficient_corrected"
JUDGED = {
    MU: "μ",
    "contact_area": "A",
    "contact_area_corrected": "A, perimeter-corrected",
    "max_pressure": "p_max",
}
COVERAGE: dict[str, Column] = {
    "class of scene": "class",
    "number": lambda row: JUDGED[row["number"]],
    "scenes": "scenes",
    "covered": lambda row: percent(row["held"]),
    "covered at worst": lambda row: percent(row["held_at_worst"]),
    "usable": lambda row: percent(row["usable"]),
    "error bar over error": lambda row: number(row["median_bar_over_error"], ".1f"),
    "file": lambda row: link("coverage_corrected"),
}


def coverage(documents: Mapping[str, Any]) -> str:
    """Show the coverage of the reference by error bars of mu on single grids, by class of scene."""
    text = (
        "Error bars of 95 % on single grids of 48 to 128 elements against 384, on random scenes drawn after "
        "the constants were fitted. *At worst*: the share if every "
        "reference erred by its bound. *Usable*: the bar is at most half "
        "of the number. *Error bar over error* is a median. Here is μ, corrected; A and p_max stand at the "
        "[end](#coverage-of-a-and-p_max)."
    )
    return listing("Coverage of error bars", text, _covered(documents, MU), COVERAGE)


def coverage_of_others(documents: Mapping[str, Any]) -> str:
    """Show the same for areas and the maximum pressure."""
    rows = itertools.chain.from_iterable(_covered(documents, name) for name in JUDGED if name != MU)
    text = "Columns as [above](#coverage-of-error-bars)."
    return listing("Coverage of A and p_max", text, rows, COVERAGE)


def _covered(documents: Mapping[str, Any], number: str) -> list[Mapping[str, Any]]:
    table = documents["coverage_corrected"]["table"]
    return [row for row in table if row["class"] and row["number"] == number]


OWN = {
    "solver": "refimpl-solver",
    "with error bars": "refimpl",
    "with friction": "refimpl+friction",
    "with friction and slopes": "refimpl+friction+slopes",
}
PEERS = {"ASPHER": "aspher", "Tamaas": "tamaas", "ContactMechanics": "ContactMechanics"}


def costs(benchmarks: Mapping[str, Any]) -> str:
    """Show the seconds of this code and ratios of published solvers, newest run of each."""
    rows: list[Row] = []
    for (kind, M), entries in newest_rows(benchmarks["runs"]).items():
        found = {row["code"]: row for row in entries}
        cells = [number(_median(found.get(code))) for code in OWN.values()]
        cells += [number(_median(found.get(code, {}).get("ratio"))) for code in PEERS.values()]
        rows.append((f"{kind} flat", f"{M}²", *cells, link("benchmarks")))
    head = (
        "surface",
        "grid",
        *(f"{label} (s)" for label in OWN),
        *(f"ratio: {name}" for name in PEERS),
        "file",
    )
    text = (
        "Table 1's contact to a relative duality gap of 1e-8, recomputed for every code. Seconds of this "
        "code: the solver alone; from a scene to numbers with error bars; with friction; with friction and "
        "slopes. Of other codes: ratio of their time to this code's with error bars, median of the newest "
        f"run on that grid. Runs are of machines with {' and '.join(_machines(benchmarks['runs']))}, and of "
        "one thread or more, as the report states."
    )
    return section("Time", text, head, rows)


def _machines(runs: Iterable[Mapping[str, Any]]) -> list[str]:
    found = [run["provenance"]["machine"] for run in runs]
    return sorted({f"{machine['cores']} cores ({machine['processor']})" for machine in found})


def _median(row: Mapping[str, Any] | None) -> float | None:
    return None if row is None or "seconds" not in row else row["seconds"]["median"]


def accuracy_costs(costs: Mapping[str, Any]) -> str:
    """Show the coarsest grid for each accuracy, by class of scene."""
    labels = {"friction_coefficient_corrected": "μ, corrected", "contact_area_corrected": "A, corrected"}
    labels["max_pressure"] = "p_max"
    demands = sorted({entry["error"] for one in costs["classes"] for entry in one["prices"]}, reverse=True)
    rows: list[Row] = []
    for one in costs["classes"]:
        offers = {(entry["quantity"], entry["error"]): entry for entry in one["prices"]}
        for quantity in dict.fromkeys(quantity for quantity, _ in offers):
            label = labels[quantity]
            cells = (_cost(offers[quantity, demand], one["ladders"]) for demand in demands)
            rows.append((one["class"], label, *cells, link("accuracy_costs")))
    head = ("class of scenes", "number", *(f"{100 * demand:g} %" for demand in demands), "file")
    text = (
        "Coarsest grid (seconds) from which all relative errors stay below the demand. The reference has "
        "2048², and its error bar is added; friction and slopes are included. A median of three "
        "realisations is given only where each of them meets the demand. *> 1024²*: at least one misses it "
        "on all grids (too coarse, or reference uncertain); in brackets how many meet it, and their finest "
        "grid."
    )
    return section("Cost and accuracy", text, head, rows)


def _cost(entry: Mapping[str, Any], realisations: Sequence[Sequence[Mapping[str, Any]]]) -> str:
    """Return the median grid and its seconds, or how many realisations meet the demand where not all do.

    >>> ends = [[{"M": M, "errors": {"mu": e}} for M, e in ((32, 0.01), (1024, e))] for e in (0.01, None)]
    >>> _cost({"quantity": "mu", "error": 0.03, "M": None, "seconds": None}, ends)
    '> 1024² (1 of 2: 32²)'
    """
    if entry["M"] is not None:
        return f"{entry['M']:.0f}² ({entry['seconds']:.2g})"
    grids = [_coarsest(rows, entry["quantity"], entry["error"]) for rows in realisations]
    met = [grid for grid in grids if grid is not None]
    return f"> 1024² ({len(met)} of {len(grids)}: {max(met)}²)" if met else "> 1024²"


def _coarsest(rows: Sequence[Mapping[str, Any]], quantity: str, demand: float) -> int | None:
    """Return the coarsest grid that meets a demand together with all finer ones; None is unbounded."""
    errors = [(row["M"], row["errors"].get(quantity)) for row in reversed(rows)]
    met = list(itertools.takewhile(lambda at: at[1] is not None and at[1] <= demand, errors))
    return met[-1][0] if met else None


COUNTED = (*STATUSES[:1], RECORDED, *STATUSES[1:])


def checks(documents: Mapping[str, Any], evidence: Evidence) -> str:
    """Show the counts of statuses, by result file."""
    rows: list[Row] = []
    for name, run in documents.items():
        if run.get("format") == FORMAT:
            made = run["provenance"]
            selected = ", ".join(f"`{pattern}`" for pattern in run["only"])
            selected = selected or f"all of the {run['tier']} tier"
            commit = (made["commit"] or "n/a")[:12]
            rows.append((link(name), selected, *_counts(run["cases"]), made["date"][:10], f"`{commit}`"))
    counted = zip(_counts(evidence.cases), COUNTED, strict=True)
    listed = ", ".join(f"{count} {status}" for count, status in counted)
    bad = [f"`{case['id']}` ({case['status']})" for case in evidence.cases if case["status"] != "pass"]
    text = f"{len(evidence.cases)} different checks: {listed}. Not passed: {', '.join(bad) or 'none'}."
    text += " *Recorded*: within a tolerance set from the result, which guards against changes alone."
    return section("Checks", text, ("file", "checks", *COUNTED, "date", "commit"), rows)


def _counts(cases: Iterable[Case]) -> list[int]:
    found = [shown_status(case) for case in cases]
    return [found.count(status) for status in COUNTED]


def studies(documents: Mapping[str, Any]) -> str:
    """Show the quality of the test suite: single numbers of the studies."""
    found, states = documents["extremes"]["counts"], documents["extremes"]["states"]
    least = min(row["digits"] for row in states if row["verdict"] == "right")
    verdicts = (
        f"{found['right']} right (to {least:.1f} digits at least), {found['detected failure']} detected "
        f"failures, {found['unjudged']} unjudged, {found['wrong']} wrong, {found['crash']} crashes"
    )
    invariants = documents["hypothesis"]
    tried = f"{invariants['examples']} tried, {invariants['counterexamples']} counter-examples"
    rows = [
        ("extreme inputs", verdicts, link("extremes")),
        ("random examples of invariants", tried, link("hypothesis")),
    ]
    text = "How far the verification itself can be trusted, and what broad searches found."
    return section("Studies", text, ("study", "result", "file"), rows)


def codes(cross_code: Mapping[str, Any]) -> str:
    """Show solvers through the suite of checks for other solvers."""
    roles = {"ours": "this code", "peer": "published solver", "trap": "negative control"}
    columns: dict[str, Column] = {
        "solver": "name",
        "role": lambda entrant: roles[entrant["role"]],
        **{status: f"{{counts[{status}]}}" for status in STATUSES},
        "file": lambda entrant: link("cross_code"),
    }
    text = "Unavailable: outside a solver's abilities. A negative control is set up wrongly on purpose."
    return listing("Solvers in the suite for other solvers", text, cross_code["entrants"], columns)
