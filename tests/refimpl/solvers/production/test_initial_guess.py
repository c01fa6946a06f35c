"""From grid to grid: what a coarser solution leaves to a finer one, and what that saves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Window
from refimpl.model.problem import Problem
from refimpl.operators.fft import Counter
from refimpl.solvers.production import nested_solver
from refimpl.solvers.production.constants import MARGIN
from refimpl.solvers.production.level import LevelSolver
from refimpl.solvers.production.nested_solver import from_guess, solve_fft
from refimpl.solvers.tau_active_set import FixedSet, first_set
from tests.refimpl.solvers.production.levels import BALL, level_solver, problem_of

STEEP = rf.Scene(
    upper=rf.Body(rf.Material(50e9, 0.2), rf.Sphere(2.4e-3) + rf.GaussianRoughness(3.3e-6, 51e-6, seed=4344)),
    lower=rf.Body(rf.Material(2.8e9, 0.24), rf.GaussianRoughness(3.3e-6, 74e-6, seed=4345)),
    friction=rf.Friction(tau=1.1e6, beta=0.32),
    load=40.0,
    side=1e-3,
)
"""Rough on rough: slopes of 0.13 (rms), modulus ratio 18, displacements of ten elements on a grid of 256."""


def solved(problem: Problem, tolerance: float, window: Window | None = None) -> LevelSolver:
    """The level's solver after a solve without tau."""
    solver = level_solver(problem, window)
    assert solver.solve(tolerance, FixedSet(np.zeros(solver.problem.gap.shape, dtype=bool)))
    return solver


def continued(solver: LevelSolver, finer: Problem) -> LevelSolver:
    return from_guess(finer, solver.initial_guess(), Counter())


def test_beside_a_coarse_window_elements_that_are_pressed_away_do_not_touch() -> None:
    """A ball's gap is below the approach as far as 1.41 contact radii; its displacement parts them there."""
    coarse, fine = (problem_of(replace(BALL, load=20.0), M) for M in (32, 64))
    whole = solved(coarse, 1e-6)
    windowed = solved(coarse, 1e-6, Window.around(whole.contact, 1))
    beside = np.ones((32, 32), dtype=bool)
    beside[windowed.window.slices] = False
    assert np.any(beside & (coarse.gap < 0.9 * windowed.cg.approach))
    expected, found = continued(whole, fine), continued(windowed, fine)
    assert found.window == expected.window
    assert np.array_equal(found.cg.contact, expected.cg.contact)
    np.testing.assert_allclose(found.cg.pressure, expected.cg.pressure, rtol=1e-4, atol=1.0)


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


def test_steep_slopes_converge_on_fine_grids() -> None:
    """Their feedback grows with displacement over spacing; relaxed updates stagnated from 256 on."""
    coarse, fine = (rf.solve(STEEP, M) for M in (128, 256))
    assert coarse.status is fine.status is rf.Status.CONVERGED
    assert fine.friction_coefficient == pytest.approx(coarse.friction_coefficient, rel=0.01)
    assert fine.cost.iterations["CG at 256 x 256"] < 200


def test_steps_are_reported_of_every_grid_and_the_finest_has_few_left() -> None:
    result, _ = solve_fft(problem_of(BALL, 128), 1e-6, Counter())
    assert list(result.iterations) == ["CG at 128 x 128", "CG at 32 x 32"]
    # measured: 7, and 12 where the coarser grids are not solved
    assert result.iterations["CG at 128 x 128"] <= 9
    assert max(result.iterations.values()) <= 9  # and no coarse grid is solved to the end


def test_a_guess_without_any_pressure_is_replaced_by_a_foundation(monkeypatch: pytest.MonkeyPatch) -> None:
    """Contact is likely there, but the coarse grid pressed elsewhere: there is nothing to start from."""
    coarse, fine = solved(problem_of(BALL, 16), 1e-3), problem_of(BALL, 32)

    def nothing(pressure: Array, *others: object, **options: object) -> Array:
        return np.zeros_like(pressure)

    monkeypatch.setattr(nested_solver, "sharpened", nothing)
    found = continued(coarse, fine)
    assert found.window == fine.grid.window
    assert found.cg.pressure.sum() * fine.grid.element_area == pytest.approx(BALL.load, rel=1e-12)


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
    found, _ = solve_fft(problem, 1e-6, Counter(), start)
    assert ("CG at 16 x 16" in found.iterations) is (abs(factor - 1) > 0.02)
