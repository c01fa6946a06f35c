"""Two parts of the matrix in one document: dear checks are tried against the few faults that need them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def merged(old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    """The old document with the new one's verdicts; who is alone is judged anew.

    Raises ValueError for documents of different formats, or for a check that both tried against one fault.
    """
    if old["format"] != new["format"]:
        raise ValueError(f"formats differ: {old['format']!r} and {new['format']!r}")
    again = {check["id"] for check in old["checks"]} & {check["id"] for check in new["checks"]}
    if again:
        raise ValueError(f"tried before: {', '.join(sorted(again))}")
    faults = {fault["name"]: {**fault, "caught_by": list(fault["caught_by"])} for fault in old["faults"]}
    for fault in new["faults"]:
        known = faults.setdefault(fault["name"], {**fault, "tried": 0, "broke": 0, "caught_by": []})
        known["what"] = fault["what"]
        known["tried"] += fault["tried"]
        known["broke"] += fault["broke"]
        known["caught_by"] += fault["caught_by"]
    sole = {name: len(fault["caught_by"]) for name, fault in faults.items()}
    checks = [
        {
            **check,
            "alone": [name for name in check["catches"] if sole[name] == 1],
            "among_few": [name for name in check["catches"] if 1 < sole[name] <= 3],
        }
        for check in (*old["checks"], *new["checks"])
    ]
    tried = {check["id"] for check in checks}
    return {
        **old,
        "faults": list(faults.values()),
        "checks": checks,
        "excluded": {id: why for id, why in old["excluded"].items() if id not in tried},
        "added": [*old.get("added", []), new["provenance"]],
    }
