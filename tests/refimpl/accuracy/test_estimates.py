"""Estimates from sequences of grids and parts of error bars, on results made up to have known values."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import refimpl as rf
from refimpl.accuracy import discretisation_error
from refimpl.accuracy.discretisation_error import (
    APPROACH_FREEDOM,
    APPROACH_SCATTER,
    BULK_SCATTER,
    SHEAR_BOUNDS,
    estimates,
)
from refimpl.accuracy.iteration_error import active_set_parts, iteration_parts
from refimpl.accuracy.refinement import tolerance_for
from refimpl.accuracy.scatter import PLASTIC_FREEDOM, PLASTIC_LACK, PLASTIC_SCATTER, edge_scatter
from refimpl.grid.straight_edges import StraightEdges
from refimpl.model.certificate import Certificate, State
from refimpl.model.forces import EDGE_SHARE, Forces
from refimpl.model.problem import Problem, Terms
from refimpl.scene.discretise import discretise
from refimpl.solution.quantities import REPORTED
from tests.refimpl.accuracy.made_up import AREA_LIMIT, BETA, DMU_DA, PEAK, made_up, sloped
from tests.refimpl.states import state_of


def test_numbers_that_follow_the_model_are_extrapolated() -> None:
    found = estimates([made_up(M) for M in (32, 64, 128)])
    for name in ("contact_area", "contact_area_corrected"):
        assert found[name].value == pytest.approx(AREA_LIMIT, rel=1e-3)
        assert abs(found[name].value - AREA_LIMIT) < found[name].half_width
    mu = found["friction_coefficient"]
    assert mu.value == pytest.approx(BETA + DMU_DA * AREA_LIMIT, rel=1e-3)
    assert abs(mu.value - BETA - DMU_DA * AREA_LIMIT) < mu.half_width
    peak = found["max_pressure"]
    assert peak.value == pytest.approx(PEAK, rel=1e-6)
    assert abs(peak.value - PEAK) < peak.half_width < 0.02 * PEAK


def test_slopes_that_change_within_elements_leave_mu_open() -> None:
    """Once found 0.249 +- 0.009 of a measured surface, and 0.07 on grids that resolve it."""
    found = [sloped(mu, M, 0.02) for mu, M in ((0.09, 32), (0.12, 64), (0.25, 512))]
    mu = estimates(found)["friction_coefficient"]
    assert mu.error_bound(0.25) > 0.15
    alone = estimates(found[-1:])["friction_coefficient"]
    assert alone.half_width > 12.7 * BULK_SCATTER[1] * 0.02  # Student's t with one degree of freedom
    settling = [sloped(0.1 + u, M, u) for u, M in ((0.08, 32), (0.02, 64), (0.0003, 512))]
    assert estimates(settling)["friction_coefficient"].error_bound(0.1003) < 2e-3


def test_the_finest_grids_slip_turns_area_into_friction() -> None:
    coarse, fine = made_up(32), made_up(128)
    mu = BETA + 3 * DMU_DA * coarse.numbers["contact_area"]
    coarse = replace(coarse, dmu_dA=3 * DMU_DA, numbers={**coarse.numbers, "friction_coefficient": mu})
    found = estimates([coarse, fine])
    assert found["friction_coefficient"].value == pytest.approx(BETA + DMU_DA * found["contact_area"].value)
    assert 1 < found["friction_coefficient"].half_width / (DMU_DA * found["contact_area"].half_width) < 2


def test_a_grid_without_contact_knows_nothing_beside_one_that_has() -> None:
    numbers = dict.fromkeys(REPORTED, 0.0) | {"normal_force": 70.0}
    apart, found = replace(made_up(32), numbers=numbers, edge=0.0), made_up(64)
    assert edge_scatter([apart, found]).tolist() == [1.0, (found.edge / found.numbers["contact_area"]) ** 1.5]
    assert edge_scatter([replace(found, edge=2 * found.numbers["contact_area"])]) == [1.0]
    assert edge_scatter([replace(found, edge=-0.5 * found.numbers["contact_area"])]) == [0.0]  # of holes
    assert discretisation_error.discretisation([found, apart]) == {}
    assert set(discretisation_error.discretisation([apart, found])) == set(REPORTED) - {"normal_force"}


def test_straight_edges_add_to_the_scatter_in_squares() -> None:
    """Runs of 10 and 24 faces: 0.21 * 26 elements; times the root of 2 where both come in and out as one."""
    found = made_up(64)
    area, dA = found.numbers["contact_area"], found.grid.element_area
    for multiplicity, together in ((1.0, 1.0), (4.0, 2.0)):
        strip = replace(found, straight=StraightEdges(34, 2, 676), symmetry_multiplicity=multiplicity)
        along = 0.21 * 26 * math.sqrt(together) * dA / area
        around = (found.edge / area) ** 1.5
        assert edge_scatter([strip])[0] == pytest.approx(math.hypot(around, along))
        assert along > around


@pytest.mark.parametrize("number", [1e101, -1e101, math.inf, math.nan])
def test_a_state_that_ran_off_is_not_bounded(number: float) -> None:
    """Nothing is not the same as zero: an accuracy would be met by it."""
    ran_off = replace(made_up(64), numbers={**made_up(64).numbers, "friction_force": number})
    parts = discretisation_error.discretisation([ran_off])
    assert set(parts) == set(discretisation_error.discretisation([made_up(64)]))
    assert all(part == {"discretisation": math.inf} for part in parts.values())


def test_a_contact_of_four_elements_bounds_no_approach() -> None:
    few = made_up(64)
    for elements, open_ in ((4, True), (5, False)):
        area = elements * few.grid.element_area
        found = estimates([replace(few, numbers={**few.numbers, "contact_area": area})])["approach"]
        assert math.isinf(found.half_width) is open_


def test_waves_that_a_grid_misses_leave_its_approach_open_by_their_share() -> None:
    fine = made_up(64)
    area = fine.numbers["contact_area"]
    parts = {**fine.parts, "contact_area": {"short waves": 0.3 * area}}
    bars = [estimates([grid])["approach"].half_width for grid in (fine, replace(fine, parts=parts))]
    factor = stats.t(APPROACH_FREEDOM).ppf(0.975)
    assert bars[1] == pytest.approx(math.hypot(bars[0], 0.3 * factor * APPROACH_SCATTER[1] * 1e-6))


@pytest.mark.parametrize(
    ("loaded", "widened"), [(True, {"approach": 2e-6}), (False, {"normal_force": 70.0, "max_pressure": None})]
)
def test_tau_on_the_edge_widens_what_is_not_given(loaded: bool, widened: dict[str, float | None]) -> None:
    """Under a load the approach, by the depth of 2 um; at an approach the force and the peak, by shares."""
    grids = [replace(made_up(M), loaded=loaded, depth=2e-6) for M in (32, 64)]
    pulled = [replace(grid, shear_to_normal_ratio=0.3) for grid in grids]
    share = 0.3 * grids[-1].edge / grids[-1].numbers["contact_area"]
    before, after = estimates(grids), estimates(pulled)
    for name, size in widened.items():
        bound = SHEAR_BOUNDS[name] * share * (size or grids[-1].numbers[name])
        assert after[name].half_width == pytest.approx(math.hypot(before[name].half_width, bound), rel=1e-12)
    assert {name for name in after if after[name] != before[name]} == set(widened)


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
    problem = discretise(SCENE, SCENE.grid(4), solution.details.problem.terms)
    return problem, replace(state_of(solution), certificate=certificate, **changes)


def test_elements_that_violate_the_law_by_hand() -> None:
    """Three elements of 0.25 mm^2 under 2 MPa carry 1.5 N, of a load of 16 N 0.09375."""
    parts = active_set_parts(*made(violations=3))
    assert {name: part["active set"] for name, part in parts.items()} == pytest.approx(
        {
            "friction_force": 1.5,
            "friction_coefficient": 0.09375,
            "contact_area": 3 * DA,
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
    assert found["contact_area"] == pytest.approx(2 * DA)
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


@pytest.mark.parametrize(("accuracy", "tolerance"), [(0.5, 1e-5), (1e-3, 1e-6), (1e-5, 1e-8), (1e-9, 1e-8)])
def test_the_tolerance_of_a_refinement_lies_between_its_ends(accuracy: float, tolerance: float) -> None:
    assert tolerance_for(accuracy) == pytest.approx(tolerance, rel=1e-12)


@pytest.mark.parametrize(("multiplicity", "squares"), [(1.0, 0), (1.0, 36), (4.0, 36)])
def test_the_yielded_area_is_uncertain_by_its_edge(multiplicity: float, squares: int) -> None:
    """25 edge elements scatter as a count, come in and out together by symmetry, and yield in part; runs of
    straight edges are three of 2, 4 and 4 faces, with squares of 36."""
    features = made_up(32)
    dA = features.grid.element_area
    yields = replace(
        features,
        numbers={**features.numbers, "plastic_area": 60 * dA},
        plastic_edge=25 * EDGE_SHARE * dA,
        plastic_straight=StraightEdges(10, 3, squares),
        symmetry_multiplicity=multiplicity,
    )
    edge = 25 * EDGE_SHARE
    sizes = 5 * math.sqrt(multiplicity), math.sqrt(squares), edge, edge * (25 / (4 * 60)) ** 2
    found = estimates([yields])["plastic_area"]
    assert found.value == pytest.approx((60 + PLASTIC_LACK * edge) * dA)
    deviation = math.hypot(*(PLASTIC_SCATTER * sizes)) * dA
    assert found.half_width == pytest.approx(deviation * stats.t.ppf(0.975, PLASTIC_FREEDOM))


def test_a_ball_pressed_far_beyond_yield_is_within_its_bars() -> None:
    """Pressures fall from the hardness to zero within an element or two: each such face scatters as well.

    The approach's bars contain 63 of 64 such errors (8 loads, 40 to 112 elements): here one may be missed.
    """
    soft = rf.Material(1e11, 0.3, hardness=2.5e8)
    scene = rf.Scene(
        rf.Body(rf.Material(2e11, 0.3), rf.Sphere(0.02)), rf.Body(soft, rf.Flat()), rf.Friction(), 1.0, 1e-3
    )
    missed, above = [], []
    for load in (21.6, 43.2, 57.6):
        pressed = replace(scene, load=load)
        exact = rf.solve(pressed, 400)
        for M in (48, 64, 80):
            found = rf.solve(pressed, M).details.features
            bar = discretisation_error.discretisation([found])["approach"]["discretisation"]
            assert bar < 0.01 * exact.approach
            above.append(abs(found.numbers["approach"] - exact.approach) > bar)
            error = abs(found.numbers["contact_area_corrected"] - exact.contact_area_corrected)
            assert error < estimates([found])["contact_area"].half_width, (load, M)
            missed.append(error > estimates([replace(found, rim_faces=0)])["contact_area"].half_width)
    assert sum(above) <= 1
    assert sum(missed) >= 3
