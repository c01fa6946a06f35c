"""Forces, areas, displacements and residuals of a few elements, worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid
from refimpl.model.certificate import approach_from, certify
from refimpl.model.elasticity import Elasticity
from refimpl.model.forces import facet_resultants, perimeter_corrected_area, resultants
from refimpl.model.materials import Pair
from refimpl.model.slopes import Slopes
from refimpl.scene.discretise import discretise
from verification.exact.dense_influence import DenseInfluence

PAIR = Pair(lower=rf.Material(2e9, 0.25, hardness=90e6), upper=rf.Material(8e9, 0.1, hardness=50e6))
PRESSURE, TRACTION = np.array([[2.0, 5.0]]), np.array([[0.5, 1.5]])
SLOPES = Slopes(np.array([[0.75, 0.0]]), np.array([[0.0, 4 / 3]]))  # cosines 0.8 and 0.6


def test_resultants_of_two_elements() -> None:
    """One climbs along with (0.8, 0.6), one across with (0.6, 0.8); dA = 3."""
    found = resultants(PRESSURE, TRACTION, SLOPES, 3.0)
    assert found.normal == pytest.approx(3 * (2 * 0.8 - 0.5 * 0.6 + 5 * 0.6))
    assert found.friction == pytest.approx(3 * (2 * 0.6 + 0.5 * 0.8 + 1.5 * 0.6))
    assert found.binormal == pytest.approx(3 * 5 * 0.8)


def test_exact_resultants_of_two_facets() -> None:
    found = facet_resultants(PRESSURE, TRACTION, SLOPES, 3.0)
    assert found.normal == pytest.approx(3 * (2 - 0.5 * 0.75 + 5))
    assert found.friction == pytest.approx(3 * (0.5 + 2 * 0.75 + 1.5))
    assert found.binormal == pytest.approx(3 * 5 * 4 / 3)


def test_slopes_count_along_and_across() -> None:
    assert SLOPES.mean_square(PRESSURE) == pytest.approx((2 * 0.5625 + 5 * 16 / 9) / 7)
    other = Slopes(np.array([[0.75, 0.1]]), np.array([[-0.3, 4 / 3]]))
    assert SLOPES.distance(other, np.array([[True, True]])) == pytest.approx(0.3)
    assert SLOPES.distance(other, np.array([[False, True]])) == pytest.approx(0.1)


def test_the_edge_of_three_elements() -> None:
    """Seven faces between contact and none on elements of 2 x 3; the border has none."""
    contact = np.zeros((4, 5), dtype=bool)
    contact[1, 1] = contact[1, 2] = contact[0, 2] = True
    area = perimeter_corrected_area(contact, Grid((4, 5), (8.0, 15.0)))
    assert area == pytest.approx(6 * (3 - (math.pi - 1 + math.log(2)) / 24 * 7))
    assert Grid((4, 5), (8.0, 15.0)).aspect == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("coupled", "tilted", "lower", "upper"),
    # c = (1 + nu)(1 - 2 nu) / (2 pi E) of 0.3125 and 0.11 / (pi GPa), minus the upper one's
    [
        (True, True, 0.15625, -0.055),
        (True, False, 0.050625, 0.050625),
        (False, True, 0.105625, -0.105625),
    ],
)
def test_what_shear_does_to_each_body(coupled: bool, tilted: bool, lower: float, upper: float) -> None:
    """Half of the sum closes the gap and half of the difference tilts; a f is shared by (1 - nu^2) / E."""
    elasticity = Elasticity(PAIR, coupled=coupled, tilted=tilted)
    normal, product = np.array([[7.0]]), np.array([[math.pi * 1e9]])
    found = elasticity.body_displacements(normal, normal, product)
    shares = 0.9375 / 2, 0.99 / 8
    into = [7 * share / sum(shares) for share in shares]
    assert float(found[0][0, 0]) == pytest.approx(into[0] + lower)
    assert float(found[1][0, 0]) == pytest.approx(into[1] + upper)
    alone = elasticity.body_displacements(normal, normal, None)
    assert [float(u[0, 0]) for u in alone] == pytest.approx(into)


def test_the_softer_body_is_the_one_of_less_hardness() -> None:
    assert (PAIR.softer_hardness, PAIR.softer_sign) == (50e6, -1.0)
    turned = Pair(lower=PAIR.upper, upper=PAIR.lower)
    assert (turned.softer_hardness, turned.softer_sign) == (50e6, 1.0)
    one = Pair(lower=PAIR.lower, upper=replace(PAIR.upper, hardness=None))
    assert (one.softer_hardness, one.softer_sign) == (90e6, 1.0)
    none = Pair(lower=rf.Material(1e9, 0.2), upper=rf.Material(2e9, 0.3))
    assert (none.softer_hardness, none.softer_sign) == (None, 0.0)


@pytest.mark.parametrize(
    ("pressure", "cap", "approach"),
    [
        ([3.0, 1.0, 0.0, 0.0], math.inf, (3 * 5 + 4) / 4),  # the mean weighted by pressure
        ([9.0, 1.0, 2.0, 0.0], 9.0, (4 + 2 * 6) / 3),  # of the free elements alone
        ([9.0, 9.0, 0.0, 0.0], 9.0, 5.5),  # the middle between 5, the most at the cap, and 6, the least free
        ([9.0, 9.0, 9.0, 9.0], 9.0, 8.0),  # nothing free: the most at the cap
        ([0.0, 0.0, 0.0, 0.0], 9.0, 4.0),  # no pressure: the least
    ],
)
def test_the_approach_of_a_state(pressure: list[float], cap: float, approach: float) -> None:
    v = np.array([[5.0, 4.0, 6.0, 8.0]])
    assert approach_from(np.array([pressure]), v, cap) == pytest.approx(approach)


SCENE = rf.Scene(
    upper=rf.Body(rf.Material(8e9, 0.1), rf.Sphere(0.5)),
    lower=rf.Body(rf.Material(2e9, 0.25, hardness=4.8e6), rf.Flat()),
    friction=rf.Friction(tau=1e5, beta=0.2),
    load=16.0,
    side=2e-3,
)


@pytest.mark.parametrize(("change", "expected"), [(0.24e6, 0.05), (-0.24e6, 0.0)])
def test_pressures_above_the_cap_are_residuals(change: float, expected: float) -> None:
    """5.04 MPa under a cap of 4.8 MPa: 0.24 / 5.04; and a negative one, over the peak."""
    s = rf.solve(SCENE, 8, plastic=True, method="dense")
    operator = DenseInfluence(s.grid, s.sliding_direction)
    top = np.unravel_index(np.argmax(s.pressure), s.pressure.shape)
    pressure = s.pressure.copy()
    assert pressure[top] == 4.8e6
    pressure[top] += change
    state = certify(s.problem, operator, pressure, s.traction, s.slopes, s.plastic_indentation)
    assert state.certificate.negative_pressure == pytest.approx(expected / 1.05, abs=1e-12)
    pressure[0, 0] = -0.6e6
    state = certify(s.problem, operator, pressure, s.traction, s.slopes, s.plastic_indentation)
    assert state.certificate.negative_pressure == pytest.approx(0.6e6 / pressure.max())


def test_slopes_of_another_indentation_are_a_residual() -> None:
    """They follow from the recomputed displacements with the recomputed indentation."""
    s = rf.solve(SCENE, 8, plastic=True, method="dense")
    operator = DenseInfluence(s.grid, s.sliding_direction)
    right = certify(s.problem, operator, s.pressure, s.traction, s.slopes, s.plastic_indentation)
    wrong = 3 * s.plastic_indentation
    displaced = s.problem.slopes(right.displacement_lower, right.displacement_upper, wrong)
    found = certify(s.problem, operator, s.pressure, s.traction, displaced, wrong)
    assert right.certificate.slope < 1e-8
    assert s.plastic_indentation.max() > 0
    assert found.certificate.slope == pytest.approx(displaced.distance(right.slopes, right.contact), rel=0.1)
    assert found.certificate.slope > 1e-6


def test_a_problem_is_discretised_with_its_own_terms() -> None:
    problem = discretise(SCENE, SCENE.grid(4))
    without = problem.with_terms(replace(problem.terms, coupled=False, oblique=False, tilted=True))
    assert (without.elasticity.coupled, without.elasticity.tilted) == (False, False)
    tilted = problem.with_terms(replace(problem.terms, coupled=False, tilted=True))
    assert (tilted.elasticity.coupled, tilted.elasticity.tilted) == (False, True)
    facets = problem.with_terms(replace(problem.terms, coupled=False, slope_correction=True))
    assert facets.elasticity.coupled
