"""Gaps that no chosen pressures have made, under strong tau: some have no solution; our solver says so."""

from __future__ import annotations

from dataclasses import replace

from verification.solver_suite import own
from verification.solver_suite.design import posed
from verification.solver_suite.dimensions import FIXED
from verification.solver_suite.protocol import ContactProblem

ROW = FIXED | {"control": "load", "tau": 0.0, "coupling": 0.45}


def strongly_sheared(elements: int, borders: str) -> ContactProblem:
    """A drawn gap; tau is the mean pressure."""
    found = posed(ROW | {"elements": elements, "borders": borders}, 0, 1e-8)
    assert found.coupling is not None
    assert found.load is not None
    return replace(found, coupling=replace(found.coupling, tau=found.load / found.area))


def test_our_solver_does_not_claim_success_on_it() -> None:
    answer = own.solve(strongly_sheared(8, "periodic"))
    assert not answer.converged
    assert own.solve(replace(strongly_sheared(8, "periodic"), coupling=None)).converged
