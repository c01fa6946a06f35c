"""One grid of the production solver: how it settles, by updates and patience, and how a settling ends."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid.window import Window
from refimpl.model.friction import Mask
from refimpl.model.problem import Terms, pose
from refimpl.solvers.production import level
from refimpl.solvers.production.level import LevelSolver
from refimpl.solvers.production.updates import Updates
from tests.refimpl.solvers.production.levels import BALL, coupled, level_solver, posed, press


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
        (1.0, 1000, level._CG_PATIENCE),
        (0.99, 7, 7),
    ],
)
def test_cg_goes_on_while_it_gets_on(
    factor: float, budget: int, steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    solver = level_solver(posed(BALL, 4))
    solver._budget = budget
    monkeypatch.setattr(solver, "cg", Falling(factor))
    assert solver._reduce(0.1) == solver.cg.residuals()[1]
    assert solver.cg_iterations == steps


class Script:
    """Stands for the updates: their residuals by turns, the last for good."""

    def __init__(self, *residuals: float) -> None:
        self.residuals, self.count = list(residuals), 0

    def __call__(self, step: int) -> float:
        self.count += 1
        return self.residuals[min(self.count, len(self.residuals)) - 1]


ONE, OTHER = np.eye(4, dtype=bool), ~np.eye(4, dtype=bool)


def settled(
    monkeypatch: pytest.MonkeyPatch, *residuals: float, sigma: float = 0.4
) -> tuple[bool, LevelSolver, Script]:
    """What `settle` says where updates have those residuals, and CG leaves nothing; the solver."""
    solver, updates = level_solver(posed(coupled(sigma), 4)), Script(*residuals)
    monkeypatch.setattr(solver.held, "update", updates)
    monkeypatch.setattr(solver.held, "mix", lambda mixing: None)
    monkeypatch.setattr(solver.cg, "residuals", lambda: (1.0, 1.0))
    monkeypatch.setattr(solver, "_reduce", lambda goal: 0.0)
    return solver.settle(1e-3), solver, updates


def test_updates_that_contract_are_not_mixed(monkeypatch: pytest.MonkeyPatch) -> None:
    meets, solver, updates = settled(monkeypatch, 1.0, 0.2, 0.04, 0.008, 1e-4)
    assert meets
    assert not solver.strong
    assert not solver.stuck
    assert updates.count == 5 + 1  # the last once more, of the pressure that has met the load


def test_updates_that_bring_much_back_are_mixed_from_then_on(monkeypatch: pytest.MonkeyPatch) -> None:
    meets, solver, _ = settled(monkeypatch, 1.0, 0.9, 0.8, 1e-4)
    assert meets
    assert solver.strong
    monkeypatch.setattr(solver.held, "update", Script(0.5, 1e-4))
    assert solver.settle(1e-3)
    assert solver.strong


def test_updates_that_lead_nowhere_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    meets, solver, updates = settled(monkeypatch, 1.0)
    assert not meets
    assert solver.stuck
    assert updates.count == 1 + 2 + 30  # two that bring all back, and the patience


@pytest.mark.parametrize(("feedback", "next_share"), [(0.5, 0.1), (0.02, 0.02), (0.0, 1e-3), (-0.01, 1e-3)])
def test_updates_are_as_far_apart_as_they_bring_little_back(
    feedback: float, next_share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """CG leaves a tenth at first, then what the last update brought back, a thousandth at least."""
    solver = level_solver(posed(coupled(0.4), 4))
    residuals, goals = [1.0], []

    def reduce(goal: float) -> float:
        goals.append(goal / residuals[-1])
        return goal

    def update(step: int) -> float:
        if goals:
            residuals.append((goals[-1] + feedback) * residuals[-1])
        return residuals[-1]

    monkeypatch.setattr(solver, "_reduce", reduce)
    monkeypatch.setattr(solver.held, "update", update)
    monkeypatch.setattr(solver.held, "mix", lambda mixing: None)
    monkeypatch.setattr(level, "_UPDATES", 2)
    solver.settle(1e-12)
    assert goals == pytest.approx([0.1, next_share], rel=1e-12)


@pytest.mark.parametrize(("share", "met"), [(0.985, True), (0.995, False)])
def test_the_certificate_may_round_otherwise(
    share: float, met: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A residual counts as met a hundredth below the tolerance: 1e-12 leaves rounding a thousandth."""
    solver = level_solver(posed(BALL, 4))
    monkeypatch.setattr(solver.held, "update", lambda step: share * 1e-12)
    monkeypatch.setattr(solver, "_reduce", lambda goal: share * 1e-12)
    monkeypatch.setattr(solver.held, "mix", lambda mixing: None)
    assert solver.settle(1e-12) is met


