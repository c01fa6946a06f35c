"""Result files of another version, and forged ones: the first page says what they state otherwise."""

from __future__ import annotations

from datetime import UTC, datetime

from reports.evidence import departures, gathered
from reports.generator import render
from tests.reports.sample import case, results

NOW = datetime(2001, 1, 3, tzinfo=UTC)
OWN = {"claim": "Eq. (7) holds", "metric": "relative", "tolerance": 0.1, "tier": "quick"}
REGISTERED = {"a/1": OWN, "a/2": OWN, "a/3": OWN, "a/4": {**OWN, "tier": "full"}}


def found(*cases: dict[str, object], committed: dict[str, dict[str, object]], **other: object) -> list[str]:
    return departures(gathered(results(*cases, **other), committed), REGISTERED, "0123".__lt__, NOW)


def test_a_run_of_this_version_departs_in_nothing() -> None:
    assert found(case("a/1"), case("a/2"), case("a/3"), committed={}) == []
    assert found(case("a/1"), only=["a/1"], committed={}) == []


def test_a_consistent_forgery_is_named_on_the_first_page() -> None:
    made = results(case("a/1"))["provenance"] | {"date": "2999-01-01T00:00:00+00:00", "commit": "0000"}
    forged = case("a/1", tolerance=100.0, claim="Eq. (8) holds", metric="absolute"), case("b/1")
    older = results(case("a/4", tolerance=0.2), provenance=made | {"date": "yesterday"})
    said = found(*forged, committed={"old": older}, provenance=made)
    assert said == [
        "this run: another claim than this version's: a/1",
        "this run: another metric than this version's: a/1 (absolute, not relative)",
        "this run: another tolerance than this version's: a/1 (100, not 0.1)",
        "this run: cases that this version does not have: b/1",
        "old.json: another tolerance than this version's: a/4 (0.2, not 0.1)",
        "this run: cases of its tier that are missing: a/2, a/3",
        "this run: its date 2999-01-01T00:00:00+00:00 is in the future",
        "this run: its commit '0000' is none of this checkout's",
        "old.json: its date 'yesterday' is no date",
        "old.json: its commit '0000' is none of this checkout's",
    ]
    page = render(results(*forged), departures=said)
    assert page.index("a/1 (100, not 0.1)") < page.index("How to run it again")
