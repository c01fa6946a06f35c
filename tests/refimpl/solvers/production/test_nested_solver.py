"""The production solver from grid to grid: windows that are widened, the certificate, what is reported."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid.window import Window
from refimpl.model.certificate import certify
from refimpl.model.friction import Mask
from refimpl.model.slopes import Slopes
from refimpl.model.state import Outcome
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.solvers.production import nested_solver
from refimpl.solvers.production.nested_solver import _beyond, _certified, _widened, solve_fft
from refimpl.solvers.production.projected_cg import Apply
from tests.refimpl.solvers.production.levels import BALL, coupled, level_solver, posed


@pytest.mark.parametrize("sigma", [0.5, 2.0])
def test_strong_couplings_converge_by_mixing(sigma: float) -> None:
    """Plain updates multiply the error by sigma."""
    scene = coupled(sigma)
    dense, fft = (rf.solve(scene, 16, method=m, oblique=False, tolerance=1e-9) for m in ("dense", "fft"))
    assert fft.status is rf.Status.CONVERGED
    assert np.abs(fft.pressure - dense.pressure).max() <= 1e-6 * dense.max_pressure


def test_states_that_cannot_be_settled_end_the_path_of_tau_and_say_so() -> None:
    """A coupling of eight, far beyond what materials have."""
    solution = rf.solve(coupled(8.0, tau=1e6), 16, oblique=False)
    assert solution.status is rf.Status.STAGNATED
    assert solution.cost.iterations["CG at 16"] < 1000


STEEP = rf.Scene(
    upper=rf.Body(rf.Material(50e9, 0.2), rf.Sphere(2.4e-3) + rf.GaussianRoughness(3.3e-6, 51e-6, seed=4344)),
    lower=rf.Body(rf.Material(2.8e9, 0.24), rf.GaussianRoughness(3.3e-6, 74e-6, seed=4345)),
    friction=rf.Friction(tau=1.1e6, beta=0.32),
    load=40.0,
    side=1e-3,
)
"""Rough on rough: slopes of 0.13 (rms), modulus ratio 18, displacements of ten elements on a grid of 256."""


def test_steep_slopes_converge_on_fine_grids() -> None:
    """Their feedback grows with displacement over spacing; relaxed updates stagnated from 256 on."""
    coarse, fine = (rf.solve(STEEP, M) for M in (128, 256))
    assert coarse.status is fine.status is rf.Status.CONVERGED
    assert fine.friction_coefficient == pytest.approx(coarse.friction_coefficient, rel=0.01)
    assert fine.cost.iterations["CG at 256"] < 200


def test_what_feeds_back_strongly_does_so_on_finer_grids() -> None:
    problem = posed(STEEP, 128, oblique=True)
    solver = level_solver(problem)
    solver.settle(1e-3)
    assert solver.strong
    assert solver.answer().strong
    finer = nested_solver.begun(posed(STEEP, 256, oblique=True), solver.answer(), Counter())
    assert finer.strong


def test_residuals_are_continued_beyond_the_contact_that_a_grid_begins_with(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[Mask] = []

    def recorded(precondition: Apply, contact: Mask) -> Apply:
        asked.append(contact)
        return precondition

    monkeypatch.setattr(nested_solver, "extended", recorded)
    coarse = level_solver(posed(BALL, 16))
    coarse.settle(1e-3)
    finer = nested_solver.begun(posed(BALL, 32), coarse.answer(), Counter())
    assert finer.contact.any()
    assert not finer.contact.all()
    assert np.array_equal(asked[-1], finer.contact)


@pytest.mark.parametrize("rows", [slice(2, 6), slice(6, 9)])
def test_the_certificate_knows_all_tractions_and_transforms_no_more(rows: slice) -> None:
    """Tau may lie around or beside the pressure where a run was cut short."""
    problem = posed(coupled(0.3, tau=1e6), 16)
    pressure, traction = np.zeros((16, 16)), np.zeros((16, 16))
    pressure[3:5, 6:8], traction[rows, 6:9] = 1e7, 1e6
    traction[3:5, 6:8] = 1e6
    flat = Slopes.flat((16, 16))
    outcome = Outcome(
        pressure, traction, flat, rf.Status.CONVERGED, withheld=pressure > 0, visited=(), iterations={}
    )
    found, everything = Counter(), Counter()
    state = _certified(problem, outcome, found)
    operator = FFTInfluence(problem.grid, problem.direction, counter=everything)
    exact = certify(problem, operator, pressure, traction, flat)
    for name in ("displacement_lower", "displacement_upper"):
        expected = getattr(exact, name)
        # rounding of a sum over the loaded elements
        assert np.abs(getattr(state, name) - expected).max() <= 1e-14 * np.abs(expected).max()
    assert found.tally == everything.tally
    assert found.point_logs < 0.6 * everything.point_logs


def test_a_window_that_is_too_small_is_widened_no_further_than_needed() -> None:
    M, tolerance = 48, 1e-8
    problem = posed(BALL, M)
    whole = level_solver(problem)
    expected = whole.solve(tolerance).pressure

    solver = level_solver(problem, Window(22, 27, 21, 26))
    for _ in range(20):
        outcome = solver.solve(tolerance)
        state = _certified(problem, outcome, Counter())
        outside = _beyond(problem, state, solver.window, tolerance)
        if not outside.any():
            break
        assert not outside[solver.window.interior(M).slices].any()
        steps = solver.cg_iterations
        outside |= solver.window.mask(M)
        solver = _widened(problem, outcome, outside, Counter(), strong=solver.strong)
        assert solver.cg_iterations == steps
    assert np.abs(outcome.pressure - expected).max() <= 1e-6 * expected.max()
    assert solver.window.shape < (M, M)
    needed = Window.around(expected > 0, margin=1)
    assert np.all(solver.window.spread(np.ones(solver.window.shape), M)[needed.slices])


def test_a_wider_window_holds_the_contact_and_what_penetrates_beside_it() -> None:
    M = 48
    solver = level_solver(posed(BALL, M), Window(18, 30, 18, 30))
    outcome = solver.solve(1e-8)
    outside = np.zeros((M, M), dtype=bool)
    outside[24, 31] = True
    outside[18] = outcome.pressure[18] > 0  # as contact on the edge is where slopes count
    assert outside[18].any()
    needed = solver.window.mask(M) | outside
    wider = _widened(solver.whole, outcome, needed, Counter(), strong=True)
    assert wider.strong
    assert wider.window == Window.around(needed, nested_solver.MARGIN).filling(M)
    assert wider.window.shape < (M, M)
    assert np.array_equal(wider.full(wider.cg.pressure), outcome.pressure)


def test_steps_are_reported_of_every_grid_and_the_finest_has_little_left_to_do() -> None:
    outcome, _ = solve_fft(posed(BALL, 128), 1e-6, Counter())
    assert list(outcome.iterations) == ["CG at 128", "CG at 32"]
    # measured: 7, and 12 where the coarser grids are not solved
    assert outcome.iterations["CG at 128"] <= 9
    assert max(outcome.iterations.values()) <= 9  # and no coarse grid is solved to the end


def test_what_just_touches_outside_a_window_is_no_penetration() -> None:
    problem = posed(BALL, 16)
    state = _certified(problem, level_solver(problem).solve(1e-8), Counter())
    touching = replace(state, separation=np.full((16, 16), state.approach))
    assert not _beyond(problem, touching, Window(7, 9, 7, 9), 1e-8).any()


def test_facet_tractions_are_the_dense_solvers() -> None:
    """With the slope correction what presses is not the pressure, and its displacement is applied anew."""
    scene = replace(BALL, load=60.0)
    dense, fft = (
        rf.solve(scene, 12, method=m, oblique=True, slope_correction=True, tolerance=1e-10)
        for m in ("dense", "fft")
    )
    assert fft.status is dense.status is rf.Status.CONVERGED
    assert dense.slope_error.max_slope > 0.015
    np.testing.assert_allclose(fft.pressure, dense.pressure, atol=1e-8 * dense.max_pressure, rtol=0)


def test_contact_on_a_windows_edge_has_outgrown_it_where_slopes_count() -> None:
    """One-sided on the edge, they are central on the whole grid."""
    problem = posed(replace(BALL, load=20.0), 16, oblique=True)
    state = _certified(problem, level_solver(problem).solve(1e-8), Counter())
    contact = state.pressure > 0
    tight = Window.around(contact, margin=0)
    assert 0 < tight.i0 < tight.i1 < 16
    on_edge = contact.copy()
    on_edge[tight.interior(16).slices] = False
    assert on_edge.any()
    assert np.array_equal(_beyond(problem, state, tight, 1e-8), on_edge)
    faint = replace(state, pressure=1e-12 * state.pressure)  # no pascal is too little
    assert np.array_equal(_beyond(problem, faint, tight, 1e-8), on_edge)
    assert not _beyond(problem, state, Window.around(contact, margin=1), 1e-8).any()
    flat = posed(replace(BALL, load=20.0), 16)
    assert not _beyond(flat, state, tight, 1e-8).any()


def test_without_friction_the_certificate_transforms_no_more_than_the_contact_needs() -> None:
    problem = posed(replace(BALL, friction=rf.Friction()), 32)
    outcome = level_solver(problem).solve(1e-6)
    found, everything = Counter(), Counter()
    _certified(problem, outcome, found)
    _certified(problem, replace(outcome, pressure=np.ones((32, 32))), everything)
    assert found.point_logs < 0.6 * everything.point_logs


def test_grids_are_climbed_from_coarse_to_fine() -> None:
    """Three of them: quartered, then halved; the last is the one asked for."""
    found = rf.solve(replace(BALL, friction=rf.Friction()), 256, oblique=False, tolerance=1e-3)
    assert set(found.cost.iterations) == {"CG at 32", "CG at 128", "CG at 256"}
    assert found.pressure.shape == (256, 256)
    assert found.converged
