"""Every invariant of `verification.properties`, over random samples, for both solvers."""

from __future__ import annotations

from functools import partial

import pytest

import refimpl as rf
from verification.properties import INVARIANTS, check_solver

SOLVERS = {
    "fft": partial(rf.solve, method="fft", tolerance=1e-12),
    "dense": partial(rf.solve, method="dense", tolerance=1e-12),
}


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("name", INVARIANTS)
def test_invariant(name: str, solver: str) -> None:
    check_solver(SOLVERS[solver], examples=20, only=[name])
