"""The committed studies of error bars: other scenes, and only numbers that were judged."""

from __future__ import annotations

from pathlib import Path

import pytest

from reports.result_files import read_result
from reports.studies import exhibit

RESULTS = Path(__file__).parents[2] / "reports" / "results"
TRAINED = range(1000, 1200)


def committed(name: str) -> dict:
    return read_result(RESULTS / f"{name}.json")


def test_the_scenes_never_looked_at_are_no_others() -> None:
    (seen, last), (first, end) = committed("coverage")["seeds"], committed("coverage_fresh")["seeds"]
    assert seen == 0
    assert last < first < end < TRAINED.start


@pytest.mark.parametrize("name", ["coverage", "coverage_fresh"])
def test_no_number_that_nothing_judges_is_shown(name: str) -> None:
    built = exhibit(name, committed(name))
    by_number, *_, beside = built.tables
    assert len(by_number.rows) == 8
    assert all(row[2] for row in beside.rows)
    assert any("at an approach" in row[0] for row in beside.rows) == (name == "coverage")
