"""Exhibits of the cross-code table and of the benchmarks: what is said of whom, from small made-up files."""

from __future__ import annotations

from typing import Any

import pytest

from reports.drawing import svg
from reports.exhibit import Exhibit, as_csv
from reports.studies import benchmarks, cross_code


def result(case: str, status: str, error: float | None) -> dict[str, Any]:
    return {"id": case, "status": status, "error": error, "tolerance": 0.1}


def entrant(name: str, *results: dict[str, Any]) -> dict[str, Any]:
    counts = {s: sum(r["status"] == s for r in results) for s in ("pass", "fail", "error", "unavailable")}
    return {
        "name": name,
        "version": f"{name} 1.0",
        "role": "peer",
        "setup": "its own",
        "installed": True,
        "counts": counts,
        "seconds": 1.5,
        "worst residual": 2e-9,
        "results": list(results),
    }


TABLE = {
    "cases": [
        {"id": "contestant/peak", "title": "Peak", "metric": "relative"},
        {"id": "contestant/order", "title": "Order", "metric": "at_least"},
        {"id": "contestant/shear", "title": "Shear", "metric": "relative"},
    ],
    "entrants": [
        entrant(
            "A",
            result("contestant/peak", "pass", 0.05),
            result("contestant/order", "fail", 0.05),
            result("contestant/shear", "unavailable", None),
        ),
        entrant(
            "B",
            result("contestant/peak", "fail", 0.3),
            result("contestant/order", "pass", 0.4),
            result("contestant/shear", "error", None),
        ),
        {"name": "C", "version": "C (not installed)", "installed": False},
    ],
}


def spread(value: float) -> dict[str, float]:
    return {"median": value, "least": 0.9 * value, "most": 1.1 * value}


def row(code: str, M: int, seconds: float) -> dict[str, Any]:
    return {
        "code": code,
        "kind": "smooth",
        "M": M,
        "failure": "",
        "seconds": spread(seconds),
        "peak memory": spread(1e8),
        "times one convolution": spread(40.0),
        "gap": 5e-9,
        "area": 6.3e-7,
        "peak": 1.66e8,
    }


def run(date: str, M: int, ours: float, theirs: float) -> dict[str, Any]:
    ratio = {"seconds": spread(theirs / ours), "processor seconds": spread(theirs / ours)}
    return {
        "provenance": {"date": date, "commit": "0123456789abcdef"},
        "conditions": {
            "rounds": 3,
            "threads": 2,
            "clock": "wall",
            "target": "gap of 1e-8",
            "versions": {"refimpl": "refimpl 1.0", "peer": "peer 2.0"},
            "load average": {"before": [0.1, 0.2, 0.3]},
        },
        "rows": [
            row("refimpl", M, ours),
            row("peer", M, theirs),
            {"code": "slow", "kind": "smooth", "M": M, "failure": "left out: 900 s expected"},
        ],
        "ratios": [
            {
                "kind": "smooth",
                "M": M,
                "peer": ratio,
                "fastest peer": {"code": "peer", "seconds over ours": theirs / ours},
            }
        ],
    }


RECORD = {"runs": [run("first", 128, 1.0, 2.0), run("second", 256, 2.0, 6.0), run("third", 128, 1.0, 4.0)]}
EXHIBITS = [cross_code.build(TABLE), benchmarks.build(RECORD)]


@pytest.mark.parametrize("exhibit", EXHIBITS, ids=["cross-code", "benchmarks"])
def test_tables_are_rectangular_and_figures_draw(exhibit: Exhibit) -> None:
    for table in exhibit.tables:
        assert table.rows
        assert {len(cells) for cells in table.rows} == {len(table.head)}
    for figure, data in exhibit.figures:
        drawn = svg(figure, data)
        assert drawn is not None
        assert drawn.rstrip().endswith("</svg>")
        assert as_csv(figure, data)


def test_verdicts_are_shares_of_the_tolerance() -> None:
    overview, verdicts = EXHIBITS[0].tables
    assert [list(cells[3:6]) for cells in overview.rows] == [["1 of 2", 1, 1], ["1 of 3", 2, 0]]
    assert [list(cells[2:]) for cells in verdicts.rows] == [
        ["pass, 0.5", "fail, 3"],
        ["fail, 2", "pass, 0.25"],  # a figure of merit: below its tolerance is a share above one
        ["not applicable", "error"],
    ]
    assert any("C (not installed)" in text for text in EXHIBITS[0].paragraphs)


def test_the_newest_run_of_a_code_counts_and_the_record_keeps_all() -> None:
    smooth, record = EXHIBITS[1].tables
    peers = [(cells[0], cells[4]) for cells in smooth.rows if cells[1] == "peer"]
    assert peers == [("128²", "4 (3.6 to 4.4)"), ("256²", "3 (2.7 to 3.3)")]
    assert {cells[-1] for cells in smooth.rows} == {"0123456789ab"}
    assert ("128²", "slow", "left out: 900 s expected") in [tuple(cells[:3]) for cells in smooth.rows]
    assert [(cells[0], cells[6], cells[7]) for cells in record.rows] == [
        ("first", "peer, 2", None),
        ("second", "peer, 3", None),
        ("third", "peer, 4", None),
    ]
