"""Evidence that must not vanish or be flattered: unjudged cases, long cases, verdicts, columns of a CSV."""

from __future__ import annotations

from typing import Any

import pytest

from reports.comparison import compared
from reports.drawing import Figure, lines
from reports.evidence import gathered
from reports.exhibit import as_csv
from reports.results import ResultFileError, check, worst
from reports.revisions import revisions_of
from reports.summary import groups
from tests.reports.sample import case, results


def dated(date: str, *cases: dict[str, Any], **other: Any) -> dict[str, Any]:
    made = results(*cases, **other)
    made["provenance"]["date"] = date
    return made


@pytest.mark.parametrize("status", ["error", "unavailable"])
def test_committed_cases_that_were_not_judged_are_shown_as_such(status: str) -> None:
    """In all runs but one it was not judged; the newest of these stands where no run judged it."""
    older = dated("2001-01-01", case("a/1", status, note="older"), case("b/1", status))
    newer = dated("2002-01-01", case("a/1", status, note="newer"))
    found = gathered(results(case("c/1")), {"older": older, "newer": newer})
    assert {c["id"]: (c["status"], c["note"]) for c in found.cases} == {
        "a/1": (status, "newer"),
        "b/1": (status, ""),
        "c/1": ("pass", ""),
    }
    (group,) = groups(found)
    assert [c["id"] for c in group.not_passed] == ["a/1", "b/1"]
    assert group.counts == {"pass": 1, "fail": 0, "error": 0, "unavailable": 0} | {status: 2}


def test_the_origin_of_a_committed_case() -> None:
    found = gathered(results(case("c/1")), {"long": dated("2002-01-01", case("a/1"))})
    assert [c["origin"] for c in found.cases] == [
        None,
        {
            "file": "long.json",
            "date": "2002-01-01",
            "commit": "0123456789abcdef",
            "command": "rough-friction verify --tier quick",
        },
    ]


def test_runs_of_other_solvers_are_no_evidence() -> None:
    theirs = dated("2009-01-01", case("a/1", value=1.05), contestant={"name": "x"})
    ours = dated("2001-01-01", case("a/1", value=1.02))
    found = gathered(results(case("c/1")), {"theirs": theirs, "ours": ours})
    assert [c["value"] for c in found.cases if c["id"] == "a/1"] == [1.02]


@pytest.mark.parametrize(
    ("old", "new", "kinds"),
    [
        # a thousandth of the tolerance of 0.1 of the reference: 0.02 of 200
        ({"value": 201.0, "reference": 200.0}, {"value": 201.019, "reference": 200.0}, []),
        ({"value": 201.0, "reference": 200.0}, {"value": 201.021, "reference": 200.0}, ["value"]),
        # the larger of both uncertainties
        ({"value": 1.0, "reference_uncertainty": 0.05}, {"value": 1.04}, []),
        ({"value": 1.0}, {"value": 1.04, "reference_uncertainty": 0.05}, []),
        ({"value": 1.0}, {"value": 1.06, "reference_uncertainty": 0.05}, ["value"]),
    ],
)
def test_a_change_is_one_beyond_the_larger_uncertainty(old: Any, new: Any, kinds: list[str]) -> None:
    found = compared(results(case("a/1", **old)), results(case("a/1", **new)))
    assert [change.kind for change in found] == kinds


def test_what_decides_about_several_cases() -> None:
    order = ["error", "fail", "unavailable", "pass"]
    for k in range(4):
        assert worst([case(f"a/{j}", order[j]) for j in range(k, 4)]) == order[k]


@pytest.mark.parametrize(("uncertainty", "refused"), [(19.9, False), (20.1, True)])
def test_a_reference_is_as_certain_as_the_tolerance(uncertainty: float, refused: bool) -> None:
    """A tenth of 200."""
    made = results(case("a/1", value=201.0, reference=200.0, reference_uncertainty=uncertainty))
    if refused:
        with pytest.raises(ResultFileError, match="not that of its value"):
            check(made)
    else:
        check(made)


def test_a_csv_has_the_rows_of_its_longest_column() -> None:
    figure = Figure("*", ("h", "error", "more"), lines("h", {"error": "e"}, xlabel="", ylabel=""), "")
    found = as_csv(figure, {"h": [1, 2, 3], "error": [0.5], "more": {"a": 7, "b": [8, 9]}})
    assert found.splitlines() == ["h,error", "1,0.5", "2,", "3,", "more", "a,7", "b,8,9"]


def test_a_file_has_the_date_and_the_commit_of_its_newest_run() -> None:
    run, old, other = (dated(f"2001-01-0{day}", case(f"{day}/1")) for day in (1, 2, 3))
    other["provenance"]["dirty"] = True
    made = [{"provenance": {"date": f"2001-02-0{day}", "commit": None}} for day in (2, 3, 1)]
    rows = revisions_of(gathered(run, {"old": old, "other": other, "study": {"runs": made, "x": [1]}}))
    assert [(name, date) for name, date, _ in rows] == [
        ("this run", "2001-01-01"),
        ("old.json", "2001-01-02"),
        ("other.json", "2001-01-03"),
        ("study.json", "2001-02-03"),
    ]
    assert rows[2][2].endswith(" and uncommitted changes")
    assert rows[3][2] == "n/a"
