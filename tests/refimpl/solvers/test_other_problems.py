"""Problems that scenes do not pose: another friction law, a soft layer, strips and rows of elements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid, Mask
from refimpl.model.certificate import State, certify
from refimpl.model.elasticity import Elasticity, Influence, WindowOperator
from refimpl.model.friction import FrictionLaw
from refimpl.model.materials import Pair
from refimpl.model.problem import Problem, Terms
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers.paper import solve_paper
from refimpl.solvers.production.nested_solver import solve_fft
from verification.exact.dense_influence import DenseInfluence

TOLERANCE = 1e-12
SAME = 1e-11
"""Of the largest pressure; measured: 2e-12 at most."""


@dataclass(frozen=True)
class LimitedShear:
    """``r = min(tau + beta f, r_max)`` on contact."""

    jump: float
    slope: float
    r_max: float
    is_linear = False

    def traction(self, pressure: Array, active: Mask) -> Array:
        """Return r (Pa)."""
        law = np.minimum(self.jump + self.slope * pressure, self.r_max)
        return np.where(active, law, self.slope * pressure)

    def shear_offset(self, pressure: Array, active: Mask) -> Array:
        """Return ``r - beta f`` (Pa)."""
        return self.traction(pressure, active) - self.slope * pressure


SOFT, HARD = rf.Material(E=2.5e9, nu=0.2), rf.Material(E=200e9, nu=0.3)
PAIR = Pair(lower=SOFT, upper=HARD)
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
SQUARE, OBLONG = Grid.square(1.6e-3, 20), Grid((24, 15), (1.6e-3, 1.6e-3))

CASES = {
    "level": (SMOOTH, SQUARE, Terms(oblique=False), None),
    "oblique, oblong elements": (SMOOTH, OBLONG, Terms(), None),
    "rough, level": (ROUGH, OBLONG, Terms(oblique=False), None),
    "rough, at an approach": (ROUGH, SQUARE, Terms(), 5e-6),
    "uncoupled": (ROUGH, SQUARE, Terms(coupled=False), None),
    "facet tractions": (ROUGH, SQUARE, Terms(slope_correction=True), None),
    "periodic": (WAVY, replace(OBLONG, periodic=True), Terms(), None),
}
on_cases = pytest.mark.parametrize("case", CASES)


def problem_with(case: str, law: FrictionLaw) -> Problem:
    scene, grid, terms, approach = CASES[case]
    return replace(discretise(scene, grid, terms, approach), friction=law)


def limited(tau: float = SMOOTH.friction.tau) -> LimitedShear:
    """The scenes' law, limited where the pressure is 8 MPa: a third of the largest pressures."""
    beta = SMOOTH.friction.beta
    return LimitedShear(tau, beta, r_max=tau + beta * 8e6)


def by_fft(problem: Problem) -> State:
    return solve_fft(problem, TOLERANCE, Counter())


def agree(found: State, expected: State) -> None:
    assert found.status is expected.status
    assert np.array_equal(found.excluded, expected.excluded)
    assert np.abs(found.pressure - expected.pressure).max() <= SAME * expected.pressure.max()
    assert np.abs(found.traction - expected.traction).max() <= SAME * np.abs(expected.traction).max()


@on_cases
def test_the_law_holds_in_the_solution(case: str) -> None:
    """To the last bit, with shear at its limit on a part of the contact; judged by matrices."""
    law = limited()
    problem = problem_with(case, law)
    fft = by_fft(problem)
    operator = DenseInfluence(problem.grid, problem.direction)
    state = certify(problem, operator, fft.pressure, fft.traction, fft.slopes)
    assert state.certificate.satisfies(1.1 * TOLERANCE)  # of the other operator, too, to rounding
    at_limit = fft.traction == law.r_max
    assert 0 < np.count_nonzero(at_limit & state.contact) < np.count_nonzero(state.contact)
    if fft.status is rf.Status.CONVERGED:
        assert state.certificate.law_violations == 0
        assert np.array_equal(fft.traction > 0, state.contact)
        assert fft.traction.max() == law.r_max


@on_cases
def test_without_a_limit_it_is_the_papers_law(case: str) -> None:
    friction = SMOOTH.friction
    unlimited = LimitedShear(friction.tau, friction.beta, np.inf)
    expected = solve_reference(problem_with(case, friction))
    found = by_fft(problem_with(case, unlimited))
    agree(found, expected)
    assert found.certificate.satisfies(TOLERANCE)


@pytest.mark.parametrize("case", ["level", "periodic"])
def test_a_law_without_a_jump_is_limited_too(case: str) -> None:
    """One solve, on an active set of all elements."""
    law = limited(tau=0.0)
    problem = problem_with(case, law)
    fft = by_fft(problem)
    assert fft.certificate.satisfies(TOLERANCE)
    assert fft.certificate.law_violations == 0
    assert fft.traction.max() == law.r_max


