"""Runs gathered, the paper traced, runs compared: what stands where, and what must not hide."""

from __future__ import annotations

from fnmatch import fnmatchcase

import pytest

from reports.claims import NOT_ESTABLISHED, VERDICTS, judged, paper
from reports.comparison import compared
from reports.evidence import gathered
from reports.findings import fields
from reports.generator import render
from reports.parts import PARTS
from reports.result_files import read_results
from reports.results import ResultFileError
from reports.studies import exhibit
from reports.summary import groups
from tests.documents import ROOT
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
    for claim in paper():
        for pattern in claim.evidence:
            assert any(fnmatchcase(id, pattern) for id in known), (claim.label, pattern)
        for id, _ in fields(claim.finding):
            assert id in known or f"{id}-full" in known, (claim.label, id)


def test_no_claim_holds_on_missing_or_failed_evidence() -> None:
    rows = {row.claim.label: row for row in judged([case("balance/normal-force", "fail")], [])}
    assert rows["Eq. (5)"].verdict == NOT_ESTABLISHED
    assert rows["Table 3: mu"].verdict == NOT_ESTABLISHED
    assert rows["Figs 1 and 2"].verdict == "schematic"


def test_the_least_favourable_verdict_counts_and_long_cases_replace_quick_ones() -> None:
    quick = case("reproduction/eq10", data={"verdict": "confirmed"})
    long = case("reproduction/eq10-full", data={"verdict": "not confirmed"})
    row = next(r for r in judged([quick, long], []) if r.claim.label == "Eq. (10)")
    assert [c["id"] for c in row.cases] == ["reproduction/eq10-full"]
    assert row.verdict == "not confirmed"


def test_a_verdict_of_the_matrix_is_not_milder_than_its_cases() -> None:
    documents = read_results(ROOT / "reports/results")
    evidence = gathered(documents["quick"], {k: v for k, v in documents.items() if k != "quick"})
    for row in judged(evidence.cases, evidence.errata):
        assert row.verdict == row.claim.verdict, row.claim.label
        assert "n/a" not in row.finding, row.claim.label
        assert row.finding, row.claim.label


def test_the_matrix_has_known_verdicts_and_parts_and_one_row_a_label() -> None:
    claims = paper()
    assert {claim.verdict for claim in claims} <= set(VERDICTS[1:])
    assert {claim.part for claim in claims} <= {part.name for part in PARTS} | {""}
    labels = [claim.label for claim in claims]
    assert len(labels) == len(set(labels))


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
        found = judged([case("reproduction/eq10"), case("reproduction/eq10-full", status)], [])
        row = next(row for row in found if row.claim.label == "Eq. (10)")
        assert [c["id"] for c in row.cases] == ["reproduction/eq10", "reproduction/eq10-full"]
        assert row.verdict == NOT_ESTABLISHED


def test_an_unknown_study_is_shown_by_its_numbers() -> None:
    shown = exhibit("something_new", {"score": 0.5, "rows": [1, 2]})
    assert shown.title == "Something new"
    assert list(shown.tables[0].rows) == [("score", 0.5)]


def test_a_study_without_its_numbers_is_refused() -> None:
    with pytest.raises(ResultFileError, match="hypothesis"):
        exhibit("hypothesis", {})
