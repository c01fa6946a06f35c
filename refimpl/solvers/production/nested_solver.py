"""The production solver: nested grids, FFTs on the contact's window, and one check on the whole grid."""

from __future__ import annotations

from dataclasses import replace

from refimpl.grid import Array, Mask, Window, inner, resampled
from refimpl.model.certificate import State, certify, relative_gap
from refimpl.model.problem import Problem
from refimpl.model.state import SolverResult
from refimpl.operators.fft import Counter
from refimpl.operators.influence import WindowInfluence, whole_grid_influence, window_influence
from refimpl.operators.preconditioner import Apply, SpectralPreconditioner, extended
from refimpl.solvers.production.coarse_grids import (
    InitialGuess,
    coarse_tolerance,
    likely_capped,
    likely_contact,
    nested_problems,
    sharpened,
    winkler_pressure,
)
from refimpl.solvers.production.constants import MARGIN, START_MISFIT
from refimpl.solvers.production.level import LevelSolver
from refimpl.solvers.tau_active_set import first_set


def solve_fft(
    problem: Problem, tolerance: float, counter: Counter, start: InitialGuess | None = None
) -> State:
    """Return the certified state of the problem, to a certificate of about ``tolerance``.

    Its status concerns the loops only; the certificate is that of the whole grid. ``start`` is the
    solution on a grid that is not finer: nested grids no finer than it are not solved again. A start on this
    very grid is used only where it fits: load or contact off by more than 2 % cost more than nested grids.
    """
    if start and start.shape == problem.grid.shape and _misfit(problem, start) > START_MISFIT:
        start = None
    iterations: dict[str, int] = {}
    nested = nested_problems(problem, above=start.shape if start else None)
    coarsest = nested.pop(0)
    if start:
        solver = from_guess(coarsest, start, counter, tolerance)
    else:
        solver = _from_winkler(coarsest, counter, tolerance)
    while nested:
        solver.solve(coarse_tolerance(solver.problem.grid.shape), first_set(solver.problem))
        iterations[f"CG at {solver.whole.grid}"] = solver.cg_iterations
        solver = from_guess(nested.pop(0), solver.initial_guess(), counter, tolerance)
    while True:
        result, window = solver.result(tolerance), solver.window
        too_small, needs_mixing = solver.window_too_small, solver.needs_mixing
        del solver  # frees its memory before the arrays of the whole grid are made
        needed = window.mask(problem.grid.shape)
        if not too_small:
            state = certified(problem, result, counter)
            missed = missed_by_window(problem, state, window, tolerance)
            if not missed.any():
                return replace(state, iterations={**state.iterations, **iterations})
            needed |= missed  # windows only grow, so the loop ends
        solver = widened(problem, result, needed, counter, tolerance, needs_mixing=needs_mixing)


def _misfit(problem: Problem, start: InitialGuess) -> float:
    """Return the relative error of a start as a solution on its own grid: of the load, and of the contact."""
    f, v = start.pressure, start.displacement + problem.gap
    total, energy = float(f.sum()), 0.5 * inner(f, start.displacement)
    gap = relative_gap(inner(f, v) - total * float(v.min()), energy)
    if problem.load is not None:
        return max(gap, abs(total * problem.grid.element_area - problem.load) / problem.load)
    return max(gap, relative_gap(abs(inner(f, v) - total * (problem.approach or 0.0)), energy))


def from_guess(problem: Problem, start: InitialGuess, counter: Counter, tolerance: float) -> LevelSolver:
    """Return the solver of a grid from an initial guess: its pressure, and the window of likely contact."""
    window, pressure, misfit, contact = _prolonged(problem, start)
    operator, precondition = _operators(problem, window, counter, tolerance)
    loaded = problem.load is not None
    capped = likely_capped(pressure, misfit, contact, problem)
    pressure = sharpened(pressure, misfit, contact & ~capped, precondition, loaded=loaded)
    pressure[capped] = problem.cap
    # where the contact is likely the guess has no pressure: there is nothing to start from
    if loaded and not pressure.any():
        return _from_winkler(problem, counter, tolerance)
    precondition = extended(precondition, (pressure > 0) & ~capped)
    return LevelSolver(problem, operator, precondition, pressure, needs_mixing=start.needs_mixing)


def _prolonged(problem: Problem, start: InitialGuess) -> tuple[Window, Array, Array, Mask]:
    """Return a window; on it the prolonged pressure, the approach minus its ``v``, and the likely contact."""
    grid = problem.grid
    v = resampled(start.displacement, grid.shape) + problem.gap
    pressure = resampled(start.pressure, grid.shape)
    known = start.approach if problem.approach is None else problem.approach
    contact, approach = likely_contact(pressure, v, known, problem)
    window = grid.window_around(contact, MARGIN).filling(grid.shape)
    place = window.slices
    return window, pressure[place].copy(), approach - v[place], contact[place].copy()


def _operators(
    problem: Problem, window: Window, counter: Counter, tolerance: float
) -> tuple[WindowInfluence, Apply]:
    operator = window_influence(problem.grid, problem.direction, window, counter, tolerance)
    return operator, SpectralPreconditioner(operator, problem.elasticity.symbol(operator.symbol))


def _from_winkler(problem: Problem, counter: Counter, tolerance: float) -> LevelSolver:
    operator, precondition = _operators(problem, problem.grid.window, counter, tolerance)
    return LevelSolver(problem, operator, precondition, winkler_pressure(problem))


def certified(problem: Problem, result: SolverResult, counter: Counter) -> State:
    """Return the state on the whole grid, from a source window that holds all tractions."""
    loaded = Window.around((result.pressure != 0) | (result.traction != 0), margin=0)
    operator = whole_grid_influence(problem.grid, problem.direction, loaded, counter)
    return certify(problem, operator, **vars(result))


def missed_by_window(problem: Problem, state: State, window: Window, tolerance: float) -> Mask:
    """Return elements that penetrate outside a window or, with slopes, are in contact on its edge."""
    missed = state.v < state.approach * (1 - tolerance)
    if problem.terms.oblique:
        missed |= state.contact
    missed[window.interior(problem.grid.shape).slices] = False
    return missed


def widened(
    problem: Problem,
    result: SolverResult,
    needed: Mask,
    counter: Counter,
    tolerance: float,
    *,
    needs_mixing: bool,
) -> LevelSolver:
    """Return a solver that starts from a result's pressure, on a window that holds all elements needed."""
    window = Window.around(needed, MARGIN).filling(problem.grid.shape)
    pressure = result.pressure[window.slices]
    operator, precondition = _operators(problem, window, counter, tolerance)
    precondition = extended(precondition, pressure > 0)
    solver = LevelSolver(problem, operator, precondition, pressure, needs_mixing=needs_mixing)
    solver.cg_iterations = sum(result.iterations.values())
    return solver
