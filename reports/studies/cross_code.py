"""Published solvers and ours through one suite: verdicts, and errors as shares of the tolerance."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from reports.exhibit import Column, Document, Exhibit, Table, table

Row = Mapping[str, Any]


def _judged(entrant: Row) -> int:
    counts: Mapping[str, int] = entrant["counts"]
    return sum(counts.values()) - counts["unavailable"]


ENTRANTS: dict[str, Column] = {
    "code": "name",
    "version": "version",
    "role": "role",
    "passed": lambda e: f"{e['counts']['pass']} of {_judged(e)}",
    "failed": lambda e: e["counts"]["fail"] + e["counts"]["error"],
    "not applicable": lambda e: e["counts"]["unavailable"],
    "seconds": "seconds",
    "worst residual": "worst residual",
    "set-up": "setup",
}


def build(document: Document) -> Exhibit:
    """Return entrants with their set-ups, and verdicts case by case."""
    entrants = [e for e in document["entrants"] if e["installed"]]
    absent = [e["version"] for e in document["entrants"] if not e["installed"]]
    cases = document["cases"]
    slugs = [str(case["id"]).partition("/")[2] for case in cases]
    found = {e["name"]: {row["id"]: row for row in e["results"]} for e in entrants}
    verdicts = [
        (slug, case["title"], *(_verdict(rows[case["id"]], case["metric"]) for rows in found.values()))
        for slug, case in zip(slugs, cases, strict=True)
    ]
    paragraphs = [
        "Every code solves the problems that it can pose, by its own recommended set-up; what it cannot pose "
        "is not counted for or against it. Peers stop at tolerances derived from those of the suite.",
        "The set-ups marked as negative controls use a peer so that it reports success on a wrong solution; "
        "the suite must detect them.",
    ]
    if absent:
        paragraphs.append(f"Not measured: {', '.join(absent)}.")
    overview = (
        "Cases passed of those that apply; seconds in the solver for all of them; and the worst residual of "
        "gap over elastic energy, load balance and tension, recomputed from the returned pressures."
    )
    caption = "Verdict and error as a share of the case's tolerance: up to 1 is a pass."
    return Exhibit(
        "Cross-code table",
        paragraphs,
        [table(overview, entrants, ENTRANTS), Table(caption, ("case", "what", *found), verdicts)],
    )


def _verdict(row: Row, metric: str) -> str:
    share = _share(row, metric)
    if row["status"] == "unavailable":
        return "not applicable"
    return str(row["status"]) if share is None else f"{row['status']}, {share:.2g}"


def _share(row: Row, metric: str) -> float | None:
    """Return error over tolerance; of a figure of merit inverted. None where nothing was measured."""
    error, tolerance = row["error"], row["tolerance"]
    if error is None:
        return None
    above, below = (tolerance, error) if metric == "at_least" else (error, tolerance)
    return above / below if below else math.inf if above else 0.0
