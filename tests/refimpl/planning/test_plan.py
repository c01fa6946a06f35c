"""What is decided before a solve: exact zeros, small terms, forced terms, and what they cost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.solution.solution import REPORTED
from refimpl.model.problem import pose
from refimpl.operators import kernel_tables
from refimpl.planning import term_effects
from refimpl.planning.expected_contact import expected, found
from refimpl.planning.plan import make_plan
from refimpl.planning.term_effects import Scales
from refimpl.scene.discretise import EVERYTHING

STEEL, COPPER, RUBBER = rf.Material(200e9, 0.30), rf.Material(118e9, 0.30), rf.Material(10e6, 0.5)
SMOOTH = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(0.14)),
    lower=rf.Body(COPPER, rf.Flat()),
    friction=rf.Friction(15e6, 0.08),
    load=70.0,
    side=1.61e-3,
)
ROUGH = replace(SMOOTH, lower=rf.Body(COPPER, rf.GaussianRoughness(0.5e-6, 104e-6, seed=2)))
INCOMPRESSIBLE = replace(
    SMOOTH, upper=rf.Body(RUBBER, rf.Sphere(0.14)), lower=rf.Body(rf.Material(1e6, 0.5), rf.Flat()), load=1e-3
)
FRICTIONLESS = replace(SMOOTH, friction=rf.Friction())
TWINS = replace(SMOOTH, lower=rf.Body(STEEL, rf.Flat()))


@pytest.mark.parametrize(
    ("scene", "why"),
    [(TWINS, "cancel"), (INCOMPRESSIBLE, "nu = 0.5 on both"), (FRICTIONLESS, "no friction")],
)
def test_exact_zeros_are_left_out_for_nothing(scene: rf.Scene, why: str) -> None:
    plan = make_plan(scene, 32, "fft")
    term = plan.term("coupled")
    assert not term.included
    assert why in term.reason
    assert term.effect == term_effects.NONE
    assert plan.neglected == () or "coupled" not in plan.neglected


def test_with_a_grid_alone_nothing_that_shear_does_is_small_enough() -> None:
    plan = make_plan(ROUGH, 64, "fft")
    assert plan.demand == 1e-8
    assert plan.neglected == ()
    assert all(plan.includes(name) for name in ("coupled", "oblique", "tilted", "active_set"))


def test_without_friction_a_symmetric_scene_has_flat_tips() -> None:
    plan = make_plan(FRICTIONLESS, 64, "fft")
    assert not plan.includes("oblique")
    assert 0 < plan.term("oblique").effect.area < 1e-4
    assert plan.contact.symmetric
    steep = replace(FRICTIONLESS, upper=rf.Body(STEEL, rf.Sphere(2e-3)), load=3000.0)
    assert make_plan(steep, 64, "fft").includes("oblique")
    assert make_plan(replace(ROUGH, friction=rf.Friction()), 64, "fft").includes("oblique")


@pytest.mark.parametrize("accuracy", [0.3, 0.1, 0.03, 0.01, 0.001])
def test_what_is_left_out_stays_within_its_budget(accuracy: float) -> None:
    plan = make_plan(ROUGH, 256, "fft", demand=accuracy)
    assert plan.budget == 0.5 * accuracy
    assert sum(plan.term(name).effect.larger for name in plan.neglected) <= plan.budget
    rest = [t for t in plan.terms if t.included and t.name in ("coupled", "oblique")]
    spent = sum(plan.term(name).effect.larger for name in plan.neglected)
    assert all(spent + term.effect.larger > plan.budget for term in rest)


def test_the_user_has_the_last_word() -> None:
    for word in (True, False):
        plan = make_plan(ROUGH, 64, "fft", coupled=word, oblique=True, tilted=word, demand=0.5)
        assert plan.includes("coupled") is word
        assert plan.includes("tilted") is word
        assert "forced" in plan.term("coupled").reason
    assert not make_plan(ROUGH, 64, "fft", oblique=False).includes("tilted")
    assert make_plan(ROUGH, 64, "fft", oblique=True, demand=0.5).includes("oblique")


def test_a_correction_excludes_leaving_shear_out() -> None:
    with pytest.raises(rf.InputError) as caught:
        make_plan(ROUGH, 16, "fft", slope_correction=True, coupled=False)
    assert caught.value.field == "coupled"


def test_tau_that_moves_nothing_has_no_support_to_iterate() -> None:
    plan = make_plan(TWINS, 32, "fft", oblique=False)
    assert not plan.includes("active_set")
    assert "moves nothing" in plan.term("active_set").reason


def test_hertz_is_foreseen() -> None:
    """Area, approach and mean pressure of the smooth ball, to the grid's resolution."""
    M = 128
    problem = pose(SMOOTH, rf.Grid.square(SMOOTH.side, M), EVERYTHING, None)
    outlook = expected(problem)
    radius = (3 * 70.0 * 0.14 / (4 * problem.pair.reduced_modulus)) ** (1 / 3)
    area = np.pi * radius**2
    assert outlook.elements * problem.grid.element_area == pytest.approx(area, rel=0.02)
    assert outlook.mean_pressure == pytest.approx(70.0 / area, rel=0.02)
    assert outlook.approach == pytest.approx(radius**2 / 0.14, rel=0.02)
    assert outlook.symmetric
    assert outlook.mirrored
    assert outlook.spots == 1