def test_a_limit_of_tau_is_shear_of_tau_whatever_beta_is() -> None:
    """``min(tau + beta f, tau) = tau``: the part ``beta f`` that solvers invert must cancel."""
    tau = SMOOTH.friction.tau
    constant = rf.Friction(tau=tau, beta=0.0)
    expected = solve_reference(problem_with("rough, level", constant))
    found = by_fft(problem_with("rough, level", LimitedShear(tau, 0.3, tau)))
    assert np.abs(found.pressure - expected.pressure).max() <= SAME * expected.pressure.max()
    assert found.certificate.law_violations == 0


def test_the_papers_scheme_solves_it_too() -> None:
    problem = problem_with("rough, level", limited())
    fft = by_fft(problem)
    paper, _ = solve_paper(problem, 1e-9, Counter())
    # pressure steps end at 1e-10 of the pressure; 100 of them for what steepest descent still had to go
    assert np.abs(paper.pressure - fft.pressure).max() <= 1e-8 * fft.pressure.max()
    assert np.array_equal(paper.excluded, fft.excluded)


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


LAYER = 0.2 * Elasticity(PAIR).element_compliance(SQUARE)


def layered(case: str, layer: float) -> Problem:
    """The case's problem with the paper's law and a layer of that compliance (m/Pa)."""
    scene, _, terms, _ = CASES[case]
    problem = replace(problem_with(case, scene.friction), elasticity=Layered(PAIR, layer=layer))
    return problem.with_terms(terms)


@on_cases
def test_the_certificate_of_either_operator_holds(case: str) -> None:
    """For a state that the layer has changed."""
    problem = layered(case, LAYER)
    fft = by_fft(problem)
    assert fft.certificate.satisfies(TOLERANCE)
    assert fft.certificate.law_violations == np.count_nonzero(fft.excluded & fft.contact)
    operator = DenseInfluence(problem.grid, problem.direction)
    judged = certify(problem, operator, fft.pressure, fft.traction, fft.slopes)
    assert judged.certificate.satisfies(1.01 * TOLERANCE)
    bare = by_fft(problem_with(case, SMOOTH.friction))
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
    given = problem_with(case, SMOOTH.friction)
    soft = 1e6 * given.elasticity.mean_compliance(given.grid)
    problem = replace(layered(case, soft), friction=rf.Friction())
    problem = problem.with_terms(Terms(oblique=False))  # under such displacements slopes would not be small
    expected = winkler(problem, soft)
    if problem.approach is not None:
        assert np.count_nonzero(expected) > 20
    found = by_fft(problem)
    assert np.abs(found.pressure - expected).max() <= 3e-6 * expected.max()
    assert found.certificate.satisfies(TOLERANCE)


AGREEMENT = 1e-10
"""Of the largest pressure."""

SCENE = rf.Scene(
    upper=rf.Body(HARD, rf.Sphere(radius=0.02)),
    lower=rf.Body(SOFT, rf.Flat()),
    friction=rf.Friction(tau=3e5, beta=0.2),
    load=2.0,
    side=1.6e-3,
    sliding_direction=0.7,
)
GRIDS = {
    "coarser grids": Grid((48, 32), (1.6e-3, 1.2e-3)),
    "strip": Grid((60, 5), (1.6e-3, 2e-4)),
    "row": Grid((24, 1), (1.6e-3, 1e-4)),
    "two columns": Grid((2, 30), (1e-4, 1.6e-3)),
}
on_grids = pytest.mark.parametrize("name", GRIDS)
of_topologies = pytest.mark.parametrize("periodic", [False, True])


def heights(grid: Grid, seed: int = 3) -> Array:
    """Smooth random waves that repeat on the domain, of half a micrometre."""
    random, found = np.random.default_rng(seed), grid.zeros
    x, y = grid.x[:, None] / grid.lengths[0], grid.y[None, :] / grid.lengths[1]
    for k, m in ((1, 0), (0, 1), (1, 2), (2, -1), (3, 1)):
        found += random.normal() * np.cos(2 * np.pi * (k * x + m * y) + random.uniform(0, 6))
    return 5e-7 * found


def problem_on(grid: Grid) -> Problem:
    upper = rf.Flat() if grid.periodic else SCENE.upper.surface
    lower = rf.ArraySurface(heights(grid), pixel=grid.spacings)
    rough = replace(SCENE, upper=rf.Body(HARD, upper), lower=rf.Body(SOFT, lower), periodic=grid.periodic)
    load = SCENE.load * grid.nominal_area / SCENE.side**2  # the same mean pressure on every domain
    return replace(discretise(rough, grid, Terms()), load=load)


@on_grids
@of_topologies
def test_the_reference_and_the_production_solver_agree(name: str, periodic: bool) -> None:
    """On grids of one or two rows and with coarser ones, which the random scenes of `test_plain` lack."""
    problem = problem_on(replace(GRIDS[name], periodic=periodic))
    dense, fft = solve_reference(problem), solve_fft(problem, TOLERANCE, Counter())
    assert fft.status is dense.status
    assert np.array_equal(fft.excluded, dense.excluded)
    assert np.abs(fft.pressure - dense.pressure).max() <= AGREEMENT * dense.pressure.max()
    assert fft.certificate.satisfies(TOLERANCE)
    assert fft.contact_area == dense.contact_area > 0
    assert fft.friction_coefficient == pytest.approx(dense.friction_coefficient, rel=1e-9)
