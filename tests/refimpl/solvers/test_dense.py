"""The plain reference: its outer loops run to rounding, whatever starts them."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.model.problem import Problem, Terms
from refimpl.operators.dense import DenseInfluence
from refimpl.scene.discretise import discretise
from refimpl.solvers import dense, pivoting
from refimpl.solvers.pivoting import restricted_solve
from refimpl.solvers.tau_active_set import FixedSet

M, SIDE = 3, 1e-3


def spike(friction: rf.Friction) -> rf.Scene:
    """One element in contact, beside two steps: tau tilts the surface there without changing its pressure."""
    lower = np.array([[0.0, 2.0, 0.0], [3.0, 8.0, 0.0], [0.0, 0.0, 1.0]]) * 1e-6
    return rf.Scene(
        upper=rf.Body(rf.Material(30e9, 0.3), rf.Flat()),
        lower=rf.Body(rf.Material(1e9, 0.2), lower),
        friction=friction,
        load=0.1,
        side=SIDE,
    )


@pytest.mark.parametrize("approach", [None, 1e-7])
def test_slopes_settle_even_where_pressure_does_not_follow_them_at_once(approach: float | None) -> None:
    """The step that switches tau on leaves the lone element's pressure, but not the slopes, as it was."""
    solution = rf.solve(
        spike(rf.Friction(tau=1e6, beta=0.1)), M, method="dense", approach=approach, tolerance=1e-13
    )
    assert solution.contact.sum() == 1
    assert solution.status is rf.Status.CONVERGED


GRID = rf.Grid.square(SIDE, M)
EVERYWHERE = FixedSet(np.ones((M, M), dtype=bool))


def sliding_spike(terms: Terms | None = None) -> Problem:
    return discretise(spike(rf.Friction(tau=0.0, beta=0.1)), GRID, terms)


def solver_of(problem: Problem) -> dense._DenseSolver:
    return dense._DenseSolver(problem, DenseInfluence(problem.grid, problem.direction))


def test_slopes_that_do_not_converge_are_no_convergence(monkeypatch: pytest.MonkeyPatch) -> None:
    """The loops say so themselves, whatever the certificate makes of the state that they leave."""
    monkeypatch.setattr(dense, "_SLOPE_ITERATIONS", 1)
    result, _ = dense.solve_dense(sliding_spike())
    assert result.status is rf.Status.ITERATION_LIMIT
    solution = rf.solve(spike(rf.Friction(tau=0.0, beta=0.1)), M, method="dense", oblique=True)
    assert solution.status is rf.Status.ITERATION_LIMIT


