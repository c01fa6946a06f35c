"""The committed studies of error bars: other scenes, and only numbers that were judged."""

from __future__ import annotations

from typing import Any

import pytest

from reports.result_files import committed
from reports.studies import accuracy_costs, exhibit

TRAINED = range(1000, 1200)


def test_the_scenes_never_looked_at_are_no_others() -> None:
    (seen, last), (first, end) = committed("coverage")["seeds"], committed("coverage_fresh")["seeds"]
    assert seen == 0
    assert last < first < end < TRAINED.start


@pytest.mark.parametrize("name", ["coverage", "coverage_fresh"])
def test_no_number_that_nothing_judges_is_shown(name: str) -> None:
    built = exhibit(name, committed(name))
    by_number, *_ = built.tables
    assert len(by_number.rows) == 8
    assert all(row[2] for row in by_number.rows)


def test_costs_of_an_error_are_of_each_number() -> None:
    def price(quantity: str, error: float, M: int | None) -> dict[str, Any]:
        return {"quantity": quantity, "error": error, "M": M, "transforms of 256": 1.234}

    prices = [price("mu", 0.1, 64), price("mu", 0.01, 128), price("A", 0.01, None), price("A", 0.1, 96)]
    (table,) = accuracy_costs.build({"classes": [{"class": "smooth", "prices": prices}]}).tables
    assert table.head == ("class", "number", "10.0%", "1.0%")
    assert table.rows == [
        ("smooth", "mu", "64 (1.23)", "128 (1.23)"),
        ("smooth", "A", "96 (1.23)", "finer"),
    ]
