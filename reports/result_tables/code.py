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
COVERED = (MU, "contact_area_corrected", "contact_area", "max_pressure")
DETAILS: dict[str, Column] = {
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
    """Show in which share of scenes the error bars of each number cover the reference, by class of scene."""
    text = (
        "Does an error bar of 95 % contain the right value? Each class has random scenes, drawn after the "
        "constants of the error bars were fixed. Each scene is solved on a single grid of 48 to 128 elements "
        "per side. The right value, the reference, is that on 384 elements. A cell is the share of scenes "
        "whose error bar covers the reference. μ is the [corrected "
        "mu](../docs/error-bars.md#corrected-mu-the-edge-bias-removed); A is summed over elements, or "
        "perimeter-corrected. How long are the error bars, and how sure is the reference? See "
        "[details](#details-of-coverage)."
    )
    found = {(row["class"], row["number"]): row for row in documents["coverage_corrected"]["table"]}
    rows: list[Row] = []
    for name in dict.fromkeys(name for name, _ in found if name):
        cells = (percent(found[name, number]["held"]) for number in COVERED)
        rows.append((name, found[name, MU]["scenes"], *cells, link("coverage_corrected")))
    head = ("class of scene", "scenes", *(JUDGED[number] for number in COVERED), "file")
    return section("Coverage of error bars", text, head, rows)


def details_of_coverage(documents: Mapping[str, Any]) -> str:
    """Show coverage with the uncertainty of references and the length of error bars, by number and class."""
    text = (
        "*Covered* is as [above](#coverage-of-error-bars). *Covered at worst* is that share if every "
        "reference erred by the bound of its own error. *Usable* is the share of error bars that are at most "
        "half of the number. *Error bar over error* divides the error bar by the error that was found; it is "
        "the median of the class."
    )
    table = [row for row in documents["coverage_corrected"]["table"] if row["class"]]
    rows = [row for number in COVERED for row in table if row["number"] == number]
    return listing("Details of coverage", text, rows, DETAILS)


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
        "How long does the contact of the paper's Table 1 take? Every code solves it until its relative "
        "duality gap, recomputed here, is 1e-8. Four columns have seconds of this code. *Solver* is for the "
        "pressures alone. *With error bars* goes from a scene to numbers with error bars. The next two add "
        "friction, then slopes. A *ratio* is the time of another code over that of this code with error "
        "bars. Numbers are medians of the newest run on the grid. Runs are of machines with "
        f"{' and '.join(_machines(benchmarks['runs']))}; the report states their numbers of threads."
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
        "Which grid do you need for an accuracy? A cell names the coarsest grid whose relative error, and "
        "those of all finer grids, are at most the percentage above; its seconds stand in brackets. Friction "
        "and slopes are included. An error is that against a grid of 2048², with the error bar of this "
        "reference added. A class of rough scenes has three realisations: the cell is their median if all of "
        "them meet the accuracy. Otherwise it is *> 1024²*: some need a finer grid, or a reference of less "
        "uncertainty. Its brackets state how many meet the accuracy, and the finest grid that these need."
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
    text += (
        " The tolerance of a *recorded* check was set from its own result, so it detects changes only. "
        "Names of checks have `*` for any letters. *Date* and *commit* are those of the run."
    )
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
    text = (
        "Two searches for wrong results. Contacts of extreme inputs were judged by an independent "
        "computation; a detected failure is a result whose status says not to use it. Random contacts were "
        "tried on rules that every solution keeps, the invariants."
    )
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
    text = (
        "Which codes pass the [suite](../docs/check-your-solver.md)? The table counts the cases by verdict. "
        "*Unavailable* cases are outside the abilities of the solver. A negative control is set up wrongly "
        "on purpose, to test that the suite detects it."
    )
    return listing("Solvers in the suite for other solvers", text, cross_code["entrants"], columns)
