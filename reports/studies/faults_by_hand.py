"""Meaningful faults, invented by reading the source: the share that tests notice, by area."""

from __future__ import annotations

from reports.exhibit import Cell, Document, Exhibit, Table

HEAD = ("area", "faults", "judged at first", "noticed at first", "lower bound", "noticed now")


def build(document: Document) -> Exhibit:
    """Shares by area, and the faults that were not noticed from the first."""
    rows = [_row("all", document["all"]), *(_row(one["area"], one) for one in document["areas"])]
    faults = [
        (one["area"], one["file"], one["breaks"], one["first"], one["outcome"]) for one in document["list"]
    ]
    return Exhibit(
        "Meaningful faults",
        (
            f"{document['all']['faults']} faults - a sign, a swapped column, a lost row, a wrong unit - were "
            "drawn up from the source before the tests were looked at. Each is judged by the doctests of its "
            "module, the tests that import it and those of its area; tests of other areas, which may notice "
            "it as well, are not run. Lower bounds are Clopper and Pearson's, at 95 %.",
            "At first means by the tests as they were; now, after tests of the same kind were written. Some "
            "faults were not judged at first: they count now alone.",
        ),
        [
            Table("Noticed by area (per cent).", HEAD, rows),
            Table(
                "Faults that were not noticed at first, or not judged then.",
                ("area", "file", "effect", "at first", "now"),
                faults,
            ),
        ],
    )


def _row(name: str, part: Document) -> tuple[Cell, ...]:
    """Shares in per cent."""
    shares = (part[key] for key in ("first", "first_lower_bound", "now"))
    return (name, part["faults"], part["judged"], *(s if s is None else round(100 * s, 1) for s in shares))
