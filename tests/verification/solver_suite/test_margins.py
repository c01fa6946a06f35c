"""Room that the suite's problems leave an honest solver: what its reasons for tolerances say is computed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from refimpl.grid import Array
from verification.solver_suite import own, reference_solution
from verification.solver_suite.isolated import Limited
from verification.solver_suite.protocol import ContactProblem
from verification.solver_suite.suite import run


@pytest.mark.parametrize("name", ["periodic-approach", "periodic-sheared-pins-approach"])
def test_an_honest_answer_at_its_claim_passes_with_its_mean_counted(name: str) -> None:
    """Errors of the contact's level, the worst there are, as large as the claim lets them be."""

    def lax(asked: ContactProblem) -> Array:
        exact = np.asarray(own.solve(replace(asked, tolerance=1e-12)).pressure)
        low, high = 1e-14, 1.0
        for _ in range(50):
            share = float(np.sqrt(low * high))
            residual = reference_solution.residual(asked, exact + share * exact.mean() * (exact > 0)).worst
            low, high = (share, high) if residual <= asked.tolerance else (low, share)
        return np.asarray(exact + low * exact.mean() * (exact > 0))

    for precision in (1e-8, 1e-6):
        (result,) = run(Limited(lax, replace(own.solve.abilities, precision=precision)), [f"solver/{name}"])
        assert result.error is not None
        assert 0 < result.error < 0.01  # of 2 claims: an error's energy is of second order
