"""Proven bounds: least eigenvalue and its proof, dual norms, states of every kind, and where none exists."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from numpy.polynomial import Polynomial

import refimpl as rf
from refimpl.contact.active_set import complementarity, restricted_solve
from refimpl.contact.bounds import (
    NO_BOUND_CORRECTED,
    NO_BOUND_PERIODIC,
    NO_BOUND_STEEP,
    UNPROVEN,
    Bounds,
    _Frozen,
    _shear_row,
    proven_bounds,
)
from refimpl.contact.energy_norm import _ROUNDING, SMALLEST_SYMBOL, EnergyNorm
from refimpl.forces import Forces, resultants
from refimpl.friction import Mask
from refimpl.grid import Array, Grid
from refimpl.materials import Pair
from refimpl.operators.dense import DenseInfluence
from refimpl.problem import Problem, Terms
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
    C, beta = problem.pair.shear_compliance * problem.terms.coupled, problem.friction.beta
    a = problem.pair.normal_compliance * influence.normal_matrix
    K = slopes.obliqueness.ravel()
    lift = problem.pair.normal_compliance * problem.grid.side / K.size if problem.periodic else 0.0
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


def posed(
    gap: Array, *, load: float | None = None, approach: float | None = None, beta: float = 0.0, **kind: bool
) -> Problem:
    """A problem of lengths, moduli and forces of about one, so that no term is lost beside another."""
    return Problem(
        grid=Grid(1.7, len(gap)),
        gap=gap,
        mean_surface=np.zeros_like(gap),
        pair=Pair(lower=rf.Material(0.8, 0.1), upper=rf.Material(1.9, 0.3)),
        friction=rf.Friction(0.0, beta),
        direction=0.7,
        periodic=kind.get("periodic", False),
        terms=Terms(coupled=kind.get("coupled", True), oblique=True, slope_correction=False),
        load=load,
        approach=approach,
    )


class Derived:
    """A state's bounds as the module's text derives them: dense matrices, polynomials, no iteration."""

    def __init__(self, problem: Problem, pressure: Array, traction: Array, slopes: Slopes) -> None:
        self.problem, self.pressure, self.traction, self.slopes = problem, pressure, traction, slopes
        influence = DenseInfluence(problem.grid, problem.direction, periodic=problem.periodic)
        norm = EnergyNorm(problem, slopes.obliqueness)
        self.floor, self.lift, self.diagonal = norm.floor, norm.lift, norm.diagonal
        self.beta, self.C = problem.friction.beta, problem.pair.shear_compliance * problem.terms.coupled
        self.shear, self.K = influence.shear_matrix, slopes.obliqueness.ravel()
        self.plain = problem.pair.normal_compliance * influence.normal_matrix
        self.matrix = self.plain + self.lift * np.outer(self.K, self.K)
        self.f = np.maximum(pressure.ravel(), 0.0)
        self.f = np.where(self.w() >= self.diagonal * self.f, 0.0, self.f)
        self.clipped = self.norm(self.f - pressure.ravel())
        self.distance, self.approach = self.largest_root()

    def held(self) -> Array:
        held: Array = (self.traction - self.beta * self.pressure).ravel()
        return held

    def w(self) -> Array:
        free = self.plain @ self.f + self.C * self.shear @ (self.held() + self.beta * self.f)
        free += self.K * self.problem.gap.ravel()
        given = self.problem.approach
        w: Array = free - self.K * (self.f @ free / (self.f @ self.K) if given is None else given)
        return w

    def norm(self, e: Array) -> float:
        return math.sqrt(e @ self.matrix @ e)

    def dual(self, right: Array, where: Mask) -> float:
        index = np.flatnonzero(where)
        return math.sqrt(right[index] @ np.linalg.solve(self.matrix[np.ix_(index, index)], right[index]))

    def largest_root(self) -> tuple[float, float]:
        """Of (B2), with r as in the text; and what it says of the approach."""
        f, w, problem, everywhere = self.f, self.w(), self.problem, np.ones(self.f.shape, dtype=bool)
        touching = np.flatnonzero((w < self.diagonal * f) | (w < 0))
        z = np.zeros_like(f)
        z[touching] = np.linalg.solve(self.matrix[np.ix_(touching, touching)], w[touching])
        r = np.minimum(w, self.matrix @ z)
        r[touching] = w[touching]
        residual = self.norm(z) + float(np.linalg.norm(r - self.matrix @ z)) / math.sqrt(self.floor)
        x = Polynomial([0.0, 1.0])
        approach, added = Polynomial([0.0]), Polynomial([0.0])
        if problem.load is not None:
            s = self.K * self.slopes.tan_x.ravel()
            target = problem.load / problem.grid.element_area + self.held() @ s
            n = abs((self.K - self.beta * s) @ f - target)
            least = min(self.K @ f, target / (1 + self.beta * np.abs(self.slopes.tan_x).max()))
            moved = self.norm(f) + self.beta * abs(self.C) * self.dual(self.shear @ f, everywhere) + residual
            approach = (max(f @ w, -f @ r) + moved * x) / least
            sum_of_errors = n + self.beta * self.dual(s, everywhere) * x
            added = approach * sum_of_errors + self.lift * sum_of_errors**2
        roots = (x**2 - residual * x - f @ (w - r) - added).roots()
        distance = float(np.real(roots).max())
        return distance, float(approach(distance))

    def masks(self) -> tuple[Mask, Mask]:
        """Elements surely in contact, and surely out of it."""
        corners = np.zeros(self.pressure.shape, dtype=bool)
        corners[np.ix_((0, -1), (0, -1))] = True
        row = self.beta * abs(self.C) * float(np.linalg.norm(self.shear[corners.ravel()]))
        error = self.distance / math.sqrt(self.floor)
        moved = math.sqrt(self.diagonal) * self.distance + row * error + self.K * self.approach
        return self.f > error, self.w() > moved

    def forces(self, out: Mask) -> Forces:
        """What the pressure's error does to each force, which is linear in it."""
        rows = []
        for impulse in np.eye(self.f.size).reshape(-1, *self.pressure.shape):
            rows.append(resultants(impulse, self.beta * impulse, self.slopes, self.problem.grid.element_area))
        open_ = ~out | (self.pressure.ravel() != 0)
        size = self.distance + self.clipped
        return Forces(*(size * self.dual(weights, open_) for weights in np.transpose(rows)))


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


