"""Another elasticity through the same solvers: half-spaces of which one has a thin, soft layer (Winkler)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid
from refimpl.model.certificate import State, certify
from refimpl.model.elasticity import Elasticity, Influence, WindowOperator
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.model.state import SolverResult
from refimpl.operators.fft import Counter
from refimpl.operators.influence import window_influence
from refimpl.scene.discretise import discretise
from refimpl.solution.energy_norm import EnergyNorm
from refimpl.solvers.production.nested_solver import solve_fft
from verification.exact.dense_influence import DenseInfluence

TOLERANCE = 1e-12
SAME = 1e-11
"""Of the largest pressure; measured: 9e-13 at most."""


@dataclass(frozen=True)
class Layered(Elasticity):
    """Half-spaces, the lower one under a layer that is compressed by ``layer`` (m/Pa) times the pressure."""

    layer: float = 0.0

    def normal(self, operator: Influence, pressure: Array) -> Array:
        """Return ``a f`` with the layer (m)."""
        return super().normal(operator, pressure) + self.layer * pressure

    def normal_with_shear(self, operator: WindowOperator, slope: float) -> Callable[[Array], Array]:
        """Return ``f -> a f + slope c f`` with the layer (m)."""
        of_bodies = super().normal_with_shear(operator, slope)
        return lambda pressure: of_bodies(pressure) + self.layer * pressure

    def body_displacements(
        self, normal: Array, pressure: Array, shear_product: Array | None
    ) -> tuple[Array, Array]:
        """Return ``(u_lower, u_upper)``: the layer's share is the lower body's alone (m)."""
        of_layer = self.layer * pressure
        lower, upper = super().body_displacements(normal - of_layer, pressure, shear_product)
        return lower + of_layer, upper

    def symbol(self, coefficients: Array) -> Array:
        """Return the transform of ``a`` with the layer (m/Pa)."""
        return super().symbol(coefficients) + self.layer

    def mean_compliance(self, grid: Grid) -> float:
        """Return the displacement by unit mean pressure with the layer (m/Pa)."""
        return super().mean_compliance(grid) + self.layer

    def element_compliance(self, grid: Grid) -> float:
        """Return ``a`` at the grid's highest frequency with the layer (m/Pa)."""
        return super().element_compliance(grid) + self.layer


def matrix_with_layer(grid: Grid) -> Array:
    """``a`` between all pairs of elements, with the layer on the diagonal (m/Pa)."""
    return PAIR.normal_compliance * DenseInfluence(grid, 0.0).normal_matrix + LAYER * np.eye(grid.elements)


SOFT, HARD = rf.Material(E=2.5e9, nu=0.2), rf.Material(E=200e9, nu=0.3)
SMOOTH = rf.Scene(
    upper=rf.Body(HARD, rf.Sphere(radius=0.02)),
    lower=rf.Body(SOFT, rf.Flat()),
    friction=rf.Friction(tau=5e5, beta=0.3),
    load=5.0,
    side=1.6e-3,
    sliding_direction=0.7,
)
ROUGH = replace(SMOOTH, lower=rf.Body(SOFT, rf.GaussianRoughness(rms=4e-7, correlation_length=3e-4, seed=4)))
WAVY = replace(ROUGH, upper=rf.Body(HARD, rf.Flat()), periodic=True, load=3.0)
PAIR = Pair(lower=SOFT, upper=HARD)
SQUARE, OBLONG = Grid.square(1.6e-3, 20), Grid((24, 15), (1.6e-3, 1.6e-3))
LAYER = 0.2 * Elasticity(PAIR).element_compliance(SQUARE)

CASES = {
    "level": (SMOOTH, SQUARE, Terms(oblique=False), None),
    "oblique": (SMOOTH, OBLONG, Terms(), None),
    "at an approach": (SMOOTH, OBLONG, Terms(), 4e-6),
    "rough": (ROUGH, SQUARE, Terms(), None),
    "rough, at an approach": (ROUGH, OBLONG, Terms(), 5e-6),
    "uncoupled": (ROUGH, SQUARE, Terms(coupled=False), None),
    "facet tractions": (ROUGH, SQUARE, Terms(slope_correction=True), None),
    "larger than a window": (SMOOTH, Grid.square(1.6e-3, 40), Terms(), None),
    "periodic": (WAVY, replace(OBLONG, periodic=True), Terms(), None),
    "periodic, at an approach": (WAVY, replace(SQUARE, periodic=True), Terms(), -4e-7),
    "periodic, in full contact": (
        replace(WAVY, load=300.0),
        replace(SQUARE, periodic=True),
        Terms(oblique=False),
        None,
    ),
}
on_cases = pytest.mark.parametrize("case", CASES)


def problem_with(case: str, layer: float | None) -> Problem:
    """The case's problem; half-spaces alone if ``layer`` is None."""
    scene, grid, terms, approach = CASES[case]
    problem = discretise(scene, grid, approach=approach)
    if layer is not None:
        problem = replace(problem, elasticity=Layered(PAIR, layer=layer))
    return problem.with_terms(terms)


