"""Derivatives against finite differences, similarity laws and Hertz; those of roughness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.scene.parameters import check_tolerances, differentiable_parameters, parameters, with_parameter
from refimpl.sensitivities.difference_quotients import NUMBERS
from refimpl.sensitivities.sensitivity import friction_slopes, grid_sensitivity, sensitivity

STEEL, POLYMER = rf.Material(E=200e9, nu=0.3), rf.Material(E=2.5e9, nu=0.38)
M, TIGHT = 48, 1e-11
ROUGHNESS = rf.GaussianRoughness(rms=2e-6, correlation_length=400e-6, seed=3)


def sliding(tau: float = 0.0, periodic: bool = False, lower: rf.Surface = ROUGHNESS) -> rf.Scene:
    ball = rf.GaussianRoughness(2e-6, 400e-6, seed=1) if periodic else rf.Sphere(radius=0.02)
    return rf.Scene(
        upper=rf.Body(STEEL, ball),
        lower=rf.Body(POLYMER, lower),
        friction=rf.Friction(tau=tau, beta=0.2),
        load=20.0,
        side=1.61e-3,
        sliding_direction=0.7,
        periodic=periodic,
    )


def differences(scene: rf.Scene, name: str, step: float, **options: object) -> dict[str, float]:
    """Central differences of full solves, which must not change the contact set."""
    value = parameters(scene)[name]
    low, high = (
        rf.solve(with_parameter(scene, name, value * (1 + s)), M, tolerance=TIGHT, **options)
        for s in (-step, step)
    )
    assert np.array_equal(low.contact, high.contact)
    return {number: (getattr(high, number) - getattr(low, number)) / (2 * step * value) for number in NUMBERS}


@pytest.mark.parametrize("options", [{}, {"slope_correction": True}, {"oblique": False}], ids=str)
def test_smooth_numbers_agree_with_finite_differences(options: dict[str, bool]) -> None:
    scene = sliding()
    names = ["friction.beta", "lower.material.nu", "lower.surface[0].rms", "upper.surface[0].radius"]
    names = ["load", *names[: 2 if options else None]]
    found = sensitivity(scene, rf.solve(scene, M, tolerance=TIGHT, **options), names)
    for name in names:
        expected = differences(scene, name, 1e-5, **options)
        for number in ("friction_coefficient_corrected", "max_pressure", "binormal_force"):
            # GMRES leaves 1e-6 and the quotients' rounding 1e-5, of the number's own scale if larger
            scale = max(abs(expected[number]), abs(found.found[number] / found.parameters[name]))
            assert abs(found.derivatives[number][name] - expected[number]) <= 1e-4 * scale, (name, number)


def test_coupling_forced_out_stays_out() -> None:
    scene = sliding()
    twins = replace(scene, lower=rf.Body(STEEL, scene.lower.surface))
    moduli = ["upper.material.E", "lower.material.E"]
    kept, out = (
        sensitivity(twins, rf.solve(twins, M, tolerance=TIGHT, coupled=coupled), moduli)
        for coupled in (None, False)
    )
    for body in ("upper", "lower"):
        assert out.derivatives["max_pressure"][f"{body}.material.E"] == pytest.approx(
            sum(kept.derivatives["max_pressure"][f"{b}.material.E"] for b in ("upper", "lower")) / 2, rel=1e-4
        )


def test_hertz_exponents() -> None:
    scene = rf.read_scene("hertz")
    found = sensitivity(scene, rf.solve(scene, 128), ["upper.surface[0].radius"])
    exponents = {"load": (2 / 3, 1 / 3), "upper.surface[0].radius": (2 / 3, -2 / 3)}
    for name, (area, peak) in exponents.items():
        assert found.relative("max_pressure", name) == pytest.approx(peak, abs=2e-3)
        scatter = found.scatter["contact_area_corrected"][name] / abs(
            found.derivatives["contact_area_corrected"][name]
        )
        assert scatter < 0.1
        assert found.relative("contact_area_corrected", name) == pytest.approx(area, rel=scatter)


def test_an_incompressible_body_answers_to_its_ratio_from_below() -> None:
    """Without friction only 1/E* = sum (1 - nu^2)/E counts: d/dnu is 2 nu E/(1 - nu^2) times d/dE."""
    hertz = rf.read_scene("hertz")
    scene = replace(hertz, lower=rf.Body(rf.Material(2.5e9, 0.5), hertz.lower.surface))
    found = sensitivity(scene, rf.solve(scene, 32), ["lower.material.E", "lower.material.nu"])
    stiffer = found.derivatives["max_pressure"]["lower.material.E"]
    expected = 2 * 0.5 * 2.5e9 / (1 - 0.5**2) * stiffer
    assert found.derivatives["max_pressure"]["lower.material.nu"] == pytest.approx(expected, rel=1e-4)


def test_parameters_are_read_and_changed_by_name() -> None:
    scene = sliding(tau=1e6)
    for given in (scene, replace(scene, lower=rf.Body(POLYMER, FRACTAL))):
        for name, value in parameters(given).items():
            other = value + 4.0 if name.endswith(".seed") else 0.95 * value
            changed = parameters(with_parameter(given, name, other))
            assert changed.pop(name) == pytest.approx(other)
            assert changed.items() <= parameters(given).items()
    with pytest.raises(rf.InputError, match=r"upper\.colour"):
        with_parameter(scene, "upper.colour", 1.0)
    with pytest.raises(rf.InputError, match="load"):
        with_parameter(scene, "load", -1.0)


CORRELATION_LENGTH = "lower.surface[0].correlation_length"


def test_a_derivative_that_two_ways_disagree_on_says_so() -> None:
    """A surface that is stretched meets elsewhere: on few elements the sign of its answer is not known."""
    scene = rf.read_scene("metal-polymer")
    found = grid_sensitivity(scene, rf.solve(scene, 64), [CORRELATION_LENGTH])
    for number in ("max_pressure", "binormal_force"):
        scatter, derivatives = found.scatter[number], found.derivatives[number]
        assert 0 < scatter["load"] < 0.3 * abs(derivatives["load"])
        assert scatter[CORRELATION_LENGTH] > 0.2 * abs(derivatives[CORRELATION_LENGTH])


def test_where_all_contact_is_at_the_hardness_friction_follows_from_its_area() -> None:
    """F = tau A + beta N on flats: mu rises by A / P with tau and by one with beta."""
    copper = rf.Material(E=118e9, nu=0.3, hardness=1e9)
    flats = rf.Scene(
        upper=rf.Body(rf.Material(E=200e9, nu=0.3), rf.Flat()),
        lower=rf.Body(copper, rf.Flat()),
        friction=rf.Friction(tau=15e6, beta=0.1),
        load=1e9 * 2e-6,
        size=(1e-3, 2e-3),
    )
    solution = rf.solve(flats, (4, 8), oblique=False)
    assert solution.plastic_area == solution.contact_area
    assert friction_slopes(flats, solution) == pytest.approx((1 / 1e9, 1.0), rel=1e-9, abs=0)
    with pytest.raises(rf.InputError, match="all contact at the hardness"):
        sensitivity(flats, solution)


GROUND = rf.GaussianRoughness(rms=2e-6, correlation_length=(600e-6, 300e-6), seed=3, lay=0.4)
FRACTAL = rf.SelfAffineRoughness(
    hurst=0.8, rms=2e-6, roll_off=8e-4, long_cut=1.6e-3, short_cut=2e-4, seed=3, anisotropy=1.5, lay=0.4
)


CASES = [
    (GROUND, ("rms", "correlation_length[1]", "lay")),
    (FRACTAL, ("hurst", "anisotropy")),
]


@pytest.mark.parametrize(("surface", "names"), CASES, ids=["Gaussian", "self-affine"])
def test_peak_pressure_follows_roughness(surface: rf.Surface, names: tuple[str, ...]) -> None:
    scene = sliding(lower=surface)
    in_full = [f"lower.surface[0].{key}" for key in names]
    found = sensitivity(scene, rf.solve(scene, M, tolerance=TIGHT), in_full)
    for name in in_full:
        expected = differences(scene, name, 1e-6)["max_pressure"]
        scale = max(abs(expected), 1e-2 * found.found["max_pressure"] / found.parameters[name])
        assert abs(found.derivatives["max_pressure"][name] - expected) <= 1e-3 * scale, name


def test_what_makes_another_realisation_has_no_derivative() -> None:
    def moved(surface: rf.Surface, periodic: bool) -> set[str]:
        names = differentiable_parameters(sliding(periodic=periodic, lower=surface))
        return {name.partition("].")[2] for name in names if name.startswith("lower.surface")}

    assert moved(FRACTAL, False) == {"rms", "hurst", "anisotropy", "lay"}
    assert moved(FRACTAL, True) == {"rms", "hurst"}
    assert len(moved(GROUND, True)) == 4
    assert moved(replace(GROUND, correlation_length=3e-4), True) == {"rms"}
    for name in ("seed", "roll_off", "long_cut", "short_cut"):
        assert f"lower.surface[0].{name}" in parameters(sliding(lower=FRACTAL))
        with pytest.raises(rf.InputError, match=name):
            check_tolerances(sliding(lower=FRACTAL), {f"lower.surface[0].{name}": 0.1})


def test_contact_stiffness_of_a_ball_is_hertz() -> None:
    scene = replace(rf.read_scene("hertz"), friction=rf.Friction())
    found = sensitivity(scene, rf.solve(scene, 64), [])
    modulus, radius = scene.materials.reduced_modulus, 1 / scene.curvature
    hertz = 2 * modulus * (0.75 * scene.load * radius / modulus) ** (1 / 3)
    assert found.contact_stiffness == pytest.approx(hertz, rel=0.02)
