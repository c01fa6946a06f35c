"""Faults of strangers that once passed the whole suite: each is caught, and its dimension is named.

A quick part; all of them against all problems: ``python -m verification.contestants.named``, whose committed
result is judged here.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from reports.result_files import read_result
from tests.documents import ROOT
from verification.contestants import compact, trial
from verification.contestants.design import in_turn, posed, rows
from verification.contestants.named import named, run
from verification.contestants.protocol import ContactProblem
from verification.contestants.short_list import short_list
from verification.contestants.suite import select
from verification.contestants.table_faults import TABLE
from verification.contestants.trial import verdicts

CAUGHT_BY = {
    "60 iterations": "oblong-05",
    "100 iterations": "oblong-05",
    "c0 below 1e-11 taken for none": "sliding-03",
    "pressures below 1 kPa dropped": "oblong-04",
    "spacing at least 1 um": "oblong-04",
    "sine from the root": "sliding-04",
    "beta at most 1": "sliding-02",
    "tau lost above 32 elements": "sliding-35",
}
"""Fault, and a problem that catches it."""


@pytest.mark.parametrize("name", CAUGHT_BY)
def test_a_fault_of_the_table_fails(name: str) -> None:
    (case,) = select([f"contestant/design-{CAUGHT_BY[name]}"])
    assert case.case(compact.solve).run().status == "pass"
    verdict = case.case(TABLE[name].fresh()).run()
    # pressures that were all dropped hold no energy to judge by: an error, and no pass
    assert verdict.status == "fail" or "hold no elastic energy" in verdict.note


QUICKLY = {
    "tau on well loaded elements only": "triples",
    "key without spacing": "memory",
    "key without borders": "memory",
    "key without modulus": "memory",
    "key without direction": "memory",
    "key of the shape alone": "plain",
    "Nyquist of shear, both axes": "triples",
    "Nyquist of shear along y": "triples",
    "pressures at most E*": "plain",
    "approach at most the gap": "plain",
    "an element that never touches": "plain",
    "one element not solved": "tiny",
    "flat gap has the mean pressure": "tiny",
    "1 % off above 100 elements": "plain",
    "1 % off above 160 elements": "plain",
    "tolerance 1e-4 above 160 elements": "plain",
}
"""Fault, and one design of the suite that is enough to catch and to name it."""


@pytest.mark.parametrize("name", QUICKLY)
def test_one_design_names_a_fault(name: str) -> None:
    failed = verdicts(TABLE[name].fresh(), TABLE[name].largest, [QUICKLY[name]])
    assert any(failed.values())
    assert named(short_list(failed), TABLE[name].dimensions), short_list(failed)


def test_a_memory_of_the_suite_is_judged_by_all_problems_in_turn() -> None:
    """The second problem of the case is wrong with operators of the first, the third one is right again."""
    number = 1 + next(n for n, row in enumerate(rows()["memory"]) if row["changed"] == "modulus")
    (case,) = select([f"contestant/design-memory-{number:02}"])
    assert case.case(compact.solve).run().status == "pass"
    assert case.case(TABLE["key without modulus"].fresh()).run().status == "fail"
    assert len(in_turn(rows()["memory"][number - 1])) == 3


def test_a_flat_periodic_gap_has_the_mean_pressure() -> None:
    number = 1 + next(
        n
        for n, row in enumerate(rows()["tiny"])
        if row["borders"] == "periodic" and not posed(row, n + 1, 1e-8).gap.any()
    )
    (case,) = select([f"contestant/design-tiny-{number:02}"])
    assert case.case(compact.solve).run().status == "pass"
    wrong = compact.with_hooks(
        pressure=lambda p, f: f * (1.001 if f.size == 1 else np.linspace(0.99, 1.01, f.size))
    )
    assert case.case(wrong).run().status == "fail"


def test_named_means_every_dimension_of_a_fault() -> None:
    listed = ["elements above 32 and tau above 0", "beta above 1"]
    assert named(listed, [["tau"], ["elements"]])
    assert not named(listed, [["tau"], ["edge", "heights"]])
    assert not named(["tau above 0"], [["ta"]])


def test_a_fault_is_recorded(tmp_path: Path) -> None:
    (found,) = run(["one element not solved"], tmp_path / "log.jsonl")
    assert found["named"]
    assert found["failed"] >= 1


def test_a_record_of_other_code_is_not_read(tmp_path: Path) -> None:
    """A log once had the record of an older fault of the same name, and the result was wrong."""
    log = tmp_path / "log.jsonl"
    old = {"fault": "one element not solved", "problems": ["design-tiny-01"], "failed": [], "code": "older"}
    log.write_text(json.dumps(old) + "\n", encoding="utf-8")
    (found,) = run(["one element not solved"], log)
    assert found["failed"] >= 1
    (again,) = run(["one element not solved"], log)
    assert again == found
    assert len(log.read_text(encoding="utf-8").splitlines()) == 2


def test_every_fault_of_the_table_is_caught_and_named() -> None:
    """By all problems, as committed."""
    found = read_result(ROOT / "reports/results/named_faults.json")["table"]
    assert len(TABLE) >= 25
    assert [each["fault"] for each in found] == [*TABLE]
    assert [each["fault"] for each in found if not each["failed"] or not each["named"]] == []


@pytest.mark.parametrize("converged", [True, False])
def test_a_right_solution_has_converged_and_meets_the_claim(
    converged: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    solved = compact.solve.solved

    def ended(problem: ContactProblem) -> compact.Solved:
        return solved(problem)._replace(converged=converged)

    monkeypatch.setattr(compact.solve, "solved", ended)
    trial.right.cache_clear()
    try:
        assert (trial.right("design-tiny-01") is not None) == converged
        monkeypatch.setattr(trial, "residual", lambda *_: 2 * trial.CLAIM)
        trial.right.cache_clear()
        assert trial.right("design-tiny-01") is None
    finally:
        trial.right.cache_clear()
