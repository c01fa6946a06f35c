"""Runs gathered and the paper traced: what stands where, and what must not hide or be flattered."""

from __future__ import annotations

from fnmatch import fnmatchcase

import pytest

from reports.agreement import SINGLE, TABLE3
from reports.claims import NOT_ESTABLISHED, VERDICTS, judged, of_the_conversion, paper, parts
from reports.evidence import gathered, groups
from reports.findings import fields
from tests.documents import ROOT
from tests.reports.sample import case, results
from verification.cases.paper import section8
from verification.framework.registry import load
from verification.output.result_files import read_results


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
    command = "rough-friction verify --tier quick"
    origin = {"file": "newer.json", "date": "2002-01-01", "commit": "0123456789abcdef", "command": command}
    assert [c["origin"] for c in found.cases if c["id"] == "b/1"] == [origin]
    assert [group.counts["pass"] for group in groups(found)] == [3]
    assert list(found.studies) == ["study"]


def test_every_pattern_of_the_paper_finds_a_case() -> None:
    known = [c.id for c in load()]
    for claim in paper():
        for pattern in claim.evidence:
            assert any(fnmatchcase(id, pattern) for id in known), (claim.label, pattern)
        for id, _ in fields(claim.finding):
            assert id.startswith("numbers/") or id in known or f"{id}-full" in known, (claim.label, id)


def test_the_plotting_accuracy_of_a_claim_is_that_of_its_case() -> None:
    (claim,) = (claim for claim in paper() if claim.label == "Fig. 8(a): exponential")
    assert [text.partition(" < ")[2] for text in claim.holds] == [str(section8.PLOTTING)]
    assert f"plotting accuracy, {100 * section8.PLOTTING:g} % of the fall" in claim.condition


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


def test_every_row_of_the_committed_results_has_a_verdict_and_a_finding() -> None:
    documents = read_results(ROOT / "reports/results")
    evidence = gathered(documents["quick"], {k: v for k, v in documents.items() if k != "quick"})
    for row in judged(evidence.cases, evidence.errata):
        assert row.verdict == (row.claim.verdict or row.verdict), row.claim.label
        assert row.claim.verdict == NOT_ESTABLISHED or row.verdict != NOT_ESTABLISHED, row.claim.label
        assert "n/a" not in row.finding, row.claim.label
        assert row.finding, row.claim.label
        assert row.verdict != "confirmed with conditions" or row.claim.condition, row.claim.label


def test_the_matrix_has_known_verdicts_and_parts_and_one_row_a_label() -> None:
    claims = paper()
    assert {claim.verdict for claim in claims if claim.evidence} <= {"", *VERDICTS}
    printed = {place for c in claims if c.verdict == "print or conversion" for place in c.corrected}
    assert printed == of_the_conversion()
    known = {row[1] for row in SINGLE} | {row[1] for row in TABLE3}
    assert {quantity for claim in claims for quantity in claim.numbers} <= known
    assert {claim.part for claim in claims} <= {part.name for part in parts()} | {""}
    labels = [claim.label for claim in claims]
    assert len(labels) == len(set(labels))


def test_a_long_case_that_did_not_pass_stands_beside_the_quick_one() -> None:
    for status in ("fail", "unavailable"):
        found = judged([case("reproduction/eq10"), case("reproduction/eq10-full", status)], [])
        row = next(row for row in found if row.claim.label == "Eq. (10)")
        assert [c["id"] for c in row.cases] == ["reproduction/eq10", "reproduction/eq10-full"]
        assert row.verdict == NOT_ESTABLISHED


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
