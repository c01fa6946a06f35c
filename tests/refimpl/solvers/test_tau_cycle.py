"""Tau's rule on scenes: one active set for every solver, start and window, and what it leaves open."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl.operators.fft import Counter
from refimpl.solvers.production.nested_solver import solve_fft
from refimpl.solvers.production.projected_cg import ProjectedCG
from tests.refimpl.solvers.production.levels import FAINT, level_solver, problem_of
from verification.coverage import scenes as study


def test_a_contact_edge_that_cannot_keep_tau_is_reported() -> None:
    """One element is in contact without tau, and out of it with tau."""
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
    assert s.certificate.largest <= s.tolerance
    assert s.uncertainty["friction_coefficient"]["active set"] < 1e-3 * s.friction_coefficient
    of_mu, of_force = (s.uncertainty[f"friction_{name}"]["active set"] for name in ("coefficient", "force"))
    assert of_force == pytest.approx(of_mu * scene.load)
    of_area, corrected = (s.uncertainty[n]["active set"] for n in ("contact_area", "contact_area_corrected"))
    assert of_area == corrected > 0


@pytest.mark.parametrize("oblique", [False, True])
def test_taus_states_are_the_same_on_any_window(oblique: bool) -> None:
    """Also where shares of tau beside the contact meet a window's edge."""
    problem = problem_of(FAINT, 80, oblique=oblique)
    everywhere = level_solver(problem).result(1e-8)
    result, state = solve_fft(problem, 1e-8, Counter())
    assert everywhere.status is result.status is rf.Status.CYCLED
    assert np.array_equal(result.excluded, everywhere.excluded)
    assert np.abs(result.pressure - everywhere.pressure).max() <= 1e-6 * everywhere.pressure.max()
    assert state.certificate.satisfies(1e-8)


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


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10**6), start=st.integers(0, 10**6), oblique=st.booleans())
def test_the_active_set_does_not_depend_on_the_start(seed: int, start: int, oblique: bool) -> None:
    """From pressures drawn at random, on any elements, as from a Winkler foundation's."""
    problem = problem_of(random_scene(seed), 32, oblique=oblique)
    draw = np.random.default_rng(start)
    drawn = draw.random((32, 32)) * (draw.random((32, 32)) < draw.uniform(0.02, 1))
    results = [level_solver(problem, pressure=p).result(1e-9) for p in (None, drawn)]
    assume(all(r.status in (rf.Status.CONVERGED, rf.Status.CYCLED) for r in results))
    one, other = results
    assert np.array_equal(one.excluded, other.excluded)
    assert np.array_equal(one.traction > 0, other.traction > 0)
    assert np.abs(one.pressure - other.pressure).max() <= 1e-5 * one.pressure.max()


@pytest.mark.parametrize("seed", [2031, 2047, 2071])
def test_the_active_set_is_that_of_the_dense_reference(seed: int) -> None:
    """And excluded elements; scenes whose contact edge cannot keep tau, on this grid or finer ones."""
    by_fft, dense = (rf.solve(study.random_scene(seed).scene, 32, method=m) for m in ("fft", "dense"))
    assert np.array_equal(by_fft.excluded, dense.excluded)
    assert np.array_equal(by_fft.traction > 0, dense.traction > 0)
    assert by_fft.friction_coefficient == pytest.approx(dense.friction_coefficient, rel=1e-8)


def test_grid_accuracy_and_start_agree() -> None:
    scene = replace(random_scene(3), friction=rf.Friction(tau=1e7, beta=0.1))
    by_accuracy = rf.solve(scene, accuracy=0.05)
    by_grid = rf.solve(scene, by_accuracy.grid.shape[0])
    nearby = rf.solve(replace(scene, load=1.01 * scene.load), by_grid.grid.shape[0])
    restarted = rf.solve(scene, by_grid.grid.shape[0], start=nearby)
    for other in (by_accuracy, restarted):
        assert np.array_equal(other.traction > 0, by_grid.traction > 0)
        assert np.array_equal(other.excluded, by_grid.excluded)


@pytest.mark.parametrize("scene", [FAINT, random_scene(3), random_scene(5)])
def test_solves_that_end_early_do_not_change_the_sequence(
    scene: rf.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = problem_of(scene, 64)
    quick = level_solver(problem)
    short = quick.result(1e-8)
    monkeypatch.setattr(ProjectedCG, "contact_is_certain", lambda cg, stiffness: False)
    thorough = level_solver(problem)
    long = thorough.result(1e-8)
    assert short.status is long.status
    assert np.array_equal(short.excluded, long.excluded)
    assert np.array_equal(short.traction > 0, long.traction > 0)
    assert np.abs(short.pressure - long.pressure).max() <= 1e-6 * long.pressure.max()
    assert quick.cg_iterations <= thorough.cg_iterations


def test_a_scene_whose_edge_moves_far_ends_after_few_solves() -> None:
    """Many elements alternate, each at its own pace: sets that followed the contact took 1776 steps."""
    found = rf.solve(study.random_scene(2047).scene, 256)
    assert found.status in (rf.Status.CYCLED, rf.Status.CONVERGED)
    assert sum(found.cost.iterations.values()) < 200


def test_the_error_bar_of_the_active_set_holds_all_of_tau_on_excluded_elements() -> None:
    scene = study.random_scene(2071).scene
    found = rf.solve(scene, 128)
    spared = np.count_nonzero(found.excluded & (found.pressure > 0)) * found.grid.element_area
    assert spared > 0
    bar = found.uncertainty["friction_coefficient"]["active set"]
    assert bar == pytest.approx(scene.friction.tau * spared / scene.load, rel=1e-12)
    assert "active set" in found.uncertainty["contact_area"]


@pytest.mark.parametrize("method", ["fft", "dense"])
def test_tau_of_several_times_the_pressure_is_given_up(method: Literal["fft", "dense"]) -> None:
    """Most of the contact would lose it. The returned state has converged, but violates the law."""
    found = rf.solve(replace(FAINT, friction=rf.Friction(tau=2e7, beta=0.5)), 40, method=method)
    assert found.status is rf.Status.ITERATION_LIMIT
    assert found.certificate.satisfies(1e-8)
    violations = found.certificate.law_violations * found.grid.element_area
    assert found.uncertainty["friction_coefficient"]["active set"] >= 2e7 * violations / 0.1 > 0
    assert found.normal_force == pytest.approx(0.1, rel=1e-8)
