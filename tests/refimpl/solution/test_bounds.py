"""Proven bounds: states of every kind, numbers by hand on few elements, and where no bound exists."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.bounds.energy_norm import EnergyNorm
from refimpl.bounds.proven_bounds import (
    NO_BOUND_CORRECTED,
    NO_BOUND_PERIODIC,
    NO_BOUND_STEEP,
    UNPROVEN,
    _Frozen,
    _shear_row,
    proven_bounds,
)
from refimpl.model.slopes import Slopes
from tests.refimpl.solution.frozen import (
    POLYMER,
    SIDE,
    STEEL,
    M,
    assert_true,
    frozen_solution,
    posed,
    scene,
    widened,
)
from verification.exact.dense_influence import DenseInfluence


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("kind", ["flat", "oblique", "approach", "periodic"])
def test_bounds_hold_for_any_state(seed: int, kind: str) -> None:
    """Loosely solved, then with noise: negative pressures, penetration, spurious pressure, a wrong load."""
    found = rf.solve(
        scene(seed, periodic=kind == "periodic"),
        M,
        tolerance=1e-3,
        oblique=kind in ("oblique", "periodic"),
        approach=2e-6 if kind == "approach" else None,
    )
    random = np.random.default_rng(seed)
    ratios = [
        assert_true(found.details.bounds, found.details.problem, found.pressure, found.traction, found.slopes)
    ]
    for size in (1e-1, 1e-3, 1e-6):
        noise = random.standard_normal((M, M)) * (random.random((M, M)) < 0.3)
        pressure = found.pressure * (1 + size * random.standard_normal()) + size * found.max_pressure * noise
        traction = found.traction + size * found.details.friction.jump * random.standard_normal((M, M))
        bounds = proven_bounds(found.details.problem, pressure, traction, found.slopes)
        ratios.append(assert_true(bounds, found.details.problem, pressure, traction, found.slopes))
    assert min(ratios) > 1e-4  # useful bounds: the norm is at most a hundred times the true error's


def test_elements_that_the_state_forgot_are_bounded() -> None:
    """One of four flat elements carries just so much that its neighbours' gap is closed to nothing: on them
    the correction would overshoot, and without that part the bound would be 9 % short in the norm."""
    base = replace(scene(0, tau=0.0, beta=0.0), lower=rf.Body(POLYMER, np.zeros((2, 2))))
    base = replace(base, upper=rf.Body(STEEL, rf.Flat()))
    found = rf.solve(base, 2, approach=1e-7, oblique=False)
    row = EnergyNorm(found.details.problem, np.ones((2, 2))).apply(np.array([[1.0, 0.0], [0.0, 0.0]]))
    pressure = np.array([[1e-7 / row[0, 1], 0.0], [0.0, 0.0]])
    bounds = proven_bounds(found.details.problem, pressure, 0 * pressure, found.slopes)
    assert assert_true(bounds, found.details.problem, pressure, 0 * pressure, found.slopes) > 0.5


def test_bounds_of_a_converged_state_are_sharp_and_decide_every_element() -> None:
    found = rf.solve(scene(4), M)
    bounds = found.details.bounds
    held = found.traction - found.details.friction.slope * found.pressure
    exact, _, a = frozen_solution(found.details.problem, held, found.slopes)
    e = found.pressure.ravel() - exact
    true = float(e @ a @ e) * found.grid.element_area
    assert true <= bounds.energy <= 2 * true + 1e-20 * float(exact @ a @ exact) * found.grid.element_area
    assert np.array_equal(bounds.in_contact, found.contact)
    assert np.array_equal(bounds.out_of_contact, ~found.contact)
    assert bounds.contact_area == pytest.approx((found.contact_area, found.contact_area))
    assert bounds.normal_force == pytest.approx(abs(found.normal_force - 3.0), abs=1e-15)


@pytest.mark.parametrize(
    ("options", "periodic", "why"),
    [
        ({"slope_correction": True}, False, NO_BOUND_CORRECTED),
        ({"approach": -1e-7}, True, NO_BOUND_PERIODIC),
    ],
)
def test_no_bound_is_infinite_and_says_why(options: dict[str, float], periodic: bool, why: str) -> None:
    bounds = rf.solve(scene(0, periodic=periodic), M, **options).details.bounds  # type: ignore[arg-type]  # two options
    assert bounds.unproven == why
    assert math.isinf(bounds.energy)
    assert math.isinf(bounds.friction_coefficient)
    assert not bounds.in_contact.any()
    assert not bounds.out_of_contact.any()
    assert bounds.contact_area == pytest.approx((0.0, SIDE**2))


def test_no_bound_without_a_definite_norm_or_a_load() -> None:
    found = rf.solve(scene(0, periodic=True), M)
    steep = Slopes(40.0 * (np.indices((M, M)).sum(axis=0) % 2), np.zeros((M, M)))
    assert (
        proven_bounds(found.details.problem, found.pressure, found.traction, steep).unproven == NO_BOUND_STEEP
    )
    found = rf.solve(scene(0), M)
    nothing = np.zeros((M, M))
    assert math.isinf(proven_bounds(found.details.problem, nothing, nothing, found.slopes).energy)
    strong = replace(found.details.problem, friction=rf.Friction(0.0, 5.0))
    tilted = Slopes(np.full((M, M), 3.0), np.zeros((M, M)))
    assert math.isinf(proven_bounds(strong, found.pressure, 5 * found.pressure, tilted).energy)


@pytest.mark.parametrize("tau", [0.0, 0.5e6])
def test_bounds_of_a_state_with_a_hardness_are_sharp(tau: float) -> None:
    """Stopped early, against the state solved to rounding."""
    base = scene(4, tau=tau, beta=0.0)
    peak = rf.solve(base, M, oblique=False).max_pressure
    yields = replace(base, lower=replace(base.lower, material=replace(POLYMER, hardness=0.5 * peak)))
    exact = rf.solve(yields, M, oblique=False, tolerance=1e-13)
    assert 0.1 * exact.contact_area < exact.plastic_area < 0.9 * exact.contact_area
    norm = EnergyNorm(exact.details.problem, np.ones((M, M)))
    for tolerance in (1e-2, 1e-3, 1e-4):
        early = rf.solve(yields, M, oblique=False, tolerance=tolerance)
        e = early.pressure - exact.pressure
        true = float(np.vdot(e, norm.apply(e))) * exact.grid.element_area
        bounds = proven_bounds(exact.details.problem, early.pressure, exact.traction, Slopes.flat((M, M)))
        assert true <= bounds.energy <= 5 * true  # measured 1.06 to 2.96


@pytest.mark.parametrize(("apart", "sure"), [(10, False), (45, False), (100, True)])
def test_surfaces_closer_than_rounding_are_not_surely_apart(apart: int, sure: bool) -> None:
    """A metre of gap against an approach of a metre, but for so many last digits."""
    nothing = np.zeros((3, 3))
    problem = posed(nothing + 1.0, approach=1 - apart * float(np.finfo(float).eps))
    bounds = proven_bounds(problem, nothing, nothing, Slopes.flat((3, 3)))
    assert bounds.out_of_contact.all() == sure
    assert bounds.out_of_contact.any() == sure


def test_one_loaded_element_of_four_by_hand() -> None:
    """Its diagonal neighbour is at w = 0 exactly and carries nothing: no contact, so it is not solved for."""
    nothing = np.zeros((2, 2))
    pressure = np.array([[1.0, 0.0], [0.0, 0.0]])
    (a, b), (_, d) = EnergyNorm(posed(nothing, load=1.0), np.ones((2, 2))).apply(pressure)
    problem = posed(nothing, approach=float(d))
    norm, flat = EnergyNorm(problem, np.ones((2, 2))), Slopes.flat((2, 2))
    u = np.add(*problem.displacements(norm.operator, pressure, nothing, flat))
    problem = replace(problem, approach=float(u[1, 1]))
    # w - a z off the element, with z = (a - d) / a on it
    left = [d * (1 - b / a), d * (1 - b / a), d * (1 - d / a)]
    residual = (a - d) / math.sqrt(a) + float(np.linalg.norm(left)) / math.sqrt(norm.floor)
    bounds = proven_bounds(problem, pressure, nothing, flat)
    assert bounds.energy == pytest.approx(residual**2 * problem.grid.element_area, rel=1e-9)


def test_a_load_that_shear_carries_alone_fixes_no_contact() -> None:
    """Eq. (2): shear that pulls up a slope takes more than the load off the pressures."""
    problem = posed(np.zeros((3, 3)), load=0.1)
    uphill = Slopes(np.full((3, 3), 0.5), np.zeros((3, 3)))
    bounds = proven_bounds(problem, np.ones((3, 3)), np.full((3, 3), -1.0), uphill)
    assert math.isinf(bounds.energy)
    assert bounds.unproven == "the load does not fix the contact: " + UNPROVEN


@pytest.mark.parametrize("shape", [(1, 1), (2, 2), (5, 5), (4, 6), (5, 2)])
def test_no_row_of_the_shear_is_longer_than_its_corners(shape: tuple[int, int]) -> None:
    """Four corners meet every offset once, those along an axis twice: seen from a wide rectangle's centre."""
    (n, m), zero = shape, np.zeros(shape)
    problem, flat = posed(zero, load=1.0, beta=0.1), Slopes.flat(shape)
    found = _shear_row(_Frozen(problem, EnergyNorm(problem, np.ones(shape)), zero, zero, flat))
    wide = widened(problem.grid)
    row = DenseInfluence(wide, problem.direction).shear_matrix[wide.elements // 2]
    offsets = row.reshape(wide.shape) ** 2
    met = offsets.sum() + offsets[n - 1].sum() + offsets[:, m - 1].sum()
    strength = 0.1 * problem.pair.shear_compliance
    assert found == pytest.approx(abs(strength) * math.sqrt(met), rel=1e-10)
    rows = strength * DenseInfluence(problem.grid, problem.direction).shear_matrix
    assert np.linalg.norm(rows, axis=1).max() <= found
