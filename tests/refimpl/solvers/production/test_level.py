"""One grid of the production solver: CG between updates of the lagged terms, patience, and how it ends."""

from __future__ import annotations

import gc
import math
import weakref
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Mask, Window
from refimpl.model.certificate import certify
from refimpl.operators.influence import window_influence
from refimpl.solvers.production import constants
from refimpl.solvers.production.anderson import AndersonMixing
from refimpl.solvers.production.level import LevelSolver
from refimpl.solvers.tau_active_set import ActiveSet, ContactTest, FixedSet
from tests.refimpl.solvers.production.levels import BALL, coupled, level_solver, problem_of

NOTHING = FixedSet(np.zeros((4, 4), dtype=bool))


class Falling:
    """Stands for CG: a residual that each step multiplies by ``factor``; its contact is ``ends_at``.

    The contact is certain after the first step.
    """

    def __init__(self, factor: float, ends_at: Mask | None = None) -> None:
        self.factor, self.contact, self.residual = factor, ends_at, 1.0
        self.steps = 0

    @property
    def pressure(self) -> Array:
        return self.contact.astype(float)

    def residuals(self) -> tuple[float, float]:
        return 0.0, self.residual

    def iterate(self) -> None:
        self.steps += 1
        self.residual *= self.factor

    def contact_is_certain(self, stiffness: float) -> bool:
        return self.steps > 0


class Scripted:
    """Stands for the lagged terms: each update's residual follows from the number of updates before it."""

    diverged = False

    def __init__(
        self,
        cg: Falling,
        residual: Callable[[int], float],
        *,
        has_lag: bool = True,
        at_mixing: float | None = None,
    ) -> None:
        self.cg, self.has_lag, self._residual, self._at_mixing = cg, has_lag, residual, at_mixing
        self.active, self.updates = NOTHING, 0
        self.mixings: list[AndersonMixing | None] = []

    def update(self) -> float:
        self.updates += 1
        return self._residual(self.updates - 1)

    def mix(self, mixing: AndersonMixing | None) -> None:
        self.mixings.append(mixing)
        if self._at_mixing is not None:
            self.cg.residual = self._at_mixing

    def iterate(self) -> None:
        self.cg.iterate()


def scripted(
    cg: Falling, residual: Callable[[int], float], *, needs_mixing: bool = False, **options: float | None
) -> tuple[LevelSolver, Scripted]:
    """A solver of 4 x 4 elements with these stand-ins for CG and for the lagged terms."""
    solver = level_solver(problem_of(coupled(0.4), 4), needs_mixing=needs_mixing)
    lagged = Scripted(cg, residual, **options)  # type: ignore[arg-type]  # the point of stand-ins
    solver.cg, solver.lagged = cg, lagged  # type: ignore[assignment]  # likewise
    return solver, lagged


def listed(*residuals: float) -> Callable[[int], float]:
    """Residuals one after the other, the last for good."""
    return lambda k: residuals[min(k, len(residuals) - 1)]


