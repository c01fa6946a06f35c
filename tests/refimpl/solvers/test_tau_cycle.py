"""Tau's support when it chases the contact set: the rule must still end with a certified state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Literal

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid.window import Window
from refimpl.model.certificate import State
from refimpl.model.friction import Mask
from refimpl.model.problem import Problem, Terms, pose
from refimpl.model.state import Outcome
from refimpl.operators.fft import Counter
from refimpl.solvers.production import nested_solver, projected_cg
from refimpl.solvers.production.anderson import Mixing
from refimpl.solvers.production.level import LevelSolver
from refimpl.solvers.production.nested_solver import solve_fft
from refimpl.solvers.production.projected_cg import ProjectedCG
from tests.refimpl.solvers.production.levels import BALL, level_solver, posed
from verification.coverage import scenes as study


def test_a_cycle_longer_than_two_is_settled() -> None:
    # One element enters and leaves every third update; found among 540 solves of rough balls on rough flats.
    smooth = rf.read_scene("table1-smooth")
    ball = rf.GaussianRoughness(0.084e-6, 104e-6, seed=2021, normalise=True)
    flat = rf.GaussianRoughness(0.2e-6, 104e-6, seed=2022, normalise=True)
    scene = replace(
        smooth,
        upper=rf.Body(smooth.upper.material, smooth.upper.surface + ball),
        lower=rf.Body(smooth.lower.material, flat),
    )
    s = rf.solve(scene, 128)
    assert s.status is rf.Status.CYCLED
    assert s.certificate.worst <= s.tolerance
    assert s.uncertainty["friction_coefficient"]["tau support"] < 1e-3 * s.friction_coefficient
    of_mu, of_force = (s.uncertainty[f"friction_{name}"]["tau support"] for name in ("coefficient", "force"))
    assert of_force == pytest.approx(of_mu * scene.load)
    of_area, corrected = (s.uncertainty[n]["tau support"] for n in ("contact_area", "contact_area_corrected"))
    assert of_area == corrected > 0


FAINT = replace(
    BALL,
    upper=rf.Body(rf.Material(E=18e9, nu=0.37), rf.Sphere(radius=0.165)),
    lower=rf.Body(rf.Material(E=4.5e9, nu=0.17), rf.Flat()),
    friction=rf.Friction(tau=8e6, beta=0.5),
    load=0.1,
    side=1.6e-3,
)
"""Tau moves the contact of so faint a load far about, from one of its states to the next."""


@pytest.mark.parametrize("oblique", [False, True])
def test_taus_states_are_the_same_on_any_window(oblique: bool) -> None:
    """Contact that met the edge of a window between two ends of the path took another one."""
    problem = posed(FAINT, 80, oblique=oblique)
    everywhere = level_solver(problem).solve(1e-8)
    outcome, state = solve_fft(problem, 1e-8, Counter())
    assert everywhere.status is outcome.status is rf.Status.CYCLED
    assert np.array_equal(outcome.withheld, everywhere.withheld)
    assert np.abs(outcome.pressure - everywhere.pressure).max() <= 1e-6 * everywhere.pressure.max()
    assert state.certificate.meets(1e-8)


@pytest.mark.parametrize(("margin", "cramped"), [(0, True), (12, False)])
def test_a_path_that_meets_the_windows_edge_ends_there(margin: int, cramped: bool) -> None:
    problem = posed(FAINT, 40)
    first = level_solver(problem)
    first.settle(1e-8, np.zeros((40, 40), dtype=bool))
    solver = level_solver(problem, Window.around(first.cg.pressure > 0, margin))
    outcome = solver.solve(1e-8)
    assert solver.window.shape < (40, 40)
    assert solver.cramped is cramped
    assert (outcome.status is rf.Status.CYCLED) is not cramped


def test_windows_of_taus_states_never_shrink(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else the last state could ask for what an earlier one lacks, and that one again, for ever."""
    windows: list[Window] = []
    solve = LevelSolver.solve

    def recorded(solver: LevelSolver, tolerance: float) -> Outcome:
        windows.append(solver.window)
        return solve(solver, tolerance)

    def once_too_small(problem: Problem, state: State, window: Window, tolerance: float) -> Mask:
        asked.append(window)
        return state.pressure > 0 if len(asked) == 1 else judge(problem, state, window, tolerance)

    asked: list[Window] = []
    judge = nested_solver._beyond
    monkeypatch.setattr(nested_solver, "_beyond", once_too_small)
    monkeypatch.setattr(LevelSolver, "solve", recorded)
    solve_fft(posed(FAINT, 80), 1e-8, Counter())
    assert len(windows) > 1 + windows.index(asked[0])
    for before, after in pairwise(windows):
        assert not np.any(before.mask(80) & ~after.mask(80))


