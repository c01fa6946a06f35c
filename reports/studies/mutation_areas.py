"""Random mutants of every area, of which no test was written against one, and the reasons of survivors."""

from __future__ import annotations

from reports.exhibit import Cell, Document, Exhibit, Table

HEAD = ("area", "mutants", "noticed at first by its own tests", "lower bound", "noticed today")


def build(document: Document) -> Exhibit:
    """Shares by area, and every mutant that the tests of its area did not notice."""
    rows = [_row("all", document["all"]), *(_row(one["area"], one) for one in document["areas"])]
    survivors = [
        (one["area"], one["file"], one["breaks"], one["outcome"], one["reason"] or _test(one))
        for one in document["list"]
    ]
    return Exhibit(
        "Mutants of every area",
        (
            f"{document['all']['faults']} random mutants, as many of each area as time allowed, in an order "
            "every beginning of which is a fair sample of the area. Beside the usual changes, arguments, "
            "columns and keys change places, and units are wrong. First each is judged by the doctests of "
            "its module and the tests of its area, as they were. Trials under way at a stop count "
            "for nothing; they are long, so more of them than of others would not have been noticed.",
            "Those that were not noticed are judged by today's tests, of other areas or written since. Lower "
            "bounds are Clopper and Pearson's (95 %).",
        ),
        [
            Table("Noticed by area (per cent).", HEAD, rows),
            Table(
                "Not noticed by the area's own tests.",
                ("area", "file", "change", "today", "reason"),
                survivors,
            ),
        ],
    )


def _row(name: str, part: Document) -> tuple[Cell, ...]:
    """Shares in per cent."""
    shares = (part[key] for key in ("first", "first_lower_bound", "now"))
    return (name, part["faults"], *(s if s is None else round(100 * s, 1) for s in shares))


def _test(mutant: Document) -> str:
    """The file of the test that notices a mutant today."""
    return str(mutant["test"] or "a test is wanting").partition("::")[0]
