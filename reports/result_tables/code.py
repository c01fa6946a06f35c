"""Tables of this code: coverage of error bars, times and costs, checks, studies of them, other codes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from reports.evidence import Evidence
from reports.exhibit import Column
from reports.result_tables import Row, link, listing, number, section
from reports.results import FORMAT, RECORDED, STATUSES, Case, shown_status
from reports.studies.benchmarks import newest_rows
from reports.text import percent

JUDGED = {
    "friction_coefficient_corrected": "μ",
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
    """Show the coverage of the reference by error bars of single grids, by class of scene."""
    rows = [
        row for row in documents["coverage_corrected"]["table"] if row["class"] and row["number"] in JUDGED
    ]
    text = (
        "Error bars of 95 % on single grids of 48 to 128 elements against 384, on random scenes drawn after "
        "the constants were fitted (p_max: before its bars became unbounded beside walls). *At worst*: the "
        "reference is off by its own bound, against the error bar. *Usable*: the bar is at most half "
        "of the number. *Error bar over error* is a median."
    )
    return listing("Coverage of error bars", text, rows, COVERAGE)


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
    """Return the kinds of machine of all runs."""
    found = [run["provenance"]["machine"] for run in runs]
    return sorted({f"{machine['cores']} cores ({machine['processor']})" for machine in found})


def _median(row: Mapping[str, Any] | None) -> float | None:
    """Return the median of the seconds of a benchmark's row; None for a code that was not timed."""
    return None if row is None or "seconds" not in row else row["seconds"]["median"]


COUNTED = (*STATUSES[:1], RECORDED, *STATUSES[1:])


def checks(documents: Mapping[str, Any], evidence: Evidence) -> str:
    """Show the counts of statuses, by result file."""
    rows: list[Row] = []
    for name, run in documents.items():
        if run.get("format") == FORMAT:
            made = run["provenance"]
            selected = (
                ", ".join(f"`{pattern}`" for pattern in run["only"]) or f"all of the {run['tier']} tier"
            )
            counts = _counts(run["cases"])
            commit = (made["commit"] or "n/a")[:12]
            rows.append((link(name), selected, *counts, made["date"][:10], f"`{commit}`"))
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
    rows = list(_searches(documents))
    text = "How far the verification itself can be trusted, and what broad searches found."
    return section("Studies", text, ("study", "result", "file"), rows)


def _searches(documents: Mapping[str, Any]) -> Iterator[Row]:
    """Yield the rows of searches for inputs that are answered wrongly."""
    found = documents["extremes"]["counts"]
    yield (
        "extreme inputs",
        f"{found['right']} right, {found['detected failure']} detected failures, "
        f"{found['wrong']} wrong, {found['crash']} crashes",
        link("extremes"),
    )
    invariants = documents["hypothesis"]
    yield (
        "random examples of invariants",
        f"{invariants['examples']} tried, {invariants['counterexamples']} counter-examples",
        link("hypothesis"),
    )


def codes(cross_code: Mapping[str, Any]) -> str:
    """Show solvers through the suite of checks for other solvers."""
    roles = {"ours": "this code", "peer": "published solver", "trap": "negative control"}
    rows: list[Row] = [
        (
            entrant["name"],
            roles[entrant["role"]],
            *(entrant["counts"][status] for status in STATUSES),
            link("cross_code"),
        )
        for entrant in cross_code["entrants"]
    ]
    text = "Unavailable: outside a solver's abilities. A negative control is set up wrongly on purpose."
    return section(
        "Solvers in the suite for other solvers", text, ("solver", "role", *STATUSES, "file"), rows
    )
