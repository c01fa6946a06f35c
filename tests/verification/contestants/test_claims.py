"""Right solvers meet the claim they state: a quick part of ``python -m verification.contestants.claims``."""

from __future__ import annotations

import pytest

from verification.contestants import own
from verification.contestants.claims import CLAIMS, verdicts

QUICK = ["contestant/design-tiny-*", "contestant/design-memory-0*", "contestant/design-capped-0*"]


@pytest.mark.parametrize("claim", CLAIMS)
@pytest.mark.parametrize("method", ["production", "dense"])
def test_no_right_solver_fails(method: str, claim: float) -> None:
    found = verdicts(own.solve if method == "production" else own.dense, claim, QUICK)
    assert found["missed"] == {}
    assert found["pass"] >= 20
