"""Another elasticity through the same solvers: half-spaces of which one has a thin, soft layer (Winkler)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.model.certificate import State, certify
from refimpl.model.elasticity import Elasticity, Influence, MatrixOperator, WindowOperator
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.model.state import SolverResult
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers.production.nested_solver import solve_fft
from verification.exact.dense_influence import DenseInfluence

TOLERANCE = 1e-12


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

    def normal_matrix(self, operator: MatrixOperator) -> Array:
        """Return ``a`` with the layer on the diagonal (m/Pa)."""
        of_bodies = super().normal_matrix(operator)
        return of_bodies + self.layer * np.eye(len(of_bodies))

    def symbol(self, coefficients: Array) -> Array:
        """Return the transform of ``a`` with the layer (m/Pa)."""
        return super().symbol(coefficients) + self.layer

    def mean_compliance(self, grid: Grid) -> float:
        """Return the displacement by unit mean pressure with the layer (m/Pa)."""
        return super().mean_compliance(grid) + self.layer

    def element_compliance(self, grid: Grid) -> float:
        """Return ``a`` at the grid's highest frequency with the layer (m/Pa)."""
        return super().element_compliance(grid) + self.layer


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
    "rough": (ROUGH, SQUARE, Terms(), None),
    "rough, at an approach": (ROUGH, OBLONG, Terms(), 5e-6),
    "uncoupled": (ROUGH, SQUARE, Terms(coupled=False), None),
    "facet tractions": (ROUGH, SQUARE, Terms(slope_correction=True), None),
    "periodic": (WAVY, replace(OBLONG, periodic=True), Terms(), None),
    "periodic, at an approach": (WAVY, replace(SQUARE, periodic=True), Terms(), -4e-7),
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


@pytest.mark.parametrize("case", ["level", "rough, at an approach", "periodic"])
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
