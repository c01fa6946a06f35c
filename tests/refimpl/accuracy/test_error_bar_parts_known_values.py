"""Parts of the uncertainty from a state made up so that each part is a sum of a few numbers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.discretisation_error import estimates
from refimpl.accuracy.iteration_error import active_set_parts, iteration_parts
from refimpl.accuracy.refinement import tolerance_for
from refimpl.grid import Grid
from refimpl.grid.straight_edges import StraightEdges
from refimpl.model.certificate import Certificate, State
from refimpl.model.forces import EDGE_SHARE, Forces
from refimpl.model.problem import Problem, Terms
from refimpl.scene.discretise import discretise
from tests.refimpl.accuracy.made_up import made_up
from tests.refimpl.states import state_of

DA = 0.25e-6  # m^2: elements of 0.5 mm
SCENE = rf.Scene(
    upper=rf.Body(rf.Material(3e9, 0.2), rf.Sphere(0.5)),
    lower=rf.Body(rf.Material(5e9, 0.4), rf.Flat()),
    friction=rf.Friction(tau=2e6, beta=0.3),
    load=16.0,
    side=2e-3,
)


def made(residual: float = 0.0, violations: int = 0, **changes: object) -> tuple[Problem, State]:
    """A state on 4 x 4 elements with one residual, and other fields as given."""
    solution = rf.solve(SCENE, 4, oblique=False, coupled=False)
    certificate = Certificate(residual, 0.0, 0.0, 0.0, 0.0, law_violations=violations)
    problem = discretise(SCENE, SCENE.grid(4), solution.problem.terms)
    return problem, replace(state_of(solution), certificate=certificate, **changes)


def test_elements_that_violate_the_law_by_hand() -> None:
    """Three elements of 0.25 mm^2 under 2 MPa carry 1.5 N, of a load of 16 N 0.09375."""
    parts = active_set_parts(*made(violations=3))
    assert {name: part["active set"] for name, part in parts.items()} == pytest.approx(
        {
            "friction_force": 1.5,
            "friction_coefficient": 0.09375,
            "contact_area": 3 * DA,
            "contact_area_corrected": 3 * DA,
        }
    )
    assert active_set_parts(*made(violations=0)) == {}


def test_the_peaks_part_is_the_worst_misfit_of_its_elements() -> None:
    """Elements of half of the peak and more count: 2 nm there, not the 70 nm of one below half."""
    pressure, clearance = np.zeros((4, 4)), np.full((4, 4), 1e-4)
    pressure[1, :3] = 8e6, 4e6, 3.9e6
    clearance[1, :3] = -1e-9, 2e-9, 7e-8
    problem, state = made(1e-9, pressure=pressure, v=clearance + 5e-6, approach=5e-6)
    # one element against its neighbours: 2 (1 - nu^2) / (pi E) of both bodies, times the edge of 0.5 mm
    compliance = 2 * ((1 - 0.2**2) / 3e9 + (1 - 0.4**2) / 5e9) / math.pi * 0.5e-3
    assert iteration_parts(problem, state)["max_pressure"]["iteration"] == pytest.approx(2e-9 / compliance)


def test_at_an_approach_of_zero_lengths_are_uncertain_by_a_share_of_an_element() -> None:
    """There is no other length: the residual times the edge of an element, 0.5 mm."""
    problem, state = made(1e-3, approach=0.0)
    assert iteration_parts(problem, state)["approach"]["iteration"] == pytest.approx(0.5e-6)
    problem, state = made(1e-3, approach=-3e-6)
    assert iteration_parts(problem, state)["approach"]["iteration"] == pytest.approx(3e-9)


def test_forces_are_uncertain_by_the_residual_and_by_tau_on_marginal_elements() -> None:
    """Residual 0.01 of F = -4 N, N = 20 N; two elements of 0.5 N each are within ten residuals of zero."""
    pressure, clearance = np.zeros((4, 4)), np.full((4, 4), 1.0)
    pressure[0, :2], clearance[0, :2] = (9e6, 0.5e6), 0.0
    clearance[2, 3] = 0.9e-6  # a tenth of the approach is 1 um
    problem, state = made(
        0.01, pressure=pressure, v=clearance + 1e-5, approach=1e-5, forces=Forces(20.0, -4.0, 0.5),
        friction_coefficient=-0.25,
    )  # fmt: skip
    found = {name: part["iteration"] for name, part in iteration_parts(problem, state).items()}
    assert found["normal_force"] == found["binormal_force"] == pytest.approx(0.2)
    assert found["contact_area"] == found["contact_area_corrected"] == pytest.approx(2 * DA)
    assert found["friction_force"] == pytest.approx(0.04 + 2 * 0.5)
    assert found["friction_coefficient"] == pytest.approx(0.0025 + 2 * 0.5 / 20.0)
    assert found["approach"] == pytest.approx(1e-7)


def test_the_plastic_area_is_uncertain_by_elements_that_may_yield_or_not() -> None:
    """Residual 0.01: pressures from 0.9 H on, and at H those that are indented by less than 0.1 of 10 um."""
    body = rf.Body(replace(SCENE.lower.material, hardness=4e6), rf.Flat())
    hard = replace(SCENE, lower=body, plastic=True)
    _, state = made(0.01)
    pressure, clearance = np.zeros((4, 4)), np.full((4, 4), 1e-3)
    pressure[0] = 3.5e6, 3.7e6, 3.8e6, 4e6
    pressure[1, :2] = 4e6
    clearance[0], clearance[1, :2] = (0.0, 0.0, 0.0, -0.9e-6), (-2e-6, -3e-6)
    state = replace(
        state,
        pressure=pressure,
        v=clearance + 1e-5,
        approach=1e-5,
        plastic=pressure == 4e6,
        plastic_area=3 * DA,
    )
    problem = discretise(hard, hard.grid(4), Terms(oblique=False, plastic=True))
    found = iteration_parts(problem, state)
    assert found["plastic_area"]["iteration"] == pytest.approx(3 * DA)
    assert found["max_pressure"]["iteration"] == 0


def test_of_oblong_elements_the_edge_is_known_less_well() -> None:
    """On 1 : 4 its spread is hypot(0.07, 0.09 ln 4) = 0.143 of the excess, twice that of squares."""
    square = made_up(64)
    oblong = replace(square, grid=Grid((32, 128), square.grid.lengths))
    assert oblong.grid.aspect == 0.25
    by_edge = replace(square, edge=50 * square.edge), replace(oblong, edge=50 * oblong.edge)
    short, long = (estimates([one])["contact_area"].half_width for one in by_edge)
    assert 1.4 < long / short < 2.05


@pytest.mark.parametrize(("accuracy", "tolerance"), [(0.5, 1e-5), (1e-3, 1e-6), (1e-5, 1e-8), (1e-9, 1e-8)])
def test_the_tolerance_of_a_refinement_lies_between_its_ends(accuracy: float, tolerance: float) -> None:
    assert tolerance_for(accuracy) == pytest.approx(tolerance, rel=1e-12)


@pytest.mark.parametrize(("multiplicity", "squares"), [(1.0, 0), (1.0, 36), (4.0, 36)])
def test_the_yielded_area_is_uncertain_by_its_edge(multiplicity: float, squares: int) -> None:
    """25 edge elements, 0.36 of a count's root each way and their excess; runs of straight edges, half an
    element each, come in and out together: three of 2, 4 and 4 faces have squares of 36."""
    features = made_up(32)
    dA = features.grid.element_area
    yields = replace(
        features,
        numbers={**features.numbers, "plastic_area": 60 * dA},
        plastic_edge=25 * EDGE_SHARE * dA,
        plastic_straight=StraightEdges(10, 3, squares),
        symmetry_multiplicity=multiplicity,
    )
    counted, along = 0.36 * 5 * math.sqrt(multiplicity), 0.5 * math.sqrt(squares)
    bar = estimates([yields])["plastic_area"].error_bound(60 * dA)
    assert bar == pytest.approx((25 * EDGE_SHARE + math.hypot(counted, along)) * dA)
