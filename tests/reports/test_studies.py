"""Tables and figures of the studies, from small documents made up here: what is shown of what."""

from __future__ import annotations

import re
from typing import Any

import pytest

from reports.drawing import svg
from reports.exhibit import as_csv
from reports.generator import render
from reports.results import ResultFileError
from reports.studies import exhibit
from reports.studies.experiments import sentences
from reports.studies.extremes import sentence
from tests.reports.sample import case, results


class Names(dict[str, Any]):
    """A record whose entries are their own names, but for those that are given."""

    def __missing__(self, key: str) -> str:
        return key


BARS = Names(held=0.951, held_at_worst=0.902, usable=0.83, held_of_usable=None, p=0.0123,
             median_bar_over_error=None)  # fmt: skip
OTHERS = BARS | {"class": None, "number": None, "scenes": 7, "held_of_usable": 0.8,
                 "median_bar_over_error": 3.456}  # fmt: skip
OFFERS = [{"quantity": "mu", "error": 0.001, "M": None},
          {"quantity": "mu", "error": 0.02, "M": 48, "transforms of 256": 1.2345}]  # fmt: skip
STATES = [("load", "fft", "right", d) for d in (12, 3, 7)] + [("load", "fft", "wrong", 5)]
STATES += [("load", "dense", "detected failure", 1), ("scale", "fft", "crash", 1)]
EXTREMES = Names(
    states=[
        {"axis": a, "series": f"s, {s}", "verdict": v, "digits": d, "oracle": "x"} for a, s, v, d in STATES
    ],
    counts=Names(), table=[Names()], limits=[Names(), Names(rule="", states=["a", "b"])],
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
SLICES = [
    {"invariant": "turn", "solver": s, "held": n, "claim": "alike"} for s, n in (("a", 2), ("b", 3), ("a", 4))
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


def spread(value: float) -> dict[str, float]:
    return {"median": value, "least": 0.9 * value, "most": 1.1 * value}


def timed(code: str, M: int, seconds: float) -> dict[str, Any]:
    return {"code": code, "kind": "smooth", "M": M, "failure": "", "seconds": spread(seconds),
            "peak memory": spread(1e8), "gap": 5e-9, "area": 6.3e-7,
            "peak": 1.66e8}  # fmt: skip


def run(M: int, ours: float, theirs: float) -> dict[str, Any]:
    ratio = {"seconds": spread(theirs / ours), "processor seconds": spread(theirs / ours)}
    slow = {"code": "slow", "kind": "smooth", "M": M, "failure": "left out: 900 s expected"}
    return {
        "provenance": {"date": "2001-01-01", "commit": "0123456789abcdef"},
        "conditions": Names(
            {"load average": {"before": [4.4]}}, rounds=3, threads=2, versions={"refimpl": "refimpl 1.0"}
        ),
        "rows": [timed("refimpl", M, ours), timed("peer", M, theirs), slow],
        "ratios": [{"kind": "smooth", "M": M, "peer": ratio}],
    }


BENCHMARKS = {"runs": [run(128, 1.0, 2.0), run(256, 2.0, 6.0), run(128, 1.0, 4.0)]}
DOCUMENTS: dict[str, Any] = {
    "accuracy_costs": {"classes": [Names(prices=OFFERS)]},
    "benchmarks": BENCHMARKS,
    "coverage_corrected": {"table": [BARS, OTHERS]},
    "cross_code": CODES,
    "experiments": {"experiments": EXPERIMENTS},
    "extremes": EXTREMES,
    "hypothesis": Names(slices=SLICES, processor_seconds=1),
}
ROWS: list[tuple[str, int, list[Any]]] = [
    ("accuracy_costs", 0, [("class", "mu", "48 (1.23)", "finer")]),
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
    ("extremes", 0, [("load", 5, 3, 1, 0, 1, 0, 3, 7), ("scale", 1, 0, 0, 0, 0, 1, None, None)]),
    ("extremes", 2, [("kind", "what", "why", "evidence", states) for states in ("rule", "a, b")]),
    ("extremes", 3, [("tau", "none", "one", "several", 7)]),
    ("extremes", 4, [(2, 3.5, 4, 0.5)]),
    ("hypothesis", 0, [("turn", "alike", 6, 3)]),
]  # fmt: skip


@pytest.mark.parametrize(("study", "table", "rows"), ROWS)
def test_each_number_has_its_column(study: str, table: int, rows: list[Any]) -> None:
    assert [tuple(row) for row in exhibit(study, DOCUMENTS[study]).tables[table].rows] == rows


@pytest.mark.parametrize("study", sorted(DOCUMENTS))
def test_tables_are_rectangular_and_figures_draw(study: str) -> None:
    built = exhibit(study, DOCUMENTS[study])
    for table in built.tables:
        assert {len(cells) for cells in table.rows} == {len(table.head)}
    for figure, data in built.figures:
        if figure.available(data):
            assert "</svg>" in (svg(figure, data) or "")
            assert as_csv(figure, data)


@pytest.mark.parametrize("study", sorted(DOCUMENTS))
def test_a_study_without_its_numbers_is_refused(study: str) -> None:
    with pytest.raises(ResultFileError, match=study):
        exhibit(study, {})


@pytest.mark.parametrize("found", [{"provenance": {}}, {"provenance": 1.5}, {"counts": True}])
def test_a_study_that_the_first_page_cannot_show_is_refused(found: dict[str, Any]) -> None:
    with pytest.raises(ResultFileError, match="study"):
        render(results(case("a/1")), {"extremes": EXTREMES | found})


def test_the_newest_run_of_a_code_counts() -> None:
    (smooth,) = exhibit("benchmarks", BENCHMARKS).tables
    peers = [(cells[0], cells[4], cells[-2]) for cells in smooth.rows if cells[1] == "peer"]
    assert peers == [("128²", "4 (3.6 to 4.4)", "3, 2, 4"), ("256²", "3 (2.7 to 3.3)", "3, 2, 4")]
    assert {cells[-1] for cells in smooth.rows} == {"0123456789ab"}
    assert ("128²", "slow", "left out: 900 s expected") in [tuple(cells[:3]) for cells in smooth.rows]


def test_codes_that_are_not_there_are_named() -> None:
    assert any("C (not installed)" in text for text in exhibit("cross_code", CODES).paragraphs)


def test_results_of_few_digits_and_second_solves_are_reported_apart() -> None:
    judges = [("Hertz", 3.1), ("Hertz", 12.0), ("the scaling law", 17.0), ("the dense solver", 0.05)]
    states = [{"verdict": "right", "oracle": oracle, "digits": digits} for oracle, digits in judges]
    counts = {"wrong": 0, "crash": 0, "detected failure": 0, "unjudged": 5}
    said = sentence({"states": states, "counts": counts})
    assert "5 not judged, 4 right, 2 of them to fewer than 6 digits, the least 0.1; 2 of the right" in said


def test_the_first_page_says_where_the_model_fails() -> None:
    said = sentences({"experiments": EXPERIMENTS})
    assert said == [
        "1 experiments: ball on Si",
        "1 of 2 points lie within U_val, 1 with a parameter fitted to the same experiment",
        "The model fails for ball on Si (wear)",
    ]


TABLE = re.compile(
    r'<table class="(?:sortable)?(?: short)?( wide)?">\s*<caption[^>]*>[^<]*</caption>'
    r"\s*<thead><tr>(.*?)</tr>",
    flags=re.S,
)


def test_tables_of_more_than_eight_columns_are_set_small_on_paper() -> None:
    """There nothing scrolls: the last columns would be cut off."""
    page = render(results(case("a/1")), {"benchmarks": BENCHMARKS})
    columns = [(head.count("<th"), bool(wide)) for wide, head in TABLE.findall(page)]
    assert (13, True) in columns
    assert all(wide is (count > 8) for count, wide in columns)
    paper = page.partition("@media print")[2].partition("\n}")[0]
    assert ".wide { font-size" in paper
    assert "th { white-space: normal; }" in paper
