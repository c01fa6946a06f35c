"""Windows of the production solver: how they grow, and the certificate on the whole grid."""

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
from refimpl.solvers.production.nested_solver import certified, missed_by_window, solve_fft, widened
from refimpl.solvers.tau_active_set import first_set
from tests.refimpl.solvers.production.levels import BALL, FAINT, coupled, level_solver, problem_of


@pytest.mark.parametrize("strength", [0.5, 2.0])
def test_strong_couplings_converge_by_mixing(strength: float) -> None:
    """Plain updates multiply the error by the strength."""
    scene = coupled(strength)
    dense, fft = (rf.solve(scene, 16, method=m, oblique=False, tolerance=1e-9) for m in ("dense", "fft"))
    assert fft.status is rf.Status.CONVERGED
    assert np.abs(fft.pressure - dense.pressure).max() <= 1e-6 * dense.max_pressure


def test_states_that_do_not_converge_end_taus_rule_and_say_so() -> None:
    """A coupling of eight, far beyond what materials have."""
    solution = rf.solve(coupled(8.0, tau=1e6), 16, oblique=False)
    assert solution.status is rf.Status.STAGNATED
    assert solution.cost.iterations["CG at 16 x 16"] < 1000


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
        solver = widened(problem, result, needed, Counter(), needs_mixing=solver.needs_mixing)
        assert solver.cg_iterations == steps
    assert np.abs(result.pressure - expected).max() <= 1e-6 * expected.max()
    assert solver.window.shape < shape
    inside = Window.around(expected > 0, margin=1)
    assert np.all(solver.window.mask(shape)[inside.slices])


def test_a_wider_window_holds_the_contact_and_what_penetrates_beside_it() -> None:
    shape = (48, 48)
    solver = level_solver(problem_of(BALL, 48), Window(18, 30, 18, 30))
    result = solver.result(1e-8)
    outside = np.zeros(shape, dtype=bool)
    outside[24, 31] = True
    outside[18] = result.pressure[18] > 0  # as contact on the edge is where slopes count
    assert outside[18].any()
    needed = solver.window.mask(shape) | outside
    wider = widened(solver.whole, result, needed, Counter(), needs_mixing=True)
    assert wider.needs_mixing
    assert wider.window == Window.around(needed, MARGIN).filling(shape)
    assert wider.window.shape < shape
    assert np.array_equal(wider.full(wider.cg.pressure), result.pressure)


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

    def recorded(solver: LevelSolver, tolerance: float) -> SolverResult:
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


def test_a_guess_for_a_finer_grid_has_the_plastic_core_at_the_cap() -> None:
    """The step that sharpens the guess leaves it out: there the misfit is indentation, and no error."""
    peak = rf.solve(BALL, 64, oblique=False).max_pressure
    lower = rf.Body(replace(BALL.lower.material, hardness=0.6 * peak), rf.Flat())
    hard = replace(BALL, lower=lower, load=2.0)
    coarse, fine = (problem_of(hard, M, plastic=True) for M in (32, 64))
    solver = level_solver(coarse)
    solver.solve(1e-6, first_set(coarse))
    guess = nested_solver.from_guess(fine, solver.initial_guess(), Counter())
    full = guess.full(guess.cg.pressure) >= 0.6 * peak * (1 - 1e-9)
    result, _ = solve_fft(fine, 1e-8, Counter())
    expected = result.pressure >= 0.6 * peak
    assert expected.sum() > 100
    assert np.count_nonzero(full != expected) <= 0.05 * expected.sum()
