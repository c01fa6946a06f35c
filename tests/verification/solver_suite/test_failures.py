"""Failures by dimension name the dimensions of a fault."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from verification.framework.case import Result, Status
from verification.solver_suite import own
from verification.solver_suite.design import further_rows, rows
from verification.solver_suite.failures import by_dimension
from verification.solver_suite.suite import thorough

CASES = {check.id: check.case(own.solve) for check in thorough() if "/design-" in check.id}
ROWS: dict[str, dict[str, Any]] = {
    f"solver/design-{name}-{number:02}": row
    for name, design in (rows() | further_rows()).items()
    for number, row in enumerate(design, start=1)
}


def judged(fails: Callable[[dict[str, Any]], bool]) -> list[Result]:
    return [
        case.result(Status.FAIL if fails(ROWS[name]) else Status.PASS, "", 0.0)
        for name, case in CASES.items()
    ]


@pytest.mark.parametrize(
    ("first", "fails"),
    [
        ({"borders"}, lambda row: row["borders"] == "periodic"),
        ({"borders", "parity"}, lambda row: row["borders"] == "periodic" and row["elements"] % 2 == 0),
        ({"sector"}, lambda row: bool(row.get("beta")) and row["sector"] == 6),
    ],
)
def test_the_dimensions_of_a_fault_come_first(
    first: set[str], fails: Callable[[dict[str, Any]], bool]
) -> None:
    found = by_dimension(judged(fails))
    assert {*found} >= first
    assert {*list(found)[: len(first)]} == first


def test_the_levels_that_fail_are_counted() -> None:
    found = by_dimension(judged(lambda row: row.get("changed") == "edge"))
    number = sum(row.get("changed") == "edge" for row in ROWS.values())
    assert found["changed"] == {"edge": (number, number)}


@pytest.mark.parametrize("fails", [True, False])
def test_failures_everywhere_or_nowhere_tell_nothing(fails: bool) -> None:
    assert by_dimension(judged(lambda _: fails)) == {}
