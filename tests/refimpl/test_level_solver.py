"""One grid of the production solver: lagging, patience, relaxation, and what is carried to a finer grid."""

from __future__ import annotations

import gc
import math
import weakref
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl import level_solver
from refimpl.contact.certificate import certify
from refimpl.friction import Mask
from refimpl.level_solver import LevelSolver
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.window import Window
from refimpl.problem import Terms, pose
from refimpl.slopes import Slopes
from tests.refimpl.levels import BALL, coupled, level, posed


@pytest.mark.parametrize("sigma", [0.3, 1.2, 2.5])
def test_relaxation_contracts_best_and_patience_waits_until_it_halves(sigma: float) -> None:
    """An update of a skew coupling multiplies its error by ``1 - w (1 + i sigma)`` at most."""
    solver = level(posed(coupled(sigma), 4))
    best = solver._relaxation

    def rate(relaxation: float) -> float:
        return abs(1 - relaxation * (1 + 1j * sigma))

    assert rate(best) < min(rate(0.999 * best), rate(1.001 * best))
    updates = solver._patience - level_solver._STALLED
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
        (1.0, 1000, level_solver._CG_PATIENCE + 1),  # the first step's residual is the best there is
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
    """Stands for the updates: the residual falls at first, and once the relaxation is ``small`` enough."""

    def __init__(self, solver: LevelSolver, small: float, supports: tuple[Mask, ...], falls: int) -> None:
        self.solver, self.small, self.supports, self.falls = solver, small, supports, falls
        self.residual, self.count = 1.0, 0

    def __call__(self, support: Mask | None) -> float:
        self.solver.support = self.supports[self.count % len(self.supports)]
        self.count += 1
        if self.count <= self.falls or self.solver._relaxation <= self.small:
            self.residual *= 0.4
        return self.residual


ONE, OTHER = np.eye(4, dtype=bool), ~np.eye(4, dtype=bool)
ONE_OF_EIGHT = np.eye(8, dtype=bool)


def settled(
    monkeypatch: pytest.MonkeyPatch,
    small: float,
    supports: tuple[Mask, ...],
    tau: float,
    sigma: float = 0.3,
    falls: int = 3,
) -> tuple[bool, Updates, float]:
    """What `settle` says of such updates, the updates, and the relaxation that it began with."""
    solver = level(posed(coupled(sigma, tau), 4))
    began, updates = solver._relaxation, Updates(solver, small, supports, falls)
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


def test_updates_that_stall_from_the_first_are_relaxed_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    """Under tau, while its support stays: nothing cycles."""
    meets, updates, began = settled(monkeypatch, 0.3, (ONE,), tau=0.5, falls=0)
    assert meets
    assert updates.solver._relaxation == 0.25 * began


