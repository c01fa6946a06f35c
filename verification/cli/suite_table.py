"""Tables of a run of the suite for a paper, beside the published codes: CSV, LaTeX, Markdown, by the suffix.

The published codes' results are those of `reports/results/cross_code.json.gz`; ours are in it too.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from verification.output.provenance import ROOT
from verification.output.text_table import csv_text, markdown_row

if TYPE_CHECKING:
    from verification.framework.case import Result

PUBLISHED = ROOT / "reports" / "results" / "cross_code.json.gz"
COLUMNS = ("code", "version", "checksum", "suite", "case", "status", "error", "tolerance", "metric")
_SPECIAL = {c: f"\\{c}" for c in "&%$#_{}"} | {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\^{}",
}

Rows = Sequence[Sequence[str]]


def run_entry(identity: Mapping[str, Any], suite: str, results: Iterable[Result]) -> dict[str, Any]:
    """Return the run as an entry like those of the published codes; designs are a row each."""
    from verification.adapters.table import summarised

    found = [asdict(result) | {"residual": None} for result in results]
    statuses = [row["status"] for row in found]
    counts = {name: statuses.count(name) for name in ("pass", "fail", "error", "unavailable")}
    return dict(identity) | {"suite": suite, "counts": counts, "results": summarised(found)}


def published() -> list[dict[str, Any]]:
    """Return the published codes' entries, without set-ups wrong on purpose; none without the file."""
    from verification.output.result_files import read_result

    if not PUBLISHED.is_file():
        return []
    document: Any = read_result(PUBLISHED)
    suite = document["suite"]["version"]
    metrics = {case["id"]: case["metric"] for case in document["cases"]}
    entries = [e for e in document["entrants"] if e["installed"] and e["role"] != "trap"]
    for entry in entries:
        entry["suite"] = suite
        entry["results"] = [row | {"metric": metrics[row["id"]]} for row in entry["results"]]
    return entries


def text_of(suffix: str, entries: Sequence[Mapping[str, Any]]) -> str:
    """Return the table of these entries, the first being the run."""
    if suffix == ".csv":
        return _csv(entries)
    how, note = (_latex, f"% {NOTE}\n") if suffix == ".tex" else (_markdown, f"{NOTE}\n\n")
    return f"{how(*overview(entries))}\n\n{note}{how(*verdicts(entries))}\n"


def _csv(entries: Sequence[Mapping[str, Any]]) -> str:
    rows: list[Sequence[object]] = [COLUMNS]
    for entry in entries:
        head = [entry["name"], entry.get("version"), entry.get("checksum"), entry["suite"]]
        for row in entry["results"]:
            rows.append([*head, row["id"], row["status"], row["error"], row["tolerance"], row.get("metric")])
    return csv_text(rows)


def overview(entries: Sequence[Mapping[str, Any]]) -> tuple[Sequence[str], Rows]:
    """Return the head and rows: who each code is, and how many cases it passed."""
    head = ("code", "version", "checksum", "suite", "passed", "failed", "errors", "not applicable")
    rows = []
    for entry in entries:
        counts = entry["counts"]
        judged = counts["pass"] + counts["fail"] + counts["error"]
        who = [str(entry.get(name) or "-") for name in ("name", "version", "checksum", "suite")]
        passed = f"{counts['pass']} of {judged}"
        rows.append([*who, passed, *(str(counts[name]) for name in ("fail", "error", "unavailable"))])
    return head, rows


def verdicts(entries: Sequence[Mapping[str, Any]]) -> tuple[Sequence[str], Rows]:
    """Return the head and rows: each case's verdict by code, with the error as a share of the tolerance."""
    by_code = [{row["id"]: row for row in entry["results"]} for entry in entries]
    cases = dict.fromkeys(case for rows in by_code for case in rows)
    head = ("case", *(str(entry["name"]) for entry in entries))
    return head, [[case.partition("/")[2], *(_verdict(rows.get(case)) for rows in by_code)] for case in cases]


def _verdict(row: Mapping[str, Any] | None) -> str:
    if row is None or row["status"] == "unavailable":
        return "-"
    error, tolerance = row["error"], row["tolerance"]
    if error is None or row.get("metric") == "at_least" or not tolerance:
        return str(row["status"])
    return f"{row['status']} {error / tolerance:.2g}"


def _markdown(head: Sequence[str], rows: Rows) -> str:
    return "\n".join(map(markdown_row, [head, ["---"] * len(head), *rows]))


def _latex(head: Sequence[str], rows: Rows) -> str:
    lines = [f"{' & '.join(map(_escaped, line))} \\\\" for line in (head, *rows)]
    body = "\n".join([lines[0], r"\hline", *lines[1:]])
    return f"\\begin{{tabular}}{{{'l' * len(head)}}}\n{body}\n\\end{{tabular}}"


NOTE = "Verdicts with the error as a share of the tolerance; up to 1 is a pass, - is not applicable."


def _escaped(text: str) -> str:
    """Return the text as LaTeX prints it.

    >>> _escaped("a_b & 5 %")
    'a\\\\_b \\\\& 5 \\\\%'
    """
    return "".join(_SPECIAL.get(c, c) for c in text)
