"""A case passes on good numbers and in no other way."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable
from dataclasses import asdict
from typing import Any, cast

import numpy as np
import pytest

from verification.framework.case import Case, Measured, Metric, Status, Unavailable, jsonable
from verification.framework.verdict import Verdict, judged


def declare(
    function: Callable[[], Measured], metric: str = "relative", tolerance: float = 0.1, **other: Any
) -> Case:
    texts = {"title": "t", "claim": "c", "source": "s", "tolerance_reason": "measured", **other}
    return Case("subject/slug", metric=cast(Metric, metric), tolerance=tolerance, function=function, **texts)


@pytest.mark.parametrize(
    ("metric", "tolerance", "value", "reference", "error", "status"),
    [
        ("relative", 0.1, 1.05, 1.0, 0.05, "pass"),
        ("relative", 0.1, -2.3, -2.0, 0.15, "fail"),
        ("absolute", 0.1, 7.05, 7.0, 0.05, "pass"),
        ("absolute", 0.1, 7.0, -7.0, 14.0, "fail"),
        ("at_most", 1e-9, 1e-9, None, 1e-9, "pass"),
        ("at_most", 1e-9, 1.1e-9, None, 1.1e-9, "fail"),
        ("at_least", 1.8, 1.8, None, 1.8, "pass"),
        ("at_least", 1.8, 1.7, None, 1.7, "fail"),
        ("at_least", -1.0, 0.0, None, 0.0, "pass"),
        ("at_least", 0.1, -1e-9, None, -1e-9, "fail"),
        ("equal", 0.0, 3, 3, 0.0, "pass"),
        ("equal", 0.0, 1 + 2.0**-52, 1.0, 2.0**-52, "fail"),
    ],
)
def test_metrics(
    metric: str, tolerance: float, value: float, reference: float | None, error: float, status: str
) -> None:
    result = declare(lambda: Measured(value=value, reference=reference), metric, tolerance).run()
    assert result.status == status
    assert result.error == pytest.approx(error, rel=1e-12, abs=0)
    assert (result.value, result.reference) == (value, reference)


@pytest.mark.parametrize(
    ("metric", "measured"),
    [
        ("relative", Measured(value=math.nan, reference=1.0)),
        ("relative", Measured(value=math.inf, reference=math.inf)),
        ("relative", Measured(value=1.0, reference=math.nan)),
        ("relative", Measured(value=0.0, reference=0.0)),
        ("relative", Measured(value=1.0)),
        ("relative", Measured(205.0, 200.0, 20.1)),  # 10 % of the reference
        ("relative", Measured(value=1.0, reference=1.0, reference_uncertainty=0.11)),
        ("relative", Measured(value=1e-6, reference=1e-6, reference_uncertainty=1.1e-7)),
        ("relative", Measured(value=-1e-6, reference=-1e-6, reference_uncertainty=1.1e-7)),
        ("absolute", Measured(value=5.0, reference=5.0, reference_uncertainty=0.11)),
        ("relative", Measured(value=1.0, reference=1.0, reference_uncertainty=math.nan)),
        ("relative", Measured(value=1.0, reference=1.0, reference_uncertainty=-0.01)),
        ("absolute", Measured(value=1e308, reference=-1e308)),
        ("absolute", Measured(value=np.nan, reference=0.0)),
        ("at_most", Measured(value=math.nan)),
        ("at_most", Measured(value=-1.0)),
        ("at_most", Measured(value=0.0, reference=0.0)),
        ("at_least", Measured(value=math.inf)),
        ("at_least", Measured(value=2.0, reference=1.0)),
        ("at_least", Measured(value=math.nan)),
        ("equal", Measured(value=math.nan, reference=math.nan)),
        ("relative", Measured(value=cast(float, "1.0"), reference=1.0)),
        ("relative", Measured(value=1.0, reference=1.0, data={"x": object()})),
        ("relative", None),
    ],
)
def test_numbers_that_cannot_be_judged_are_errors(metric: str, measured: Any) -> None:
    result = declare(lambda: measured, metric, 0.0 if metric == "equal" else 0.1).run()
    assert result.status == Status.ERROR
    assert result.error is None
    assert result.note


@pytest.mark.parametrize(
    ("metric", "reference", "uncertainty"),
    [
        ("relative", 200.0, 19.9),
        ("relative", 1e6, 9e4),
        ("relative", 1e-6, 9e-8),
        ("absolute", 1e-6, 0.09),
        ("absolute", 1e6, 0.1),
    ],
)
def test_a_reference_may_be_as_uncertain_as_the_tolerance(
    metric: str, reference: float, uncertainty: float
) -> None:
    measured = Measured(value=reference, reference=reference, reference_uncertainty=uncertainty)
    assert declare(lambda: measured, metric, 0.1).run().status == Status.PASS


@pytest.mark.parametrize("raised", [RuntimeError("broken"), SystemExit(0), AssertionError(), MemoryError()])
def test_whatever_a_case_raises_is_an_error(raised: BaseException) -> None:
    def function() -> Measured:
        raise raised

    result = declare(function).run()
    assert result.status == Status.ERROR
    assert type(raised).__name__ in result.note
    assert f"test_case.py:{function.__code__.co_firstlineno + 1}" in result.note
    assert "/" not in result.note


def test_a_missing_dependency_is_unavailable_and_says_which() -> None:
    def function() -> Measured:
        raise Unavailable("needs tamaas")

    result = declare(function).run()
    assert (result.status, result.note) == (Status.UNAVAILABLE, "needs tamaas")


def test_an_interrupt_is_not_a_verdict() -> None:
    def function() -> Measured:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        declare(function).run()


@pytest.mark.parametrize(
    "other",
    [
        {"metric": "close"},
        {"metric": "RELATIVE"},
        {"tolerance_reason": "  "},
        {"claim": ""},
        {"tolerance": math.nan},
        {"tolerance": math.inf},
        {"tolerance": -1e-3},
        {"tier": "nightly"},
        {"metric": "equal", "tolerance": 1e-12},
    ],
)
def test_a_badly_declared_case_is_refused(other: dict[str, Any]) -> None:
    with pytest.raises(ValueError):
        declare(lambda: Measured(value=1.0, reference=1.0), **other)


@pytest.mark.parametrize("id", ["noslash", "/slug", "subject/", "a b/c"])
def test_an_id_is_subject_and_slug(id: str) -> None:
    with pytest.raises(ValueError, match="subject/slug"):
        Case(id, "t", "c", "s", Metric.EQUAL, 0.0, "exact", lambda: Measured(1.0, 1.0))


def test_a_result_is_json_whatever_the_data_holds() -> None:
    """Data keep six digits, maps three; the verdict keeps all."""
    data = {
        "map": np.arange(4.0).reshape(2, 2),
        "n": np.int64(3),
        "h": [1 / 3, math.nan],
        "x": "y",
        "-": None,
    }
    result = declare(lambda: Measured(value=np.float64(1 / 3), reference=1 / 3, data=data)).run()
    back = json.loads(json.dumps(asdict(result), allow_nan=False))
    expected = {"map": [[0.0, 1.0], [2.0, 3.0]], "n": 3, "h": [0.333333, None], "x": "y", "-": None}
    assert (back["value"], back["data"]) == (1 / 3, expected)
    assert jsonable(np.full((40, 25), 2 / 3)) == [[0.667] * 25] * 40
    assert jsonable(np.full((40, 24), 2 / 3)) == [[0.666667] * 24] * 40
    with pytest.raises(TypeError):
        jsonable({1, 2})


def test_a_judgement_keeps_its_numbers() -> None:
    found = judged(Verdict.REFUTED, "so", 2.5, data={"h": [1]}, reference=2.0, unit="N")
    data = {"verdict": "not confirmed", "h": [1]}
    assert found == Measured(2.5, 2.0, 0.0, "N", data, "so")


@pytest.mark.parametrize("failure", [RuntimeError, SystemExit, Unavailable])
def test_a_note_can_be_written_to_any_utf_8_file_and_has_an_end(failure: type[BaseException]) -> None:
    def undecodable() -> Measured:
        raise failure("no licence in " + os.fsdecode(b"/opt/caf\xe9"))

    def endless() -> Measured:
        raise failure("begun " + "x" * 5_000_000 + " done")

    assert b"no licence in /opt/caf?" in declare(undecodable).run().note.encode()
    note = declare(endless).run().note
    assert len(note) < 2000
    assert "begun xxx" in note
    assert "xxx done" in note
