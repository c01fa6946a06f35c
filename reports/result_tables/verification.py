"""Tables of the verification itself: checks by file, studies of the checks, other codes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from reports.evidence import Evidence
from reports.result_tables.markdown import Row, link, section
from reports.results import FORMAT, RECORDED, STATUSES, Case, shown_status

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
