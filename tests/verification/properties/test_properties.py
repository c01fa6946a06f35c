"""Every invariant of `verification.properties`, over random samples, for both solvers."""

from __future__ import annotations

import pytest

from verification.properties import INVARIANTS, check_solver
from verification.properties.nightly import SOLVERS


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("name", INVARIANTS)
def test_invariant(name: str, solver: str, order_seed: int | None) -> None:
    check_solver(SOLVERS[solver], examples=20, only=[name], seed=order_seed)
