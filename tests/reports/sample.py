"""A small result file, made by hand: reports know nothing of the package that writes real ones."""

from __future__ import annotations

from typing import Any

UNJUDGED: dict[str, Any] = {
    "value": None, "reference": None, "reference_uncertainty": None, "error": None,
}  # fmt: skip


def case(id: str, status: str = "pass", **other: Any) -> dict[str, Any]:
    """A case whose error and status follow from its numbers, unless ``other`` says otherwise."""
    numbers = {"value": 1.01 if status == "pass" else 1.2, "reference": 1.0, "reference_uncertainty": 0.0}
    if status in ("error", "unavailable"):
        numbers = UNJUDGED
    made = {
        "id": id, "title": f"Title of {id}", "claim": "Eq. (7) holds", "source": "Johnson 1985",
        "metric": "relative", **numbers, "tolerance": 0.1,
        "tolerance_reason": "first order in h", "status": status, "seconds": 0.5, "unit": "Pa", "note": "",
        "tier": "quick", "data": {}, **other,
    }  # fmt: skip
    return made if "error" in made else {**made, "error": error_of(made)}


def error_of(case: dict[str, Any]) -> float | None:
    value, reference = case["value"], case["reference"]
    if value is None or reference is None:
        return value
    scale = abs(reference) if case["metric"] == "relative" else 1.0
    return float(abs(value - reference) / scale)


def results(*cases: dict[str, Any], **other: Any) -> dict[str, Any]:
    statuses = ("pass", "fail", "error", "unavailable")
    return {
        "format": "rough-friction results, version 1",
        "tier": "quick",
        "only": [],
        "counts": {s: sum(c["status"] == s for c in cases) for s in statuses},
        "seconds": 1.0,
        "cases": list(cases),
        "errata": [],
        "provenance": {
            "command": "rough-friction verify --tier quick",
            "date": "2001-01-01T00:00:00+00:00",
            "commit": "0123456789abcdef",
            "dirty": False,
            "versions": {"python": "3.11", "rough-friction": "0.1.0", "pyamg": None},
            "machine": {"cores": 2, "processor": "x", "platform": "Linux"},
        },
        **other,
    }


TEXTBOOK = {
    "offset": [1, 10, 100],
    "textbook": [1e-15, 1e-13, 1e-11],
    "production": [1e-16, 2e-16, 1e-16],
}
ERRATUM = {
    "case": "a/1", "status": "pass", "equation": "A4", "printed": "sin xi", "corrected": "cos xi",
    "measure": "residual", "printed_error": 0.3, "corrected_error": 1e-12,
}  # fmt: skip