@pytest.mark.parametrize("n", [2, 4])
@pytest.mark.parametrize("uneven", [0.0, 0.5])
def test_floor_of_a_periodic_square_parts_the_mean_from_the_waves(n: int, uneven: float) -> None:
    """Waves have the plain matrix's stiffness less what the lift takes, the mean half of the lift's."""
    K = 0.3 + uneven * np.random.default_rng(n).random((n, n)) ** 2
    problem = posed(np.zeros((n, n)), load=1.0, periodic=True)
    norm = EnergyNorm(problem, K)
    mean = np.full(n * n, 1 / n)
    plain = problem.pair.normal_compliance * DenseInfluence(problem.grid, 0.0, periodic=True).normal_matrix
    along, across = float(mean @ K.ravel()) ** 2, float(np.sum((K.ravel() - (mean @ K.ravel()) * mean) ** 2))
    waves = float(np.linalg.eigvalsh(plain)[1]) - norm.lift * across
    assert norm.floor == pytest.approx(min(waves, 0.5 * norm.lift * along))
    assert norm.floor <= np.linalg.eigvalsh(plain + norm.lift * np.outer(K, K))[0]


@pytest.mark.parametrize("periodic", [False, True])
def test_rounding_is_of_the_sum_of_all_coefficients(periodic: bool) -> None:
    """The centre of a square of nearly twice the side meets each offset once: no row is worse."""
    n = 4
    problem, K = posed(np.zeros((n, n)), load=1.0, periodic=periodic), np.full((n, n), 0.7)
    norm, grid = EnergyNorm(problem, K), problem.grid
    wide = DenseInfluence(Grid(grid.spacing * (2 * n - 1), 2 * n - 1), 0.0)
    row = problem.pair.normal_compliance * wide.normal_matrix[wide.normal_matrix.shape[0] // 2]
    one, other = np.random.default_rng(7).standard_normal((2, n, n))
    size = float(np.linalg.norm(one) + np.linalg.norm(other))
    worst = float(row.sum()) * n / (n - 0.5) + norm.lift * 0.49 * n**2
    assert norm.rounding(one, other) == pytest.approx(_ROUNDING * worst * size, abs=0)


def test_dual_norm_of_a_unit_impulse() -> None:
    norm = EnergyNorm(posed(np.zeros((3, 3)), load=1.0), np.ones((3, 3)))
    a = np.array([norm.apply(row.reshape(3, 3)).ravel() for row in np.eye(9)])
    impulse = np.eye(9)[4].reshape(3, 3)
    exact = math.sqrt(np.linalg.inv(a)[4, 4])
    assert exact <= norm.dual_norm(impulse, np.ones((3, 3), dtype=bool)) <= 1.001 * exact


def test_conjugate_gradients_stop_at_a_hundredth(monkeypatch: pytest.MonkeyPatch) -> None:
    """As soon as what is left counts for no more than that of the norm, and no sooner."""
    norm = EnergyNorm(posed(np.zeros((7, 7)), load=1.0), np.ones((7, 7)))
    right, where = np.random.default_rng(5).random((2, 7, 7))
    inside = where > 0.3

    def enough(z: Array, az: Array) -> bool:
        left = float(np.linalg.norm((right - az)[inside]))
        return left / math.sqrt(norm.floor) <= 0.01 * math.sqrt(float(np.vdot(z, az)))

    found, states = norm.solve(right, inside), []
    for iterations in range(8):
        monkeypatch.setitem(EnergyNorm.solve.__globals__, "_ITERATIONS", iterations)
        states.append(norm.solve(right, inside))
    first = [enough(*state) for state in states].index(True)
    assert first > 1
    assert np.array_equal(states[first], found)
    assert np.array_equal(states[-1], found)


def test_dual_norm_allows_for_the_rounding_of_its_product(monkeypatch: pytest.MonkeyPatch) -> None:
    """It may turn the energy by its length times z, and lies across what is left at worst."""
    norm, everywhere = (
        EnergyNorm(posed(np.zeros((5, 5)), load=1.0), np.ones((5, 5))),
        np.ones((5, 5), dtype=bool),
    )
    right = np.random.default_rng(5).random((5, 5))
    z, _ = norm.solve(right, everywhere)
    exact = norm.dual_norm(right, everywhere)
    monkeypatch.setattr(norm, "rounding", lambda *_: 0.1)
    least = exact**2 + 0.1 * float(np.linalg.norm(z)) + 0.1**2 / norm.floor
    assert norm.dual_norm(right, everywhere) ** 2 >= least


def test_an_indefinite_norm_has_no_dual() -> None:
    n = 4
    K = 2.0 * (np.indices((n, n)).sum(axis=0) % 2)
    norm = EnergyNorm(posed(np.zeros((n, n)), load=1.0, periodic=True), K)
    assert -1 < norm.floor < 0
    everywhere = np.ones((n, n), dtype=bool)
    assert math.isinf(norm.dual_norm(np.ones((n, n)), everywhere))
    assert norm.dual_norm(np.zeros((n, n)), everywhere) == 0


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
    assert found.bounds in {found.bounds}


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


def test_flats_that_just_touch_carry_nothing_for_sure_and_nothing_is_open_for_sure() -> None:
    nothing = np.zeros((3, 3))
    bounds = proven_bounds(posed(nothing, approach=0.0), nothing, nothing, Slopes.flat((3, 3)))
    assert bounds.energy == bounds.pressure == bounds.normal_force == 0.0
    assert math.isinf(bounds.friction_coefficient)
    assert not bounds.in_contact.any()
    assert not bounds.out_of_contact.any()


def test_surfaces_apart_leave_the_rounding_of_their_distance() -> None:
    """Half a metre on each of nine elements."""
    nothing = np.zeros((3, 3))
    problem = posed(nothing, approach=-0.5)
    bounds = proven_bounds(problem, nothing, nothing, Slopes.flat((3, 3)))
    noise, floor = 4 * np.finfo(float).eps * 0.5 * 3, EnergyNorm(problem, np.ones((3, 3))).floor
    expected = noise**2 / floor * problem.grid.element_area
    assert bounds.energy == pytest.approx(expected, rel=1e-12, abs=0)
    assert bounds.out_of_contact.all()


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
    left = [
        d * (1 - b / a),
        d * (1 - b / a),
        d * (1 - d / a),
    ]  # of w - a z, z being (a - d) / a on the element
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


@pytest.mark.parametrize("n", [1, 2, 5])
def test_no_row_of_the_shear_is_longer_than_its_corners(n: int) -> None:
    """Four corners meet every offset once, those along an axis twice: told by a wide square's centre."""
    problem, flat = posed(np.zeros((n, n)), load=1.0, beta=0.1), Slopes.flat((n, n))
    zero = np.zeros((n, n))
    found = _shear_row(_Frozen(problem, EnergyNorm(problem, np.ones((n, n))), zero, zero, flat))
    wide = DenseInfluence(Grid(problem.grid.spacing * (2 * n - 1), 2 * n - 1), problem.direction)
    offsets = wide.shear_matrix[2 * n * (n - 1)].reshape(2 * n - 1, 2 * n - 1) ** 2
    met = offsets.sum() + offsets[n - 1].sum() + offsets[:, n - 1].sum()
    assert found == pytest.approx(math.sqrt(met), rel=1e-10)
    rows = DenseInfluence(problem.grid, problem.direction).shear_matrix
    assert np.linalg.norm(rows, axis=1).max() <= found


KINDS: dict[str, dict[str, bool]] = {
    "load": {},
    "frictionless": {},
    "uncoupled": {"coupled": False},
    "approach": {},
    "periodic": {"periodic": True},
}


@pytest.fixture
def to_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Conjugate gradients that stop at rounding, of the norm that bounds use (doctests import another)."""
    norm = proven_bounds.__globals__["EnergyNorm"]
    monkeypatch.setitem(norm.solve.__globals__, "_ENOUGH", 1e-11)


def assert_derived(problem: Problem, pressure: Array, traction: Array, slopes: Slopes) -> Derived:
    """Every bound is what the text derives, to rounding."""
    derived = Derived(problem, pressure, traction, slopes)
    bounds = proven_bounds(problem, pressure, traction, slopes)
    assert_true(bounds, problem, pressure, traction, slopes)
    total, dA = derived.distance + derived.clipped, problem.grid.element_area
    inside, out = derived.masks()
    assert np.array_equal(bounds.in_contact.ravel(), inside)
    assert np.array_equal(bounds.out_of_contact.ravel(), out)
    assert bounds.contact_area == pytest.approx((inside.sum() * dA, (out.size - out.sum()) * dA))
    error, found = derived.forces(out), resultants(pressure, traction, slopes, dA)
    if problem.load is not None:
        error = error._replace(normal=abs(found.normal - problem.load))
        mu = error.friction / problem.load
    elif error.normal < found.normal:
        ends = [found.friction + side * error.friction for side in (-1, 1)]
        ratios = [end / (found.normal + side * error.normal) for end in ends for side in (-1, 1)]
        mu = max(abs(ratio - found.friction / found.normal) for ratio in ratios)
    else:
        mu = math.inf
    expected = {
        "energy": total**2 * dA,
        "pressure": total / math.sqrt(derived.floor),
        "pressure_l2": total / math.sqrt(derived.floor) * math.sqrt(dA),
        "approach": derived.approach,
        "normal_force": error.normal,
        "friction_force": error.friction,
        "binormal_force": error.binormal,
        "friction_coefficient": mu,
    }
    assert {name: getattr(bounds, name) for name in expected} == pytest.approx(expected, rel=1e-7)
    assert bounds.unproven == UNPROVEN
    return derived


@pytest.mark.usefixtures("to_the_end")
@pytest.mark.parametrize("kind", KINDS)
def test_every_bound_is_what_its_derivation_gives(kind: str) -> None:
    """From near the solution to far from it."""
    random = np.random.default_rng(5)
    beta = 0.0 if kind == "frictionless" else 0.1
    for size in np.geomspace(1e-3, 1, 4 if kind in ("uncoupled", "frictionless") else 20):
        n = int(random.integers(3, 6))
        slopes = Slopes(*random.uniform(-0.3, 0.3, (2, n, n)))
        gap, held = 0.4 * random.random((n, n)), 0.1 * random.standard_normal((n, n))
        given = {"approach": 0.25} if kind == "approach" else {"load": 0.9}
        problem = posed(gap, beta=beta, **given, **KINDS[kind])
        exact = frozen_solution(problem, held, slopes)[0].reshape(n, n)
        pressure = exact + size * random.standard_normal((n, n)) * (random.random((n, n)) < 0.5)
        assert_derived(problem, pressure, held + beta * pressure, slopes)


@pytest.mark.usefixtures("to_the_end")
@pytest.mark.parametrize("kind", ["load", "periodic"])
def test_pressure_that_comes_to_stand_over_a_gap_is_bounded(kind: str) -> None:
    """Without one element's spurious pressure the approach falls, and leaves another open under its own."""
    gap, pressure = np.full((3, 3), 0.9), np.zeros((3, 3))
    gap[0, 0], gap[0, 2], gap[2, 2] = 0.0, 0.45, 0.315
    pressure[0, 0], pressure[0, 2], pressure[2, 2] = 0.3, 0.09, 0.06
    slopes = Slopes(*np.random.default_rng(1).uniform(-0.3, 0.3, (2, 3, 3)))
    problem = posed(gap, load=0.09, beta=0.1, **KINDS[kind])
    derived = assert_derived(problem, pressure, 0.1 * pressure + 0.05 * gap, slopes)
    assert np.flatnonzero(derived.f).tolist() == [0, 8]
    assert derived.w()[8] > derived.diagonal * derived.f[8]
