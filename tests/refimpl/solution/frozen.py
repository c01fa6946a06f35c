"""Rough contacts with slopes and shear held, and their solution by pivoting on dense matrices."""

from __future__ import annotations

import math

import numpy as np

import refimpl as rf
from refimpl.bounds.energy_norm import EnergyNorm
from refimpl.bounds.proven_bounds import Bounds
from refimpl.grid import Array, Grid
from refimpl.model.elasticity import Elasticity
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.model.slopes import Slopes
from tests.refimpl.complementarity import complementarity, restricted_solve
from verification.exact.dense_influence import DenseInfluence

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
    influence = DenseInfluence(problem.grid, problem.direction)
    C, beta = problem.pair.shear_compliance * problem.terms.coupled, problem.friction.slope
    a = problem.pair.normal_compliance * influence.normal_matrix
    K = slopes.cosine_product.ravel()
    size = math.sqrt(math.prod(problem.grid.lengths))
    lift = problem.pair.normal_compliance * size / K.size if problem.grid.periodic else 0.0
    G = a + beta * C * influence.shear_matrix + lift * np.outer(K, K)
    g = C * influence.shear_matrix @ held.ravel() + K * problem.gap.ravel()
    active = problem.gap.ravel() < np.median(problem.gap)
    if problem.approach is not None:
        return complementarity(G, g - K * problem.approach, active)[0], problem.approach, a
    assert problem.load is not None
    weights = K * (1 - beta * slopes.tan_x.ravel())
    target = problem.load / problem.grid.element_area + float(held.ravel() @ (K * slopes.tan_x.ravel()))
    low, high, unsettled = -np.inf, np.inf, True
    while unsettled:
        per_approach, at_zero = restricted_solve(G, np.stack([K, -g], axis=1), active).T
        approach = (target - weights @ at_zero) / (weights @ per_approach)
        if not low < approach < high:
            approach = 0.5 * (low + high)
        pressure, free = complementarity(G, g - K * approach, active)
        unsettled = not np.array_equal(free, active)
        low, high = (approach, high) if weights @ pressure < target else (low, approach)
        active = free
    return pressure, approach - lift * float(K @ pressure), a


def widened(grid: Grid) -> Grid:
    """The grid of nearly twice the lengths whose middle element sees every offset of ``grid`` once."""
    shape = 2 * grid.shape[0] - 1, 2 * grid.shape[1] - 1
    return Grid(shape, (grid.spacings[0] * shape[0], grid.spacings[1] * shape[1]))


def assert_true(bounds: Bounds, problem: Problem, pressure: Array, traction: Array, slopes: Slopes) -> float:
    """Every bound holds against the frozen solution; true over bound in the energy."""
    beta = problem.friction.slope
    held = traction - beta * pressure
    exact, approach, a = frozen_solution(problem, held, slopes)
    e, dA = pressure.ravel() - exact, problem.grid.element_area
    K, tan_x, tan_y = slopes.cosine_product.ravel(), slopes.tan_x.ravel(), slopes.tan_y.ravel()
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
            EnergyNorm(problem, slopes.cosine_product).operator, pressure, traction, slopes
        )
        free = np.add(*v).ravel() + K * problem.gap.ravel()
        mean = float(pressure.ravel() @ free) / float(pressure.ravel() @ K)
        assert abs(mean - approach) <= bounds.approach
    return energy / bounds.energy


def posed(
    gap: Array,
    *,
    lengths: tuple[float, float] = (1.7, 1.7),
    periodic: bool = False,
    coupled: bool = True,
    load: float | None = None,
    approach: float | None = None,
    beta: float = 0.0,
) -> Problem:
    """A problem of lengths, moduli and forces of about one, so that no term is lost beside another."""
    rows, columns = gap.shape
    return Problem(
        grid=Grid((rows, columns), lengths, periodic),
        gap=gap,
        mean_surface=np.zeros_like(gap),
        elasticity=Elasticity(Pair(lower=rf.Material(0.8, 0.1), upper=rf.Material(1.9, 0.3))),
        friction=rf.Friction(0.0, beta),
        direction=0.7,
        terms=Terms(),
        load=load,
        approach=approach,
    ).with_terms(Terms(coupled=coupled))
