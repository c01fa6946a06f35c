"""Verdicts on a solver under test: of the case that was asked for, and by the worst of its problems."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from refimpl.grid import Array
from verification.contestants import own
from verification.contestants.broken import Wrong
from verification.contestants.check import MODULUS
from verification.contestants.isolated import Table
from verification.contestants.protocol import Answer, ContactProblem
from verification.contestants.suite import run, select
from verification.framework.case import Status


@pytest.mark.parametrize("light", [0.001, 0.01, 0.05])
def test_a_load_that_is_missed_alone_is_seen(light: float) -> None:
    """One of three loads is borne to 1e-4 too much: 1e4 times the claim of 1e-8."""

    def solver(problem: ContactProblem) -> Array:
        missed = problem.load is not None and np.isclose(problem.load, light * MODULUS)
        answer: Any = own.solve(problem)
        return np.asarray(answer.pressure) * (1.0001 if missed else 1.0)

    (result,) = run(Wrong(solver), ["contestant/load-balance"])
    assert result.status == "fail"
    assert result.value == pytest.approx(1e4, rel=1e-3)


def nothing(problem: ContactProblem) -> Answer:
    raise NotImplementedError


def test_a_verdict_on_another_case_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """The process is asked for one case and answers for another: an error, and a new process."""
    asked, other = select(["contestant/load-balance", "contestant/no-tension"])
    verdicts = [check.case(nothing).result(Status.PASS, "", 0.5) for check in (asked, other)]
    happened: list[str] = []
    for name in ("close", "_open"):
        monkeypatch.setattr(Table, name, lambda table, name=name: happened.append(name))
    judge: Any = object.__new__(Table)
    judge._limit = 3.0

    def judged(verdict: object) -> Any:
        judge._pipe = SimpleNamespace(
            send=happened.append, poll=lambda limit: limit == 3.0, recv=lambda: verdict
        )
        return judge.run(asked)

    assert judged(verdicts[0]) is verdicts[0]
    assert happened == [asked.slug]
    for wrong in (verdicts[1], "pass", None):
        happened.clear()
        found = judged(wrong)
        assert (found.id, found.status) == (verdicts[0].id, Status.ERROR)
        assert "something else than this case's verdict" in found.note
        assert happened == [asked.slug, "close", "_open"]
