"""Rows of the studies' tables, column by column, of records with something else in each place."""

from __future__ import annotations

from typing import Any

import pytest

from reports.studies import exhibit


class Names(dict[str, Any]):
    """A record whose entries are their own names, but for those that are given."""

    def __missing__(self, key: str) -> str:
        return key


FOUND = {"scenes": 9, "met": 0.91, "covered": 0.82, "covered_at_worst": 0.73, "median_bar_over_error": 2.345,
         "median_cost": 1.234, "cost_at_most_2": 0.64, "median_bar": 0.056}  # fmt: skip
NONE = {"scenes": 0}
JUDGED = {"accuracy": 0.02, "numbers": {"contact_area": FOUND}, "verdicts": {},
          "classes": {"flat": {"a": FOUND, "b": NONE}}}  # fmt: skip
COVERAGE = Names(accuracies=[JUDGED], seeds=[3, 12], reference_check={"seeds": []},
                 solves={"count": 55, "seconds": 600, "worst_residual": 2e-9,
                         "worst_apart": 3e-7})  # fmt: skip
BARS = Names(held=0.951, held_at_worst=0.902, usable=0.83, held_of_usable=None, p=0.0123)
BARS["median_bar_over_error"] = None
OTHERS = BARS | {"class": None, "number": None, "scenes": 7, "held_of_usable": 0.8}
OTHERS["median_bar_over_error"] = 3.456
OFFERS = [{"quantity": "mu", "error": 0.001, "M": None}]
OFFERS += [{"quantity": "mu", "error": 0.02, "M": 48, "transforms of 256": 1.2345}]
STATES = [("load", "fft", "right", d) for d in (12, 3, 7)] + [("load", "fft", "wrong", 5)]
STATES += [("load", "dense", "honest failure", 1), ("scale", "fft", "crash", 1)]
EXTREMES = Names(
    states=[{"axis": a, "series": f"s, {s}", "verdict": v, "digits": d} for a, s, v, d in STATES],
    counts=Names(), table=[Names()], limits=[Names()], conditioning={},
    precision={"arithmetic": ["f4"], "digits lost": {"N": [6.5]}, "cause": {"N": "sum"}, "cure": {"N": ""}},
)  # fmt: skip
EXTREMES["lawful states"] = [Names(statuses={"fft": {"converged": 5, "cycle": 3, "stuck": 4}})]
ROWS: list[tuple[str, Any, int, list[Any]]] = [
    ("accuracy_costs", {"classes": [Names(prices=OFFERS)]}, 0, [("class", "mu", "48 (1.23)", "finer")]),
    ("coverage", COVERAGE, 0, [("A", 0.02, 9, 91.0, 82.0, 73.0, 2.35, 1.23, 64.0)]),
    ("coverage", COVERAGE, 1, [("flat", 82.0, None)]),
    ("coverage_classes", {"table": [BARS, OTHERS]}, 0,
     [("class", "number", "scenes", "95.1%", "90.2%", "83%", "none", "0.012", "unbounded"),
      ("all", "all", 7, "95.1%", "90.2%", "83%", "80.0%", "0.012", "3.46")]),
    ("extremes", EXTREMES, 0, [("load", 5, 3, 1, 1, 0, 3, 7), ("scale", 1, 0, 0, 0, 1, None, None)]),
    ("extremes", EXTREMES, 3, [("N", 6.5, "sum", "it is this code's form")]),
]  # fmt: skip


@pytest.mark.parametrize(("study", "document", "table", "rows"), ROWS)
def test_each_number_has_its_column(study: str, document: Any, table: int, rows: list[Any]) -> None:
    assert [tuple(row) for row in exhibit(study, document).tables[table].rows] == rows


def test_series_of_figures() -> None:
    """Digits of the production solver alone."""
    (_, kept), _, (_, states), _ = exhibit("extremes", EXTREMES).figures
    assert kept == {"digits kept": {"load: s": [12, 3, 7, "wrong"]}}
    assert [*states.values()] == [["tau"], ["none"], ["one"], ["several"], [7]]
