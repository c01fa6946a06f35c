"""The production solver's own loops: lagging, patience, windows, and what is carried to a finer grid."""

from __future__ import annotations

import gc
import math
import weakref
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl import fft_solver
from refimpl.contact.certificate import certify
from refimpl.fft_solver import (
    _certified,
    _LevelSolver,
    _penetrating_outside,
    _preconditioner,
    _widened,
)
from refimpl.friction import Mask
from refimpl.nesting import foundation_pressure
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.window import Window
from refimpl.outcome import Outcome
from refimpl.problem import Problem, Terms, pose
from refimpl.slopes import Slopes

BALL = rf.Scene(
    upper=rf.Body(rf.Material(E=200e9, nu=0.3), rf.Sphere(radius=0.05)),
    lower=rf.Body(rf.Material(E=2.5e9, nu=0.2), rf.Flat()),
    friction=rf.Friction(tau=0.0, beta=0.1),
    load=1.0,
    side=2e-3,
)


def coupled(sigma: float, tau: float = 0.0) -> rf.Scene:
    """The ball with such a beta that ``beta c f`` is up to ``sigma`` times ``a f``."""
    pair = BALL.materials
    beta = sigma * pair.normal_compliance / abs(pair.shear_compliance)
    return replace(BALL, friction=rf.Friction(tau, beta))


def posed(scene: rf.Scene, M: int, *, oblique: bool = False, approach: float | None = None) -> Problem:
    terms = Terms(coupled=True, oblique=oblique, slope_correction=False)
    return pose(scene, rf.Grid(scene.side, M), terms, approach)


def level(problem: Problem, window: Window | None = None) -> _LevelSolver:
    window, counter = window or Window.full(problem.grid.M), Counter()
    start = foundation_pressure(problem)[window.slices]
    return _LevelSolver(problem, counter, window, _preconditioner(problem, window, counter), start)


@pytest.mark.parametrize("sigma", [0.3, 1.2, 2.5])
def test_relaxation_contracts_best_and_patience_waits_until_it_halves(sigma: float) -> None:
    """An update of a skew coupling multiplies its error by ``1 - w (1 + i sigma)`` at most."""
    solver = level(posed(coupled(sigma), 4))
    best = solver._relaxation

    def rate(relaxation: float) -> float:
        return abs(1 - relaxation * (1 + 1j * sigma))

    assert rate(best) < min(rate(0.999 * best), rate(1.001 * best))
    updates = solver._patience - fft_solver._STALLED
    assert rate(best) ** updates <= 0.5 < rate(best) ** (updates - 1)


class Falling:
    """Stands for CG: a residual that each step multiplies by ``factor``."""

    def __init__(self, factor: float) -> None:
        self.residual, self.factor = 1.0, factor

    def residuals(self) -> tuple[float, float]:
        return 0.0, self.residual

    def iterate(self) -> None:
        self.residual *= self.factor


