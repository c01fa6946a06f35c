"""One grid of the production solver: what is held during CG, brought up to date, and carried on."""

from __future__ import annotations

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from refimpl.grid.window import Window
from refimpl.model.certificate import certify
from refimpl.model.problem import Terms, pose
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import FFTInfluence
from refimpl.solvers.production import nested_solver
from tests.refimpl.solvers.production.levels import BALL, coupled, level_solver, posed, press

ONE_OF_EIGHT = np.eye(8, dtype=bool)


def test_without_a_support_tau_is_nowhere() -> None:
    """As on coarse grids: tau's rule begins so, and there only."""
    solver = level_solver(posed(coupled(0.3, tau=1e6), 16))
    assert solver.settle(1e-9)
    pressure, friction = solver.cg.pressure, solver.problem.friction
    assert 1 < np.count_nonzero(pressure) < 16**2
    assert np.array_equal(solver.held.traction, friction.beta * pressure)
    assert not solver.held.support.any()


def test_beside_a_coarse_window_elements_that_are_pressed_away_do_not_touch() -> None:
    """A ball's gap is below the approach as far as 1.41 contact radii; its displacement parts them there."""
    coarse, fine = (posed(replace(BALL, load=20.0), M) for M in (32, 64))
    whole = level_solver(coarse)
    assert whole.settle(1e-6)
    solver = level_solver(coarse, Window.around(whole.cg.pressure > 0, 1))
    assert solver.settle(1e-6)
    beside = np.ones((32, 32), dtype=bool)
    beside[solver.window.slices] = False
    assert np.any(beside & (coarse.gap < 0.9 * solver.cg.approach))
    expected, found = (
        nested_solver.begun(fine, whole.answer(), whole.counter),
        nested_solver.begun(fine, solver.answer(), solver.counter),
    )
    assert found.window == expected.window
    assert np.array_equal(found.cg.contact, expected.cg.contact)
    np.testing.assert_allclose(found.cg.pressure, expected.cg.pressure, rtol=1e-4, atol=1.0)


class Between:
    """Stands for mixing: a quarter of the way from what was held to what is asked for; both are kept."""

    def mixed(self, held: Array, asked: Array) -> Array:
        self.held, self.asked = held, asked
        return held + 0.25 * (asked - held)


@pytest.mark.parametrize(("sigma", "oblique"), [(0.4, True), (0.4, False), (0.2, True)])
def test_what_lags_is_mixed_without_units(sigma: float, oblique: bool) -> None:
    """Shear where CG has not taken it in, in displacements, and cosines where there are slopes."""
    solver = level_solver(posed(coupled(sigma), 16, oblique=oblique))
    held = solver.held
    held.update(0)
    held.mix(None)  # nothing to mix yet
    shear, K = held._led
    solver.cg.iterate()
    held.update(1)
    displaced, mixing = np.abs(solver.cg.normal_displacement).max(), Between()
    held.mix(mixing)
    lagging = [(shear, held._asked[0])] * (sigma > 0.3) + [(K, held._asked[1])] * oblique
    scales = [displaced] * (sigma > 0.3) + [1.0] * oblique
    for part, name in enumerate(("held", "asked")):
        expected = np.vstack([pair[part] / scale for pair, scale in zip(lagging, scales, strict=True)])
        np.testing.assert_allclose(getattr(mixing, name), expected, rtol=1e-14)
    assert np.abs(mixing.asked - mixing.held).max() > 1e-7  # CG moved something
    mixed_shear = shear + 0.25 * (held._asked[0] - shear) if sigma > 0.3 else held._asked[0]
    mixed_K = K + 0.25 * (held._asked[1] - K)
    bound = 1e-14 * np.abs(solver.cg._b).max()
    np.testing.assert_allclose(solver.cg._K, mixed_K, rtol=1e-14)
    np.testing.assert_allclose(solver.cg._b, mixed_K * solver.problem.gap + mixed_shear, rtol=0, atol=bound)
    np.testing.assert_allclose(held._led[1], mixed_K, rtol=1e-14)


class Beyond:
    """Stands for mixing that goes too far: to cosines of no slope."""

    def mixed(self, held: Array, asked: Array) -> Array:
        return np.where(np.arange(asked.size).reshape(asked.shape) % 2, 1.1, -0.1)


def test_mixed_cosines_stay_cosines() -> None:
    solver = level_solver(posed(BALL, 16, oblique=True))
    solver.held.update(0)
    solver.held.mix(None)
    solver.held.mix(Beyond())
    assert set(np.unique(solver.cg._K)) == {1e-6, 1.0}


@pytest.mark.parametrize("friction", [rf.Friction(), rf.Friction(tau=1.0), rf.Friction(beta=0.1)])
@pytest.mark.parametrize("coupled", [False, True])
@pytest.mark.parametrize("oblique", [False, True])
@pytest.mark.parametrize("slope_correction", [False, True])
def test_what_lags(friction: rf.Friction, coupled: bool, oblique: bool, slope_correction: bool) -> None:
    """Slopes, and tractions on them; tau is constant on its support."""
    terms = Terms(coupled=coupled, oblique=oblique, slope_correction=slope_correction)
    problem = pose(replace(BALL, friction=friction), rf.Grid(BALL.side, 4), terms, None)
    assert level_solver(problem).held.lags is max(oblique, slope_correction)


