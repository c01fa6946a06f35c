"""Result files of `rough-friction verify`: what a report needs of them, checked before anything is drawn."""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from jinja2 import UndefinedError

FORMAT = "rough-friction results, version 1"
STATUSES = ("pass", "fail", "error", "unavailable")
METRICS = ("relative", "absolute", "at_most", "at_least", "equal")
LARGEST_INTEGER = 2**63 - 1
_ROUNDING = 4 * 2.0**-52  # relative; a written error is a difference and a quotient of written doubles

Case = Mapping[str, Any]
Kind = Callable[[object], bool]


def _a(kind: type) -> Kind:
    return lambda value: isinstance(value, kind)


_text, _flag, _table, _list = _a(str), _a(bool), _a(Mapping), _a(list)


def _number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _size(value: Any) -> bool:
    return _number(value) and bool(value >= 0)


def _texts(value: object) -> bool:
    return isinstance(value, list) and all(map(_text, value))


def _id(value: object) -> bool:
    return isinstance(value, str) and all(value.partition("/")) and len(value.split()) == 1


def _or_none(kind: Kind) -> Kind:
    return lambda value: value is None or kind(value)


def _one_of(*values: str) -> Kind:
    return lambda value: isinstance(value, str) and value in values


def _command(value: object) -> bool:
    try:
        return isinstance(value, str) and bool(shlex.split(value))
    except ValueError:  # an open quote
        return False


def _labels(value: object) -> bool:
    kinds = _or_none(lambda item: _text(item) or _number(item))
    return isinstance(value, Mapping) and all(map(kinds, value.values()))


FILE: Mapping[str, Kind] = {
    "tier": _text, "only": _texts, "counts": _table, "seconds": _size, "cases": _list, "errata": _list,
    "provenance": _table,
}  # fmt: skip
CASE: Mapping[str, Kind] = {
    "id": _id, "title": _text, "claim": _text, "source": _text, "metric": _one_of(*METRICS),
    "value": _or_none(_number), "reference": _or_none(_number), "reference_uncertainty": _or_none(_size),
    "error": _or_none(_number), "tolerance": _number, "tolerance_reason": _text,
    "status": _one_of(*STATUSES), "seconds": _size, "unit": _text, "note": _text, "tier": _text,
    "data": _table,
}  # fmt: skip
ERRATUM: Mapping[str, Kind] = {
    "case": _text, "status": _one_of(*STATUSES), "equation": _text, "printed": _text, "corrected": _text,
    "measure": _text, "printed_error": _or_none(_number), "corrected_error": _or_none(_number),
}  # fmt: skip
PROVENANCE: Mapping[str, Kind] = {
    "command": _command, "date": _text, "commit": _or_none(_text), "dirty": _or_none(_flag),
    "versions": _labels, "machine": _labels,
}  # fmt: skip
SOLVER: Mapping[str, Kind] = {"name": _text}


OTHER_SHAPE = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError, UndefinedError)
"""Exceptions where data are not of the shape that a table, a figure or a template needs."""


class ResultFileError(ValueError):
    """The file is not a result file that this report understands."""


class CaseDataError(ResultFileError):
    """The data of a case are not of the shape that its figures show; ``origin`` as in `reports.evidence`."""

    def __init__(self, message: str, origin: Mapping[str, Any] | None) -> None:
        super().__init__(message)
        self.origin = origin


@contextmanager
def shaped(what: str, error: Callable[[str], ResultFileError] = ResultFileError) -> Iterator[None]:
    """Raise ``error`` where data are not of the shape that the block needs; other refusals stay."""
    try:
        yield
    except ResultFileError:
        raise
    except OTHER_SHAPE as broken:
        raise error(f"{what}: {broken}") from broken


