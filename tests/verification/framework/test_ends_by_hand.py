"""Both ends of what the framework judges by: uncertainties, counts and the mode of files."""

from __future__ import annotations

import os
import time
from dataclasses import asdict
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from verification.framework import provenance, registry, runner, workers
from verification.framework.case import Case, Measured, Metric, Result, Status, Tier
from verification.framework.files import write_text
from verification.framework.registry import select
from verification.framework.runner import Run
from verification.framework.verdict import Verdict, judged


def case(id: str = "a/b", *, metric: Metric = Metric.RELATIVE, measured: Measured | None = None) -> Case:
    found = measured or Measured(205.0, 200.0)
    return Case(id, "t", "c", "s", metric, 0.05, "r", lambda: found)


@pytest.mark.parametrize(("uncertainty", "status"), [(9.9, "pass"), (10.1, "error")])
def test_a_relative_tolerance_holds_relative_uncertainties(uncertainty: float, status: str) -> None:
    """5 % of the reference, 200."""
    assert case(measured=Measured(205.0, 200.0, uncertainty)).run().status == status


def test_no_error_measure_is_negative_but_a_figure_of_merit_may_be() -> None:
    assert case(metric=Metric.AT_MOST, measured=Measured(-1e-9)).run().status == "error"
    assert case(metric=Metric.AT_LEAST, measured=Measured(-1e-9)).run().status == "fail"


def result(status: Status) -> Result:
    return case().result(status, "", 0.5)


@pytest.mark.parametrize(
    ("statuses", "expected"),
    [
        ([Status.PASS, Status.UNAVAILABLE], 0),
        ([Status.PASS, Status.FAIL], 1),
        ([Status.PASS, Status.ERROR], 1),
        ([Status.UNAVAILABLE], 1),
        ([], 1),
    ],
)
def test_a_run_succeeds_where_something_passed_and_nothing_failed_or_broke(
    statuses: list[Status], expected: int
) -> None:
    run = Run(Tier.QUICK, (), tuple(map(result, statuses)), 1.5)
    assert run.exit_status == expected
    assert run.counts == {status.value: statuses.count(status) for status in Status}


def test_one_glob_that_matches_nothing_is_refused_beside_another() -> None:
    cases = [case("a/b"), case("a/c")]
    assert select(cases, Tier.QUICK, ["a/b"]) == (cases[0],)
    with pytest.raises(LookupError, match="z/"):
        select(cases, Tier.QUICK, ["a/b", "z/*"])


def test_a_verdict_keeps_its_numbers() -> None:
    found = judged(
        Verdict.REFUTED, "so", 2.5, data={"h": [1]}, reference=2.0, reference_uncertainty=0.125, unit="N"
    )
    data = {"verdict": "not confirmed", "h": [1]}
    assert found == Measured(2.5, 2.0, 0.125, "N", data, "not confirmed: so")


def test_a_replaced_file_keeps_its_mode(tmp_path: Path) -> None:
    path = tmp_path / "file"
    write_text("old", path)
    os.chmod(path, 0o640)
    write_text("new", path)
    assert (path.read_text(), path.stat().st_mode & 0o777) == ("new", 0o640)
    before = os.umask(0o027)
    try:
        write_text("fresh", tmp_path / "fresh")
    finally:
        os.umask(before)
    assert (tmp_path / "fresh").stat().st_mode & 0o777 == 0o640


@pytest.mark.parametrize(("changes", "dirty"), [("", False), (" M a.py", True), (None, None)])
def test_a_tree_whose_state_git_cannot_tell_is_neither_clean_nor_dirty(
    changes: str | None, dirty: bool | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = {"--show-prefix": "", "HEAD": "abc", "--porcelain": changes}
    monkeypatch.setattr(provenance, "_git", lambda root, *words: answers[words[-1]])
    assert provenance.revision() == {"commit": "abc", "dirty": dirty}


def test_results_come_in_the_order_of_the_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    """The case in the middle ends last: the other worker has taken the third one by then."""

    class Player:
        def run(self, one: Any) -> Any:
            time.sleep(0.2 if one.module == "b" else 0.0)
            return SimpleNamespace(id=one.id)

        def close(self) -> None:
            pass

    monkeypatch.setattr(workers, "Worker", Player)
    cases: Any = [SimpleNamespace(id=f"{letter}/1", module=letter) for letter in "abc"]
    ended: list[str] = []
    found = workers.run_all(cases, 2, lambda result: ended.append(result.id))
    assert [result.id for result in found] == ["a/1", "b/1", "c/1"]
    assert sorted(ended) == ["a/1", "b/1", "c/1"]
    assert ended[-1] == "b/1"


def test_each_field_of_a_result_is_that_of_its_case(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "_declared", {})
    monkeypatch.setattr(runner, "provenance", dict)
    own: Any = {"title": "t", "claim": "c", "source": "s", "metric": "absolute", "tolerance": 0.75}
    own |= {"tolerance_reason": "r", "tier": "full"}
    registry.case("a/b", **own)(lambda: Measured(2.5, 2.0, 0.125, "N", {"h": 1}, "so"))
    found = registry.find("a/b").run()
    assert asdict(found) == own | {
        "id": "a/b", "value": 2.5, "reference": 2.0, "reference_uncertainty": 0.125, "error": 0.5,
        "seconds": found.seconds, "status": "pass", "unit": "N", "note": "so", "data": {"h": 1},
    }  # fmt: skip
    document = Run(Tier.FULL, ("a/*",), (found,), 1.23456).document()
    assert [document[key] for key in ("tier", "only", "seconds")] == ["full", ["a/*"], 1.235]
    assert result(Status.FAIL).seconds == 0.5
