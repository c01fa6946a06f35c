"""Tables of this code: coverage of error bars, times and costs, checks, studies of them, other codes."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from reports.evidence import Evidence
from reports.exhibit import Column
from reports.result_tables import Row, link, listing, markdown, number, section
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
SUMMARY: dict[str, Column] = {
    "number": lambda row: JUDGED[row["number"]],
    "covered": lambda row: percent(row["held"]),
    "covered at worst": lambda row: percent(row["held_at_worst"]),
    "usable": lambda row: percent(row["usable"]),
    "error bar over error": lambda row: number(row["median_bar_over_error"], ".1f"),
}


def coverage(documents: Mapping[str, Any]) -> str:
    """Show how many error bars cover the reference: of all scenes, then by class."""
    found = {(row["class"], row["number"]): row for row in documents["coverage_corrected"]["table"]}
    scenes = found[None, MU]["scenes"]
    text = (
        f"Does an error bar of 95 % contain the right value? {scenes} random scenes were drawn after the "
        "constants of the error bars were fixed. Each is solved on one grid of 48 to 128 elements per side. "
        "The reference is its solution on 384 elements; for rounded punches it is a closed form. "
        f"File: {link('coverage_corrected')}.\n\n"
        "- *Covered*: share of the error bars that contain the reference; an unbounded bar does.\n"
        "- *Covered at worst*: this share if every reference were wrong by its own error bound.\n"
        "- *Usable*: share of the error bars that are at most half of the value that they belong to.\n"
        "- *Error bar over error*: median ratio of the error bar to the error that was found.\n\n"
        "μ is the [corrected mu](../docs/error-bars.md#corrected-mu-the-edge-bias-removed). A is summed over "
        "elements, or perimeter-corrected."
    )
    by_class = "*Covered*, by class of scene:"
    classes = [name for name, _ in found if name]
    rows = [
        (name, found[name, MU]["scenes"], *(percent(found[name, number]["held"]) for number in COVERED))
        for name in dict.fromkeys(classes)
    ]
    head = ("class of scene", "scenes", *(JUDGED[number] for number in COVERED))
    summary = listing("Coverage of error bars", text, [found[None, number] for number in COVERED], SUMMARY)
    return "\n\n".join((summary, by_class, markdown(head, rows)))


OWN = {
    "solver": "refimpl-solver",
    "with error bars": "refimpl",
    "with friction": "refimpl+friction",
    "with friction and slopes": "refimpl+friction+slopes",
}
PEERS = {
    "ASPHER": "aspher",
    "ASPHER, quickest options": "aspher+options",
    "Tamaas": "tamaas",
    "ContactMechanics": "ContactMechanics",
}


def costs(benchmarks: Mapping[str, Any]) -> str:
    """Show the seconds of this code and ratios of published solvers, newest run of each."""
    rows: list[Row] = []
    for (kind, M), entries in newest_rows(benchmarks["runs"]).items():
        found = {row["code"]: row for row in entries}
        cells = [number(_median(found.get(code))) for code in OWN.values()]
        cells += [number(_median(found.get(code, {}).get("ratio"))) for code in PEERS.values()]
        rows.append((f"{kind} flat", f"{M}²", *cells))
    head = ("surface", "grid", *(f"{label} (s)" for label in OWN), *(f"ratio: {name}" for name in PEERS))
    text = (
        "How long does the contact of the paper's Table 1 take? Every code runs on one thread "
        f"({', '.join(_processors(benchmarks['runs']))}) until its relative duality gap, recomputed here, is "
        f"1e-8. Times are medians of several runs. File: {link('benchmarks')}.\n\n"
        "- *Solver*: seconds of this code for the pressures alone.\n"
        "- *With error bars*: from a scene to numbers with error bars. The next two columns add friction, "
        "then slopes.\n"
        "- *Ratio*: time of another code, divided by that of this code with error bars. A dash: not run."
    )
    return section("Time", text, head, rows)


def _processors(runs: Iterable[Mapping[str, Any]]) -> list[str]:
    return sorted({run["provenance"]["machine"]["processor"] for run in runs})


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
            rows.append((one["class"], label, *cells))
    head = ("class of scenes", "number", *(f"{100 * demand:g} %" for demand in demands))
    text = (
        "Which grid do you need for an accuracy? A cell has the coarsest grid that is accurate enough: "
        "its relative error, and those of all finer grids, are at most the percentage above. Friction and "
        "slopes are included. "
        f"File: {link('accuracy_costs')}.\n\n"
        "- *Error*: difference from a grid of 2048², plus the error bar of that grid.\n"
        "- Each class has three scenes. The cell is their median.\n"
        "- *64² (2 of 3)*: two of three scenes meet the accuracy, on 64² or coarser. The third does not up "
        "to 1024², or its reference is too uncertain.\n"
        "- *> 1024²*: none of the three does."
    )
    return section("Cost and accuracy", text, head, rows)


def _cost(entry: Mapping[str, Any], realisations: Sequence[Sequence[Mapping[str, Any]]]) -> str:
    """Return the median grid, or the finest of those that meet the demand where not all realisations do.

    >>> ends = [[{"M": M, "errors": {"mu": e}} for M, e in ((32, 0.01), (1024, e))] for e in (0.01, None)]
    >>> _cost({"quantity": "mu", "error": 0.03, "M": None}, ends)
    '32² (1 of 2)'
    """
    if entry["M"] is not None:
        return f"{entry['M']:.0f}²"
    grids = [_coarsest(rows, entry["quantity"], entry["error"]) for rows in realisations]
    met = [grid for grid in grids if grid is not None]
    return f"{max(met)}² ({len(met)} of {len(grids)})" if met else "> 1024²"


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
    text = (
        f"{len(evidence.cases)} different checks: {listed}. Failed or not run: {', '.join(bad) or 'none'}. "
        "The tolerance of a *recorded* check was set from its own result, so it detects changes only.\n\n"
        "A row has the checks of one file. Some quick checks stand in a second file too, so the rows sum to "
        "more than all checks. In names, `*` stands for any letters."
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
        "Were wrong results found? Two studies searched for them. The first has contacts of extreme inputs, "
        "judged by an independent computation. A *detected failure* is a result whose status says: do not "
        "use it. The second tries random contacts on rules that every solution obeys, the invariants."
    )
    return section("Studies", text, ("study", "result", "file"), rows)


def codes(cross_code: Mapping[str, Any]) -> str:
    """Show solvers through the suite of checks for other solvers."""
    roles = {"ours": "this code", "peer": "published solver", "trap": "negative control"}
    columns: dict[str, Column] = {
        "solver": "name",
        "role": lambda entrant: roles[entrant["role"]],
        **{status: f"{{counts[{status}]}}" for status in STATUSES},
    }
    text = (
        "Which codes pass the [suite](../docs/check-your-solver.md)? The table counts the cases by verdict. "
        f"File: {link('cross_code')}.\n\n"
        "- *Unavailable*: the solver does not solve such a case.\n"
        "- *Negative control*: a solver that is set up wrongly on purpose, which the suite must detect."
    )
    return listing("Solvers in the suite for other solvers", text, cross_code["entrants"], columns)
