"""Nested grids and windows: initial guesses, how windows grow, the certificate on the whole grid."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Mask, Window
from refimpl.model.certificate import State, certify
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.model.state import SolverResult
from refimpl.operators.fft import Counter
from refimpl.operators.influence import window_influence
from refimpl.solvers.production import nested_solver
from refimpl.solvers.production.constants import MARGIN
from refimpl.solvers.production.level import LevelSolver
from refimpl.solvers.production.nested_solver import (
    certified,
    from_guess,
    missed_by_window,
    solve_fft,
    widened,
)
from refimpl.solvers.tau_active_set import FixedSet, first_set
from tests.refimpl.solvers.production.levels import BALL, FAINT, coupled, level_solver, problem_of


@pytest.mark.parametrize("strength", [0.5, 2.0])
def test_strong_couplings_converge_by_mixing(strength: float) -> None:
    """Plain updates multiply the error by the strength."""
    scene = coupled(strength)
    dense, fft = (rf.solve(scene, 16, method=m, oblique=False, tolerance=1e-9) for m in ("dense", "fft"))
    assert fft.status is rf.Status.CONVERGED
    assert np.abs(fft.pressure - dense.pressure).max() <= 1e-6 * dense.max_pressure


@pytest.mark.parametrize("rows", [slice(2, 6), slice(6, 9)])
def test_the_certificate_knows_all_tractions_and_transforms_no_more(rows: slice) -> None:
    """Tau may lie around or beside the pressure where a loop was cut short."""
    problem = problem_of(coupled(0.3, tau=1e6), 16)
    pressure, traction = np.zeros((2, 16, 16))
    pressure[3:5, 6:8], traction[rows, 6:9] = 1e7, 1e6
    traction[3:5, 6:8] = 1e6
    flat = Slopes.flat((16, 16))
    result = SolverResult(pressure, traction, flat, rf.Status.CONVERGED, excluded=pressure > 0)
    found, everything = Counter(), Counter()
    state = certified(problem, result, found)
    operator = window_influence(problem.grid, problem.direction, counter=everything)
    exact = certify(problem, operator, pressure, traction, flat)
    for name in ("displacement_lower", "displacement_upper"):
        expected = getattr(exact, name)
        # rounding of a sum over the loaded elements
        assert np.abs(getattr(state, name) - expected).max() <= 1e-14 * np.abs(expected).max()
    assert found.tally == everything.tally
    assert found.point_logs < 0.6 * everything.point_logs


def test_a_window_that_is_too_small_is_widened_no_further_than_needed() -> None:
    shape, tolerance = (48, 48), 1e-8
    problem = problem_of(BALL, 48)
    expected = level_solver(problem).result(tolerance).pressure
    solver = level_solver(problem, Window(22, 27, 21, 26))
    for _ in range(20):
        result = solver.result(tolerance)
        state = certified(problem, result, Counter())
        missed = missed_by_window(problem, state, solver.window, tolerance)
        if not missed.any():
            break
        assert not missed[solver.window.interior(shape).slices].any()
        steps, needed = solver.cg_iterations, missed | solver.window.mask(shape)
        solver = widened(problem, result, needed, Counter(), tolerance, needs_mixing=solver.needs_mixing)
        assert solver.cg_iterations == steps
    assert np.abs(result.pressure - expected).max() <= 1e-6 * expected.max()
    assert solver.window.shape < shape
    inside = Window.around(expected > 0, margin=1)
    assert np.all(solver.window.mask(shape)[inside.slices])


def test_contact_on_a_windows_edge_has_outgrown_it_where_slopes_count() -> None:
    """One-sided on the edge, they are central on the whole grid."""
    problem = problem_of(replace(BALL, load=20.0), 16, oblique=True)
    state = certified(problem, level_solver(problem).result(1e-8), Counter())
    tight = Window.around(state.contact, margin=0)
    assert 0 < tight.i0 < tight.i1 < 16
    on_edge = state.contact.copy()
    on_edge[tight.interior((16, 16)).slices] = False
    assert on_edge.any()
    assert np.array_equal(missed_by_window(problem, state, tight, 1e-8), on_edge)
    faint = replace(state, pressure=1e-12 * state.pressure)  # no pascal is too little
    assert np.array_equal(missed_by_window(problem, faint, tight, 1e-8), on_edge)
    assert not missed_by_window(problem, state, Window.around(state.contact, margin=1), 1e-8).any()
    flat = problem_of(replace(BALL, load=20.0), 16)
    assert not missed_by_window(flat, state, tight, 1e-8).any()


def test_windows_of_taus_states_never_shrink(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else the last state could ask for what an earlier one lacks, and that one again, for ever."""
    windows: list[Window] = []
    result = LevelSolver.result

    def recorded(solver: LevelSolver, tolerance: float) -> State:
        windows.append(solver.window)
        return result(solver, tolerance)

    def once_too_small(problem: Problem, state: State, window: Window, tolerance: float) -> Mask:
        asked.append(window)
        return state.contact if len(asked) == 1 else missed_by_window(problem, state, window, tolerance)

    asked: list[Window] = []
    monkeypatch.setattr(nested_solver, "missed_by_window", once_too_small)
    monkeypatch.setattr(LevelSolver, "result", recorded)
    solve_fft(problem_of(FAINT, 80), 1e-8, Counter())
    assert len(windows) > 1 + windows.index(asked[0])
    for before, after in pairwise(windows):
        assert not np.any(before.mask((80, 80)) & ~after.mask((80, 80)))


