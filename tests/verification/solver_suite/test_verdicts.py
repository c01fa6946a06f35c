"""Verdicts on a solver under test: by the worst of its problems."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from refimpl.grid import Array
from verification.solver_suite import own
from verification.solver_suite.check import MODULUS
from verification.solver_suite.faulty_solvers.table import Faulty
from verification.solver_suite.protocol import ContactProblem
from verification.solver_suite.suite import run


@pytest.mark.parametrize("light", [0.001, 0.01, 0.05])
def test_a_load_that_is_missed_alone_is_seen(light: float) -> None:
    """One of three loads is borne to 1e-4 too much: 1e4 times the claim of 1e-8."""

    def solver(problem: ContactProblem) -> Array:
        missed = problem.load is not None and np.isclose(problem.load, light * MODULUS)
        answer: Any = own.solve(problem)
        return np.asarray(answer.pressure) * (1.0001 if missed else 1.0)

    (result,) = run(Faulty(solver), ["contestant/load-balance"])
    assert result.status == "fail"
    assert result.value == pytest.approx(1e4, rel=1e-3)