@pytest.mark.parametrize("tau", [0.0, 1e6])
@pytest.mark.parametrize(("sigma", "lags"), [(0.29, False), (0.31, True)])
def test_strong_coupling_lags(sigma: float, lags: bool, tau: float) -> None:
    assert level_solver(posed(coupled(sigma, tau=tau), 4)).held.lags is lags


def test_any_pressure_is_contact() -> None:
    """However small in pascals: it carries tau, and its slopes count."""
    solver = level_solver(posed(replace(BALL, friction=rf.Friction(tau=1.0, beta=0.0)), 8))
    press(solver.cg, np.where(ONE_OF_EIGHT, 1e-3, 0.0))
    assert np.array_equal(solver.contact, ONE_OF_EIGHT)
    solver.held.support = solver.contact
    assert np.array_equal(solver.held.traction, 1.0 * ONE_OF_EIGHT)


@pytest.mark.parametrize(("inside", "seen"), [(True, True), (False, False)])
def test_slopes_of_facets_that_are_out_of_date_count_where_there_is_contact(inside: bool, seen: bool) -> None:
    facets = Terms(coupled=True, oblique=True, slope_correction=True)
    solver = level_solver(replace(posed(BALL, 16), terms=facets))
    assert solver.settle(1e-8)
    where = (solver.cg.pressure > 0) == inside
    assert 1 < np.count_nonzero(where) < 16**2
    solver.held.slopes = Slopes(solver.held.slopes.tan_x + 1e-3 * where, solver.held.slopes.tan_y)
    assert (solver.held.update(solver.cg_iterations) >= 0.999e-3) is seen


def test_a_load_that_shear_on_slopes_exceeds_leaves_some_contact() -> None:
    """A thousandth of the load, more or less: enough to go on from, and too little to balance."""
    solver = level_solver(posed(replace(BALL, friction=rf.Friction(tau=1e9, beta=0.0)), 8, oblique=True))
    solver.held.support = np.ones((8, 8), dtype=bool)
    solver.held.slopes = Slopes(np.full((8, 8), -0.5), np.zeros((8, 8)))  # downhill: tau takes from the load
    target, balance = solver.held._target(solver.held.slopes.obliqueness)
    assert target is not None
    pressed = target * solver.problem.grid.element_area / BALL.load
    assert 1e-4 <= pressed <= 1e-2
    assert balance > 1


@pytest.mark.parametrize("approach", [None, 1e-6])
def test_a_finer_grid_starts_with_nearly_the_answer(approach: float | None) -> None:
    coarse, fine = (posed(BALL, M, approach=approach) for M in (32, 64))
    solver = level_solver(coarse)
    assert solver.settle(1e-6)
    refined = nested_solver.begun(fine, solver.answer(), solver.counter)
    answer = level_solver(fine)
    assert answer.settle(1e-8)
    exact, start = answer.cg.pressure, refined.full(refined.cg.pressure)
    assert refined.window == Window.around(exact > 0, nested_solver.MARGIN).filling(64)
    # the coarse grid's own error, measured: 0.080 and 0.057, and a fifteenth of the contact's elements
    assert np.linalg.norm(start - exact) <= 0.1 * np.linalg.norm(exact)
    assert np.count_nonzero((start > 0) != (exact > 0)) <= 0.08 * np.count_nonzero(exact)
    assert refined.settle(1e-8)
    assert refined.cg_iterations <= 10  # measured: 9 and 9
    if approach is not None:  # measured: 12; under a load springs are as good a start for a smooth ball, 9
        assert refined.cg_iterations < answer.cg_iterations


def test_a_solver_that_is_dropped_is_gone_at_once() -> None:
    """No cycle of references keeps a level's arrays until the garbage is collected."""
    gc.disable()
    try:
        solver = level_solver(posed(BALL, 16))
        solver.settle(1e-3)
        gone = weakref.ref(solver.cg)
        del solver
        assert gone() is None
    finally:
        gc.enable()


def test_without_facet_tractions_an_update_applies_no_pressure() -> None:
    solver = level_solver(posed(coupled(0.2), 16))
    before = dict(solver.counter.tally)
    solver.held.update(solver.cg_iterations)
    assert solver.counter.tally == before


@pytest.mark.parametrize("slope_correction", [False, True])
def test_the_residual_is_what_the_certificate_finds(slope_correction: bool) -> None:
    """Also of facet tractions, which take the slopes of the update before: they are told with the state.

    The last update scales the pressure to the load, by less than a thousandth here.
    """
    steep = replace(BALL, upper=replace(BALL.upper, surface=rf.Sphere(radius=4e-3)), load=50.0)
    terms = Terms(coupled=True, oblique=True, slope_correction=slope_correction)
    problem = pose(steep, rf.Grid(steep.side, 32), terms, None)
    solver = level_solver(problem)
    outcome = solver.solve(1e-4)
    operator = FFTInfluence(problem.grid, problem.direction)
    state = certify(problem, operator, outcome.pressure, outcome.traction, outcome.slopes)
    assert outcome.status is rf.Status.CONVERGED
    assert state.certificate.worst == pytest.approx(solver.residual, rel=1e-3)
