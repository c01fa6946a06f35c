"""Random extremes: verdicts on states drawn over all parameters at once."""

from __future__ import annotations

from reports.exhibit import Document, Exhibit, Table


def build(document: Document) -> Exhibit:
    """Counts, the ranges, and the states that are not right."""
    ranges = [
        (name, *(bounds if isinstance(bounds, list) else (bounds, bounds)))
        for name, bounds in document["ranges"].items()
    ]
    said = ", ".join(f"{number} {verdict}" for verdict, number in document["counts"].items())
    others = [
        (row["at"], row["elements"], row["verdict"], row["status"], row["error"], row["note"])
        for row in document["rows"]
        if row["verdict"] != "right"
    ]
    head = ("state", "elements a side", "verdict", "status", "error", "note")
    return Exhibit(
        "States drawn at random over all parameters",
        (
            f"{document['states']} states (seed {document['seed']}), judged by the discrete problem in 34 "
            f"digits: {said}.",
        ),
        [
            Table("Ranges, drawn uniformly.", ("parameter", "from", "to"), ranges),
            Table("States that are not right.", head, others),
        ],
    )