def test_slopes_that_converged_before_may_not_converge_now(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each active set of tau is judged for itself."""
    solver = solver_of(sliding_spike())
    assert solver.solve(1e-13, EVERYWHERE)
    assert solver.converged
    monkeypatch.setattr(dense, "_SLOPE_ITERATIONS", 1)
    solver.problem = replace(solver.problem, load=0.2)
    assert not solver.solve(1e-13, EVERYWHERE)
    assert not solver.converged


def test_changes_at_the_rounding_floor_that_grow_again_end_the_slopes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    solver = solver_of(sliding_spike())

    def jittered(held_traction: Array) -> None:
        k = solver.picard  # relative changes: 1, then 3e-12, 5e-12, 7e-12, ...
        solver.pressure = 1e6 * (1 + (-1) ** k * k * 1e-12) * np.eye(M)

    monkeypatch.setattr(solver, "_solve_frozen", jittered)
    assert not solver.converged
    assert solver.solve(1e-13, EVERYWHERE)
    assert solver.picard == 3


@pytest.mark.parametrize(
    ("changes", "passes"), [((1e-6, 5e-14), 2), ((1e-6, 5e-13, 0.0), 3), ((1e-6, 2e-6, 1e-9, 0.0), 4)]
)
def test_slopes_end_at_a_change_of_1e_13_of_the_peak(
    changes: tuple[float, ...], passes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Larger changes go on, even where a change exceeds the one before."""
    solver = solver_of(sliding_spike())
    solver.pressure = 1e6 * np.eye(M)
    monkeypatch.setattr(Problem, "slopes", lambda *displacements: solver.slopes)  # which stay
    steps = iter((*changes, 0.0, 0.0))

    def changed(held_traction: Array) -> None:
        solver.pressure = (1 + next(steps)) * solver.pressure

    monkeypatch.setattr(solver, "_solve_frozen", changed)
    assert solver.solve(dense._SLOPE_TOLERANCE, EVERYWHERE)
    assert solver.picard == passes


def test_a_spent_budget_ends_every_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    """Limits of nested loops do not multiply. The mean pressure is the modulus here."""
    z = np.random.default_rng(1).normal(size=(16, 16))
    scene = rf.Scene(
        upper=rf.Body(rf.Material(1.0, 0.0), z * 0.25 / np.ptp(z)),
        lower=rf.Body(rf.Material(4e3, 0.5), rf.Flat()),
        friction=rf.Friction(0.1, 0.4),
        load=1.0,
        side=1.0,
        sliding_direction=0.3,
    )
    monkeypatch.setattr(dense, "_SOLVES", 100)
    result, _ = dense.solve_dense(discretise(scene, scene.grid(16)))
    assert result.status is rf.Status.ITERATION_LIMIT
    assert 100 <= result.iterations["linear solves"] < 120


@pytest.mark.parametrize("approach", [None, 3e-6])
def test_facet_tractions_are_solved_for(approach: float | None) -> None:
    """The certificate recomputes Eq. (7) with the facets' tractions from the arrays, by other code."""
    heights = np.random.default_rng(4).uniform(0, 4e-5, (5, 5))
    scene = rf.Scene(
        upper=rf.Body(rf.Material(30e9, 0.3), rf.Flat()),
        lower=rf.Body(rf.Material(1e9, 0.2), heights),
        friction=rf.Friction(tau=1e6, beta=0.2),
        load=3.0,
        side=SIDE,
        sliding_direction=0.7,
    )
    solution = rf.solve(scene, 5, method="dense", approach=approach, slope_correction=True, tolerance=1e-11)
    assert solution.contact.sum() > 1
    assert np.abs(solution.slopes.tan_x).max() > 0.05
    assert solution.status is rf.Status.CONVERGED


def test_one_pass_without_slopes() -> None:
    result, _ = dense.solve_dense(sliding_spike(Terms(oblique=False)))
    assert result.iterations["slopes"] == 1


@pytest.mark.parametrize("approach", [None, 3e-6])
def test_pivoting_starts_from_the_contact_that_was_found_last(approach: float | None) -> None:
    """Repeated, a pass takes one solve at an approach, and with Newton's own two at a load."""
    heights = np.random.default_rng(4).uniform(0, 4e-5, (5, 5))
    scene = replace(
        spike(rf.Friction(tau=0.0, beta=0.2)), lower=rf.Body(rf.Material(1e9, 0.2), heights), load=3.0
    )
    solver = solver_of(discretise(scene, rf.Grid.square(SIDE, 5), approach=approach))
    active = np.ones((5, 5), dtype=bool)
    solver.solve(1e-13, FixedSet(active))
    solves, passes = solver.solves, solver.picard
    assert solves > passes * (1 if approach is not None else 2)
    solver.solve(1e-13, FixedSet(active))
    assert solver.picard > passes
    assert solver.solves - solves == (solver.picard - passes) * (1 if approach is not None else 2)


@pytest.mark.parametrize("oblique", [False, True])
def test_the_plastic_indentation_is_measured_from_elements_below_the_hardness(oblique: bool) -> None:
    """Between 0 and H all have v = d; an element at H is (d - v) cos cos deep, whatever the load on it."""
    heights = np.random.default_rng(7).uniform(0, 2e-5, (5, 5))
    scene = rf.Scene(
        upper=rf.Body(rf.Material(30e9, 0.3), rf.Flat()),
        lower=rf.Body(rf.Material(1e9, 0.2, hardness=20e6), heights),
        friction=rf.Friction(tau=1e6, beta=0.2),
        load=5.0,
        side=SIDE,
        sliding_direction=0.7,
    )
    problem = discretise(scene, rf.Grid.square(SIDE, 5), Terms(oblique=oblique, plastic=True))
    result, state = dense.solve_dense(problem)
    free = (state.pressure > 0) & ~state.plastic
    assert min(free.sum(), state.plastic.sum()) > 1
    between = state.v[free]
    assert np.ptp(between) < 1e-11 * between.mean()
    assert result.indentation is not None
    depth = (between.mean() - state.v) * state.slopes.obliqueness
    assert result.indentation[state.plastic] == pytest.approx(depth[state.plastic], rel=1e-8)
    assert not result.indentation[~state.plastic].any()


def test_every_linear_solve_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []

    def counted(*arguments: Any) -> Any:
        calls.append(1)
        return restricted_solve(*arguments)

    for module in (dense, pivoting):
        monkeypatch.setattr(module, "restricted_solve", counted)
    result, _ = dense.solve_dense(sliding_spike())
    assert result.iterations["linear solves"] == len(calls) > 2


@pytest.mark.parametrize("beyond", [(0.5, 9.0), (1.0, 5.0)])
def test_newton_steps_that_are_not_within_the_bracket_halve_it(
    beyond: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its ends are not. Proposals are played; ``g = h = 0`` and ``K = 1``, so ``q`` is minus the approach."""
    problem = sliding_spike()
    solver = solver_of(problem)
    assert problem.load is not None
    target = problem.load / problem.grid.element_area
    proposals, tried = iter((1.0, 5.0, *beyond)), list[float]()

    def restricted(G: Array, right: Array, active: Mask) -> Array:
        """The pressures whose sum is the target at the proposal."""
        return np.tile([1 / M**2, (next(proposals) - target) / M**2], (M**2, 1))

    def contact(G: Array, q: Array, free: Mask, cap: float, capped: Mask) -> SimpleNamespace:
        """A force that grows in proportion to the approach, and is the load near 4."""
        tried.append(-q[0])
        share = 1.0 if abs(tried[-1] - 4) < 1e-6 else tried[-1] / 4
        pressure = np.full(M**2, target * share / M**2)
        return SimpleNamespace(pressure=pressure, free=np.ones(M**2, dtype=bool), capped=capped, solves=1)

    monkeypatch.setattr(dense, "restricted_solve", restricted)
    monkeypatch.setattr(dense, "complementarity", contact)
    zero, one = np.zeros(M**2), np.ones(M**2)
    solver._solve_load(dense._Frozen(np.eye(M**2), zero, one, one, 0.0), zero)
    assert tried == pytest.approx([1.0, 5.0, 3.0, 4.0], rel=1e-9)
    assert solver.solves == 8


@pytest.mark.parametrize("direction", [0.0, 0.7, 2.5])
def test_shear_on_slopes_that_bears_more_than_the_load_leaves_no_approach(direction: float) -> None:
    """Nothing presses then, and a change of approach changes no load: said by name, not by a division."""
    scene = rf.Scene(
        upper=rf.Body(rf.Material(1e11, 0.45), rf.Sphere(11742.5)),
        lower=rf.Body(rf.Material(1e11, 0.3), rf.Flat()),
        friction=rf.Friction(tau=3e7, beta=0.1),
        load=7e8,
        side=1e3,
        sliding_direction=direction,
    )
    with pytest.raises(ArithmeticError, match="no approach balances the load"):
        rf.solve(scene, 2, method="dense")


def test_where_all_that_press_are_at_the_hardness_the_next_element_bears_the_rest() -> None:
    """Two elements of 1/16 mm^2 at 0.1 GPa bear 12.5 N of 13 N; of the others the nearest bears 8 MPa."""
    body = rf.Body(rf.Material(E=200e9, nu=0.3, hardness=0.1e9), rf.Flat())
    scene = rf.Scene(body, body, rf.Friction(), load=13.0, side=1e-3)
    gap = np.full((4, 4), 3e-6)
    gap[0, 1] = gap[3, 2] = 0.0
    gap[1, 3] = 2e-6
    problem = replace(discretise(scene, scene.grid(4), Terms(oblique=False, plastic=True), None), gap=gap)
    result, _ = dense.solve_dense(problem)
    expected = np.zeros((4, 4))
    expected[0, 1] = expected[3, 2] = 0.1e9
    expected[1, 3] = 8e6
    np.testing.assert_allclose(result.pressure, expected, rtol=1e-9)
