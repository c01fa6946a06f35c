"""Estimates from a contact of a few elements, with every sum worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.model.materials import Pair
from refimpl.model.problem import Terms
from refimpl.planning.expected_contact import ExpectedContact, solved_contact
from refimpl.planning.plan import estimated_memory, make_plan
from refimpl.planning.term_effects import Effect, Scales, effects_in
from refimpl.planning.terms import budget_of, choose
from refimpl.scene.discretise import discretise

PAIR = Pair(lower=rf.Material(2e9, 0.25, hardness=90e6), upper=rf.Material(8e9, 0.1))
C = [(1 + nu) * (1 - 2 * nu) / 2 / E for E, nu in ((2e9, 0.25), (8e9, 0.1))]
A = sum((1 - nu**2) / E for E, nu in ((2e9, 0.25), (8e9, 0.1)))
"""pi c of the lower and the upper body, pi a of the pair (1/Pa)."""
CONTACT = ExpectedContact(
    elements=50, patches=4.0, mean_pressure=10e6, pressure=16e6, approach=2e-6, slope_squared=4e-4,
    least_slope=0.01, least_mean_slope=0.002, border=0.1, extent=0.2, symmetric=False, mirrored=False,
    window=(7, 9),
)  # fmt: skip
SCENE = rf.Scene(
    upper=rf.Body(PAIR.upper, rf.Sphere(0.05)),
    lower=rf.Body(PAIR.lower, rf.GaussianRoughness(1e-6, 3e-4, seed=2)),
    friction=rf.Friction(tau=1e6, beta=0.2),
    load=8.0,
    side=2e-3,
)


def test_slope_terms_by_hand() -> None:
    """mu = 0.2 + 1 MPa / 10 MPa; tilts pi c 2 (0.2 * 16 MPa + 1 MPa), pi c = (1 + nu)(1 - 2 nu) / (2 E)."""
    lower, upper = (c * 2.0 * 4.2e6 for c in C)
    scales = Scales(CONTACT, PAIR, SCENE.friction)
    assert scales.tilts == pytest.approx((lower, upper))
    slope = lower + 4e-4 + 1.5 * 0.002 + 0.4 * 0.01 + 2.0 * 0.1 * 0.02
    local = 0.3 * slope + 4e-4
    area = local + 2 * math.sqrt(local / 50)
    found = effects_of("oblique", scales)
    assert found.area == pytest.approx(area)
    assert found.friction == pytest.approx(((1 + 0.09) * slope + 0.1 * area) / 0.3)


def test_coupling_by_hand() -> None:
    """c / a with lower minus upper; four patches halve the change of the area."""
    strength = (C[0] - C[1]) / A * 0.3
    local = 0.35 * strength
    area = 2.0 * strength**2 + local / 2 + 2 * math.sqrt(local / 50)
    tilt = 0.5 * (C[0] - C[1]) * 2.0 * 4.2e6
    found = effects_of("coupled", Scales(CONTACT, PAIR, SCENE.friction))
    assert found.area == pytest.approx(area)
    assert found.friction == pytest.approx((tilt + local * 0.01 + 0.1 * area) / 0.3)


def effects_of(name: str, scales: Scales) -> Effect:
    from refimpl.planning.term_effects import ESTIMATES

    return ESTIMATES[name](scales)


def test_on_a_finer_grid_as_many_times_more_elements_touch() -> None:
    """Of 36 elements two touch, so of 900 fifty; a coarser request changes nothing."""
    problem = discretise(SCENE, SCENE.grid(6))
    pressure = np.zeros((6, 6))
    pressure[2, 2:4] = 2e6
    clearance = np.zeros_like(pressure)
    contact = solved_contact(problem, pressure, clearance, CONTACT)
    for elements, expected in ((900, 50), (18, 2), (None, 2)):
        found = effects_in(("oblique",), problem, pressure, clearance, CONTACT, elements)
        scales = Scales(replace(contact, elements=expected), problem.pair, problem.friction)
        assert found == {"oblique": effects_of("oblique", scales)}
    assert effects_in((), problem, pressure, clearance, CONTACT) == {}
    assert effects_in(("oblique",), problem, 0 * pressure, clearance, CONTACT) == {}


@pytest.mark.parametrize(("mean", "included"), [(29e6, False), (31e6, True)])
def test_the_cap_enters_where_three_mean_pressures_reach_the_hardness(mean: float, included: bool) -> None:
    problem = discretise(SCENE, SCENE.grid(6))
    terms = choose(problem, replace(CONTACT, mean_pressure=mean), Terms(), 1e-8)
    (cap,) = (term for term in terms if term.name == "plastic")
    assert cap.included is included


def test_tilt_by_hand() -> None:
    """Half of both tilts; they turn mu = 0.3 into slopes once more, and with it the area."""
    scales = Scales(CONTACT, PAIR, SCENE.friction)
    tilt = 0.5 * sum(scales.tilts)
    area = 0.3 * tilt + 2 * math.sqrt(0.3 * tilt / 50)
    found = effects_of("tilted", scales)
    assert found.area == pytest.approx(area)
    assert found.friction == pytest.approx((1.09 * tilt + 0.1 * area) / 0.3)


@pytest.mark.parametrize("symmetric", [False, True])
@pytest.mark.parametrize("beta", [0.0, 0.3])
def test_facets_by_hand(symmetric: bool, beta: float) -> None:
    """rms slope 0.02; c / a of the pair, lower minus upper and their sum, with half of its squared slopes."""
    local = 0.7 * ((C[0] - C[1]) / A + beta) * 0.02
    slope = 0.0 if symmetric and not beta else (beta + 0.5 * sum(C) / A) * 4e-4
    area = local + 2 * math.sqrt((4 if symmetric else 1) * local / 50)
    scales = Scales(replace(CONTACT, symmetric=symmetric), PAIR, rf.Friction(0.0, beta))
    expected = Effect(slope / beta, area) if beta else Effect(0.0, area, bare=slope)
    assert vars(effects_of("slope_correction", scales)) == pytest.approx(vars(expected))


def test_without_friction_a_symmetric_scene_has_a_hundredth_of_its_edge_as_budget() -> None:
    """50 elements in four patches have radii of 2 elements, and each whole elements' excess of 0.30 / r."""
    problem = discretise(replace(SCENE, friction=rf.Friction()), SCENE.grid(6))
    found = [budget_of(problem, replace(CONTACT, symmetric=word), 1e-3) for word in (True, False)]
    assert found == pytest.approx([0.01 * 0.30 / math.sqrt(50 / 4 / math.pi), 5e-4], rel=0.02)
    assert budget_of(problem, replace(CONTACT, symmetric=True), 0.2) == 0.1