def check(results: object) -> Mapping[str, Any]:
    """Return results of the schema, of verdicts from numbers, counts from cases. Raises ResultFileError."""
    if not isinstance(results, Mapping) or results.get("format") != FORMAT:
        raise ResultFileError(f"not a file of the format {FORMAT!r}")
    _check_values(results, "the file")
    _require(results, FILE, "the file")
    _require(results["provenance"], PROVENANCE, "the provenance")
    if "solver" in results:  # only where somebody else's solver was run
        _require(results["solver"], SOLVER, "solver")
    if not results["cases"]:
        raise ResultFileError("it has no cases")
    for number, erratum in enumerate(results["errata"]):
        _require(erratum, ERRATUM, f"erratum {number}")
    for number, case in enumerate(results["cases"]):
        _require(case, CASE, f"case {number}")
        _check_verdict(case)
    ids = [case["id"] for case in results["cases"]]
    if len(set(ids)) < len(ids):
        raise ResultFileError(f"case {max(ids, key=ids.count)!r} is there twice")
    counted = {status: sum(c["status"] == status for c in results["cases"]) for status in STATUSES}
    if counted != results["counts"]:
        raise ResultFileError(f"counts {results['counts']} are not those of the cases, {counted}")
    return results


def verdict_of(case: Case) -> str:
    """Return "pass" or "fail": the verdict that follows from error, tolerance and metric."""
    error, tolerance = case["error"], case["tolerance"]
    within = error >= tolerance if case["metric"] == "at_least" else error <= tolerance
    return "pass" if within else "fail"


def _check_verdict(case: Case) -> None:
    """Refuse a status that does not follow from the numbers, and an error that does not either."""
    id, status = case["id"], case["status"]
    if status in ("error", "unavailable"):
        given = [name for name in ("value", "reference", "error") if case[name] is not None]
        if given:
            raise ResultFileError(f"case {id!r} was not judged ({status}), but has {', '.join(given)}")
        return
    if status == "fail" and case["value"] is None and case["error"] is None and case["note"]:
        return  # disproved before a number was found, as the note says
    missing = [name for name in ("value", "reference_uncertainty", "error") if case[name] is None]
    if case["reference"] is None and case["metric"] not in ("at_most", "at_least"):
        missing.append("reference")
    if missing:
        raise ResultFileError(f"case {id!r} has the status {status!r} without {', '.join(missing)}")
    if case["tolerance"] < 0 and case["metric"] != "at_least":
        raise ResultFileError(f"case {id!r} has the negative tolerance {case['tolerance']!r}")
    if not _error_follows(case):
        raise ResultFileError(f"case {id!r}: error {case['error']!r} is not that of its value and reference")
    if verdict_of(case) != status:
        numbers = f"error {case['error']!r}, tolerance {case['tolerance']!r}, metric {case['metric']}"
        raise ResultFileError(f"case {id!r} has the status {status!r}, which does not follow from {numbers}")


def _error_follows(case: Case) -> bool:
    """Return True if value, reference and metric give the error, with a certain reference."""
    value, reference, error, metric = (case[name] for name in ("value", "reference", "error", "metric"))
    if metric in ("at_most", "at_least"):
        return reference is None and bool(error == value) and (metric == "at_least" or value >= 0)
    scale = abs(reference) if metric == "relative" else 1.0
    if scale == 0 or case["reference_uncertainty"] > case["tolerance"] * scale * (1 + _ROUNDING):
        return False
    rounding = _ROUNDING * (abs(value) + abs(reference))
    return bool(error >= 0 and abs(error * scale - abs(value - reference)) <= rounding)


def _check_values(value: object, where: str) -> None:
    """Refuse, at any depth, numbers that are not finite or that no double holds, and texts without UTF-8."""
    if isinstance(value, Mapping):
        for key, entry in value.items():
            _check_values(key, where)
            _check_values(entry, where)
    elif isinstance(value, list):
        for entry in value:
            _check_values(entry, where)
    elif isinstance(value, float) and not math.isfinite(value):
        raise ResultFileError(f"{where} holds {value}, which is no number")
    elif isinstance(value, int) and abs(value) > LARGEST_INTEGER:
        raise ResultFileError(f"{where} holds an integer beyond {LARGEST_INTEGER}")
    elif isinstance(value, str) and not value.isascii() and any("\ud800" <= c <= "\udfff" for c in value):
        raise ResultFileError(f"{where} holds a text that is no UTF-8")


