"""The plain reference: its outer loops run to rounding, whatever starts them."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.friction import Mask
from refimpl.model.problem import Problem, Terms, pose
from refimpl.operators.dense import DenseInfluence
from refimpl.solvers import dense, pivoting
from refimpl.solvers.pivoting import restricted_solve

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


def test_slopes_that_do_not_settle_are_no_convergence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dense, "_SLOPE_ITERATIONS", 1)
    solution = rf.solve(spike(rf.Friction(tau=0.0, beta=0.1)), M, method="dense", oblique=True)
    assert solution.status is rf.Status.ITERATION_LIMIT


def sliding_spike() -> tuple[Problem, DenseInfluence]:
    scene, grid = spike(rf.Friction(tau=0.0, beta=0.1)), rf.Grid(SIDE, M)
    terms = Terms(coupled=True, oblique=True, slope_correction=False)
    return pose(scene, grid, terms, None), DenseInfluence(grid, scene.sliding_direction)


def test_the_loops_themselves_say_that_slopes_did_not_settle(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the certificate makes of the state that they left."""
    monkeypatch.setattr(dense, "_SLOPE_ITERATIONS", 1)
    outcome, _ = dense.solve_dense(*sliding_spike())
    assert outcome.status is rf.Status.ITERATION_LIMIT


