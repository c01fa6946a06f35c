"""Pressures capped at the hardness: the option, when the cap enters, its numbers and their error bars."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.options import Options
from refimpl.model.problem import Terms
from refimpl.scene.parameters import with_parameter
from refimpl.solution.model_warning import Limit, ModelWarning

H = 0.8e9
STEEL, COPPER = rf.Material(200e9, 0.30), rf.Material(118e9, 0.34, hardness=H)
ROUGH = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(5e-3)),
    lower=rf.Body(COPPER, rf.GaussianRoughness(0.3e-6, 100e-6, seed=1)),
    friction=rf.Friction(15e6, 0.08),
    load=50.0,
    side=1e-3,
)
FLATS = replace(ROUGH, upper=rf.Body(STEEL, rf.Flat()))


def hard(hardness: float | None, scene: rf.Scene = ROUGH) -> rf.Scene:
    return replace(scene, lower=rf.Body(replace(COPPER, hardness=hardness), scene.lower.surface))


def limits(s: rf.Solution) -> set[str]:
    return {str(w.limit) for w in s.warnings}


def test_the_hardness_decides() -> None:
    """Far above all pressures it leaves the elastic solution, below them it caps them."""
    free, capped = rf.solve(hard(1e12), 32), rf.solve(ROUGH, 32)
    assert not free.plan.includes("plastic")
    assert free.plastic_area == 0
    assert not free.plastic_indentation.any()
    assert capped.plan.includes("plastic")
    assert capped.max_pressure == H < free.max_pressure
    assert capped.contact_area > free.contact_area
    assert capped.status is rf.Status.CONVERGED


def test_off_is_elastic_and_says_so() -> None:
    s, soft = rf.solve(ROUGH, 32, plastic=False), rf.solve(hard(None), 32)
    assert np.array_equal(s.pressure, soft.pressure)
    warned = next(w for w in s.warnings if isinstance(w, ModelWarning) and w.limit is Limit.HARDNESS)
    assert "set plastic = true" in warned
    assert "A is at least P/H" in warned
    assert "plasticity not checked" in " ".join(soft.warnings)
    assert Limit.HARDNESS not in limits(soft)


def test_notes_of_a_capped_solution() -> None:
    s = rf.solve(ROUGH, 32)
    told = " ".join(s.warnings)
    assert not {"peak pressure", "plasticity index"} & limits(s)
    assert "the upper body has no hardness" in told
    assert f"{s.plastic_share:.1%} of the contact area is at the hardness" in told
    assert "growth of junctions" in told


def test_error_bars_at_the_hardness() -> None:
    """The maximum pressure is known; the plastic area has the bar of its edge, which a finer grid meets."""
    coarse, fine = rf.solve(ROUGH, 64), rf.solve(ROUGH, 128)
    assert sum(coarse.uncertainty["max_pressure"].values()) == 0
    bar = sum(coarse.uncertainty["plastic_area"].values())
    assert 0 < abs(coarse.plastic_area - fine.plastic_area) < bar < 0.5 * coarse.plastic_area
    assert coarse.summary()["plastic_share"] == coarse.plastic_area / coarse.contact_area


def test_indentation_is_where_pressures_are_capped() -> None:
    s = rf.solve(ROUGH, 32)
    at_cap = s.pressure == H
    assert np.count_nonzero(at_cap) * s.grid.element_area == pytest.approx(s.plastic_area)
    assert not s.plastic_indentation[~at_cap].any()
    assert s.plastic_indentation[at_cap].min() >= 0
    K = s.slopes.cosine_product
    # with the indentation the bodies fit: v - approach + w_p / K vanishes where pressures are capped
    assert np.abs(s.details.clearance + s.plastic_indentation / K)[at_cap].max() < 1e-12


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("method", ["dense", "fft"])
def test_no_contact_bears_more_than_the_hardness(method: str, periodic: bool) -> None:
    most = H * 1e-6
    scene = replace(FLATS, periodic=periodic, friction=rf.Friction(15e6, 0.1))
    with pytest.raises(rf.InputError) as refused:
        rf.solve(replace(scene, load=most * (1 + 1e-9)), 8)
    assert refused.value.field == "load"
    assert rf.solve(replace(scene, load=1.01 * most), 8, plastic=False).converged
    s = rf.solve(replace(scene, load=most), 8, method=method, oblique=False)  # type: ignore[arg-type]
    assert s.converged
    assert s.pressure == pytest.approx(np.full((8, 8), H), rel=1e-9)
    assert s.friction_coefficient == pytest.approx(15e6 / H + 0.1, rel=1e-9)
    assert s.contact_area == pytest.approx(1e-6)
    if method == "dense":  # which keeps one element free, at the hardness but for rounding
        assert s.plastic_area >= s.contact_area - 1.5 * s.grid.element_area
        return
    assert s.plastic_area == s.contact_area
    assert math.isinf(sum(s.uncertainty["approach"].values()))
    assert "the approach is not unique" in " ".join(s.warnings)


def test_a_load_that_slopes_do_not_carry_says_how_much_they_carry() -> None:
    rough = rf.Body(STEEL, rf.GaussianRoughness(20e-6, 100e-6, seed=1))
    scene = replace(ROUGH, upper=rough, lower=rf.Body(COPPER, rf.Flat()), periodic=True)
    s = rf.solve(replace(scene, load=0.9999 * H * 1e-6), 12)
    assert not s.converged
    assert any("at the hardness everywhere the contact carries" in text for text in s.warnings)
    below = replace(scene, load=0.995 * s.normal_force)
    for method in ("fft", "dense"):
        assert rf.solve(below, 12, method=method, plastic=True).converged  # type: ignore[arg-type]


def test_capped_elements_that_bear_too_much_leave_by_their_depth() -> None:
    """Rigid-plastic: rough by far more than pressures at the hardness move; scaling all would free all."""
    z = 10e-6 * np.random.default_rng(1).standard_normal((10, 10))
    scene = replace(hard(5e4, FLATS), periodic=True, friction=rf.Friction(beta=0.2))
    scene = replace(scene, lower=rf.Body(scene.lower.material, z), load=0.9999 * 5e4 * 1e-6)
    s = rf.solve(scene, 10, plastic=True)
    assert s.converged
    assert s.plastic_share > 0.97


def test_the_scene_chooses() -> None:
    off = replace(ROUGH, plastic=False)
    assert not rf.solve(off, 16).plan.includes("plastic")
    assert rf.solve(off, 16, plastic=True).plan.includes("plastic")
    with pytest.raises(rf.InputError, match="plastic"):
        replace(ROUGH, plastic=1)
    assert Options(scene=off, grid=8, requested=Terms()).requested.plastic is False


def test_sensitivities_of_a_capped_solution() -> None:
    """At the fixed set as two solves have it: with steps so small that no element changes its state."""
    scene = replace(ROUGH, friction=rf.Friction(0.0, 0.2))
    s = rf.solve(scene, 32, tolerance=1e-12)
    assert 0.1 < s.plastic_share < 0.9
    d = rf.sensitivity(scene, s, ["load", "lower.material.hardness", "lower.material.E"])
    assert d.relative("max_pressure", "lower.material.hardness") == pytest.approx(1.0, rel=1e-9)
    assert d.derivatives["max_pressure"]["load"] == 0
    for name in ("lower.material.hardness", "lower.material.E"):
        value, step = d.parameters[name], 1e-6
        low, high = (
            rf.solve(with_parameter(scene, name, value * (1 + sign * step)), 32, tolerance=1e-13)
            for sign in (-1, 1)
        )
        for number in ("friction_coefficient_corrected", "binormal_force"):
            difference = (getattr(high, number) - getattr(low, number)) / (2 * step * value)
            assert d.derivatives[number][name] == pytest.approx(difference, rel=2e-3), (name, number)


def test_at_an_approach_the_scenes_load_limits_nothing() -> None:
    beyond = replace(FLATS, load=2 * H * 1e-6)
    with pytest.raises(rf.InputError):
        rf.solve(beyond, 4)
    assert rf.solve(beyond, 4, approach=1e-9).converged


def test_more_than_one_plastic_state_carries() -> None:
    """A ridge of 27 degrees, all at the hardness: 0.958 H A0 at the least approach, more at others."""
    x = (np.arange(16) + 0.5) / 16 * 1e-3
    z = np.where(x < 4e-4, 6e-4 + 0.5 * (x - 2e-4), -0.5 * (x - 7e-4))
    ridge = rf.Body(rf.Material(1e13, 0.3), rf.surfaces.ArraySurface(np.repeat(z[:, None], 16, 1)))
    flat = rf.Body(rf.Material(1e13, 0.3, hardness=1e8), rf.Flat())
    scene = rf.Scene(flat, ridge, rf.Friction(5e7, 0.3), 0.967 * 1e8 * 1e-6, side=1e-3, plastic=True)
    assert rf.solve(scene, 16).converged
