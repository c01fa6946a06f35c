"""Tables and figures of the studies, from small documents made up here: what is shown of what."""

from __future__ import annotations

from typing import Any

import pytest

from reports.generator import render
from reports.results import ResultFileError
from reports.studies import exhibit
from reports.studies.experiments import sentences
from tests.reports.sample import case, results


class Names(dict[str, Any]):
    """A record whose entries are their own names, but for those that are given."""

    def __missing__(self, key: str) -> str:
        return key


BARS = Names(held=0.951, held_at_worst=0.902, usable=0.83, held_of_usable=None, p=0.0123,
             median_bar_over_error=None)  # fmt: skip
OTHERS = BARS | {"class": None, "number": None, "scenes": 7, "held_of_usable": 0.8,
                 "median_bar_over_error": 3.456}  # fmt: skip
STATES = [("load", "fft", "right", d) for d in (12, 3, 7)] + [("load", "fft", "wrong", 5)]
STATES += [("load", "dense", "detected failure", 1), ("scale", "fft", "crash", 1)]
EXTREMES = Names(
    states=[
        {"axis": a, "series": f"s, {s}", "verdict": v, "digits": d, "oracle": "x"} for a, s, v, d in STATES
    ],
    counts=Names(), table=[Names()], limits=[Names()],
    conditioning={"M": [2], "condition": [3.5], "CG iterations": [4], "digits lost by a direct solve": [0.5]},
)  # fmt: skip
EXTREMES["lawful states"] = [Names(statuses={"fft": {"converged": 5, "cycle": 3, "stuck": 4}})]
POINTS = [
    {
        "at": at,
        "measured": 40.0,
        "measured_half_width": 2.0,
        "predicted": s,
        "numerical": 0.01,
        "input": 3.0,
        "error": s - 40.0,
        "uncertainty": 3.6,
        "within": s < 50,
    }
    for at, s in ((0.5, 41.23), ("r", 99.0))
]
EXPERIMENTS = [
    Names(title="Ball on Si", unit="nm", over="load", trend_only=True, failure="wear", points=POINTS)
]


def entrant(name: str, *found: tuple[str, float | None]) -> dict[str, Any]:
    rows = [
        {"id": one["id"], "status": status, "error": error, "tolerance": 0.1}
        for one, (status, error) in zip(SUITE, found, strict=True)
    ]
    statuses = [row["status"] for row in rows]
    counts = {status: statuses.count(status) for status in ("pass", "fail", "error", "unavailable")}
    return Names(name=name, installed=True, counts=counts, results=rows)


SUITE = [{"id": f"solver/{slug}", "title": slug.title(), "metric": metric} for slug, metric in
         (("peak", "relative"), ("order", "at_least"), ("shear", "relative"))]  # fmt: skip
CODES = {
    "cases": SUITE,
    "entrants": [
        entrant("A", ("pass", 0.05), ("fail", 0.05), ("unavailable", None)),
        entrant("B", ("fail", 0.3), ("pass", 0.4), ("error", None)),
        {"name": "C", "version": "C (not installed)", "installed": False},
    ],
}


DOCUMENTS: dict[str, Any] = {
    "coverage_corrected": {"table": [BARS, OTHERS]},
    "cross_code": CODES,
    "experiments": {"experiments": EXPERIMENTS},
    "extremes": EXTREMES,
}
ROWS: list[tuple[str, int, list[Any]]] = [
    ("coverage_corrected", 0,
     [("class", "number", "scenes", "95.1%", "90.2%", "83%", "none", "0.012", "unbounded"),
      ("all", "all", 7, "95.1%", "90.2%", "83%", "80.0%", "0.012", "3.46")]),
    ("cross_code", 0,
     [("A", "version", "role", "1 of 2", 1, 1, "seconds", "worst residual", "setup"),
      ("B", "version", "role", "1 of 3", 2, 0, "seconds", "worst residual", "setup")]),
    ("cross_code", 1,  # a figure of merit below its tolerance is a share above one
     [("peak", "Peak", "pass, 0.5", "fail, 3"), ("order", "Order", "fail, 2", "pass, 0.25"),
      ("shear", "Shear", "not applicable", "error")]),
    ("experiments", 0,
     [(0.5, "40.0 ± 2.0", "41.2", "0.01", "3", "+1.2", "3.6", True),
      ("r", "40.0 ± 2.0", "99.0", "0.01", "3", "+59.0", "3.6", False)]),
    ("extremes", 0, [("load", 5, 3, 1, 1, 0, 3, 7), ("scale", 1, 0, 0, 0, 1, None, None)]),
]  # fmt: skip


@pytest.mark.parametrize(("study", "table", "rows"), ROWS)
def test_each_number_has_its_column(study: str, table: int, rows: list[Any]) -> None:
    assert [tuple(row) for row in exhibit(study, DOCUMENTS[study]).tables[table].rows] == rows


@pytest.mark.parametrize("study", sorted(DOCUMENTS))
def test_a_study_without_its_numbers_is_refused(study: str) -> None:
    with pytest.raises(ResultFileError, match=study):
        exhibit(study, {})


@pytest.mark.parametrize("found", [{"provenance": {}}, {"provenance": 1.5}, {"counts": True}])
def test_a_study_that_the_first_page_cannot_show_is_refused(found: dict[str, Any]) -> None:
    with pytest.raises(ResultFileError, match="study"):
        render(results(case("a/1")), {"extremes": EXTREMES | found})


def test_the_first_page_says_where_the_model_fails() -> None:
    said = sentences({"experiments": EXPERIMENTS})
    assert said == [
        "1 experiments: ball on Si",
        "1 of 2 points lie within U_val, 1 with a parameter fitted to the same experiment",
        "The model fails for ball on Si (wear)",
    ]
