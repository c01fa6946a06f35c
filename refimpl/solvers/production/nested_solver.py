"""The production solver: nested grids, FFTs on the contact's window, and one check on the whole grid."""

from __future__ import annotations

from refimpl.grid import Array, resampled
from refimpl.grid.window import Window
from refimpl.model.certificate import State, certify
from refimpl.model.friction import Mask
from refimpl.model.problem import Problem
from refimpl.model.state import Outcome
from refimpl.operators.base import Influence
from refimpl.operators.extension import extended
from refimpl.operators.fft import Counter, WholeGridInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.operators.preconditioner import SpectralPreconditioner
from refimpl.solvers.production.coarse_grids import Start, foundation_pressure, levels, sharpened, touching
from refimpl.solvers.production.level import LevelSolver, WindowInfluence, influence
from refimpl.solvers.production.projected_cg import Apply

MARGIN = 2  # elements, at least, by which a window exceeds its contact: slopes at its edge are one-sided
_COARSE_TOLERANCE = 1e-3  # a coarse state is only a start: its own grid error is larger than this


def solve_fft(
    problem: Problem, tolerance: float, counter: Counter, start: Start | None = None
) -> tuple[Outcome, State]:
    """Outcome and certified state of the problem, to a certificate of about ``tolerance``.

    The outcome's status speaks of the loops only; the certificate is of the full grid. ``start`` is the
    answer on a grid that is not finer: levels no finer than it need not be solved again.
    """
    iterations: dict[str, int] = {}
    nested = levels(problem, above=start.M if start else 0)
    coarsest = nested.pop(0)
    solver = begun(coarsest, start, counter) if start else _unprepared(coarsest, counter)
    while nested:
        solver.settle(_COARSE_TOLERANCE)
        iterations[f"CG at {solver.whole.grid.M}"] = solver.cg_iterations
        solver = begun(nested.pop(0), solver.answer(), counter)
    while True:
        outcome, window, cramped = solver.solve(tolerance), solver.window, solver.cramped
        strong = solver.strong
        del solver  # what it holds is no longer needed when the whole grid's arrays come
        beyond = window.mask(problem.grid.M)
        if not cramped:
            state = _certified(problem, outcome, counter)
            missed = _beyond(problem, state, window, tolerance)
            if not missed.any():
                outcome.iterations.update(iterations)
                return outcome, state
            beyond |= missed  # windows only grow, so that this ends
        solver = _widened(problem, outcome, beyond, counter, strong=strong)


def begun(problem: Problem, start: Start, counter: Counter) -> LevelSolver:
    """The solver of a grid, from another one's answer: its pressure, and the window of likely contact."""
    window, pressure, misfit, contact = _prolonged(problem, start)
    operator, precondition = _operators(problem, window, counter)
    loaded = problem.load is not None
    pressure = sharpened(pressure, misfit, contact, precondition, loaded=loaded)
    # contact is likely where the other grid had none: there is nothing to go on from
    if loaded and not pressure.any():
        return _unprepared(problem, counter)
    precondition = extended(precondition, pressure > 0)
    return LevelSolver(problem, operator, precondition, pressure, strong=start.strong)


def _prolonged(problem: Problem, start: Start) -> tuple[Window, Array, Array, Mask]:
    """A window; there the prolonged pressure, what its ``v`` lacks of the approach, and likely contact."""
    M = problem.grid.M
    v = resampled(start.displacement, M) + problem.gap
    pressure = resampled(start.pressure, M)
    known = start.approach if problem.approach is None else problem.approach
    contact, approach = touching(pressure, v, known, problem)
    window = Window.full(M)
    if not problem.periodic:
        window = Window.around(contact, MARGIN).filling(M)
    place = window.slices
    return window, pressure[place].copy(), approach - v[place], contact[place].copy()


def _operators(problem: Problem, window: Window, counter: Counter) -> tuple[WindowInfluence, Apply]:
    """The influence of a window on itself, and the preconditioner that goes with it."""
    operator = influence(problem, window, counter)
    return operator, SpectralPreconditioner(operator, problem.pair.normal_compliance)


def _unprepared(problem: Problem, counter: Counter) -> LevelSolver:
    """The solver of a grid of which nothing is known."""
    operator, precondition = _operators(problem, Window.full(problem.grid.M), counter)
    return LevelSolver(problem, operator, precondition, foundation_pressure(problem))


def _certified(problem: Problem, outcome: Outcome, counter: Counter) -> State:
    """The state on the whole grid, from a source window that holds all tractions."""
    if problem.periodic:
        operator: Influence = PeriodicInfluence(problem.grid, problem.direction, counter=counter)
    else:
        loaded = (outcome.pressure != 0) | (outcome.traction != 0)
        operator = WholeGridInfluence(
            problem.grid,
            problem.direction,
            source=Window.around(loaded, margin=0),
            target=Window.full(problem.grid.M),
            counter=counter,
        )
    return certify(problem, operator, outcome.pressure, outcome.traction, outcome.slopes)


def _beyond(problem: Problem, state: State, window: Window, tolerance: float) -> Mask:
    """Elements outside a window or on its edge for which it is too small.

    They penetrate by more than the tolerance; or slopes count, which were one-sided there, and they touch.
    """
    beyond = state.separation < state.approach * (1 - tolerance)
    if problem.terms.oblique:
        beyond |= state.pressure > 0
    beyond[window.interior(len(beyond)).slices] = False
    return beyond


def _widened(
    problem: Problem, outcome: Outcome, needed: Mask, counter: Counter, *, strong: bool
) -> LevelSolver:
    """A solver that starts from a pressure found, on a window that holds all elements needed."""
    window = Window.around(needed, MARGIN).filling(len(needed))
    pressure = outcome.pressure[window.slices]
    operator, precondition = _operators(problem, window, counter)
    precondition = extended(precondition, pressure > 0)
    solver = LevelSolver(problem, operator, precondition, pressure, strong=strong)
    solver.cg_iterations = sum(outcome.iterations.values())
    return solver
