"""Tables of the verification itself: checks by file, studies of the checks, other codes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from reports.evidence import Evidence
from reports.result_tables.markdown import Row, link, section
from reports.results import FORMAT, STATUSES

_EXTREMES = {
    "extreme inputs": "extremes",
}
_MUTANTS = {
    "mutants of the code, sample that tests were written for": "mutation",
    "mutants of the code, fresh sample": "mutation_fresh",
    "mutants of the verification code": "mutation_judges",
}
_FAULTS = {
    "meaningful faults, first list": "faults_by_hand",
    "meaningful faults, second list (by the tests nearest to each)": "later_faults",
    "meaningful faults, third list, drawn up blind": "third_faults",
    "meaningful faults, fourth list, drawn up blind": "fourth_faults",
    "random mutants of all areas": "mutation_areas",
}


def checks(documents: Mapping[str, Any], evidence: Evidence) -> str:
    """Counts of statuses, by result file."""
    rows: list[Row] = []
    for name, run in documents.items():
        if run.get("format") == FORMAT:
            made = run["provenance"]
            selected = (
                ", ".join(f"`{pattern}`" for pattern in run["only"]) or f"all of the {run['tier']} tier"
            )
            counts = [run["counts"][status] for status in STATUSES]
            rows.append((link(name), selected, *counts, made["date"][:10], f"`{made['commit'][:12]}`"))
    total = [sum(case["status"] == status for case in evidence.cases) for status in STATUSES]
    listed = ", ".join(f"{count} {status}" for count, status in zip(total, STATUSES, strict=True))
    bad = [f"`{case['id']}` ({case['status']})" for case in evidence.cases if case["status"] != "pass"]
    text = f"{len(evidence.cases)} different checks: {listed}. Not passed: {', '.join(bad) or 'none'}."
    return section("Checks", text, ("file", "checks", *STATUSES, "date", "commit"), rows)


def studies(documents: Mapping[str, Any]) -> str:
    """Quality of the verification itself: single numbers of the studies."""
    rows = [*_searches(documents), *_faults(documents), *_repetitions(documents)]
    text = "How far the verification itself can be trusted, and what broad searches found."
    return section("Studies", text, ("study", "result", "file"), rows)


def _searches(documents: Mapping[str, Any]) -> Iterator[Row]:
    """Rows of searches for inputs that are answered wrongly."""
    for what, name in _EXTREMES.items():
        found = documents[name]["counts"]
        yield (
            what,
            f"{found['right']} right, {found['honest failure']} detected failures, "
            f"{found['wrong']} wrong, {found['crash']} crashes",
            link(name),
        )
    chaos, fuzz, invariants = (documents[name] for name in ("chaos", "fuzz", "hypothesis"))
    yield (
        "sweeps that are killed, copied and cut off",
        f"{chaos['sweeps']} tried, {chaos['different']} other tables, {chaos['tracebacks']} tracebacks",
        link("chaos"),
    )
    yield (
        "damaged input files",
        f"{fuzz['inputs']} tried, {fuzz['tracebacks']} tracebacks, {fuzz['hangs']} hangs",
        link("fuzz"),
    )
    yield (
        "random examples of invariants",
        f"{invariants['examples']} tried, {invariants['counterexamples']} counter-examples",
        link("hypothesis"),
    )


def _faults(documents: Mapping[str, Any]) -> Iterator[Row]:
    """Rows of faults put into the code, and how many of them the checks detected."""
    seeded = documents["fault_matrix"]
    seen = sum(bool(fault["caught_by"]) for fault in seeded["faults"])
    yield (
        "seeded faults in the code",
        f"{seen} of {len(seeded['faults'])} detected, by {len(seeded['checks'])} quick checks",
        link("fault_matrix"),
    )
    for what, name in _MUTANTS.items():
        found = documents[name]
        yield (
            what,
            f"{100 * found['score']:.1f} % of {found['tried'] - found['equivalent']} detected; "
            f"95 % lower bound {100 * found['score_lower_bound']:.1f} %",
            link(name),
        )
    for what, name in _FAULTS.items():
        found = documents[name]["all"]
        yield (
            what,
            f"{100 * found['first']:.0f} % of {found['judged']} detected at first; 95 % lower bound "
            f"{100 * found['first_lower_bound']:.0f} %; {100 * found['now']:.0f} % today",
            link(name),
        )


def _repetitions(documents: Mapping[str, Any]) -> Iterator[Row]:
    """Rows of what was repeated: tests in other orders, ensembles with other seeds."""
    order, ensembles = documents["random_order"], documents["multilevel"]
    tests = [run["tests"] for run in order["runs"]]
    covered = {name: found["covered"] for name, found in ensembles["quantities"].items()}
    yield (
        "tests in random order",
        f"{len(tests)} orders of {' to '.join(dict.fromkeys((str(min(tests)), str(max(tests)))))} tests, "
        + ("no test changes its outcome" if order["no_test_flips"] else "some tests change their outcome"),
        link("random_order"),
    )
    yield (
        "intervals of ensemble means",
        f"cover μ in {covered['friction_coefficient']} and A in {covered['contact_area']} of "
        f"{ensembles['repetitions']} repetitions",
        link("multilevel"),
    )


def codes(cross_code: Mapping[str, Any]) -> str:
    """Solvers through the suite of checks for other solvers."""
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