def test_slopes_that_settled_before_may_not_settle_now(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each support of tau is judged for itself."""
    solver = dense._DenseSolver(*sliding_spike())
    support = np.ones((M, M), dtype=bool)
    solver.settle_slopes(support)
    assert solver.slopes_settled
    monkeypatch.setattr(dense, "_SLOPE_ITERATIONS", 1)
    solver.problem = replace(solver.problem, load=0.2)
    solver.settle_slopes(support)
    assert not solver.slopes_settled


A, B = np.eye(M, dtype=bool), np.ones((M, M), dtype=bool)


@pytest.mark.parametrize(("last", "status"), [(A, rf.Status.CONVERGED), (B, rf.Status.CYCLED)])
def test_a_cycle_of_tau_is_named_where_withheld_elements_touch(
    last: Mask, status: rf.Status, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Contact goes from A to B and back, which withholds all but A from tau."""
    problem, operator = sliding_spike()
    contacts = iter((A, B, A, last))

    def settle_slopes(solver: dense._DenseSolver, support: Mask) -> Array:
        solver.pressure, solver.slopes_settled = np.where(next(contacts), 0.5, 0.0), True
        return np.where(support, 0.5, 0.0)

    monkeypatch.setattr(dense._DenseSolver, "settle_slopes", settle_slopes)
    sliding = replace(problem, friction=rf.Friction(tau=0.5, beta=0.1))
    outcome, _ = dense.solve_dense(sliding, operator)
    assert outcome.status is status
    assert np.array_equal(outcome.withheld, ~A)
    assert len(outcome.visited) == 2
    assert outcome.iterations["tau supports"] == 4


def test_changes_at_the_rounding_floor_that_grow_again_end_the_slopes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem, operator = sliding_spike()
    solver = dense._DenseSolver(problem, operator)

    def jittered(support: Mask) -> None:
        k = solver.picard  # relative changes: 1, then 3e-12, 5e-12, 7e-12, ...
        solver.pressure = 1e6 * (1 + (-1) ** k * k * 1e-12) * np.eye(M)

    monkeypatch.setattr(solver, "_solve_frozen", jittered)
    assert not solver.slopes_settled
    solver.settle_slopes(np.ones((M, M), dtype=bool))
    assert solver.slopes_settled
    assert solver.picard == 3


@pytest.mark.parametrize(
    ("changes", "passes"), [((1e-6, 5e-14), 2), ((1e-6, 5e-13, 0.0), 3), ((1e-6, 2e-6, 1e-9, 0.0), 4)]
)
def test_slopes_end_at_a_change_of_1e_13_of_the_peak(
    changes: tuple[float, ...], passes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The loop's bound; above it they go on, even where a change exceeds the one before."""
    problem, operator = sliding_spike()
    solver = dense._DenseSolver(problem, operator)
    solver.pressure = 1e6 * np.eye(M)
    monkeypatch.setattr(Problem, "slopes", lambda *displacements: solver.slopes)  # which stay
    steps = iter((*changes, 0.0, 0.0))

    def changed(support: Mask) -> None:
        solver.pressure = (1 + next(steps)) * solver.pressure

    monkeypatch.setattr(solver, "_solve_frozen", changed)
    solver.settle_slopes(np.ones((M, M), dtype=bool))
    assert solver.picard == passes
    assert solver.slopes_settled


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
    scene, grid = spike(rf.Friction(tau=0.0, beta=0.1)), rf.Grid(SIDE, M)
    problem = pose(scene, grid, Terms(coupled=True, oblique=False, slope_correction=False), None)
    outcome, _ = dense.solve_dense(problem, DenseInfluence(grid, scene.sliding_direction))
    assert outcome.iterations["slopes"] == 1


@pytest.mark.parametrize("approach", [None, 3e-6])
def test_pivoting_starts_from_the_contact_that_was_found_last(approach: float | None) -> None:
    """Repeated, a pass takes one solve at an approach, and with Newton's own two at a load."""
    heights = np.random.default_rng(4).uniform(0, 4e-5, (5, 5))
    scene = replace(spike(rf.Friction(tau=0.0, beta=0.2)), lower=rf.Body(rf.Material(1e9, 0.2), heights))
    grid = rf.Grid(SIDE, 5)
    terms = Terms(coupled=True, oblique=True, slope_correction=False)
    problem = pose(replace(scene, load=3.0), grid, terms, approach)
    solver = dense._DenseSolver(problem, DenseInfluence(grid, scene.sliding_direction))
    support = np.ones((5, 5), dtype=bool)
    solver.settle_slopes(support)
    solves, passes = solver.solves, solver.picard
    assert solves > passes * (1 if approach is not None else 2)
    solver.settle_slopes(support)
    assert solver.picard > passes
    assert solver.solves - solves == (solver.picard - passes) * (1 if approach is not None else 2)


def test_every_linear_solve_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []

    def counted(*arguments: Any) -> Any:
        calls.append(1)
        return restricted_solve(*arguments)

    for module in (dense, pivoting):
        monkeypatch.setattr(module, "restricted_solve", counted)
    scene = spike(rf.Friction(tau=0.0, beta=0.1))
    grid = rf.Grid(SIDE, M)
    problem = pose(scene, grid, Terms(coupled=True, oblique=True, slope_correction=False), None)
    outcome, _ = dense.solve_dense(problem, DenseInfluence(grid, scene.sliding_direction))
    assert outcome.iterations["linear solves"] == len(calls) > 2


@pytest.mark.parametrize("beyond", [(0.5, 9.0), (1.0, 5.0)])
def test_newton_steps_that_are_not_within_the_bracket_halve_it(
    beyond: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its ends are not. Proposals are played; ``g = h = 0`` and ``K = 1``, so ``q`` is minus the approach."""
    problem, operator = sliding_spike()
    solver = dense._DenseSolver(problem, operator)
    assert problem.load is not None
    target = problem.load / problem.grid.element_area
    proposals, tried = iter((1.0, 5.0, *beyond)), list[float]()

    def restricted(G: Array, right: Array, active: Mask) -> Array:
        """The pressures whose sum is the target at the proposal."""
        return np.tile([1 / M**2, (next(proposals) - target) / M**2], (M**2, 1))

    def contact(G: Array, q: Array, active: Mask) -> SimpleNamespace:
        """A force that grows in proportion to the approach, and is the load near 4."""
        tried.append(-q[0])
        share = 1.0 if abs(tried[-1] - 4) < 1e-6 else tried[-1] / 4
        pressure = np.full(M**2, target * share / M**2)
        return SimpleNamespace(pressure=pressure, active=np.ones(M**2, dtype=bool), solves=1)

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
        friction=rf.Friction(tau=2.2e7, beta=0.1),
        load=7e8,
        side=1e3,
        sliding_direction=direction,
    )
    with pytest.raises(ArithmeticError, match="no approach balances the load"):
        rf.solve(scene, 2, method="dense")
