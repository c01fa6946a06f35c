"""Gaps that no chosen pressures have made, under strong tau: some have no solution; our solver says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Mask
from verification.solver_suite import own, reference_solution
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


def sheared(problem: ContactProblem, where: Mask) -> ContactProblem:
    """The problem without tau over a gap that tau on some elements has moved beforehand, under a load."""
    assert problem.coupling is not None
    one = where.astype(np.float64)
    alone = replace(problem, coupling=replace(problem.coupling, beta=0.0))
    gap = (
        problem.gap
        + reference_solution.displacement(alone, one)
        - reference_solution.by_pressure(problem, one)
    )
    return replace(problem, gap=gap - gap.min(), coupling=replace(problem.coupling, tau=0.0))


def solved(problem: ContactProblem) -> tuple[Array, Mask]:
    """Our pressures (Pa), and the elements that have tau."""
    found = rf.solve(own.scene(problem), problem.shape, oblique=False)
    assert found.status is rf.Status.CYCLED
    c = problem.coupling
    assert c is not None
    return found.pressure, np.asarray(found.traction - c.beta * found.pressure > 0.5 * c.tau)


@pytest.mark.parametrize(("elements", "borders"), [(8, "periodic"), (9, "free")])
def test_the_residual_is_all_of_the_elements_that_tau_lifts(elements: int, borders: str) -> None:
    """With tau where the solver has it the pressures are right; tau wherever f > 0 leaves 1 % and more."""
    problem = strongly_sheared(elements, borders)
    f, on = solved(problem)
    assert 1 <= np.count_nonzero((f > 0) & ~on) <= 2
    assert not np.any((f == 0) & on)
    assert reference_solution.residual(sheared(problem, on), f).gap < 1e-8
    assert reference_solution.residual(problem, f).gap > 1e-2


def test_our_solver_does_not_claim_success_on_it() -> None:
    answer = own.solve(strongly_sheared(8, "periodic"))
    assert not answer.converged
    assert own.solve(replace(strongly_sheared(8, "periodic"), coupling=None)).converged
