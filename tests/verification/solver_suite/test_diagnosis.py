"""The short list names the dimensions of a fault."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from verification.solver_suite.design import rows
from verification.solver_suite.diagnosis import levels, short_list

SLUGS = [f"design-{name}-{n:02}" for name, design in rows().items() for n in range(1, len(design) + 1)]
TRAITS: dict[str, dict[str, Any]] = {slug: levels(slug) or {} for slug in SLUGS}


@pytest.mark.parametrize(
    ("first", "fails"),
    [
        (
            "parity = even and borders = periodic",
            lambda t: t["borders"] == "periodic" and t["parity"] == "even",
        ),
        ("sector = 6", lambda t: t.get("sector") == "6"),
        ("beta above 1.3", lambda t: t.get("beta", 0.0) > 1.4),
        ("pressure over E* above 0.5", lambda t: t["pressure over E*"] > 1.0),
        ("elements below 2", lambda t: t["elements"] == 1.0),
        ("everywhere", lambda _: True),
        # as by operators kept by a key without the direction, whatever the design
        ("changed direction", lambda t: bool(t.get("changed direction"))),
    ],
)
def test_the_dimensions_of_a_fault_come_first(first: str, fails: Callable[[dict[str, Any]], bool]) -> None:
    listed = short_list({slug: fails(traits) for slug, traits in TRAITS.items()})
    assert listed[0] == first
    assert not any(
        first.split()[0] in other for other in listed[1:]
    )  # three dimensions, not three thresholds


def test_no_failure_has_no_list() -> None:
    assert short_list(dict.fromkeys(SLUGS, False)) == []
    assert levels("hertz-load") is None


def test_dimensions_count_among_the_problems_that_have_them() -> None:
    """A memory fails where one dimension changes, and here and there among the other designs."""
    changed = {slug: TRAITS[slug].get("changed") == "edge" for slug in SLUGS}
    failed = {slug: changed[slug] or (slug.endswith("-17") and "memory" not in slug) for slug in SLUGS}
    assert short_list(failed)[0] == "changed = edge"


def test_a_dimension_of_few_problems_does_not_hide_that_of_most_failures() -> None:
    """The changed sector explains one failure: it once stood first, by a score among the memories alone."""
    failed = {slug: bool(TRAITS[slug]["beyond the gap"]) for slug in SLUGS}
    failed[next(slug for slug in SLUGS if TRAITS[slug].get("changed") == "sector")] = True
    listed = short_list(failed)
    assert listed[0] == "beyond the gap"
    assert not any("changed" in each for each in listed)


def test_a_part_that_alone_differs_from_an_earlier_problem_is_a_trait() -> None:
    assert sum(bool(TRAITS[slug].get("changed direction")) for slug in SLUGS if "memory" not in slug) > 20
    assert TRAITS["design-plain-01"]["changed edges"] is None
    changed = next(traits for traits in TRAITS.values() if traits.get("changed") == "edge")
    assert (changed["changed edges"], changed["changed borders"]) == (True, None)
