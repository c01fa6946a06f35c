"""What CG inverts and what is held: weak coupling in one product, strong coupling beside it, the same sum."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.friction import local_friction
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.solvers.production import flexibility
from refimpl.solvers.production.flexibility import Flexibility
from tests.refimpl.solvers.production.levels import coupled, posed

M = 12
ROUNDING = 1e-14  # of the largest displacement: transforms of a few hundred points


def turned(sigma: float, tau: float = 0.0, *, oblique: bool = False, periodic: bool = False) -> Problem:
    """Sliding along no axis of the grid."""
    scene = replace(coupled(sigma, tau), sliding_direction=0.7, periodic=periodic)
    return posed(scene, M, oblique=oblique)


def flexible(problem: Problem) -> tuple[Flexibility, Counter]:
    kind, counter = PeriodicInfluence if problem.periodic else FFTInfluence, Counter()
    return Flexibility(problem, kind(problem.grid, problem.direction, counter=counter)), counter


def pressed(seed: int) -> Array:
    pressure = np.random.default_rng(seed).random((M, M))
    return np.where(pressure > 0.5, pressure * 1e6, 0.0)


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("sigma", [0.0, 0.1, 0.3, 0.5])
def test_weak_coupling_is_applied_with_the_pressure(sigma: float, periodic: bool) -> None:
    problem = turned(sigma, periodic=periodic)
    found, counter = flexible(problem)
    dense = DenseInfluence(problem.grid, problem.direction, periodic=periodic)
    pressure = pressed(1)
    expected = problem.pair.normal_compliance * dense.normal(pressure)
    if 0 < sigma <= 0.3:
        expected += problem.coupling(dense, problem.friction.beta * pressure)
    assert found.coupled is (0 < sigma <= 0.3)
    assert np.abs(found.apply(pressure) - expected).max() <= ROUNDING * np.abs(expected).max()
    assert sum(n for kind, n in counter.tally.items() if "kernel" not in kind) == 1


def test_coupling_that_is_left_out_is_not_applied() -> None:
    level = turned(0.2)
    apart = replace(level, terms=replace(level.terms, coupled=False))
    assert not flexible(apart)[0].coupled


@pytest.mark.parametrize(("slope_correction", "sigma"), [(False, 0.0), (True, 2.5)])
def test_coupling_that_is_left_out_counts_for_nothing(slope_correction: bool, sigma: float) -> None:
    """Facet tractions bring shear to the gap by themselves."""
    strong = turned(2.5, oblique=True)
    apart = replace(strong, terms=replace(strong.terms, coupled=False, slope_correction=slope_correction))
    assert flexible(apart)[0].sigma == pytest.approx(sigma)


def test_facet_tractions_are_no_multiple_of_the_pressure() -> None:
    tilted = turned(0.2, oblique=True)
    facets = replace(tilted, terms=replace(tilted.terms, slope_correction=True))
    assert flexible(tilted)[0].coupled
    assert not flexible(facets)[0].coupled


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("oblique", [False, True])
@pytest.mark.parametrize("tau", [0.0, 1e6])
def test_what_is_applied_and_what_is_held_add_up_to_the_same(
    tau: float, oblique: bool, periodic: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the displacement of Eq. (7) and to the slopes, however shear is shared out."""
    problem = turned(0.2, tau, oblique=oblique, periodic=periodic)
    pressure, slopes = pressed(2), Slopes.flat((M, M))
    support = pressed(3) > 0
    traction = local_friction(problem.friction, pressure, support)
    sums = []
    for weak in (0.3, 0.0):
        monkeypatch.setattr(flexibility, "_WEAK", weak)
        found, _ = flexible(problem)
        displacement = found.apply(pressure)
        held, left = found.displaced(pressure, 0, support, slopes, displacement)
        assert found.coupled is (weak > 0)
        sums.append((displacement + held, left.tan_x, left.tan_y))
    dense = DenseInfluence(problem.grid, problem.direction, periodic=periodic)
    lower, upper = problem.displacements(dense, pressure, traction, slopes)
    expected = problem.slopes(lower, upper)
    for total, along, across in sums:
        assert np.abs(total - (lower + upper)).max() <= ROUNDING * np.abs(lower + upper).max()
        # differences of displacements over two spacings
        bound = ROUNDING * np.abs(lower + upper).max() / problem.grid.spacing
        assert np.abs(along - expected.tan_x).max() <= bound
        assert np.abs(across - expected.tan_y).max() <= bound


