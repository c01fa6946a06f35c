"""Proven bounds as their text derives them, term by term, and by hand on few elements."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from refimpl.bounds.energy_norm import EnergyNorm
from refimpl.bounds.proven_bounds import UNPROVEN, _Frozen, _shear_row, proven_bounds
from refimpl.grid import Array, Mask
from refimpl.model.forces import Forces, resultants
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from tests.refimpl.solution.frozen import assert_true, frozen_solution, posed, widened
from verification.exact.dense_influence import DenseInfluence


class Derived:
    """A state's bounds as the module's text derives them: dense matrices, polynomials, no iteration."""

    def __init__(self, problem: Problem, pressure: Array, traction: Array, slopes: Slopes) -> None:
        self.problem, self.pressure, self.traction, self.slopes = problem, pressure, traction, slopes
        influence = DenseInfluence(problem.grid, problem.direction)
        norm = EnergyNorm(problem, slopes.cosine_product)
        self.floor, self.lift, self.diagonal = norm.floor, norm.lift, norm.diagonal
        self.beta, self.C = problem.friction.slope, problem.pair.shear_compliance * problem.terms.coupled
        self.shear, self.K = influence.shear_matrix, slopes.cosine_product.ravel()
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
        n, m = (int(count) for count in random.integers(3, 6, 2))
        slopes = Slopes(*random.uniform(-0.3, 0.3, (2, n, m)))
        gap, held = 0.4 * random.random((n, m)), 0.1 * random.standard_normal((n, m))
        given = {"approach": 0.25} if kind == "approach" else {"load": 0.9}
        problem = posed(gap, beta=beta, lengths=(1.7, random.uniform(0.8, 2.4)), **given, **KINDS[kind])
        exact = frozen_solution(problem, held, slopes)[0].reshape(n, m)
        pressure = exact + size * random.standard_normal((n, m)) * (random.random((n, m)) < 0.5)
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