def test_at_an_approach_as_under_the_load() -> None:
    under_load = make_plan(SMOOTH, 128, "fft").contact
    at_approach = make_plan(SMOOTH, 128, "fft", approach=under_load.approach).contact
    assert at_approach.elements == pytest.approx(under_load.elements, rel=0.05)
    assert at_approach.mean_pressure == pytest.approx(under_load.mean_pressure, rel=0.05)


def test_a_rough_contact_is_foreseen_within_a_factor_of_two() -> None:
    s = rf.solve(ROUGH, 128)
    contact = found(s.problem, s.pressure, s.plan.contact)
    outlook = s.plan.contact
    assert 0.5 < outlook.elements / contact.elements < 2
    assert 0.5 < outlook.pressure / contact.pressure < 2
    assert 0.5 < outlook.slope_squared / contact.slope_squared < 2
    assert 0.5 < outlook.approach / s.approach < 2


def test_two_flats_and_one_element_have_an_outlook() -> None:
    flat = replace(SMOOTH, upper=rf.Body(STEEL, rf.Flat()))
    assert make_plan(flat, 8, "fft").contact.elements == 64
    assert make_plan(SMOOTH, 1, "fft").contact.elements == 1
    assert make_plan(flat, 8, "fft", approach=0.0).contact.elements >= 1


def test_shear_tilts_the_common_surface_of_twins() -> None:
    """Twins do not couple, but shear moves both surfaces alike: F loses what the estimate says."""
    strong = replace(TWINS, friction=rf.Friction(beta=0.5), load=7000.0, side=6e-3)
    tilted, level = (rf.solve(strong, 64, tilted=word) for word in (True, False))
    lost = level.friction_coefficient - tilted.friction_coefficient
    scales = Scales(tilted.plan.contact, tilted.problem.pair, strong.friction)
    assert "shear" in tilted.cost.applications
    assert "shear" not in level.cost.applications
    assert 0 < lost <= term_effects.shear_tilt(scales).friction * scales.mu < 3 * lost


def test_parts_add_up_to_the_whole() -> None:
    """Coupling and tilt are the two halves of one displacement: leaving one out leaves the other whole."""
    whole = rf.solve(ROUGH, 32, tolerance=1e-10)
    apart = {
        word: rf.solve(ROUGH, 32, tolerance=1e-10, coupled=word[0], tilted=word[1])
        for word in ((True, True), (True, False), (False, True), (False, False))
    }
    assert np.array_equal(whole.pressure, apart[True, True].pressure)
    change = {word: s.friction_coefficient - whole.friction_coefficient for word, s in apart.items()}
    assert abs(change[True, False]) > 1e-6
    assert abs(change[False, True]) > 1e-6
    together = change[True, False] + change[False, True]
    assert change[False, False] == pytest.approx(together, rel=0.2)


def test_dense_and_fft_leave_the_same_out() -> None:
    for coupled, tilted in ((False, True), (True, False), (False, False)):
        dense, fft = (
            rf.solve(ROUGH, 24, method=method, tolerance=1e-11, coupled=coupled, tilted=tilted)
            for method in ("dense", "fft")
        )
        np.testing.assert_allclose(dense.pressure, fft.pressure, atol=1e-8 * dense.max_pressure)


def test_accuracy_leaves_out_and_says_so() -> None:
    s = rf.solve(SMOOTH, accuracy=0.05)
    assert s.plan.neglected
    assert "neglected" in s.uncertainty["friction_coefficient"]
    assert 0 < s.uncertainty["friction_coefficient"]["neglected"] <= 0.05 * s.friction_coefficient
    full = rf.solve(SMOOTH, s.grid.shape[0], tolerance=s.tolerance, oblique=True, coupled=True, tilted=True)
    change = abs(s.friction_coefficient - full.friction_coefficient)
    assert change <= s.uncertainty["friction_coefficient"]["neglected"]
    assert set(s.neglected) == set(s.plan.neglected)


