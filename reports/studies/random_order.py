"""The whole test suite in random orders, with other random examples each time."""

from __future__ import annotations

from reports.exhibit import Document, Exhibit, Table

HEAD = ("seed", "share (per cent)", "tests", "failed", "skipped", "processor time (s)", "commit")


def build(document: Document) -> Exhibit:
    """A row for each run: its seed, tests and failures."""
    rows = [
        (
            run["seed"],
            round(100 * run.get("share", 1)),
            run["tests"],
            sum(end != "skipped" for end in run["not_passed"].values()),
            sum(end == "skipped" for end in run["not_passed"].values()),
            run["processor_seconds"],
            run["provenance"]["commit"],
        )
        for run in document["runs"]
    ]
    ends = [end for run in document["runs"] for end in run["not_passed"].items()]
    skipped = sorted({name.partition("::")[0] for name, end in ends if end == "skipped"}) or ["nothing"]
    verdict = "No test flips" if document["no_test_flips"] else "Some test flips"
    return Exhibit(
        "Random order",
        (
            f"{verdict} in {len(rows)} runs with files and tests shuffled, and every search of random "
            "examples seeded by the run's seed; a share of the tests is drawn for each. All that is skipped "
            f"is of {', '.join(skipped)}.",
        ),
        [Table("Runs.", HEAD, rows)],
    )
