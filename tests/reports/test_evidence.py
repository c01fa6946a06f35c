"""Runs gathered, the paper traced, runs compared: what stands where, and what must not hide."""

from __future__ import annotations

from fnmatch import fnmatchcase

import pytest

from reports.comparison import compared
from reports.evidence import gathered
from reports.generator import render
from reports.results import ResultFileError
from reports.studies import exhibit
from reports.summary import groups
from reports.traceability import paper, traced
from tests.reports.sample import ERRATUM, case, results
from verification.framework.registry import load


def dated(date: str, *cases: dict, **other: object) -> dict:
    made = results(*cases, **other)
    made["provenance"]["date"] = date
    return made


def test_the_run_outweighs_committed_runs_and_the_newest_judged_of_those_counts() -> None:
    older = dated("2001-01-01", case("a/1", value=1.0), case("b/1", value=1.0), case("c/1", value=1.0))
    newer = dated("2002-01-01", case("b/1", value=1.02), case("c/1", "error"))
    found = gathered(results(case("a/1", value=1.09)), {"older": older, "newer": newer, "study": {"x": 1}})
    values = {c["id"]: (c["value"], c["origin"] and c["origin"]["file"]) for c in found.cases}
    assert values == {"a/1": (1.09, None), "b/1": (1.02, "newer.json"), "c/1": (1.0, "older.json")}
    assert [group.counts["pass"] for group in groups(found)] == [3]
    assert list(found.studies) == ["study"]


def test_names_of_earlier_versions_are_read_as_those_of_today() -> None:
    old = {"obliqueness": {"left out": [1]}, "bar": {"2031: 1 withheld": 0.5}}
    run, committed = (results(case(id, data=old)) for id in ("a/1", "b/1"))
    for found in gathered(run, {"file": committed}).cases:
        assert found["data"] == {"slope terms": {"neglected": [1]}, "bar": {"2031: 1 excluded": 0.5}}


def test_errata_of_committed_runs_count_the_newest_of_each() -> None:
    def with_erratum(date: str, **named: str) -> dict:
        return dated(date, case(f"{date}/1"), errata=[{**ERRATUM, **named}])

    run = with_erratum("2000-01-01", equation="A1", printed="in this run")
    older = with_erratum("2001-01-01", equation="A4", printed="older")
    newer = with_erratum("2002-01-01", equation="A4", printed="newer")
    again = with_erratum("2003-01-01", equation="A1", printed="in another run")
    found = gathered(run, {"older": older, "newer": newer, "again": again})
    assert {e["equation"]: e["printed"] for e in found.errata} == {"A1": "in this run", "A4": "newer"}


def test_a_broken_committed_run_is_refused() -> None:
    with pytest.raises(ResultFileError):
        gathered(results(case("a/1")), {"x": {"format": results()["format"]}})


def test_every_pattern_of_the_paper_finds_a_case() -> None:
    known = [c.id for c in load()]
    for item in paper():
        for pattern in item.evidence:
            assert any(fnmatchcase(id, pattern) for id in known), (item.label, pattern)


def test_no_item_passes_on_missing_or_failed_evidence() -> None:
    rows = {row.item.label: row for row in traced([case("balance/normal-force", "fail")], [])}
    assert rows["Eqs (2), (3)"].verdict == "not established"
    assert rows["Table 3"].status == "unavailable"
    assert rows["Table 3"].verdict == "not established"


def test_the_least_favourable_verdict_counts_and_long_cases_replace_quick_ones() -> None:
    quick = case("reproduction/eq11", data={"verdict": "confirmed"})
    long = case("reproduction/eq11-full", data={"verdict": "refuted"})
    row = next(
        r for r in traced([quick, long], [{**ERRATUM, "equation": "(11)"}]) if r.item.label == "Eq. (11)"
    )
    assert [c["id"] for c in row.cases] == ["reproduction/eq11-full"]
    assert row.verdict == "refuted; print corrected"


def test_changes_beyond_uncertainty_only() -> None:
    old = results(case("a/1"), case("b/1"), case("c/1"), case("d/1"))
    new = results(case("a/1", value=1.01 + 1e-5), case("b/1", "fail"), case("c/1", value=1.05), case("e/1"))
    assert [(c.kind, c.id) for c in compared(old, new)] == [
        ("status", "b/1"),
        ("value", "c/1"),
        ("not run", "d/1"),
        ("new", "e/1"),
    ]
    page = render(new, {}, old)
    assert "Changes against the older run" in page
    assert "No case changed" in render(new, {}, new)


def test_a_long_case_that_did_not_pass_stands_beside_the_quick_one() -> None:
    for status in ("fail", "error", "unavailable"):
        found = traced([case("reproduction/eq11"), case("reproduction/eq11-full", status)], [])
        row = next(row for row in found if row.item.label == "Eq. (11)")
        assert [c["id"] for c in row.cases] == ["reproduction/eq11", "reproduction/eq11-full"]
        assert row.status == status
        assert row.verdict == "not established"


def test_without_a_verdict_an_erratum_corrects_and_no_more() -> None:
    (row,) = (
        r
        for r in traced([case("reproduction/eq11")], [{**ERRATUM, "equation": "(11)"}])
        if r.item.label == "Eq. (11)"
    )
    assert row.verdict == "corrected"


def test_an_unknown_study_is_shown_by_its_numbers() -> None:
    shown = exhibit("something_new", {"score": 0.5, "rows": [1, 2]})
    assert shown.title == "Something new"
    assert list(shown.tables[0].rows) == [("score", 0.5)]


def test_a_study_without_its_numbers_is_refused() -> None:
    with pytest.raises(ResultFileError, match="hypothesis"):
        exhibit("hypothesis", {})
