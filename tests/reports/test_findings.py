"""Numbers of cases in sentences: values, steps into lists and tables, and readings of "less than 2 %"."""

from __future__ import annotations

import pytest

from reports.findings import MISSING, by_claim, filled, number
from tests.reports.sample import case

MADE = case(
    "a/1",
    value=-0.5,
    data={
        "x": [0.1, -3.0, None, 2.0],
        "numbers": {"mu": 0.25},
        "sure": True,
        "lower, self": [1.9, -1.9, -2.5],
        "upper, in line": [2.0, "n/a"],
        "across": [0.1],
        "elsewhere": [0.2],
    },
)


@pytest.mark.parametrize(
    ("key", "found"),
    [
        ("value", -0.5),
        ("x#max", 3.0),  # the largest magnitude
        ("x#1", -3.0),
        ("x#2", None),
        ("x#4", None),
        ("numbers#mu", 0.25),
        ("numbers#tau", None),
        ("sure", None),
        ("#readings", 6.0 - 1.0),  # numbers of the three lists
        ("#below 2", 3.0),  # 1.9, -1.9 and 0.1
    ],
)
def test_the_number_under_a_key(key: str, found: float | None) -> None:
    assert number(MADE, key) == found


def test_what_is_missing_in_a_sentence_is_not_available() -> None:
    text = "{a/1 | x#max | .1f} and {a/1 | y | .1f} of {b/1 | value | d}, {a/1 | #below 2 | d}"
    assert filled(text, {"a/1": MADE}) == f"3.0 and {MISSING} of {MISSING}, 3"


@pytest.mark.parametrize(("status", "value"), [("pass", 2.0), ("fail", 1.0)])
def test_a_long_case_stands_for_the_quick_one_where_it_passed(status: str, value: float) -> None:
    quick, long = case("b/1", value=1.0), case("b/1-full", status, value=2.0)
    for order in ([quick, long], [long, quick]):
        assert by_claim(order)["b/1"]["value"] == value
