"""Random examples of the solver invariants."""

from __future__ import annotations

from collections import defaultdict

from reports.exhibit import Document, Exhibit, Table


def build(document: Document) -> Exhibit:
    """Return the numbers of examples that every invariant required and passed, by solver."""
    held: dict[str, dict[str, int]] = defaultdict(dict)
    claims = {}
    for part in document["slices"]:
        known = held[part["invariant"]].get(part["solver"], 0)
        held[part["invariant"]][part["solver"]] = known + part["held"]
        claims[part["invariant"]] = part["claim"]
    solvers = sorted({part["solver"] for part in document["slices"]})
    rows = [
        (name, claims[name], *(counts.get(solver, 0) for solver in solvers)) for name, counts in held.items()
    ]
    return Exhibit(
        "Random examples of the invariants",
        (
            f"{document['examples']} examples by hypothesis, seed {document['seed']}, in "
            f"{document['processor_seconds']:.0f} s of processor time: "
            f"counter-examples: {document['counterexamples'] or 'none'}.",
        ),
        [Table("Examples that held.", ("invariant", "claim", *solvers), rows)],
    )