RECORDED = "recorded"
"""First word of a tolerance that was set from the result: it guards against changes, and claims nothing."""


def shown_status(case: Case) -> str:
    """Return the status for people: a pass by a tolerance set from the result is "recorded"."""
    recorded = case["status"] == "pass" and case["tolerance_reason"].startswith(RECORDED)
    return RECORDED if recorded else str(case["status"])


def shown_counts(cases: Iterable[Case]) -> dict[str, int]:
    """Return numbers of cases by status for people; "recorded" only if there are any."""
    shown = [shown_status(case) for case in cases]
    statuses = (*STATUSES[:1], *[RECORDED] * (RECORDED in shown), *STATUSES[1:])
    return {status: shown.count(status) for status in statuses}


def worst(cases: list[Case]) -> str:
    """Return the status that decides over cases: error or failure first, then what did not run."""
    present = {case["status"] for case in cases}
    return next(status for status in ("error", "fail", "unavailable", "pass") if status in present)


def by_subject(cases: Iterable[Case]) -> dict[str, list[Case]]:
    """Return cases by the part of their id before the slash, in order of first appearance.

    >>> by_subject([{"id": "a/1"}, {"id": "b/1"}, {"id": "a/2"}])["a"]
    [{'id': 'a/1'}, {'id': 'a/2'}]
    """
    groups: dict[str, list[Case]] = {}
    for case in cases:
        groups.setdefault(case["id"].partition("/")[0], []).append(case)
    return groups


def _require(item: object, schema: Mapping[str, Kind], where: str) -> None:
    """Refuse an item that is no table, lacks a key of the schema, or has a value of another kind."""
    if not isinstance(item, Mapping):
        raise ResultFileError(f"{where} is no table")
    missing = [key for key in schema if key not in item]
    if missing:
        raise ResultFileError(f"{where} lacks {', '.join(missing)}")
    for key, kind in schema.items():
        if not kind(item[key]):
            raise ResultFileError(f"{where}: {key} cannot be {str(item[key])[:60]!r}")


_SHARE = 1e-3  # share of the tolerance: allowed change of a value where its reference is exact


@dataclass(frozen=True)
class Change:
    """One case that is new, gone, of another status, or of another value; old and new as they were."""

    kind: str
    id: str
    old: Case | None
    new: Case | None


def compared(old: object, new: object) -> list[Change]:
    """Return every change from an old result file to a new one, by case id.

    A value counts as changed beyond the larger of its two reference uncertainties and a thousandth of its
    tolerance. Raises ResultFileError for what is no result file.
    """
    before = {case["id"]: case for case in check(old)["cases"]}
    after = {case["id"]: case for case in check(new)["cases"]}
    pairs = {id: (before.get(id), after.get(id)) for id in sorted(before.keys() | after.keys())}
    return [Change(kind, id, *pair) for id, pair in pairs.items() if (kind := _kind(*pair)) is not None]


def _kind(old: Case | None, new: Case | None) -> str | None:
    if old is None:
        return "new"
    if new is None:
        return "not run"
    if old["status"] != new["status"]:
        return "status"
    if old["value"] is None or new["value"] is None:
        return "value" if old["value"] != new["value"] else None
    moved = abs(new["value"] - old["value"])
    return "value" if moved > max(_unnoticed(old), _unnoticed(new)) else None


def _unnoticed(case: Mapping[str, Any]) -> float:
    """Return the largest change of the value that is not listed (unit of the value)."""
    scale = abs(case["reference"] or 0.0) if case["metric"] == "relative" else 1.0
    uncertainty: float = case["reference_uncertainty"] or 0.0
    return max(uncertainty, _SHARE * (case["tolerance"] or 0.0) * scale)
