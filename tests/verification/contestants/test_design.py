"""The covering design covers, and a right solver passes it."""

from __future__ import annotations

import itertools

import pytest

from verification.contestants import own
from verification.contestants.campaign import caught
from verification.contestants.design import OBLONG, PLAIN, SLIDING, rows
from verification.contestants.random_faults import SEEDS, random_fault
from verification.contestants.suite import select


@pytest.mark.parametrize(("name", "dimensions"), [("plain", PLAIN), ("sliding", SLIDING), ("oblong", OBLONG)])
def test_every_pair_of_levels_occurs(name: str, dimensions: dict[str, tuple[object, ...]]) -> None:
    for one, other in itertools.combinations(dimensions, 2):
        found = {(row[one], row[other]) for row in rows()[name]}
        assert found == set(itertools.product(dimensions[one], dimensions[other]))


def test_our_solver_meets_its_claim_in_every_problem() -> None:
    verdicts = {c.slug: c.case(own.solve).run() for c in select(["contestant/design-*"])}
    assert {slug: r.note for slug, r in verdicts.items() if r.status != "pass"} == {}


def test_a_random_fault_is_caught() -> None:
    fault = next(f for f in map(random_fault, SEEDS) if f.effect.startswith("load times"))
    assert caught(fault, ["plain"]) is not None