def solved(problem: Problem, tolerance: float, window: Window | None = None) -> LevelSolver:
    """The level's solver after a solve without tau."""
    solver = level_solver(problem, window)
    assert solver.solve(tolerance, FixedSet(np.zeros(solver.problem.gap.shape, dtype=bool)))
    return solver


def continued(solver: LevelSolver, finer: Problem) -> LevelSolver:
    return from_guess(finer, solver.initial_guess(), Counter(), 1e-8)


@pytest.mark.parametrize("approach", [None, 1e-6])
def test_a_finer_grid_starts_close_to_its_solution(approach: float | None) -> None:
    coarse, fine = (problem_of(BALL, M, approach=approach) for M in (32, 64))
    refined = continued(solved(coarse, 1e-6), fine)
    alone = solved(fine, 1e-8)
    exact, start = alone.cg.pressure, refined.full(refined.cg.pressure)
    assert refined.window == Window.around(exact > 0, MARGIN).filling((64, 64))
    # the coarse grid's own error, measured: 0.080 and 0.057, and a fifteenth of the contact's elements
    assert np.linalg.norm(start - exact) <= 0.1 * np.linalg.norm(exact)
    assert np.count_nonzero((start > 0) != (exact > 0)) <= 0.08 * np.count_nonzero(exact)
    assert refined.solve(1e-8, FixedSet(np.zeros(refined.problem.gap.shape, dtype=bool)))
    assert refined.cg_iterations <= 10  # measured: 9 and 9
    if approach is not None:  # measured: 12; under a load a foundation is as good for a smooth ball, 9
        assert refined.cg_iterations < alone.cg_iterations


def test_steps_are_reported_of_every_grid_and_the_finest_has_few_left() -> None:
    result = solve_fft(problem_of(BALL, 128), 1e-6, Counter())
    assert list(result.iterations) == ["CG at 128 x 128", "CG at 32 x 32"]
    # measured: 7, and 12 where the coarser grids are not solved
    assert result.iterations["CG at 128 x 128"] <= 9
    assert max(result.iterations.values()) <= 9  # and no coarse grid is solved to the end


@pytest.mark.parametrize("approach", [None, 1e-6])
@pytest.mark.parametrize("factor", [1.005, 0.995, 1.03, 0.97])
def test_a_start_on_the_same_grid_is_used_where_it_is_off_by_one_per_cent(
    approach: float | None, factor: float
) -> None:
    """And not by three; at an approach v is off by (factor - 1) u, whose work is twice that of the energy."""
    problem = problem_of(replace(BALL, load=8.0), 32, approach=approach)
    solver = level_solver(problem)
    solver.solve(1e-9, first_set(problem))
    guess = solver.initial_guess()
    start = guess._replace(pressure=factor * guess.pressure, displacement=factor * guess.displacement)
    found = solve_fft(problem, 1e-6, Counter(), start)
    assert ("CG at 16 x 16" in found.iterations) is (abs(factor - 1) > 0.02)


STEEP = rf.Scene(
    upper=rf.Body(rf.Material(50e9, 0.2), rf.Sphere(2.4e-3) + rf.GaussianRoughness(3.3e-6, 51e-6, seed=4344)),
    lower=rf.Body(rf.Material(2.8e9, 0.24), rf.GaussianRoughness(3.3e-6, 74e-6, seed=4345)),
    friction=rf.Friction(tau=1.1e6, beta=0.32),
    load=40.0,
    side=1e-3,
)


def test_steep_slopes_converge_on_fine_grids() -> None:
    """Their feedback grows with displacement over spacing; relaxed updates stagnated from 256 on."""
    coarse, fine = (rf.solve(STEEP, M) for M in (128, 256))
    assert coarse.status is fine.status is rf.Status.CONVERGED
    assert fine.friction_coefficient == pytest.approx(coarse.friction_coefficient, rel=0.01)
    assert fine.cost.iterations["CG at 256 x 256"] < 200
