"""Proven bounds: least eigenvalue and its proof, dual norms, states of every kind, and where none exists."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

import refimpl as rf
from refimpl.contact.active_set import complementarity, restricted_solve
from refimpl.contact.bounds import (
    NO_BOUND_CORRECTED,
    NO_BOUND_PERIODIC,
    NO_BOUND_STEEP,
    Bounds,
    _Frozen,
    proven_bounds,
)
from refimpl.contact.energy_norm import SMALLEST_SYMBOL, EnergyNorm
from refimpl.grid import Array
from refimpl.operators.dense import DenseInfluence
from refimpl.problem import Problem
from refimpl.slopes import Slopes

SIDE, M = 1e-3, 10
POLYMER, STEEL = rf.Material(2.5e9, 0.1), rf.Material(200e9, 0.3)


def scene(seed: int, *, periodic: bool = False, tau: float = 0.5e6, beta: float = 0.3) -> rf.Scene:
    z = 0.6e-6 * np.random.default_rng(seed).standard_normal((M, M))
    return rf.Scene(
        upper=rf.Body(STEEL, rf.Flat() if periodic else rf.Sphere(0.1)),
        lower=rf.Body(POLYMER, z),
        friction=rf.Friction(tau, beta),
        load=3.0,
        side=SIDE,
        sliding_direction=0.7,
        periodic=periodic,
    )


def frozen_solution(problem: Problem, held: Array, slopes: Slopes) -> tuple[Array, float, Array]:
    """Pressure and approach with ``held`` and slopes fixed, by pivoting on dense matrices; and ``a``."""
    influence = DenseInfluence(problem.grid, problem.direction, periodic=problem.periodic)
    C, beta = problem.pair.shear_compliance, problem.friction.beta
    a = problem.pair.normal_compliance * influence.normal_matrix
    K = slopes.obliqueness.ravel()
    lift = problem.pair.normal_compliance * SIDE / K.size if problem.periodic else 0.0
    G = a + beta * C * influence.shear_matrix + lift * np.outer(K, K)
    g = C * influence.shear_matrix @ held.ravel() + K * problem.gap.ravel()
    active = problem.gap.ravel() < np.median(problem.gap)
    if problem.approach is not None:
        return complementarity(G, g - K * problem.approach, active).pressure, problem.approach, a
    assert problem.load is not None
    weights = K * (1 - beta * slopes.tan_x.ravel())
    target = problem.load / problem.grid.element_area + float(held.ravel() @ (K * slopes.tan_x.ravel()))
    low, high, unsettled = -np.inf, np.inf, True
    while unsettled:
        per_approach, at_zero = restricted_solve(G, np.stack([K, -g], axis=1), active).T
        approach = (target - weights @ at_zero) / (weights @ per_approach)
        if not low < approach < high:
            approach = 0.5 * (low + high)
        found = complementarity(G, g - K * approach, active)
        unsettled = not np.array_equal(found.active, active)
        low, high = (approach, high) if weights @ found.pressure < target else (low, approach)
        active = found.active
    return found.pressure, approach - lift * float(K @ found.pressure), a


def assert_true(bounds: Bounds, problem: Problem, pressure: Array, traction: Array, slopes: Slopes) -> float:
    """Every bound holds against the frozen solution; true over bound in the energy."""
    beta = problem.friction.beta
    held = traction - beta * pressure
    exact, approach, a = frozen_solution(problem, held, slopes)
    e, dA = pressure.ravel() - exact, problem.grid.element_area
    K, tan_x, tan_y = slopes.obliqueness.ravel(), slopes.tan_x.ravel(), slopes.tan_y.ravel()
    touching = (exact > 0).reshape(pressure.shape)
    energy = float(e @ a @ e) * dA
    assert energy <= bounds.energy
    assert np.abs(e).max() <= bounds.pressure
    assert np.linalg.norm(e) * math.sqrt(dA) <= bounds.pressure_l2
    normal = abs(float((K * (1 - beta * tan_x)) @ e)) * dA
    friction = abs(float((K * (tan_x + beta)) @ e)) * dA
    binormal = abs(float(((1 - beta * tan_x) * K * tan_y) @ e)) * dA
    rounding = 1e-13 * float(np.abs(pressure).sum()) * dA
    assert normal <= bounds.normal_force + rounding
    assert friction <= bounds.friction_force + rounding
    assert binormal <= bounds.binormal_force + rounding
    assert not (bounds.in_contact & ~touching).any()
    assert not (bounds.out_of_contact & touching).any()
    low, high = bounds.contact_area
    assert low <= touching.sum() * dA <= high
    if problem.load is not None and (pressure >= 0).all():
        v = problem.displacements(
            EnergyNorm(problem, slopes.obliqueness).operator, pressure, traction, slopes
        )
        free = np.add(*v).ravel() + K * problem.gap.ravel()
        mean = float(pressure.ravel() @ free) / float(pressure.ravel() @ K)
        assert abs(mean - approach) <= bounds.approach
    return energy / bounds.energy


def test_smallest_symbol_is_enclosed_from_below() -> None:
    """2/sqrt(pi) times the integral of S(pi, t)^2: by Poisson's sum for small t, by error functions else."""

    def S(t: mp.mpf) -> mp.mpf:
        if t < 2:
            k = [mp.pi * (2 * n + 1) for n in range(12)]
            terms = [(-1) ** n * 4 / k[n] * mp.exp(-((k[n] / (2 * t)) ** 2)) for n in range(12)]
            return mp.sqrt(mp.pi) / t * mp.fsum(terms)
        ends = [mp.erf(t * (mp.mpf(j) + mp.mpf(1) / 2)) for j in range(13)]
        B = [ends[0]] + [(ends[j] - ends[j - 1]) / 2 for j in range(1, 13)]
        return mp.sqrt(mp.pi) / t * (B[0] + 2 * mp.fsum((-1) ** j * B[j] for j in range(1, 13)))

    with mp.workdps(20):
        assert abs(S(mp.mpf("1.9999999")) - S(mp.mpf("2.0000001"))) < 1e-6
        finite = mp.quad(lambda t: S(t) ** 2, [0.05, 0.3, 0.6, 1, 2, 4, 8, 16])
        value = 2 / mp.sqrt(mp.pi) * (finite + mp.pi / 16)  # erf is 1 to 20 digits beyond t = 16
        assert 0 < value - mp.mpf(SMALLEST_SYMBOL) < 1e-10


