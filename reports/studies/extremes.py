"""Extremes: verdicts and digits by axis, limits found, lawful states, conditioning."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from reports.exhibit import Column, Document, Exhibit, Table, table

VERDICTS = ("right", "detected failure", "unjudged", "wrong", "crash")

BY_SERIES: dict[str, Column] = {
    "axis": "axis",
    "series": "series",
    "from": "from",
    "to": "to",
    **{verdict: verdict for verdict in VERDICTS},
    "fewest digits kept": "fewest digits",
    "median": "median digits",
    "judged by": "oracle",
}
LIMITS: dict[str, Column] = {
    "kind": "kind",
    "what happens": "what",
    "why": "why",
    "evidence": "evidence",
    "states": lambda row: row["rule"] or ", ".join(row["states"]),
}
LAWFUL: dict[str, Column] = {
    "tau / mean pressure": "tau",
    "none": "none",
    "one": "one",
    "several": "several",
    "solver not converged": lambda row: _not_converged(row["statuses"]["fft"]),
}
CONDITIONING = ("M", "condition", "CG iterations", "digits lost by a direct solve")


SECOND_SOLVE = ("the scaling law", "the same heights without an offset", "the dense solver")
"""Judges that are this code again."""
FEW = 6
"""Decimal digits below which a right result is counted apart: those of single precision."""


def sentence(document: Document) -> str:
    """Return verdicts, results of few digits, and judges that are this code, for the first page."""
    rows, counts = document["states"], document["counts"]
    right = [row for row in rows if row["verdict"] == "right"]
    digits = [row["digits"] for row in right]
    few = sum(kept < FEW for kept in digits)
    again = sum(row["oracle"] in SECOND_SOLVE for row in right)
    return (
        f"{len(rows)} extreme inputs: {counts['wrong']} wrong beyond the conditioning of the input, "
        f"{counts['crash']} crashes, {counts['detected failure']} failed and reported it, "
        f"{counts['unjudged']} not judged, {len(right)} right"
        f"{f', {few} of them to fewer than {FEW} digits, the least {min(digits):.1f}' if few else ''}; "
        f"{again} of the right ones are judged by a second solve of this code"
    )


def build(document: Document) -> Exhibit:
    """Return the tables of the study."""
    rows, counts = document["states"], document["counts"]
    found = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS)
    conditioning = document["conditioning"]
    return Exhibit(
        "Every axis to the point of failure",
        (
            f"{len(rows)} states: {found}. Right: within its limit of the judge that the table names: the "
            "discrete problem in 34 digits, a closed form, or a second solve of this code (other units, no "
            "offset, the dense solver). A limit is what the input leaves: heights with a large offset have "
            "lost their digits, and finite elements have the digits of their mesh. Detected failure: "
            "refused, or a status that says so. Unjudged: no judge decides, as it fails itself, or as the "
            "heights have lost their digits. Crash: an exception without a reason, or no end in the time "
            "allowed.",
            "Unit scaling by powers of two must change no bit, by powers of ten no more than 1e-12.",
            "For any beta a + beta c is positive definite (the proof is in the code), so at fixed slopes and "
            "active set of tau there is one state. It ends with tau, as the count of lawful states shows.",
        ),
        [
            _by_axis(rows),
            table("Every series, its range, and its verdicts.", document["table"], BY_SERIES),
            table(
                "Limits found: where this implementation stops being a reference, and what shows it.",
                document["limits"],
                LIMITS,
            ),
            table(
                "Lawful states of 40 rough flats on 3 x 3 elements, counted by trying all contact sets.",
                document["lawful states"],
                LAWFUL,
            ),
            Table(
                "Condition number of the dense flexibility on M x M elements, about 1.66 M, and its cost.",
                CONDITIONING,
                list(zip(*(conditioning.get(name, ()) for name in CONDITIONING), strict=True)),
            ),
        ],
    )


def _not_converged(statuses: dict[str, int]) -> int:
    return sum(statuses.values()) - statuses.get("converged", 0)


def _by_axis(rows: Sequence[dict[str, Any]]) -> Table:
    found = []
    for axis in dict.fromkeys(row["axis"] for row in rows):
        group = [row for row in rows if row["axis"] == axis]
        digits = sorted(row["digits"] for row in group if row["verdict"] == "right")
        counts = [sum(row["verdict"] == verdict for row in group) for verdict in VERDICTS]
        least_and_median = (digits[0], digits[len(digits) // 2]) if digits else (None, None)
        found.append((axis, len(group), *counts, *least_and_median))
    head = ("axis", "states", *VERDICTS, "fewest digits kept", "median")
    return Table("Verdicts by axis; digits of the right ones.", head, found)