def by_fft(problem: Problem) -> tuple[SolverResult, State]:
    return solve_fft(problem, TOLERANCE, Counter())


def agree(found: SolverResult, expected: SolverResult) -> None:
    assert found.status is expected.status
    assert np.abs(found.pressure - expected.pressure).max() <= SAME * expected.pressure.max()
    assert np.abs(found.traction - expected.traction).max() <= SAME * expected.traction.max()


def test_terms_keep_the_kind_of_elasticity() -> None:
    elasticity = problem_with("uncoupled", LAYER).elasticity
    assert elasticity == Layered(PAIR, coupled=False, tilted=True, layer=LAYER)


@on_cases
def test_the_certificate_of_either_operator_holds(case: str) -> None:
    """For a state that the layer has changed."""
    problem = problem_with(case, LAYER)
    fft, state = by_fft(problem)
    assert state.certificate.satisfies(TOLERANCE)
    assert state.certificate.law_violations == np.count_nonzero(fft.excluded & state.contact)
    operator = DenseInfluence(problem.grid, problem.direction)
    judged = certify(problem, operator, fft.pressure, fft.traction, fft.slopes)
    assert judged.certificate.satisfies(1.01 * TOLERANCE)
    bare, _ = by_fft(problem_with(case, None))
    assert np.abs(bare.pressure - fft.pressure).max() > 0.005 * fft.pressure.max()


@on_cases
def test_a_layer_of_no_compliance_is_none(case: str) -> None:
    (found, _), (expected, _) = by_fft(problem_with(case, 0.0)), solve_reference(problem_with(case, None))
    agree(found, expected)


def winkler(problem: Problem, layer: float) -> Array:
    """Pressures ``(d - h) / layer`` where positive, at the approach or at the d that bears the load (Pa)."""
    gap = problem.gap
    if problem.approach is None:
        assert problem.load is not None
        total = problem.load / problem.grid.element_area * layer
        lowest = np.sort(gap, axis=None)
        counts = np.arange(1, lowest.size + 1)
        depths = (total + np.cumsum(lowest)) / counts
        deepest = np.flatnonzero(depths > lowest)[-1]
        return np.maximum(depths[deepest] - gap, 0.0) / layer
    return np.maximum(problem.approach - gap, 0.0) / layer


@pytest.mark.parametrize("case", ["level", "at an approach", "rough", "rough, at an approach", "periodic"])
def test_on_a_very_soft_layer_each_element_presses_for_itself(case: str) -> None:
    """Half-spaces displace by ``a f``, a share of 1e-6 of what the layer does."""
    given = problem_with(case, None)
    soft = 1e6 * given.elasticity.mean_compliance(given.grid)
    problem = replace(problem_with(case, soft), friction=rf.Friction())
    problem = problem.with_terms(Terms(oblique=False))  # under such displacements slopes would not be small
    expected = winkler(problem, soft)
    if problem.approach is not None:
        assert np.count_nonzero(expected) > 20
    found, state = by_fft(problem)
    assert np.abs(found.pressure - expected).max() <= 3e-6 * expected.max()
    assert state.certificate.satisfies(TOLERANCE)


@pytest.mark.parametrize("case", ["level", "oblique", "periodic", "periodic, in full contact"])
def test_the_energy_norms_floor_is_below_the_least_eigenvalue(case: str) -> None:
    """With the layer, which raises every eigenvalue."""
    problem = problem_with(case, LAYER)
    K = np.ones(problem.grid.shape)
    norm = EnergyNorm(problem, K)
    matrix = matrix_with_layer(problem.grid) + norm.lift
    least = float(np.linalg.eigvalsh(matrix).min())
    assert 0.5 * least <= norm.floor <= least * (1 + 1e-12)
    assert norm.floor > LAYER


@pytest.mark.parametrize("periodic", [False, True])
def test_products_matrices_and_symbols_of_the_layer_are_the_same_map(periodic: bool) -> None:
    grid = replace(OBLONG, periodic=periodic)
    elasticity = Layered(PAIR, layer=LAYER)
    fft = window_influence(grid, 0.7)
    pressure = np.random.default_rng(3).random(grid.shape) * 1e6
    expected = (matrix_with_layer(grid) @ pressure.ravel()).reshape(grid.shape)
    bound = 1e-13 * expected.max()
    assert np.abs(elasticity.normal(fft, pressure) - expected).max() <= bound
    closed = elasticity.normal_with_shear(fft, 0.0)(pressure)
    assert np.abs(closed - expected).max() <= bound
    lower, upper = elasticity.body_displacements(expected, pressure, None)
    assert np.abs(lower + upper - expected).max() <= bound
    bare = Elasticity(PAIR)
    _, alone = bare.body_displacements(bare.normal(fft, pressure), pressure, None)
    assert np.abs(upper - alone).max() <= bound  # the layer moves the upper body nowhere
    if periodic:
        wave = np.cos(2 * np.pi * (2 * grid.x[:, None] + grid.y[None, :]) / 1.6e-3)
        symbol = elasticity.symbol(fft.symbol)[2, 1]
        assert np.abs(elasticity.normal(fft, wave) - symbol * wave).max() <= 1e-13 * symbol
