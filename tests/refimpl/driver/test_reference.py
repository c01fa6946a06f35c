"""The plain reference through `solve` and on problems: facets, plastic indentation, what has no solution."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.reference import solve_reference
from refimpl.model import certificate
from refimpl.model.forces import Forces
from refimpl.model.problem import Terms
from refimpl.scene.discretise import discretise

SIDE = 1e-3


def rough(lower: rf.Material, height: float, load: float, seed: int) -> rf.Scene:
    heights = np.random.default_rng(seed).uniform(0, height, (5, 5))
    upper = rf.Body(rf.Material(30e9, 0.3), rf.Flat())
    friction = rf.Friction(tau=1e6, beta=0.2)
    return rf.Scene(upper, rf.Body(lower, heights), friction, load=load, side=SIDE, sliding_direction=0.7)


@pytest.mark.parametrize("oblique", [False, True])
def test_the_plastic_indentation_is_measured_from_elements_below_the_hardness(oblique: bool) -> None:
    """Between 0 and H all have v = d; an element at H is (d - v) cos cos deep, whatever the load on it."""
    scene = rough(rf.Material(1e9, 0.2, hardness=20e6), 2e-5, 5.0, seed=7)
    problem = discretise(scene, scene.grid(5), Terms(oblique=oblique, plastic=True))
    state = solve_reference(problem)
    free = (state.pressure > 0) & ~state.plastic
    assert min(free.sum(), state.plastic.sum()) > 1
    between = state.v[free]
    assert np.ptp(between) < 1e-11 * between.mean()
    assert state.indentation is not None
    depth = (between.mean() - state.v) * state.slopes.cosine_product
    assert state.indentation[state.plastic] == pytest.approx(depth[state.plastic], rel=1e-8)
    assert not state.indentation[~state.plastic].any()


@pytest.mark.parametrize("direction", [0.0, 2.5])
def test_shear_on_slopes_that_could_bear_more_than_the_load(direction: float) -> None:
    """Pressures of 1e-4 of tau balance it: a state that holds by the certificate."""
    scene = rf.Scene(
        upper=rf.Body(rf.Material(1e11, 0.45), rf.Sphere(11742.5)),
        lower=rf.Body(rf.Material(1e11, 0.3), rf.Flat()),
        friction=rf.Friction(tau=3e7, beta=0.1),
        load=7e8,
        side=1e3,
        sliding_direction=direction,
    )
    solution = rf.solve(scene, 2, method="dense")
    assert solution.status is rf.Status.CONVERGED
    assert solution.certificate.law_violations == 0
    assert 0 < solution.max_pressure < 1e-3 * solution.traction.max()


def test_where_all_that_press_are_at_the_hardness_the_next_element_bears_the_rest() -> None:
    """Two elements of 1/16 mm^2 at 0.1 GPa bear 12.5 N of 13 N; of the others the nearest bears 8 MPa."""
    body = rf.Body(rf.Material(E=200e9, nu=0.3, hardness=0.1e9), rf.Flat())
    scene = rf.Scene(body, body, rf.Friction(), load=13.0, side=1e-3)
    gap = np.full((4, 4), 3e-6)
    gap[0, 1] = gap[3, 2] = 0.0
    gap[1, 3] = 2e-6
    problem = replace(discretise(scene, scene.grid(4), Terms(oblique=False, plastic=True), None), gap=gap)
    result = solve_reference(problem)
    expected = np.zeros((4, 4))
    expected[0, 1] = expected[3, 2] = 0.1e9
    expected[1, 3] = 8e6
    np.testing.assert_allclose(result.pressure, expected, rtol=1e-9)


@pytest.mark.parametrize(("coupled", "tilted"), [(False, False), (False, True), (True, False)])
def test_neglected_terms_are_other_bodies(coupled: bool, tilted: bool) -> None:
    """Coupling and tilt depend on c of each body, which E and nu can give at the same a."""
    scene = rough(rf.Material(1e9, 0.2), 2e-5, 3.0, seed=5)
    dense, fft = (
        rf.solve(scene, 5, method=m, coupled=coupled, tilted=tilted, oblique=True, tolerance=1e-11)
        for m in ("dense", "fft")
    )
    assert np.abs(dense.pressure - fft.pressure).max() <= 1e-8 * fft.max_pressure


def test_a_rigid_body_takes_both_terms_or_neither() -> None:
    scene = rough(rf.Material(1e9, 0.2), 2e-5, 3.0, seed=5)
    rigid = replace(scene, upper=rf.Body(rf.Material(float("inf"), 0.3), rf.Flat()))
    with pytest.raises(rf.InputError, match="tilted = False"):
        rf.solve(rigid, 5, method="dense", coupled=True, tilted=False, oblique=True)


def test_the_reference_reports_its_own_sums(monkeypatch: pytest.MonkeyPatch) -> None:
    """F of the certificate 1 % too large moves no number of method dense, and is one of its residuals."""
    scene = rough(rf.Material(1e9, 0.2), 2e-5, 3.0, seed=5)
    before = rf.solve(scene, 5, method="dense")
    assert before.certificate.reference < 1e-12
    sums = certificate.resultants

    def wrong(*given: Any) -> Forces:
        forces = sums(*given)
        return forces._replace(friction=1.01 * forces.friction)

    monkeypatch.setattr(certificate, "resultants", wrong)
    after = rf.solve(scene, 5, method="dense")
    assert after.friction_force == before.friction_force
    assert after.friction_coefficient == before.friction_coefficient
    assert after.certificate.reference > 1e-4
    assert after.status is rf.Status.STAGNATED
