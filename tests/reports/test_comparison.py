"""What counts as a change between two runs, and what is noise."""

from __future__ import annotations

from typing import Any

import pytest

from reports.generator import render
from reports.results import compared
from tests.reports.sample import case, results

LARGE: dict[str, Any] = {"reference": 2e6, "tolerance": 0.1}
EXACT: dict[str, Any] = {"metric": "absolute", "reference": 5.0, "tolerance": 0.1}


@pytest.mark.parametrize(
    ("old", "new", "changed"),
    [
        # a thousandth of the tolerance, which is a share of the reference: 200 here, and 1e-4 there
        (LARGE | {"value": 2e6}, LARGE | {"value": 2e6 + 190}, False),
        (LARGE | {"value": 2e6}, LARGE | {"value": 2e6 - 210}, True),
        (EXACT | {"value": 5.0}, EXACT | {"value": 4.99985}, True),
        # where a reference is uncertain, by the larger of what the two runs say of it
        (EXACT | {"value": 5.0}, EXACT | {"value": 5.02, "reference_uncertainty": 0.03}, False),
        (EXACT | {"value": 5.0, "reference_uncertainty": 0.03}, EXACT | {"value": 5.02}, False),
        (EXACT | {"value": 5.0, "reference_uncertainty": 0.03}, EXACT | {"value": 5.04}, True),
    ],
)
def test_a_value_changes_beyond_what_is_uncertain_of_it(
    old: dict[str, Any], new: dict[str, Any], changed: bool
) -> None:
    found = compared(results(case("a/1", **old)), results(case("a/1", **new)))
    assert [change.kind for change in found] == (["value"] if changed else [])


@pytest.mark.parametrize(("old", "new"), [("pass", "fail"), ("error", "unavailable")])
def test_another_status_is_a_change_whatever_the_value(old: str, new: str) -> None:
    (change,) = compared(results(case("a/1", old)), results(case("a/1", new)))
    assert (change.kind, change.id) == ("status", "a/1")
    assert change.old is not None
    assert change.new is not None
    assert (change.old["status"], change.new["status"]) == (old, new)


def test_every_kind_of_change_is_on_the_page() -> None:
    old = results(case("a/1"), case("b/1"), case("c/1"), case("d/1"))
    new = results(case("a/1", value=1.01 + 1e-5), case("b/1", "fail"), case("c/1", value=1.05), case("e/1"))
    assert [(c.kind, c.id) for c in compared(old, new)] == [
        ("status", "b/1"),
        ("value", "c/1"),
        ("not run", "d/1"),
        ("new", "e/1"),
    ]
    assert "Changes against the older run" in render(new, {}, old)
    assert "No case changed" in render(new, {}, new)