def test_the_claim_behind_the_smallest_symbol() -> None:
    """S(theta, t) >= S(pi, t) >= 0, and A falls with s: sampled, as the proof says."""
    theta = np.linspace(0, np.pi, 201)[1:, None]
    k = theta + 2 * np.pi * np.arange(-60, 61)
    sign = (-1.0) ** np.arange(-60, 61)
    before = np.ones(len(theta))
    for s in np.geomspace(1e-3, 3, 60):
        A = np.sum(sign * 2 * np.sin(theta / 2) * np.exp(-(k**2) * s) / k, axis=1)
        assert A.min() >= A[-1] - 1e-13
        assert A[-1] >= -1e-13
        assert np.max(A - before) <= 1e-13
        before = A


@pytest.mark.parametrize("periodic", [False, True])
def test_least_eigenvalue_and_dual_norm(periodic: bool) -> None:
    problem = rf.solve(scene(1, periodic=periodic), M, tolerance=0.5).problem
    K = np.random.default_rng(2).uniform(0.99, 1.0, (M, M))
    norm = EnergyNorm(problem, K)
    influence = DenseInfluence(problem.grid, 0.0, periodic=periodic)
    a = problem.pair.normal_compliance * influence.normal_matrix + norm.lift * np.outer(K, K)
    least = float(np.linalg.eigvalsh(a)[0])
    assert 0.9 * least <= norm.floor <= least
    assert norm.diagonal == pytest.approx(a.diagonal().max(), rel=1e-3)
    right, where = np.random.default_rng(3).standard_normal((2, M, M))
    inside = where > 0
    index = np.flatnonzero(inside)
    exact = math.sqrt(right[inside] @ np.linalg.solve(a[np.ix_(index, index)], right[inside]))
    assert exact <= norm.dual_norm(right, inside) <= 1.02 * exact
    assert norm.dual_norm(np.zeros((M, M)), inside) == 0.0
    e = right * inside
    exact = math.sqrt(e.ravel() @ a @ e.ravel())
    assert exact <= norm.norm(e) <= (1 + 1e-9) * exact


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
    ratios = [assert_true(found.bounds, found.problem, found.pressure, found.traction, found.slopes)]
    for size in (1e-1, 1e-3, 1e-6):
        noise = random.standard_normal((M, M)) * (random.random((M, M)) < 0.3)
        pressure = found.pressure * (1 + size * random.standard_normal()) + size * found.max_pressure * noise
        traction = found.traction + size * found.friction.tau * random.standard_normal((M, M))
        bounds = proven_bounds(found.problem, pressure, traction, found.slopes)
        ratios.append(assert_true(bounds, found.problem, pressure, traction, found.slopes))
    assert min(ratios) > 1e-4  # useful bounds: the norm is at most a hundred times the true error's


@pytest.mark.parametrize("oblique", [False, True])
@pytest.mark.parametrize("factor", [0.9, 1.1])
def test_the_exact_state_of_another_load_is_bounded_by_the_load_error_alone(
    factor: float, oblique: bool
) -> None:
    base = scene(2, tau=0.0)
    other = rf.solve(replace(base, load=factor * base.load), M, tolerance=1e-12, oblique=oblique)
    problem = replace(other.problem, load=base.load)
    bounds = proven_bounds(problem, other.pressure, other.traction, other.slopes)
    ratio = assert_true(bounds, problem, other.pressure, other.traction, other.slopes)
    assert ratio > 0.1
    assert bounds.normal_force == pytest.approx(abs(factor - 1) * base.load)