@pytest.mark.parametrize(
    ("factor", "limit", "steps", "stagnated"),
    [
        # slow, but a tenth less within the patience: down to 0.9 of the tolerance, the rest is for rounding
        (0.99, 1000, math.ceil(math.log(0.9e-3) / math.log(0.99)), False),
        (1.0, 1000, 5 * constants.CG_PATIENCE, True),  # five calls of CG without any progress
        (0.99, 7, 7, True),
    ],
)
def test_cg_continues_while_it_makes_progress(
    factor: float, limit: int, steps: int, stagnated: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(constants, "CG_LIMIT", limit)
    cg = Falling(factor)
    solver, _ = scripted(cg, lambda k: cg.residual, has_lag=False)
    assert solver.solve(1e-3, NOTHING) is not stagnated
    assert solver.cg_iterations == cg.steps == steps
    assert solver.stagnated is stagnated


def test_updates_that_contract_are_not_mixed() -> None:
    solver, lagged = scripted(Falling(0.0), listed(1.0, 0.2, 0.04, 0.008, 1e-4))
    assert solver.solve(1e-3, NOTHING)
    assert not solver.needs_mixing
    assert not solver.stagnated
    assert lagged.updates == 5 + 1  # the last once more, of the pressure that has met the load


def test_updates_of_strong_feedback_are_mixed_from_then_on() -> None:
    solver, lagged = scripted(Falling(0.0), listed(1.0, 0.9, 0.8, 1e-4))
    assert solver.solve(1e-3, NOTHING)
    assert solver.needs_mixing
    assert lagged.mixings[:2] == [None, None]
    again = Scripted(Falling(0.0), listed(0.5, 1e-4))
    solver.lagged = again  # type: ignore[assignment]  # a stand-in
    assert solver.solve(1e-3, NOTHING)
    assert again.mixings[0] is not None


def test_updates_without_progress_are_given_up() -> None:
    solver, lagged = scripted(Falling(0.0), listed(1.0))
    assert not solver.solve(1e-3, NOTHING)
    assert solver.stagnated
    assert lagged.updates == 1 + 2 + 30  # two of strong feedback, and the patience


def test_a_solve_takes_no_more_updates_than_its_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(constants, "UPDATE_LIMIT", 7)
    solver, lagged = scripted(Falling(0.0), lambda k: 0.45**k)
    assert not solver.solve(1e-12, NOTHING)
    assert solver.stagnated
    assert lagged.updates == 1 + 7


@pytest.mark.parametrize("needs_mixing", [False, True])
def test_cg_stops_where_the_contact_is_certain_and_enough_but_not_between_mixed_updates(
    needs_mixing: bool,
) -> None:
    """A mixed state solves no problem of its own; after an update the contact is the state's."""
    cg = Falling(0.5, ends_at=np.eye(4, dtype=bool))
    solver, lagged = scripted(cg, listed(1.0, 0.1), needs_mixing=needs_mixing)
    assert not solver.solve(1e-8, NOTHING, lambda contact: bool(contact.any()))
    assert not solver.stagnated
    assert (cg.steps, lagged.updates) == ((4 if needs_mixing else 1), 2)


@pytest.mark.parametrize(("share", "met"), [(0.985, True), (0.995, False)])
def test_a_hundredth_of_the_tolerance_is_left_to_the_certificates_rounding(share: float, met: bool) -> None:
    """At a tolerance of 1e-12 rounding is a thousandth of it."""
    solver, _ = scripted(Falling(0.0), listed(share * 1e-12))
    assert solver.solve(1e-12, NOTHING) is met


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


@pytest.mark.parametrize("friction", [rf.Friction(), rf.Friction(tau=0.0, beta=0.1), rf.Friction(tau=1.0)])
def test_without_tau_there_is_one_solve(friction: rf.Friction, monkeypatch: pytest.MonkeyPatch) -> None:
    solver = level_solver(problem_of(replace(BALL, friction=friction), 8))
    solves: list[ContactTest | None] = []
    solve = solver.solve

    def recorded(tolerance: float, active: ActiveSet, enough: ContactTest | None = None) -> bool:
        solves.append(enough)
        return solve(tolerance, active, enough)

    monkeypatch.setattr(solver, "solve", recorded)
    assert solver.result(1e-8).status is rf.Status.CONVERGED
    if friction.tau == 0:
        assert solves == [None]
    else:
        assert all(enough is not None for enough in solves)
        assert len(solves) > 1


@pytest.mark.parametrize(
    ("place", "too_small"), [((0, 3), True), ((2, 7), True), ((1, 1), False), ((2, 6), False)]
)
def test_shear_off_the_contact_must_keep_off_the_edge_as_well(
    place: tuple[int, int], too_small: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the set of tau is behind the contact, elements that no longer press are sheared still."""
    pressure = np.zeros((4, 8))
    pressure[1:3, 2:6] = 1.0
    problem = problem_of(coupled(0.3, tau=1e6), 16)
    solver = level_solver(problem, Window(4, 8, 4, 12), pressure=pressure)
    traction = np.zeros((4, 8))
    monkeypatch.setattr(type(solver.lagged), "traction", property(lambda lagged: traction))
    assert not solver.window_too_small
    traction[place] = 2e5
    assert solver.window_too_small is too_small


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