def test_reasons_of_terms_that_come_with_others() -> None:
    """The budget less the neglected coupling, a hundredth more and less than the tilt takes."""
    problem, scales = discretise(SCENE, SCENE.grid(6)), Scales(CONTACT, PAIR, SCENE.friction)
    sizes = {name: effects_of(name, scales).larger for name in ("coupled", "tilted")}
    both, given = sum(sizes.values()), Terms(oblique=True)
    for share, reason in ((1.01, "negligible"), (0.99, "shear moves the common surface")):
        tilted = choose(problem, CONTACT, given, share * both)[2]
        assert (tilted.reason, tilted.negligible) == (reason, share > 1)
    assert choose(problem, CONTACT, given, 0.0)[2].reason == "comes with the coupling's kernel"


def test_without_friction_slopes_that_are_all_of_mu_stay_and_facets_still_shear() -> None:
    """A budget of half of mu: slopes are kept for mu's sake, when the cap is restored as well."""
    problem = discretise(replace(SCENE, friction=rf.Friction()), SCENE.grid(6))
    plan = make_plan(problem, demand=1.0, for_mu=True)
    assert not make_plan(problem, demand=1.0).includes("oblique")
    restored = plan.restore(problem, "plastic")
    assert restored.includes("oblique")
    assert [term.name for term in restored.terms if "restored" in term.reason] == ["plastic"]
    corrected = choose(problem, CONTACT, Terms(slope_correction=True), 1.0)
    assert [term.included for term in corrected] == [True, True, True, True, False, False]


def test_memory_is_of_the_grid_or_of_a_window_half_as_large_again() -> None:
    grid = rf.Grid((10, 20), (1.0, 2.0))
    found = [estimated_memory("fft", grid, extent=share) / 200 for share in (0.1, 0.4, 0.9)]
    assert found == [176, 0.6 * 520, 520]


def test_less_shear_than_a_double_holds_is_none() -> None:
    least = rf.Friction(tau=5e-324)
    assert Scales(CONTACT, PAIR, least).frictionless
    assert rf.solve(replace(SCENE, friction=least), 6).status is rf.Status.CONVERGED