@pytest.mark.parametrize(
    ("factor", "budget", "steps"),
    [
        (0.99, 1000, math.ceil(math.log(0.1) / math.log(0.99))),  # slow, but a tenth less within the patience
        (1.0, 1000, fft_solver._CG_PATIENCE + 1),  # the first step's residual is the best there is
        (0.99, 7, 7),
    ],
)
def test_cg_goes_on_while_it_gets_on(
    factor: float, budget: int, steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    solver = level(posed(BALL, 4))
    solver._budget = budget
    monkeypatch.setattr(solver, "cg", Falling(factor))
    solver._reduce(0.1)
    assert solver.cg_iterations == steps


class Updates:
    """Stands for the updates: the residual falls three times, and once the relaxation is ``small`` enough."""

    def __init__(self, solver: _LevelSolver, small: float, supports: tuple[Mask, ...]) -> None:
        self.solver, self.small, self.supports = solver, small, supports
        self.residual, self.count = 1.0, 0

    def __call__(self, support: Mask | None) -> float:
        self.solver.support = self.supports[self.count % len(self.supports)]
        self.count += 1
        if self.count <= 3 or self.solver._relaxation <= self.small:
            self.residual *= 0.4
        return self.residual


ONE, OTHER = np.eye(4, dtype=bool), ~np.eye(4, dtype=bool)


def settled(
    monkeypatch: pytest.MonkeyPatch, small: float, supports: tuple[Mask, ...], tau: float
) -> tuple[bool, Updates, float]:
    """What `settle` says of such updates, the updates, and the relaxation that it began with."""
    solver = level(posed(coupled(0.3, tau), 4))
    began, updates = solver._relaxation, Updates(solver, small, supports)
    monkeypatch.setattr(solver, "_update", updates)
    monkeypatch.setattr(solver, "_reduce", lambda goal: None)
    return solver.settle(1e-3), updates, began


@pytest.mark.parametrize(("supports", "tau"), [((ONE,), 0.5), ((ONE, OTHER), 0.0)])
def test_updates_that_stall_are_relaxed_until_they_contract(
    supports: tuple[Mask, ...], tau: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    meets, updates, began = settled(monkeypatch, 0.3, supports, tau)
    assert meets
    assert updates.solver._relaxation == 0.25 * began
    # a stall is a patience without halving; 0.4^8 < 1e-3
    assert updates.count == 3 + 2 * updates.solver._patience + 5


def test_updates_that_never_contract_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    meets, updates, _ = settled(monkeypatch, 0.0, (ONE,), tau=1e6)
    assert not meets
    assert 1 / 32 <= updates.solver._relaxation < 1 / 16


def test_a_cycling_support_of_tau_is_left_to_its_rule(monkeypatch: pytest.MonkeyPatch) -> None:
    meets, updates, began = settled(monkeypatch, 0.0, (ONE, OTHER), tau=0.5)
    assert not meets
    assert updates.solver._relaxation == began
    assert updates.count == 3 + updates.solver._patience


@pytest.mark.parametrize(("last", "status"), [(ONE, rf.Status.CONVERGED), (ONE | OTHER, rf.Status.CYCLED)])
def test_a_cycle_of_tau_is_named_where_withheld_elements_touch(
    last: Mask, status: rf.Status, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Contact grows from one set and back to it, which withholds all that changed from tau."""
    solver = level(posed(coupled(0.3, tau=0.5), 4))
    contacts = iter((ONE, ONE | OTHER, ONE, last))

    def settle(tolerance: float, support: Mask) -> bool:
        solver.cg.pressure, solver.support = np.where(next(contacts), 0.5, 0.0), support
        solver.residual, solver._tolerance = 0.0, tolerance
        return True

    monkeypatch.setattr(solver, "settle", settle)
    outcome = solver.solve(1e-6)
    assert outcome.status is status
    assert np.array_equal(outcome.withheld, ~ONE)
    assert len(outcome.visited) == 2


@pytest.mark.parametrize("sigma", [0.5, 2.0])
def test_strong_couplings_converge_by_relaxation(sigma: float) -> None:
    """Unrelaxed, the updates multiply the error by sigma."""
    scene = coupled(sigma)
    dense, fft = (rf.solve(scene, 12, method=m, oblique=False, tolerance=1e-9) for m in ("dense", "fft"))
    assert fft.status is rf.Status.CONVERGED
    assert np.abs(fft.pressure - dense.pressure).max() <= 1e-6 * dense.max_pressure


def test_without_a_support_tau_is_where_contact_is() -> None:
    solver = level(posed(coupled(0.3, tau=1e6), 16))
    assert solver.settle(1e-9)
    pressure, friction = solver.cg.pressure, solver.problem.friction
    assert 1 < np.count_nonzero(pressure) < 16**2
    expected = np.where(pressure > 0, 1e6 + friction.beta * pressure, 0.0)
    # the pressure is brought to the load once more after the traction: a change of rounding
    np.testing.assert_allclose(solver.traction, expected, rtol=1e-14, atol=0)


def test_the_certificate_knows_all_tractions_and_transforms_no_more() -> None:
    """Tau may lie beside the pressure where a run was cut short."""
    problem = posed(coupled(0.3, tau=1e6), 16)
    pressure, traction = np.zeros((16, 16)), np.zeros((16, 16))
    pressure[3:5, 6:8], traction[2:6, 6:9] = 1e7, 1e6
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
    whole = level(problem)
    expected = whole.solve(tolerance).pressure

    solver = level(problem, Window(22, 27, 21, 26))
    for _ in range(20):
        outcome = solver.solve(tolerance)
        state = _certified(problem, outcome, Counter())
        outside = _penetrating_outside(state, solver.window, tolerance)
        if not outside.any():
            break
        assert not outside[solver.window.interior(M).slices].any()
        steps = solver.cg_iterations
        solver = _widened(problem, outcome, outside, Counter())
        assert solver.cg_iterations == steps
    assert np.abs(outcome.pressure - expected).max() <= 1e-6 * expected.max()
    assert solver.window.shape < (M, M)
    needed = Window.around(expected > 0, margin=1)
    assert np.all(solver.window.spread(np.ones(solver.window.shape), M)[needed.slices])


@pytest.mark.parametrize("approach", [None, 1e-6])
def test_a_finer_grid_starts_with_nearly_the_answer(approach: float | None) -> None:
    coarse, fine = (posed(BALL, M, approach=approach) for M in (32, 64))
    solver = level(coarse)
    assert solver.settle(1e-6)
    refined = solver.refined(fine)
    answer = level(fine)
    assert answer.settle(1e-8)
    exact, start = answer.cg.pressure, refined.full(refined.cg.pressure)
    assert refined.window == Window.around(exact > 0, fft_solver._MARGIN).filling(64)
    # the coarse grid's own error, measured: 0.080 and 0.057, and a fifteenth of the contact's elements
    assert np.linalg.norm(start - exact) <= 0.1 * np.linalg.norm(exact)
    assert np.count_nonzero((start > 0) != (exact > 0)) <= 0.08 * np.count_nonzero(exact)
    assert refined.settle(1e-8)
    assert refined.cg_iterations <= 12 < answer.cg_iterations  # measured: 11 instead of 14 and 19


def test_a_solver_that_is_dropped_is_gone_at_once() -> None:
    """No cycle of references keeps a level's arrays until the garbage is collected."""
    gc.disable()
    try:
        solver = level(posed(BALL, 16))
        solver.settle(1e-3)
        gone = weakref.ref(solver.cg)
        del solver
        assert gone() is None
    finally:
        gc.enable()
