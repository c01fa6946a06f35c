"""Right solvers meet the claim they state: a quick part of ``python -m verification.contestants.claims``."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from verification.contestants import claims, own
from verification.contestants.claims import CLAIMS, verdicts

QUICK = ["contestant/design-tiny-*", "contestant/design-memory-0*", "contestant/design-capped-0*"]


@pytest.mark.parametrize("claim", CLAIMS)
@pytest.mark.parametrize("method", ["production", "dense"])
def test_no_right_solver_fails(method: str, claim: float) -> None:
    found = verdicts(own.solve if method == "production" else own.dense, claim, QUICK)
    assert found["missed"] == {}
    assert found["pass"] >= 20


def test_all_but_passed_and_unavailable_cases_are_missed(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = {"a": ("pass", 1e-9), "b": ("unavailable", None), "c": ("fail", 0.0123), "d": ("error", None)}
    results = [
        SimpleNamespace(id=name, status=status, error=error, note="" if error else f"note of {name}")
        for name, (status, error) in ends.items()
    ]
    monkeypatch.setattr(claims, "run", lambda *_: results)
    assert verdicts(own.dense, 1e-8) == {
        "pass": 1, "unavailable": 1, "fail": 1, "error": 1, "claim": 1e-8,
        "missed": {"c": "0.0123", "d": "note of d"},
    }  # fmt: skip
