"""The compact solver is right without a fault, and the campaign's faults are reproducible."""

from __future__ import annotations

import numpy as np
import pytest

from verification.contestants import compact, own
from verification.contestants.random_faults import COUNTED, SEEDS, error, probe, random_fault
from verification.contestants.suite import suite

NAMED = [c for c in suite() if not c.slug.startswith("design-")]


def test_the_compact_solver_passes_every_case() -> None:
    """But for those with a cap, which it does not have."""
    ended = {c.slug: c.case(compact.solve).run().status for c in NAMED}
    capped = {name for name, status in ended.items() if status == "unavailable"}
    assert {name for name, status in ended.items() if status != "pass"} == capped
    assert all("cap" in name or "plastic" in name for name in capped), capped


def test_at_least_two_hundred_faults_with_their_seeds() -> None:
    faults = [random_fault(seed) for seed in SEEDS]
    assert len(faults) >= 200
    assert len({(f.effect, f.condition) for f in faults}) > 190
    assert [(f.effect, f.condition) for f in faults] == [
        (f.effect, f.condition) for f in map(random_fault, SEEDS)
    ]


@pytest.mark.parametrize("seed", range(6))
def test_probes_are_solved_alike_by_both_right_solvers(seed: int) -> None:
    posed = probe(np.random.default_rng(seed))
    ours, theirs = (np.asarray(solver(posed).pressure) for solver in (own.solve, compact.solve))
    np.testing.assert_allclose(theirs, ours, atol=1e-3 * ours.max())


def test_a_fault_has_an_error() -> None:
    assert error(next(f for f in map(random_fault, SEEDS) if f.effect.startswith("load times"))) > COUNTED
