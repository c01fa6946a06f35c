"""Chaos: what sweeps were disturbed by, and whether their tables were the undisturbed one."""

from __future__ import annotations

from reports.exhibit import Document, Exhibit, Table


def build(document: Document) -> Exhibit:
    """Counts by fault, and the sweeps whose table was another one if there were any."""
    attempts = [attempt for row in document["rows"] for attempt in row["attempts"]]
    rows = []
    for fault in document["faults"]:
        group = [attempt for attempt in attempts if attempt["fault"] == fault]
        statuses = ", ".join(map(str, sorted({attempt["status"] for attempt in group})))
        rows.append((fault, len(group), statuses, max((attempt["lines"] for attempt in group), default=None)))
    head = ("fault", "times", "exit status, or minus the signal", "most lines of messages")
    return Exhibit(
        "Sweeps that are killed, copied and cut off",
        (
            f"{document['sweeps']} sweeps (seed {document['seed']}), {document['on a cluster']} of them on a "
            f"cluster of processes, each disturbed once or twice and then finished: {document['different']} "
            "tables differ from that of the undisturbed sweep, byte for byte; "
            f"{document['tracebacks']} tracebacks were shown.",
        ),
        [Table("Disturbances by kind.", head, rows)],
    )