@pytest.mark.parametrize(("share", "met"), [(0.985, True), (0.995, False)])
def test_the_certificate_may_round_otherwise(
    share: float, met: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A residual counts as met a hundredth below the tolerance: 1e-12 leaves rounding a thousandth."""
    solver = level(posed(BALL, 4))
    monkeypatch.setattr(solver, "_update", lambda support: share * 1e-12)
    monkeypatch.setattr(solver, "_reduce", lambda goal: None)
    solver.support = ONE
    assert solver.settle(1e-12) is met


@pytest.mark.parametrize("sigma", [0.0, 0.3])
def test_updates_that_never_contract_are_given_up(sigma: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """At a sixteenth, which halvings of one meet, they are still tried."""
    meets, updates, _ = settled(monkeypatch, 0.0, (ONE,), tau=1e6, sigma=sigma)
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


def test_without_a_support_tau_is_where_contact_is() -> None:
    solver = level(posed(coupled(0.3, tau=1e6), 16))
    assert solver.settle(1e-9)
    pressure, friction = solver.cg.pressure, solver.problem.friction
    assert 1 < np.count_nonzero(pressure) < 16**2
    expected = np.where(pressure > 0, 1e6 + friction.beta * pressure, 0.0)
    # the pressure is brought to the load once more after the traction: a change of rounding
    np.testing.assert_allclose(solver.traction, expected, rtol=1e-14, atol=0)


def test_beside_a_coarse_window_elements_that_are_pressed_away_do_not_touch() -> None:
    """A ball's gap is below the approach as far as 1.41 contact radii; its displacement parts them there."""
    coarse, fine = (posed(replace(BALL, load=20.0), M) for M in (32, 64))
    whole = level(coarse)
    assert whole.settle(1e-6)
    solver = level(coarse, Window.around(whole.cg.pressure > 0, 1))
    assert solver.settle(1e-6)
    beside = np.ones((32, 32), dtype=bool)
    beside[solver.window.slices] = False
    assert np.any(beside & (coarse.gap < 0.9 * solver.cg.approach))
    expected, found = (
        LevelSolver.begun(fine, whole.answer(), whole.counter),
        LevelSolver.begun(fine, solver.answer(), solver.counter),
    )
    assert found.window == expected.window
    assert np.array_equal(found.cg.contact, expected.cg.contact)
    np.testing.assert_allclose(found.cg.pressure, expected.cg.pressure, rtol=1e-4, atol=1.0)


@pytest.mark.parametrize("tolerance", np.geomspace(1e-3, 1e-8, 15))
def test_where_nothing_lags_no_step_is_taken_below_the_tolerance(
    tolerance: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But for a tenth of it that is left to rounding."""
    terms = Terms(coupled=False, oblique=False, slope_correction=False)
    frictionless = pose(replace(BALL, load=20.0), rf.Grid(BALL.side, 64), terms, None)
    solver = level(frictionless)
    before: list[float] = []
    iterate = solver.cg.iterate

    def recorded() -> None:
        before.append(max(solver.cg.residuals()))
        iterate()

    monkeypatch.setattr(solver.cg, "iterate", recorded)
    assert solver.settle(tolerance)
    assert min(before) > 0.9 * tolerance
    assert solver.cg_iterations == len(before) > 1


@pytest.mark.parametrize("relaxation", [0.25, 0.5])
def test_a_relaxed_update_goes_that_part_of_the_way(relaxation: float) -> None:
    """From what was held, in the shear displacement and in the obliqueness."""
    problem = posed(coupled(0.3), 16, oblique=True)
    plain, relaxed = level(problem), level(problem)
    plain._relaxation, relaxed._relaxation = 1.0, relaxation
    first, second = plain.cg.pressure, 3 * np.sqrt(plain.cg.pressure * plain.cg.pressure.max())
    held = []
    for solver in (plain, relaxed):
        for pressure in (first, second):
            solver._tolerance, solver.cg.pressure = 0.0, pressure
            solver.cg.normal_displacement = solver.cg._apply(pressure)
            solver._update(None)
            held.append((solver.cg._b, solver.cg._K))
    before, after, same, between = held
    for old, new, again, found in zip(before, after, same, between, strict=True):
        assert np.array_equal(again, old)
        assert np.abs(new - old).max() > 1e-6 * np.abs(old).max()
        bound = 1e-14 * np.abs(old).max()
        np.testing.assert_allclose(found, old + relaxation * (new - old), rtol=0, atol=bound)


@pytest.mark.parametrize(
    ("residual", "steps", "status"),
    [
        (1e-8, 5, rf.Status.CONVERGED),
        (1e-8, 10, rf.Status.CONVERGED),
        (1.1e-8, 9, rf.Status.STAGNATED),
        (1.1e-8, 10, rf.Status.ITERATION_LIMIT),
    ],
)
def test_how_a_settling_ended(residual: float, steps: int, status: rf.Status) -> None:
    solver = level(posed(BALL, 4))
    solver.residual, solver._tolerance = residual, 1e-8
    solver.cg_iterations, solver._budget = steps, 10
    assert solver._ended() is status


@pytest.mark.parametrize("friction", [rf.Friction(), rf.Friction(tau=0.0, beta=0.1), rf.Friction(tau=1.0)])
def test_without_tau_one_settling_is_all(friction: rf.Friction, monkeypatch: pytest.MonkeyPatch) -> None:
    solver = level(posed(replace(BALL, friction=friction), 8))
    settlings: list[Mask | None] = []
    settle = solver.settle

    def recorded(tolerance: float, support: Mask | None = None) -> bool:
        settlings.append(support)
        return settle(tolerance, support)

    monkeypatch.setattr(solver, "settle", recorded)
    assert solver.solve(1e-8).status is rf.Status.CONVERGED
    if friction.tau == 0:
        assert settlings == [None]
    else:
        assert all(support is not None for support in settlings)
        assert len(settlings) > 1


@pytest.mark.parametrize("friction", [rf.Friction(), rf.Friction(tau=1.0), rf.Friction(beta=0.1)])
@pytest.mark.parametrize("coupled", [False, True])
@pytest.mark.parametrize("oblique", [False, True])
@pytest.mark.parametrize("slope_correction", [False, True])
def test_what_lags(friction: rf.Friction, coupled: bool, oblique: bool, slope_correction: bool) -> None:
    """Slopes, tractions on them, and shear where there is friction and the bodies differ."""
    terms = Terms(coupled=coupled, oblique=oblique, slope_correction=slope_correction)
    problem = pose(replace(BALL, friction=friction), rf.Grid(BALL.side, 4), terms, None)
    sheared = coupled and max(friction.tau, friction.beta) > 0
    assert level(problem)._lags is max(oblique, slope_correction, sheared)


def test_any_pressure_is_contact() -> None:
    """However small in pascals: it carries tau, and its slopes count."""
    solver = level(posed(replace(BALL, friction=rf.Friction(tau=1.0, beta=0.0)), 8))
    solver.cg.pressure = np.where(ONE_OF_EIGHT, 1e-3, 0.0)
    solver._tolerance = 1e-8
    solver._update(None)
    assert np.array_equal(solver.support, ONE_OF_EIGHT)
    assert np.array_equal(solver.traction, 1.0 * ONE_OF_EIGHT)


@pytest.mark.parametrize(("inside", "seen"), [(True, True), (False, False)])
def test_slopes_of_facets_that_are_out_of_date_count_where_there_is_contact(inside: bool, seen: bool) -> None:
    facets = Terms(coupled=True, oblique=True, slope_correction=True)
    solver = level(replace(posed(BALL, 16), terms=facets))
    assert solver.settle(1e-8)
    where = (solver.cg.pressure > 0) == inside
    assert 1 < np.count_nonzero(where) < 16**2
    solver.slopes = Slopes(solver.slopes.tan_x + 1e-3 * where, solver.slopes.tan_y)
    assert (solver._update(None) >= 0.999e-3) is seen


def test_a_load_that_shear_on_slopes_exceeds_leaves_some_contact() -> None:
    """A thousandth of the load, more or less: enough to go on from, and too little to balance."""
    solver = level(posed(replace(BALL, friction=rf.Friction(tau=1e9, beta=0.0)), 8, oblique=True))
    solver.support = np.ones((8, 8), dtype=bool)
    solver.slopes = Slopes(np.full((8, 8), -0.5), np.zeros((8, 8)))  # downhill: tau takes from the load
    target, balance = solver._target(solver.slopes.obliqueness)
    assert target is not None
    pressed = target * solver.problem.grid.element_area / BALL.load
    assert 1e-4 <= pressed <= 1e-2
    assert balance > 1


@pytest.mark.parametrize("approach", [None, 1e-6])
def test_a_finer_grid_starts_with_nearly_the_answer(approach: float | None) -> None:
    coarse, fine = (posed(BALL, M, approach=approach) for M in (32, 64))
    solver = level(coarse)
    assert solver.settle(1e-6)
    refined = LevelSolver.begun(fine, solver.answer(), solver.counter)
    answer = level(fine)
    assert answer.settle(1e-8)
    exact, start = answer.cg.pressure, refined.full(refined.cg.pressure)
    assert refined.window == Window.around(exact > 0, level_solver.MARGIN).filling(64)
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


def test_without_facet_tractions_an_update_applies_no_pressure() -> None:
    solver = level(posed(coupled(0.3), 16))
    before = solver.counter.tally["normal"]
    solver._update(None)
    assert solver.counter.tally["normal"] == before


@pytest.mark.parametrize("slope_correction", [False, True])
def test_the_residual_is_what_the_certificate_finds(slope_correction: bool) -> None:
    """Also of facet tractions, which take the slopes of the update before: they are told with the state.

    The last update scales the pressure to the load, by less than a thousandth here.
    """
    steep = replace(BALL, upper=replace(BALL.upper, surface=rf.Sphere(radius=4e-3)), load=50.0)
    terms = Terms(coupled=True, oblique=True, slope_correction=slope_correction)
    problem = pose(steep, rf.Grid(steep.side, 32), terms, None)
    solver = level(problem)
    outcome = solver.solve(1e-4)
    operator = FFTInfluence(problem.grid, problem.direction)
    state = certify(problem, operator, outcome.pressure, outcome.traction, outcome.slopes)
    assert outcome.status is rf.Status.CONVERGED
    assert state.certificate.worst == pytest.approx(solver.residual, rel=1e-3)