def random_scene(seed: int) -> rf.Scene:
    """A ball on a flat, rough or smooth, of any materials, tau and beta."""
    draw = np.random.default_rng(seed)
    rough = rf.GaussianRoughness(rms=10 ** draw.uniform(-7.5, -6.2), correlation_length=2e-4, seed=seed)
    materials = [rf.Material(E=10 ** draw.uniform(9, 12), nu=draw.uniform(0, 0.45)) for _ in range(2)]
    return rf.Scene(
        upper=rf.Body(materials[0], rf.Sphere(radius=10 ** draw.uniform(-2, -0.7))),
        lower=rf.Body(materials[1], rough if draw.random() < 0.6 else rf.Flat()),
        friction=rf.Friction(tau=float(draw.choice([1e5, 1e6, 1e7])), beta=float(draw.choice([0, 0.1, 0.4]))),
        load=10 ** draw.uniform(-1, 1.5),
        side=1.6e-3,
    )


def test_states_on_the_way_end_where_their_contact_is_beyond_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    """Even half of the doubt allowed for is enough to tell what contact the full tolerance finds.

    And mu, to the residual; measured on 900 states of 400 scenes with slopes: 0.6 times that at most.
    """
    monkeypatch.setattr(projected_cg, "_DOUBT", 1.0)
    told_early = []
    for seed in range(24):
        solver, off = level_solver(posed(random_scene(seed), 48, oblique=bool(seed % 2))), list[float]()

        def compared(
            tolerance: float,
            support: Mask,
            withheld: Mask | None = None,
            solver: LevelSolver = solver,
            off: list[float] = off,
            settle: Callable[..., bool] = solver.settle,
        ) -> bool:
            settle(tolerance, support, withheld)
            told, residual, early = solver.cg.pressure > 0, solver.residual, solver.visited()
            settle(tolerance, support)
            assert np.array_equal(told, solver.cg.pressure > 0)
            told_early.append(residual > tolerance)
            off.append(abs(early.friction_coefficient - solver.visited().friction_coefficient) / residual)
            return True

        monkeypatch.setattr(solver, "settle", compared)
        solver.solve(1e-8)
        assert max(off) <= solver.visited().friction_coefficient
    assert sum(told_early) > 40


