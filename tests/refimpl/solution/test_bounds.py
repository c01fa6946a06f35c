"""Proven bounds and their norm: numbers by hand, where no bound exists, eigenvalues, rounding."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

import refimpl as rf
from refimpl.bounds.energy_norm import _ROUNDING, EnergyNorm, smallest_symbol
from refimpl.bounds.proven_bounds import (
    NO_BOUND_CORRECTED,
    NO_BOUND_PERIODIC,
    NO_BOUND_STEEP,
    UNPROVEN,
    _Frozen,
    _shear_row,
    proven_bounds,
)
from refimpl.grid import Array, Grid
from refimpl.model.elasticity import Elasticity
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.model.slopes import Slopes
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


def widened(grid: Grid) -> Grid:
    """The grid of nearly twice the lengths whose middle element sees every offset of ``grid`` once."""
    shape = 2 * grid.shape[0] - 1, 2 * grid.shape[1] - 1
    return Grid(shape, (grid.spacings[0] * shape[0], grid.spacings[1] * shape[1]))


def posed(
    gap: Array,
    *,
    lengths: tuple[float, float] = (1.7, 1.7),
    periodic: bool = False,
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
    ).with_terms(Terms(coupled=True))


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


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize(
    ("shape", "lengths"),
    [((10, 10), (1.0, 1.0)), ((12, 8), (1.5, 1.0)), ((9, 12), (1.0, 0.4)), ((8, 11), (0.3, 2.0))],
)
def test_least_eigenvalue_and_dual_norm(
    shape: tuple[int, int], lengths: tuple[float, float], periodic: bool
) -> None:
    problem = posed(np.zeros(shape), lengths=lengths, load=1.0, periodic=periodic)
    K = np.random.default_rng(2).uniform(0.99, 1.0, shape)
    norm = EnergyNorm(problem, K)
    influence = DenseInfluence(problem.grid, 0.0)
    a = problem.pair.normal_compliance * influence.normal_matrix + norm.lift * np.outer(K, K)
    least = float(np.linalg.eigvalsh(a)[0])
    assert 0.9 * least <= norm.floor <= least
    assert norm.diagonal == pytest.approx(a.diagonal().max(), rel=1e-3)
    right, where = np.random.default_rng(3).standard_normal((2, *shape))
    inside = where > 0
    index = np.flatnonzero(inside)
    exact = math.sqrt(right[inside] @ np.linalg.solve(a[np.ix_(index, index)], right[inside]))
    assert exact <= norm.dual_norm(right, inside) <= 1.02 * exact
    assert norm.dual_norm(np.zeros(shape), inside) == 0.0
    e = right * inside
    exact = math.sqrt(e.ravel() @ a @ e.ravel())
    assert exact <= norm.norm(e) <= (1 + 1e-9) * exact


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("shape", [(4, 4), (6, 3)])
def test_rounding_is_of_the_sum_of_all_coefficients(shape: tuple[int, int], periodic: bool) -> None:
    """The centre of a rectangle of nearly twice the lengths meets each offset once: no row is worse.

    Rounding allows for twice the lengths; 1/rho over a rectangle has a closed form (Johnson 1985, 3.25).
    """
    n, m = shape
    problem, K = posed(np.zeros(shape), load=1.0, periodic=periodic, lengths=(1.7, 1.2)), np.full(shape, 0.7)
    norm, wide = EnergyNorm(problem, K), widened(problem.grid)
    row = problem.pair.normal_compliance * DenseInfluence(wide, 0.0).normal_matrix[wide.elements // 2]
    one, other = np.random.default_rng(7).standard_normal((2, *shape))
    size = float(np.linalg.norm(one) + np.linalg.norm(other))
    a, b = problem.grid.lengths
    reach = problem.pair.normal_compliance * 4 * (a * math.asinh(b / a) + b * math.asinh(a / b))
    assert 1 < reach / row.sum() < (2 * n / (2 * n - 1)) * (2 * m / (2 * m - 1))
    worst = reach + norm.lift * 0.49 * n * m
    assert norm.rounding(one, other) == pytest.approx(_ROUNDING * worst * size, rel=1e-12, abs=0)


def test_an_indefinite_norm_has_no_dual() -> None:
    n = 4
    K = 2.0 * (np.indices((n, n)).sum(axis=0) % 2)
    norm = EnergyNorm(posed(np.zeros((n, n)), load=1.0, periodic=True), K)
    assert -1 < norm.floor < 0
    everywhere = np.ones((n, n), dtype=bool)
    assert math.isinf(norm.dual_norm(np.ones((n, n)), everywhere))
    assert norm.dual_norm(np.zeros((n, n)), everywhere) == 0


def test_dual_norm_is_a_bound_whatever_conjugate_gradients_return(monkeypatch: pytest.MonkeyPatch) -> None:
    norm = EnergyNorm(rf.solve(scene(1), M, tolerance=0.5).details.problem, np.ones((M, M)))
    right, where = np.random.default_rng(3).standard_normal((M, M)), np.ones((M, M), dtype=bool)
    z, az = norm.solve(right, where)
    exact = norm.dual_norm(right, where)
    for share in (0.0, 0.5, 1.5):
        monkeypatch.setattr(norm, "solve", lambda *_, share=share: (share * z, share * az))
        assert 0.99 * exact <= norm.dual_norm(right, where) < math.inf


@pytest.mark.parametrize(("aspect", "least", "most"), [(1.0, 0.0, 1e-10), (1.7, 0.9e-12, 1.1e-12)])
def test_it_is_the_integral_to_many_digits(aspect: float, least: float, most: float) -> None:
    """By other code: Poisson's sum for small t, tanh-sinh quadrature.

    Below the integral by 1e-12 of its value; square elements have a constant of ten digits.
    """

    def alternating(t: mp.mpf) -> mp.mpf:
        if t < 2:
            waves = (
                (-1) ** n / mp.mpf(2 * n + 1) * mp.exp(-(((n + 0.5) * mp.pi / t) ** 2)) for n in range(12)
            )
            return 4 / (mp.sqrt(mp.pi) * t) * mp.fsum(waves)
        tails = ((-1) ** m * mp.erfc((m + mp.mpf(1) / 2) * t) for m in range(12))
        return mp.sqrt(mp.pi) / t * (1 - 2 * mp.fsum(tails))

    with mp.workdps(20):
        a = mp.mpf(aspect)
        total = mp.quad(lambda t: alternating(t) * a * alternating(a * t), [0, 1, 4, 16, mp.inf])
        exact = 2 / mp.sqrt(mp.pi) * total
        assert least < (exact - mp.mpf(smallest_symbol(aspect))) / exact < most
