"""accuracy=: the bar is met, it holds the error against a far finer grid, and its parts are what they say."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.iteration_error import iteration_parts, merged
from refimpl.accuracy.refinement import FIRST_GRIDS
from refimpl.solution.cost import total_cost
from refimpl.solution.solution import REPORTED
from tests.refimpl.states import state_of

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)


def sliding_ball(rms: float, seed: int, load: float = 70.0) -> rf.Scene:
    rough = rf.GaussianRoughness(rms=rms, correlation_length=200e-6, seed=seed)
    return rf.Scene(
        upper=rf.Body(STEEL, rf.Sphere(radius=0.14)),
        lower=rf.Body(COPPER, rough),
        friction=rf.Friction(tau=15e6, beta=0.08),
        load=load,
        side=1.61e-3,
    )


HERTZ = rf.read_scene("hertz")


def bar(solution: rf.Solution, name: str) -> float:
    return sum(solution.uncertainty[name].values())


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.nightly)])
def test_the_bar_is_met_and_holds_the_error(seed: int) -> None:
    scene = sliding_ball(0.3e-6, seed)
    found = rf.solve(scene, accuracy=0.05)
    assert found.status in (rf.Status.CONVERGED, rf.Status.CYCLED)
    assert bar(found, "friction_coefficient") <= 0.05 * found.friction_coefficient
    # the finer grid's own error is part of the check
    finer = rf.solve(scene, grid=2 * found.grid.shape[0], tolerance=1e-6)
    for name in ("friction_coefficient", "contact_area", "max_pressure"):
        assert abs(getattr(found, name) - getattr(finer, name)) <= bar(found, name), name


def test_a_tighter_accuracy_takes_a_finer_grid() -> None:
    scene = sliding_ball(0.3e-6, 1)
    rough = rf.solve(scene, accuracy=0.1)
    begun = time.perf_counter()
    fine = rf.solve(scene, accuracy=0.02)
    assert 0 < fine.cost.seconds <= time.perf_counter() - begun
    assert rough.grid.shape[0] < fine.grid.shape[0]
    assert set(rough.cost.iterations) < set(fine.cost.iterations)


def test_the_cost_is_that_of_all_grids() -> None:
    """Each grid is solved from the one before, as by `solve` with a start."""
    scene, words = sliding_ball(0.3e-6, 1), {"coupled": True, "oblique": True, "tilted": True}
    lines: list[str] = []
    found = rf.solve(scene, accuracy=0.02, **words, progress=lines.append)
    sizes = [int(size) for size in dict.fromkeys(line.partition(" x ")[0] for line in lines)]
    assert tuple(sizes[:2]) == FIRST_GRIDS
    assert len(sizes) > 2
    solved: list[rf.Solution] = []
    for M in sizes:
        start = solved[-1] if solved else None
        solved.append(rf.solve(scene, M, **words, start=start, tolerance=found.tolerance))
    assert np.array_equal(found.pressure, solved[-1].pressure)
    expected = total_cost(solution.cost for solution in solved)
    assert found.cost.applications == expected.applications
    assert found.cost.iterations == expected.iterations
    assert found.cost.point_logs == pytest.approx(expected.point_logs)


@pytest.mark.parametrize(("scene", "quantity"), [(sliding_ball(0.3e-6, 1), "contact_area"), (HERTZ, None)])
def test_the_area_counts_on_request_and_without_friction(scene: rf.Scene, quantity: str | None) -> None:
    found = rf.solve(scene, accuracy=0.05, quantity=quantity)  # type: ignore[arg-type]  # one of the quantities
    assert bar(found, "contact_area") <= 0.05 * found.contact_area


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({}, "grid"),
        ({"grid": 64, "accuracy": 0.1}, "grid"),
        ({"grid": 32, "max_grid": 64}, "accuracy"),
        ({"accuracy": 0.0}, "accuracy"),
        ({"accuracy": 1.0}, "accuracy"),
        ({"accuracy": 0.1, "quantity": "F"}, "quantity"),
        ({"accuracy": 0.1, "max_grid": 0}, "max_grid"),
        ({"accuracy": 0.1, "max_seconds": -1.0}, "max_seconds"),
        ({"accuracy": 0.1, "max_memory": 0.0}, "max_memory"),
    ],
)
def test_bad_accuracies_are_refused(arguments: dict[str, Any], field: str) -> None:
    with pytest.raises(rf.InputError, match=f"^{field} = "):
        rf.solve(sliding_ball(0.3e-6, 1), **arguments)


def test_one_grid_has_bars_of_its_own() -> None:
    scene = sliding_ball(0.3e-6, 1)
    found, finer = rf.solve(scene, grid=64), rf.solve(scene, grid=256)
    for name in ("friction_coefficient", "contact_area", "max_pressure", "approach", "binormal_force"):
        bar = found.uncertainty[name]["discretisation"]
        assert abs(getattr(found, name) - getattr(finer, name)) <= bar, name
        assert finer.uncertainty[name]["discretisation"] < 0.4 * bar  # first order at least
    edge = found.contact_area - found.contact_area_corrected
    assert edge < found.uncertainty["contact_area"]["discretisation"] < 2 * edge
    assert found.uncertainty["approach"]["iteration"] <= 1e-8 * found.approach


def test_a_looser_certificate_has_a_larger_iteration_part() -> None:
    scene = sliding_ball(0.3e-6, 1)
    loose, tight = (rf.solve(scene, grid=64, tolerance=t) for t in (1e-3, 1e-10))
    assert loose.certificate.largest > tight.certificate.largest
    state = state_of(loose)
    parts, tighter = iteration_parts(loose.problem, state), iteration_parts(tight.problem, state_of(tight))
    assert set(parts) == set(tighter) == set(REPORTED)
    # steep slopes can make a normal force negative at an approach
    pulled = replace(state, forces=state.forces._replace(normal=-state.forces.normal))
    assert iteration_parts(loose.problem, pulled)["binormal_force"] == parts["binormal_force"]
    for name in REPORTED:
        assert tighter[name]["iteration"] <= parts[name]["iteration"]
        # the loose state lies within its own bar of the tight one
        missed = abs(getattr(loose, name) - getattr(tight, name))
        assert missed <= parts[name]["iteration"] + 1e-8 * abs(getattr(tight, name)), name


def test_a_sum_over_slopes_that_cancels_is_no_better_known_than_its_terms() -> None:
    """Without friction F is slopes alone, a vector's component: there is a direction in which it is zero."""
    scene = replace(sliding_ball(0.3e-6, 1), friction=rf.Friction())
    ahead = rf.solve(scene, grid=64, oblique=True, tolerance=1e-12)
    across = math.atan2(-ahead.friction_force, ahead.binormal_force)
    scene = replace(scene, sliding_direction=across)
    loose, tight = (rf.solve(scene, grid=64, oblique=True, tolerance=t) for t in (1e-3, 1e-12))
    assert abs(tight.friction_force) < 1e-6 * abs(tight.binormal_force)
    for name in ("friction_coefficient", "friction_force"):
        missed = abs(getattr(loose, name) - getattr(tight, name))
        assert 0.01 * abs(getattr(loose, name)) < missed < loose.uncertainty[name]["iteration"]


def test_parts_are_merged_by_number_and_name() -> None:
    first, second = {"A": {"x": 1.0, "y": 2.0}}, {"A": {"y": 3.0}, "B": {"x": 4.0}}
    assert merged(first, second) == {"A": {"x": 1.0, "y": 3.0}, "B": {"x": 4.0}}


def test_slopes_do_not_make_elements_outside_contact_marginal() -> None:
    # on slopes Eq. (6) leaves surfaces u (1 / K - 1) apart: clearance counts, not separation
    ball = rf.Scene(
        upper=rf.Body(STEEL, rf.Sphere(radius=2e-3)),
        lower=rf.Body(COPPER, rf.Flat()),
        friction=rf.Friction(beta=0.1),
        load=500.0,
        side=1.6e-3,
    )
    found = rf.solve(ball, grid=64, tolerance=1e-6)
    assert found.slope_error.rms_gradient > 0.03
    assert abs(found.clearance[found.contact]).max() <= 1e-5 * found.approach
    assert found.separation[found.contact].min() < -1e-3 * found.approach
    assert found.uncertainty["contact_area"]["iteration"] <= 4 * found.grid.element_area