@pytest.mark.parametrize("scene", [FAINT, random_scene(3), random_scene(5)])
def test_the_path_is_that_of_settled_states(scene: rf.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = posed(scene, 64)
    quick = level_solver(problem)
    short = quick.solve(1e-8)
    monkeypatch.setattr(ProjectedCG, "beyond_doubt", lambda cg, stiffness: False)
    thorough = level_solver(problem)
    long = thorough.solve(1e-8)
    assert short.status is long.status
    assert np.array_equal(short.withheld, long.withheld)
    assert np.array_equal(short.traction > 0, long.traction > 0)
    assert np.abs(short.pressure - long.pressure).max() <= 1e-6 * long.pressure.max()
    assert len(short.visited) == len(long.visited)
    np.testing.assert_allclose(short.visited, long.visited, rtol=1e-7)
    assert bool(long.visited) or quick.cg_iterations < 0.9 * thorough.cg_iterations


def test_nothing_leads_on_between_mixed_updates(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is held then is nobody's, and so is the contact; after an update it is the state's own."""
    solver = level_solver(posed(replace(BALL, friction=rf.Friction(tau=1e6, beta=0.1)), 16))
    nothing = np.zeros((16, 16), dtype=bool)
    solver.settle(1e-8, nothing, nothing)
    assert solver._leads_on()
    monkeypatch.setattr(solver, "_leads_on", lambda: True)
    residual = max(solver.cg.residuals())
    assert solver._reduce(0.1 * residual) == residual
    solver._updates.mixing = Mixing()
    assert solver._reduce(0.1 * residual) < residual


@pytest.mark.parametrize(("coupled", "oblique", "leads"), [(1, 0, True), (0, 1, True), (0, 0, False)])
def test_what_tau_moves_leads_on(coupled: int, oblique: int, leads: bool) -> None:
    """Common slopes alone are moved as well; where nothing is, the next state is the same one."""
    terms = Terms(coupled=bool(coupled), oblique=bool(oblique), slope_correction=False)
    scene = replace(BALL, friction=rf.Friction(tau=1e6, beta=0.0))
    solver = level_solver(pose(scene, rf.Grid(scene.side, 16), terms, None))
    nothing = np.zeros((16, 16), dtype=bool)
    solver.settle(1e-8, nothing, nothing)
    assert solver._leads_on() is leads


def test_tau_that_moves_nothing_costs_nothing() -> None:
    """The state without it is the last one, scaled to the load once more; it was left too early."""
    terms = {"coupled": False, "oblique": False}
    still, rubbed = (
        rf.solve(replace(random_scene(3), friction=rf.Friction(tau, 0.0)), 48, **terms) for tau in (0.0, 1e7)
    )
    assert np.abs(still.pressure - rubbed.pressure).max() <= 1e-14 * still.max_pressure
    assert still.cost.applications == rubbed.cost.applications


def test_a_support_that_wanders_settles() -> None:
    """Many elements flip, each at its own pace: no support returned within 200 states, 1776 steps."""
    found = rf.solve(study.random_scene(2047).scene, 256)
    assert found.status is rf.Status.CYCLED
    assert sum(found.cost.iterations.values()) < 400
    assert 0 < found.uncertainty["friction_coefficient"]["tau support"] < 1e-2 * found.friction_coefficient


def test_what_leaves_too_often_is_withheld_by_both_solvers() -> None:
    """A scene where that happens on a grid for the dense one, found among 1000."""
    by_fft, dense = (rf.solve(study.random_scene(910).scene, 32, method=m) for m in ("fft", "dense"))
    assert by_fft.withheld.any()
    assert np.array_equal(by_fft.withheld, dense.withheld)
    assert by_fft.friction_coefficient == pytest.approx(dense.friction_coefficient, rel=1e-12)


def test_the_bar_of_taus_support_holds_all_of_tau_where_it_is_withheld() -> None:
    """And not only what the states on the cycle differ by, which is less here."""
    scene = study.random_scene(2071).scene
    found = rf.solve(scene, 128)
    spared = np.count_nonzero(found.withheld & (found.pressure > 0)) * found.grid.element_area
    assert spared > 0
    bar = found.uncertainty["friction_coefficient"]["tau support"]
    assert bar == pytest.approx(scene.friction.tau * spared / scene.load, rel=1e-12)
    assert "tau support" in found.uncertainty["contact_area"]


@pytest.mark.parametrize("method", ["fft", "dense"])
def test_tau_of_several_times_the_pressure_is_given_up(method: Literal["fft", "dense"]) -> None:
    """Most of the contact would lose it. What is returned is a state on the way, settled but unlawful."""
    found = rf.solve(replace(FAINT, friction=rf.Friction(tau=2e7, beta=0.5)), 40, method=method)
    assert found.status is rf.Status.ITERATION_LIMIT
    assert found.certificate.meets(1e-8)
    unlawful = found.certificate.unlawful * found.grid.element_area
    assert found.uncertainty["friction_coefficient"]["tau support"] >= 2e7 * unlawful / 0.1 > 0
    assert found.normal_force == pytest.approx(0.1, rel=1e-8)
    assert np.count_nonzero(found.withheld & found.contact) < np.count_nonzero(found.contact)
