"""One grid of the production solver: what CG inverts and what lags, windows, and how a solve ends."""

from __future__ import annotations

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.certificate import certify
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import Counter
from refimpl.operators.influence import window_influence
from refimpl.operators.preconditioner import Apply
from refimpl.solvers.production import constants, lagged_terms
from refimpl.solvers.production.lagged_terms import couples_weakly, coupling_strength, pressure_compliance
from refimpl.solvers.tau_active_set import FixedSet
from tests.refimpl.solvers.production.levels import BALL, coupled, level_solver, problem_of
from verification.exact.dense_influence import DenseInfluence

M = 12
ROUNDING = 1e-14  # of the largest displacement: transforms of a few hundred points


def turned(
    strength: float,
    tau: float = 0.0,
    *,
    oblique: bool = False,
    periodic: bool = False,
    **terms: bool,
) -> Problem:
    """Sliding along no axis of the grid; at an approach, so that no pressure is scaled to a load."""
    scene = replace(coupled(strength, tau), sliding_direction=0.7, periodic=periodic)
    return problem_of(scene, M, oblique=oblique, approach=-1e-7 if periodic else 1e-6, **terms)


def pressed(seed: int) -> Array:
    pressure = np.random.default_rng(seed).random((M, M))
    return np.where(pressure > 0.5, pressure * 1e6, 0.0)


def compliance(problem: Problem) -> tuple[Apply, Counter]:
    counter = Counter()
    operator = window_influence(problem.grid, problem.direction, counter=counter)
    return pressure_compliance(problem, operator), counter


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("strength", [0.0, 0.1, 0.3, 0.5])
def test_weak_coupling_is_applied_with_the_pressure(strength: float, periodic: bool) -> None:
    problem = turned(strength, periodic=periodic)
    apply, counter = compliance(problem)
    dense, pressure = DenseInfluence(problem.grid, problem.direction), pressed(1)
    weak = 0 < strength <= 0.3
    expected = problem.elasticity.normal(dense, pressure)
    if weak:
        expected += problem.elasticity.gap_by_shear(dense.shear(problem.friction.slope * pressure))
    assert coupling_strength(problem) == pytest.approx(strength, rel=1e-14)
    assert couples_weakly(problem) is weak
    assert np.abs(apply(pressure) - expected).max() <= ROUNDING * np.abs(expected).max()
    assert sum(n for kind, n in counter.tally.items() if "kernel" not in kind) == 1


@pytest.mark.parametrize(("slope_correction", "strength"), [(False, 0.0), (True, 2.5)])
def test_neglected_coupling_has_no_strength(slope_correction: bool, strength: float) -> None:
    """Facet tractions bring shear to the gap by themselves."""
    apart = turned(2.5, oblique=True, coupled=False, slope_correction=slope_correction)
    assert coupling_strength(apart) == pytest.approx(strength)


def test_facet_tractions_are_no_multiple_of_the_pressure() -> None:
    assert couples_weakly(turned(0.2, oblique=True))
    assert not couples_weakly(turned(0.2, oblique=True, slope_correction=True))


@pytest.mark.parametrize("tau", [0.0, 1e6])
@pytest.mark.parametrize(("strength", "lags"), [(0.29, False), (0.31, True)])
def test_strong_coupling_lags(strength: float, lags: bool, tau: float) -> None:
    lagged = level_solver(problem_of(coupled(strength, tau=tau), 4)).lagged
    lagged.active = FixedSet(np.ones((4, 4), dtype=bool))
    assert lagged.has_lag is lags


@pytest.mark.parametrize(
    ("oblique", "strength", "lags"), [(True, 0.099, True), (True, 0.101, False), (False, 0.099, False)]
)
def test_the_weakest_coupling_lags_beside_slopes(oblique: bool, strength: float, lags: bool) -> None:
    assert couples_weakly(problem_of(coupled(strength), 4, oblique=oblique)) is not lags


@pytest.mark.parametrize("oblique", [False, True])
def test_coupling_that_cg_inverts_ends_in_the_same_state_for_less(
    oblique: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A fifth less at least; measured: 0.63 level, 0.73 oblique."""
    scene = replace(coupled(0.3), load=20.0)
    together = rf.solve(scene, 64, oblique=oblique)
    monkeypatch.setattr(lagged_terms, "WEAK_COUPLING", 0.0)
    apart = rf.solve(scene, 64, oblique=oblique)
    assert together.status is apart.status is rf.Status.CONVERGED
    assert np.abs(together.pressure - apart.pressure).max() <= 1e-6 * apart.max_pressure
    assert together.cost.point_logs <= 0.8 * apart.cost.point_logs


def test_how_a_solve_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    """The residual counts before the limit; what ends by neither has stagnated."""
    problem = problem_of(BALL, 16)
    solver = level_solver(problem)
    assert solver.result(1e-8).status is rf.Status.CONVERGED
    monkeypatch.setattr(constants, "CG_LIMIT", solver.cg_iterations)
    assert level_solver(problem).result(1e-8).status is rf.Status.CONVERGED
    assert level_solver(problem).result(1e-8).iterations == {"CG at 16 x 16": solver.cg_iterations}
    monkeypatch.setattr(constants, "CG_LIMIT", solver.cg_iterations - 1)
    assert level_solver(problem).result(1e-8).status is rf.Status.ITERATION_LIMIT
    stagnating = level_solver(problem_of(coupled(8.0), 16))  # far beyond what materials have
    monkeypatch.setattr(constants, "CG_LIMIT", 10**6)
    assert stagnating.result(1e-8).status is rf.Status.STAGNATED


@pytest.mark.parametrize("inside", [True, False])
def test_outdated_slopes_of_facets_count_where_there_is_contact(inside: bool) -> None:
    solver = level_solver(problem_of(BALL, 16, oblique=True, slope_correction=True))
    assert solver.solve(1e-8, FixedSet(solver.problem.gap < 0))
    slopes, where = solver.lagged.slopes, solver.contact == inside
    solver.lagged.slopes = Slopes(slopes.tan_x + 1e-3 * where, slopes.tan_y)
    assert (solver.lagged.update() >= 0.999e-3) is inside


@pytest.mark.parametrize("slope_correction", [False, True])
def test_the_residual_is_what_the_certificate_finds(slope_correction: bool) -> None:
    """Also of facet tractions, at the slopes of the update before: these are returned with the state.

    The last update scales the pressure to the load, by less than a thousandth here.
    """
    steep = replace(BALL, upper=replace(BALL.upper, surface=rf.Sphere(radius=4e-3)), load=50.0)
    problem = problem_of(steep, 32, oblique=True, slope_correction=slope_correction)
    solver = level_solver(problem)
    result = solver.result(1e-4)
    operator = window_influence(problem.grid, problem.direction)
    state = certify(problem, operator, result.pressure, result.traction, result.slopes)
    assert result.status is rf.Status.CONVERGED
    assert state.certificate.largest == pytest.approx(solver.residual, rel=1e-3)


def test_a_deleted_solver_is_gone_at_once() -> None:
    """No cycle of references keeps a level's arrays until the garbage is collected."""
    gc.disable()
    try:
        solver = level_solver(problem_of(BALL, 16))
        solver.solve(1e-3, FixedSet(np.zeros((16, 16), dtype=bool)))
        gone = weakref.ref(solver.cg)
        del solver
        assert gone() is None
    finally:
        gc.enable()
