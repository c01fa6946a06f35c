"""Fuzzing: what became of mutated scenes, studies, height files and results."""

from __future__ import annotations

from reports.exhibit import Document, Exhibit, Table


def build(document: Document) -> Exhibit:
    """Counts by reader, and the faults if there were any."""
    keys = ("target", "inputs", "accepted", "refused", "traceback", "hang", "seconds")
    head = (
        "reader",
        "inputs",
        "accepted",
        "refused in one line",
        "tracebacks",
        "hangs",
        "processor time (s)",
    )
    tables = [
        Table("Mutated inputs by reader.", head, [[row[key] for key in keys] for row in document["targets"]])
    ]
    if document["faults"]:
        faults = [(fault["target"], fault["fault"]) for fault in document["faults"]]
        tables.append(Table("Faults.", ("reader", "fault"), faults))
    return Exhibit(
        "Broken and hostile input",
        (
            f"{document['inputs']} seeded mutations (seed {document['seed']}) of valid files: "
            f"{document['tracebacks']} tracebacks, {document['hangs']} hangs. Faults of machine and disk - "
            "interrupts, kills, full and read-only disks, corrupted stores - are tests of their own.",
        ),
        tables,
    )
