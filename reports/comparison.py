"""Changes between two runs beyond the uncertainty of their values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from reports.results import Case, check

_SHARE = 1e-3  # share of the tolerance: allowed change of a value where its reference is exact


@dataclass(frozen=True)
class Change:
    """One case that is new, gone, of another status, or of another value; old and new as they were."""

    kind: str
    id: str
    old: Case | None
    new: Case | None


def compared(old: object, new: object) -> list[Change]:
    """Every change from an old result file to a new one, by case id.

    A value counts as changed beyond the larger of its two reference uncertainties and a thousandth of its
    tolerance. Raises ResultFileError for what is no result file.
    """
    before = {case["id"]: case for case in check(old)["cases"]}
    after = {case["id"]: case for case in check(new)["cases"]}
    changes = []
    for id in sorted(before.keys() | after.keys()):
        kind = _kind(before.get(id), after.get(id))
        if kind is not None:
            changes.append(Change(kind, id, before.get(id), after.get(id)))
    return changes


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
    """Largest change of the value that is not listed (unit of the value)."""
    scale = abs(case["reference"] or 0.0) if case["metric"] == "relative" else 1.0
    uncertainty: float = case["reference_uncertainty"] or 0.0
    return max(uncertainty, _SHARE * (case["tolerance"] or 0.0) * scale)
