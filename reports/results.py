"""Result files of `rough-friction verify`: what a report needs of them, checked before anything is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

FORMAT = "rough-friction results, version 1"
TOP_KEYS = ("tier", "only", "counts", "seconds", "cases", "errata", "provenance")
CASE_KEYS = (
    "id", "title", "claim", "source", "metric", "value", "reference", "reference_uncertainty", "error",
    "tolerance", "tolerance_reason", "status", "seconds", "unit", "note", "tier", "tags", "data",
)  # fmt: skip
ERRATUM_KEYS = (
    "case",
    "status",
    "equation",
    "printed",
    "corrected",
    "measure",
    "printed_error",
    "corrected_error",
)
PROVENANCE_KEYS = ("command", "date", "commit", "dirty", "versions", "machine")
STATUSES = ("pass", "fail", "error", "unavailable")

Case = Mapping[str, Any]


class ResultFileError(ValueError):
    """The file is not a result file that this report understands."""


def check(results: object) -> Mapping[str, Any]:
    """The results, if they are of the known format, complete, and their counts are those of their cases.

    Raises ResultFileError.
    """
    if not isinstance(results, Mapping) or results.get("format") != FORMAT:
        raise ResultFileError(f"not a file of the format {FORMAT!r}")
    _require(results, TOP_KEYS, "the file")
    _require(results["provenance"], PROVENANCE_KEYS, "the provenance")
    if "contestant" in results:  # only where somebody else's solver was run
        _require(results["contestant"], ("name",), "contestant")
    for key in ("cases", "errata"):
        if not isinstance(results[key], list):
            raise ResultFileError(f"{key} are no list")
    for number, erratum in enumerate(results["errata"]):
        _require(erratum, ERRATUM_KEYS, f"erratum {number}")
    for number, case in enumerate(results["cases"]):
        _require(case, CASE_KEYS, f"case {number}")
        if case["status"] not in STATUSES:
            raise ResultFileError(f"case {case['id']!r} has the unknown status {case['status']!r}")
    ids = [case["id"] for case in results["cases"]]
    if len(set(ids)) < len(ids):
        raise ResultFileError(f"case {max(ids, key=ids.count)!r} is there twice")
    counted = {status: sum(c["status"] == status for c in results["cases"]) for status in STATUSES}
    if counted != results["counts"]:
        raise ResultFileError(f"counts {results['counts']} are not those of the cases, {counted}")
    return results


def worst(cases: list[Case]) -> str:
    """The status that decides about several cases: any error or failure outweighs, then what did not run."""
    present = {case["status"] for case in cases}
    return next(status for status in ("error", "fail", "unavailable", "pass") if status in present)


def by(cases: list[Case], key: str) -> dict[str, list[Case]]:
    """Cases grouped by a field, in order of first appearance.

    >>> by([{"claim": "a", "id": 1}, {"claim": "b", "id": 2}, {"claim": "a", "id": 3}], "claim")["a"]
    [{'claim': 'a', 'id': 1}, {'claim': 'a', 'id': 3}]
    """
    groups: dict[str, list[Case]] = {}
    for case in cases:
        groups.setdefault(case[key], []).append(case)
    return groups


def by_subject(cases: list[Case]) -> dict[str, list[Case]]:
    """Cases grouped by the part of their id before the slash."""
    return by([{**case, "subject": case["id"].partition("/")[0]} for case in cases], "subject")


def _require(item: object, keys: tuple[str, ...], where: str) -> None:
    if not isinstance(item, Mapping):
        raise ResultFileError(f"{where} is no table")
    missing = [key for key in keys if key not in item]
    if missing:
        raise ResultFileError(f"{where} lacks {', '.join(missing)}")
