"""Random mutants of every area, of which no test was written against one, and the reasons of survivors."""

from __future__ import annotations

from reports.exhibit import Cell, Document, Exhibit, Table

HEAD = (
    "area",
    "mutants",
    "noticed by its own tests",
    "lower bound",
    "and by others'",
)
UNEXPLAINED = "a test was written, or is wanting"


def build(document: Document) -> Exhibit:
    """Shares by area, and every mutant that the tests of its area did not notice."""
    rows = [_row("all", document["all"]), *(_row(one["area"], one) for one in document["areas"])]
    survivors = [
        (one["area"], one["file"], one["breaks"], one["outcome"], one["reason"] or UNEXPLAINED)
        for one in document["list"]
    ]
    return Exhibit(
        "Mutants of every area",
        (
            f"{document['all']['faults']} random mutants, as many of each area as time allowed, in an order "
            "every beginning of which is a fair sample of the area's modules. Beside the usual ones, arguments, columns "
            "and keys change places, and units are wrong. First each is judged by the doctests of its module and "
            "the tests of its area, as they were. Then those that are not noticed are judged by the tests of "
            "other areas that import the module, as they were too. Lower bounds are Clopper and "
            "Pearson's, at 95 %.",
        ),
        [
            Table("Noticed by area (per cent).", HEAD, rows),
            Table(
                "Not noticed by the area's own tests.",
                ("area", "file", "change", "by others", "reason"),
                survivors,
            ),
        ],
    )


def _row(name: str, part: Document) -> tuple[Cell, ...]:
    """Shares in per cent."""
    shares = (part[key] for key in ("first", "first_lower_bound", "now"))
    return (name, part["faults"], *(s if s is None else round(100 * s, 1) for s in shares))
