"""Extremes: verdicts and digits by axis, the limits found, lawful states, precision and condition numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from reports.exhibit import Document, Exhibit, Table
from reports.extremes_figures import CONDITION, KEPT, LAWFUL, LOST

Row = Mapping[str, Any]
VERDICTS = ("right", "honest failure", "wrong", "crash")
DRAWN = ("load", "contact set", "material", "friction", "topography", "grid")


def build(document: Document) -> Exhibit:
    """The chapter's part on extremes."""
    rows, counts = document["states"], document["counts"]
    said = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS)
    lawful = document["lawful states"]
    statuses = [row["statuses"]["fft"] for row in lawful]
    taus = {
        "tau / mean pressure": [row["tau"] for row in lawful],
        **{name: [row[name] for row in lawful] for name in ("none", "one", "several")},
        "not converged": [sum(told.values()) - told.get("converged", 0) for told in statuses],
    }
    return Exhibit(
        "Every axis to the point of failure",
        (
            f"{len(rows)} states: {said}. Right: within its limit of an oracle that shares nothing with the "
            "solver: the discrete problem in 34 digits, a scaling law, a closed form. Detected failure: "
            "refused, or a status that says so. Crash: an exception without a reason, or no end in the time "
            "allowed.",
            "Unit scaling by powers of two must change no bit, by powers of ten no more than 1e-12.",
            "For any beta a + beta c is positive definite (the proof is in the code), so at fixed slopes and "
            "active set of tau there is one state. It ends with tau, as the count of lawful states shows.",
        ),
        [
            _by_axis(rows),
            _by_series(document["table"]),
            _limits(document["limits"]),
            _causes(document["precision"]),
        ],
        [
            (KEPT, {"digits kept": _kept(rows)}),
            (LOST, document["precision"]),
            (LAWFUL, taus),
            (CONDITION, document["conditioning"]),
        ],
    )


def _by_axis(rows: Sequence[Row]) -> Table:
    found = []
    for axis in dict.fromkeys(row["axis"] for row in rows):
        group = [row for row in rows if row["axis"] == axis]
        digits = sorted(row["digits"] for row in group if row["verdict"] == "right")
        counts = [sum(row["verdict"] == verdict for row in group) for verdict in VERDICTS]
        least_and_median = (digits[0], digits[len(digits) // 2]) if digits else (None, None)
        found.append((axis, len(group), *counts, *least_and_median))
    head = ("axis", "states", *VERDICTS, "fewest digits kept", "median")
    return Table("Verdicts by axis; digits of the right ones.", head, found)


def _by_series(table: Sequence[Row]) -> Table:
    head = ("axis", "series", "from", "to", *VERDICTS, "fewest digits kept", "median", "judged by")
    keys = ("axis", "series", "from", "to", *VERDICTS, "fewest digits", "median digits", "oracle")
    return Table(
        "Every series, its range, and its verdicts.", head, [[row[key] for key in keys] for row in table]
    )


def _limits(limits: Sequence[Row]) -> Table:
    keys = ("what", "why", "remedy", "states")
    caption = "Limits found: where this implementation stops being a reference."
    return Table(
        caption, ("what happens", "why", "what would help", "states"), [[r[k] for k in keys] for r in limits]
    )


def _causes(precision: Mapping[str, Any]) -> Table:
    names, lost = precision["arithmetic"], precision["digits lost"]
    head = ("quantity", *names, "cause", "what this code does")
    rows = [
        (name, *values, precision["cause"][name], precision["cure"][name] or "it is this code's form")
        for name, values in lost.items()
    ]
    return Table("Decimal digits lost in each arithmetic, why, and the cure.", head, rows)


def _kept(rows: Sequence[Row]) -> dict[str, list[Any]]:
    """Digits, or the verdict of what is not right, by series of the production solver."""
    found: dict[str, list[Any]] = {}
    for row in rows:
        if row["axis"] in DRAWN and row["series"].endswith("fft"):
            name = f"{row['axis']}: {row['series'].removesuffix(', fft')}"
            right = row["verdict"] == "right"
            found.setdefault(name, []).append(row["digits"] if right else row["verdict"])
    return found