def test_tau_is_applied_once_for_a_support_and_a_pressure_once_for_a_step() -> None:
    """Between CG's steps a pressure is only brought to the load, which the product follows to rounding."""
    problem = turned(0.2, 1e6, oblique=True)
    found, counter = flexible(problem)
    slopes = Slopes.flat((M, M))
    for supports, step, factor, products in (
        (1, 0, 1.0, 2),
        (1, 0, 1.1, 2),
        (2, 0, 0.7, 3),
        (2, 1, 0.7, 4),
        (1, 1, 1.0, 5),
    ):
        support = pressed(supports) > 0
        pressure = factor * pressed(7 + step)
        displacement = found.apply(pressure)
        held, left = found.displaced(pressure, step, support, slopes, displacement)
        assert counter.tally["shear"] == products
        expected, tangents = flexible(problem)[0].displaced(pressure, 0, support, slopes, displacement)
        assert np.abs(held - expected).max() <= ROUNDING * np.abs(displacement).max()
        bound = ROUNDING * np.abs(displacement).max() / problem.grid.spacing
        assert np.abs(left.tan_x - tangents.tan_x).max() <= bound


def test_without_tau_nothing_is_applied_for_it() -> None:
    problem = turned(0.2, oblique=True)
    found, counter = flexible(problem)
    support, flat = pressed(1) > 0, Slopes.flat((M, M))
    found.displaced(pressed(7), 0, support, flat, found.apply(pressed(7)))
    assert counter.tally["shear"] == 1


def test_no_pressure_at_all_is_sheared_by_nothing() -> None:
    problem = turned(0.2, 1e6, oblique=True)
    found, _ = flexible(problem)
    nothing = np.zeros((M, M))
    for _ in range(2):
        held, left = found.displaced(nothing, 0, nothing > 0, Slopes.flat((M, M)), nothing)
        assert not held.any()
        assert np.isfinite(left.tan_x).all()


@pytest.mark.parametrize("influence", [FFTInfluence, PeriodicInfluence])
def test_both_kernels_in_one_product_cost_one(
    influence: type[FFTInfluence] | type[PeriodicInfluence],
) -> None:
    problem = turned(0.2)
    grid, counter = problem.grid, Counter()
    operator = influence(grid, problem.direction, counter=counter)
    product = operator.coupled(0.5)
    before, pressure = counter.point_logs, pressed(4)
    found = product(pressure)
    after = counter.point_logs
    expected = operator.normal(pressure) + 0.5 * operator.shear(pressure)
    assert math.isclose(after - before, 0.5 * (counter.point_logs - after), rel_tol=1e-14)
    assert np.abs(found - expected).max() <= ROUNDING * np.abs(expected).max()


@pytest.mark.parametrize("oblique", [False, True])
def test_coupling_that_cg_takes_in_ends_in_the_same_state_for_less(
    oblique: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A fifth less at least; measured: 0.63 level, 0.73 oblique."""
    scene = replace(coupled(0.3), load=20.0)
    together = rf.solve(scene, 64, oblique=oblique)
    monkeypatch.setattr(flexibility, "_WEAK", 0.0)
    apart = rf.solve(scene, 64, oblique=oblique)
    assert together.status is apart.status is rf.Status.CONVERGED
    assert np.abs(together.pressure - apart.pressure).max() <= 1e-6 * apart.max_pressure
    assert together.cost.point_logs <= 0.8 * apart.cost.point_logs


@pytest.mark.parametrize(("sigma", "pays"), [(0.5, True), (0.7, False)])
def test_coupling_pays_beyond_what_is_taken_in_and_fails_still_further(
    sigma: float, pays: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What `_WEAK` rests on, with room to spare: on four balls, work over the lagged updates' and status."""
    ratios, ended = [], []
    for load in (0.5, 2.0, 8.0, 32.0):
        scene = replace(coupled(sigma), load=load)
        apart = rf.solve(scene, 64, oblique=False)
        with monkeypatch.context() as patched:
            patched.setattr(flexibility, "_WEAK", 1.0)
            together = rf.solve(scene, 64, oblique=False)
        assert apart.status is rf.Status.CONVERGED
        ratios.append(together.cost.point_logs / apart.cost.point_logs)
        ended.append(together.status)
    assert (max(ratios) < 1) is pays
    assert (min(ratios) < 1) is pays
    assert all((status is rf.Status.CONVERGED) is pays for status in ended)