def test_elements_that_the_state_forgot_are_bounded() -> None:
    """One of four flat elements carries just so much that its neighbours' gap is closed to nothing: on them
    the correction would overshoot, and without that part the bound would be 9 % short in the norm."""
    base = replace(scene(0, tau=0.0, beta=0.0), lower=rf.Body(POLYMER, np.zeros((2, 2))))
    base = replace(base, upper=rf.Body(STEEL, rf.Flat()))
    found = rf.solve(base, 2, approach=1e-7, oblique=False)
    row = EnergyNorm(found.problem, np.ones((2, 2))).apply(np.array([[1.0, 0.0], [0.0, 0.0]]))
    pressure = np.array([[1e-7 / row[0, 1], 0.0], [0.0, 0.0]])
    bounds = proven_bounds(found.problem, pressure, 0 * pressure, found.slopes)
    assert assert_true(bounds, found.problem, pressure, 0 * pressure, found.slopes) > 0.5


def test_dual_norm_is_a_bound_whatever_conjugate_gradients_return(monkeypatch: pytest.MonkeyPatch) -> None:
    norm = EnergyNorm(rf.solve(scene(1), M, tolerance=0.5).problem, np.ones((M, M)))
    right, where = np.random.default_rng(3).standard_normal((M, M)), np.ones((M, M), dtype=bool)
    z, az = norm.solve(right, where)
    exact = norm.dual_norm(right, where)
    for share in (0.0, 0.5, 1.5):
        monkeypatch.setattr(norm, "solve", lambda *_, share=share: (share * z, share * az))
        assert 0.99 * exact <= norm.dual_norm(right, where) < math.inf


def test_bounds_of_a_converged_state_are_sharp_and_decide_every_element() -> None:
    found = rf.solve(scene(4), M)
    bounds = found.bounds
    held = found.traction - found.friction.beta * found.pressure
    exact, _, a = frozen_solution(found.problem, held, found.slopes)
    e = found.pressure.ravel() - exact
    true = float(e @ a @ e) * found.grid.element_area
    assert true <= bounds.energy <= 2 * true + 1e-20 * float(exact @ a @ exact) * found.grid.element_area
    assert np.array_equal(bounds.in_contact, found.contact)
    assert np.array_equal(bounds.out_of_contact, ~found.contact)
    assert bounds.contact_area == pytest.approx((found.contact_area, found.contact_area))
    assert bounds.normal_force == pytest.approx(abs(found.normal_force - 3.0), abs=1e-15)


def test_bounds_cost_nothing_until_asked_for() -> None:
    found = rf.solve(scene(0), M)
    assert "bounds" not in vars(found)
    assert found.bounds is found.bounds


def test_surfaces_apart_are_exact() -> None:
    bounds = rf.solve(scene(0), M, approach=-1e-6).bounds
    assert bounds.energy <= 1e-30
    assert bounds.out_of_contact.all()


@pytest.mark.parametrize(
    ("options", "periodic", "why"),
    [
        ({"slope_correction": True}, False, NO_BOUND_CORRECTED),
        ({"approach": -1e-7}, True, NO_BOUND_PERIODIC),
    ],
)
def test_no_bound_is_infinite_and_says_why(options: dict[str, float], periodic: bool, why: str) -> None:
    bounds = rf.solve(scene(0, periodic=periodic), M, **options).bounds  # type: ignore[arg-type]  # two options
    assert bounds.unproven == why
    assert math.isinf(bounds.energy)
    assert math.isinf(bounds.friction_coefficient)
    assert not bounds.in_contact.any()
    assert not bounds.out_of_contact.any()
    assert bounds.contact_area == pytest.approx((0.0, SIDE**2))


def test_no_bound_without_a_definite_norm_or_a_load() -> None:
    found = rf.solve(scene(0, periodic=True), M)
    steep = Slopes(40.0 * (np.indices((M, M)).sum(axis=0) % 2), np.zeros((M, M)))
    assert proven_bounds(found.problem, found.pressure, found.traction, steep).unproven == NO_BOUND_STEEP
    found = rf.solve(scene(0), M)
    nothing = np.zeros((M, M))
    assert math.isinf(proven_bounds(found.problem, nothing, nothing, found.slopes).energy)
    strong = replace(found.problem, friction=rf.Friction(0.0, 5.0))
    tilted = Slopes(np.full((M, M), 3.0), np.zeros((M, M)))
    assert math.isinf(proven_bounds(strong, found.pressure, 5 * found.pressure, tilted).energy)


def test_coupling_that_is_left_out_widens_no_bound() -> None:
    """Shear that only tilts the surface is held with the slopes; c does not stand in the contact's matrix."""
    left_out = rf.solve(scene(3), M, coupled=False)
    assert left_out.problem.terms.shear_moves()
    assert left_out.problem.pair.shear_compliance != 0
    frozen = _Frozen(
        left_out.problem,
        EnergyNorm(left_out.problem, left_out.slopes.obliqueness),
        left_out.pressure,
        left_out.traction,
        left_out.slopes,
    )
    assert frozen.coupling == 0