@pytest.mark.parametrize(("last", "status"), [(ONE, rf.Status.CONVERGED), (ONE | OTHER, rf.Status.CYCLED)])
def test_a_cycle_of_tau_is_named_where_withheld_elements_touch(
    last: Mask, status: rf.Status, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Contact grows from one set and back to it, which withholds all that changed from tau."""
    solver = level_solver(posed(coupled(0.3, tau=0.5), 4))
    contacts = iter((ONE, ONE | OTHER, ONE, last))

    def settle(tolerance: float, support: Mask, withheld: Mask | None = None) -> bool:
        contact = support if withheld is None else next(contacts)  # a state of the cycle, or the path's next
        press(solver.cg, np.where(contact, 0.5, 0.0))
        solver.held.support = support
        solver.residual, solver._tolerance = 0.0, tolerance
        return True

    monkeypatch.setattr(solver, "settle", settle)
    outcome = solver.solve(1e-6)
    assert outcome.status is status
    assert np.array_equal(outcome.withheld, ~ONE)
    assert len(outcome.visited) == 2


@pytest.mark.parametrize("tolerance", np.geomspace(1e-3, 1e-8, 15))
def test_where_nothing_lags_no_step_is_taken_below_the_tolerance(
    tolerance: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But for a tenth of it that is left to rounding."""
    terms = Terms(coupled=False, oblique=False, slope_correction=False)
    frictionless = pose(replace(BALL, load=20.0), rf.Grid(BALL.side, 64), terms, None)
    solver = level_solver(frictionless)
    before: list[float] = []
    iterate = solver.cg.iterate

    def recorded() -> None:
        before.append(max(solver.cg.residuals()))
        iterate()

    monkeypatch.setattr(solver.cg, "iterate", recorded)
    assert solver.settle(tolerance)
    assert min(before) > 0.9 * tolerance
    assert solver.cg_iterations == len(before) > 1


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
    solver = level_solver(posed(BALL, 4))
    solver.residual, solver._tolerance = residual, 1e-8
    solver.cg_iterations, solver._budget = steps, 10
    assert solver._ended() is status


@pytest.mark.parametrize("friction", [rf.Friction(), rf.Friction(tau=0.0, beta=0.1), rf.Friction(tau=1.0)])
def test_without_tau_one_settling_is_all(friction: rf.Friction, monkeypatch: pytest.MonkeyPatch) -> None:
    solver = level_solver(posed(replace(BALL, friction=friction), 8))
    settlings: list[Mask | None] = []
    settle = solver.settle

    def recorded(tolerance: float, support: Mask | None = None, withheld: Mask | None = None) -> bool:
        settlings.append(support)
        return settle(tolerance, support, withheld)

    monkeypatch.setattr(solver, "settle", recorded)
    assert solver.solve(1e-8).status is rf.Status.CONVERGED
    if friction.tau == 0:
        assert settlings == [None]
    else:
        assert all(support is not None for support in settlings)
        assert len(settlings) > 1


def test_a_whole_grid_needs_no_product_to_answer() -> None:
    solver = level_solver(posed(BALL, 16))
    solver.settle(1e-3)
    before = dict(solver.counter.tally)
    solver.answer()
    assert solver.counter.tally == before


def test_between_mixed_updates_cg_leaves_a_tenth_of_what_mixing_has_left(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without a step of CG an update would tell nothing new; a tenth of the tolerance is enough of all."""
    solver = level_solver(posed(BALL, 4))
    solver._updates = Updates(1.0, lags=True, strong=True)
    for residual, left, goal in ((1e-2, 1e-3, 1e-4), (1e-3, 1e-2, 1e-4), (2e-8, 1e-8, 1e-9)):
        solver.residual = residual
        monkeypatch.setattr(solver.cg, "residuals", lambda left=left: (0.0, left))
        assert solver._goal(1e-8) == pytest.approx(goal, rel=1e-12)


@pytest.mark.parametrize(("tau", "cramped"), [(0.0, False), (1e6, True)])
def test_only_states_on_taus_way_must_keep_off_a_windows_edge(tau: float, cramped: bool) -> None:
    """Without tau there is one state, and the check on the whole grid tells what its window lacks."""
    problem = posed(coupled(0.3, tau=tau), 16)
    solver = level_solver(problem, Window(4, 8, 4, 12))
    press(solver.cg, np.ones((4, 8)))
    assert solver.cramped is cramped