def test_a_term_that_turns_out_to_matter_is_put_back(monkeypatch: pytest.MonkeyPatch) -> None:
    """Estimates a thousand times too small before the solve, and right after it."""
    honest = term_effects.shear_coupling
    monkeypatch.setattr(
        term_effects,
        "shear_coupling",
        lambda scales: term_effects.Effect(*(1e-3 * x for x in vars(honest(scales)).values())),
    )
    soft = replace(
        ROUGH, lower=rf.Body(rf.Material(2.5e9, 0.1), ROUGH.lower.surface), friction=rf.Friction(0, 0.4)
    )
    s = rf.solve(soft, accuracy=0.05)
    assert s.plan.includes("coupled")
    assert "put back" in s.plan.term("coupled").reason


def test_nothing_builds_a_cerruti_kernel_that_does_not_need_one(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("a tangential kernel was built")

    monkeypatch.setattr(kernel_tables, "_cache", {})
    monkeypatch.setitem(kernel_tables._TABLES, "tangential", refuse)
    rf.solve(FRICTIONLESS, 32)
    rf.solve(replace(ROUGH, friction=rf.Friction()), 32)
    rf.solve(TWINS, 32, oblique=False)
    rf.solve(TWINS, accuracy=0.1)
    with pytest.raises(AssertionError, match="tangential"):
        rf.solve(SMOOTH, 32)


def test_slopes_left_out_of_a_frictionless_scene_leave_mu_open() -> None:
    """All of mu, and of Q, is theirs: it was told as 0 without a bar."""
    scene = replace(ROUGH, friction=rf.Friction())
    s = rf.solve(scene, accuracy=0.1)
    assert "oblique" in s.plan.neglected
    full = rf.solve(scene, s.grid.shape[0], oblique=True)
    for name in ("friction_coefficient", "friction_force", "binormal_force"):
        assert getattr(s, name) == 0.0
        assert 0 < abs(getattr(full, name)) <= s.uncertainty[name]["neglected"], name


@pytest.mark.parametrize("at_approach", [False, True])
def test_terms_left_out_are_in_the_bars_of_all_numbers(at_approach: bool) -> None:
    """Of the approach and the corrected area as well, which followed without one; then of the force."""
    scene = rf.Scene(
        upper=rf.Body(rf.Material(6.6e10, 0.0), rf.Sphere(0.0498)),
        lower=rf.Body(rf.Material(3.55e16, 0.3), rf.Sphere(0.0699)),
        friction=rf.Friction(0.0, 0.3),
        load=14883.7,
        side=8.3517e-3,
        sliding_direction=5.2365,
    )
    approach = 5.5e-5 if at_approach else None
    s = rf.solve(scene, accuracy=0.2, quantity="contact_area", approach=approach)
    assert "coupled" in s.plan.neglected
    full = rf.solve(scene, s.grid.shape[0], approach=approach)
    given = {"approach"} if at_approach else {"normal_force"}
    for name in set(REPORTED) - given:
        left_out = s.uncertainty[name]["neglected"]
        assert abs(getattr(s, name) - getattr(full, name)) <= left_out, name
    assert "neglected" not in s.uncertainty.get(given.pop(), {})


def test_who_asks_for_mu_without_friction_asks_for_slopes() -> None:
    scene = replace(ROUGH, friction=rf.Friction())
    s = rf.solve(scene, accuracy=0.1, quantity="friction_coefficient")
    assert s.converged
    assert s.plan.includes("oblique")
    assert sum(s.uncertainty["friction_coefficient"].values()) <= 0.1 * abs(s.friction_coefficient)


def test_the_slope_correction_moves_mu_on_a_flat_body_without_friction() -> None:
    """What acts along the facets of a rough ball works too, so that <t> need not be the flat body's."""
    ball = rf.Sphere(0.14) + rf.GaussianRoughness(0.5e-6, 104e-6, seed=2)
    scene = replace(FRICTIONLESS, upper=rf.Body(STEEL, ball))
    printed, corrected = (rf.solve(scene, 64, slope_correction=on) for on in (False, True))
    change = abs(corrected.friction_coefficient - printed.friction_coefficient)
    estimate = corrected.plan.term("slope_correction").effect
    assert 1e-7 < change <= estimate.bare < 1e-3
    smooth = make_plan(FRICTIONLESS, 64, "fft")
    assert smooth.term("slope_correction").effect.bare == 0.0


def test_a_mu_that_is_exactly_zero_needs_no_finer_grid() -> None:
    s = rf.solve(rf.read_scene("hertz"), accuracy=0.01, quantity="friction_coefficient")
    assert s.converged
    assert s.grid.shape[0] == 64
    assert s.friction_coefficient == 0.0
