"""Derivatives with respect to the numbers of random roughness, and which of them have one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.scene.parameters import check_tolerances, moving, parameters, with_parameter
from refimpl.sensitivities.sensitivity import sensitivity

STEEL, POLYMER = rf.Material(E=200e9, nu=0.3), rf.Material(E=2.5e9, nu=0.38)
M, TIGHT = 48, 1e-11
GROUND = rf.GaussianRoughness(rms=2e-6, correlation_length=(600e-6, 300e-6), seed=3, lay=0.4)
FRACTAL = rf.SelfAffineRoughness(
    hurst=0.8, rms=2e-6, roll_off=8e-4, long_cut=1.6e-3, short_cut=2e-4, seed=3, anisotropy=1.5, lay=0.4
)


def scene(surface: rf.Surface, *, periodic: bool = False) -> rf.Scene:
    return rf.Scene(
        upper=rf.Body(STEEL, rf.Flat() if periodic else rf.Sphere(radius=0.02)),
        lower=rf.Body(POLYMER, surface),
        friction=rf.Friction(beta=0.2),
        load=20.0,
        side=1.61e-3,
        sliding_direction=0.7,
        periodic=periodic,
    )


CASES = [
    (GROUND, ("rms", "correlation_length[0]", "correlation_length[1]", "lay")),
    (FRACTAL, ("rms", "hurst", "anisotropy", "lay")),
    (
        rf.SelfAffineRoughness(**{**FRACTAL.parameters(), "rms": None, "rms_gradient": 0.02}),
        ("rms_gradient", "hurst"),
    ),
]


@pytest.mark.parametrize(("surface", "names"), CASES, ids=["Gaussian", "self-affine", "by gradient"])
def test_peak_pressure_follows_roughness(surface: rf.Surface, names: tuple[str, ...]) -> None:
    """Central differences of full solves over steps that leave the contact set as it is."""
    here = scene(surface)
    found = sensitivity(here, rf.solve(here, M, tolerance=TIGHT))
    for key in names:
        name, step = f"lower.surface[0].{key}", 1e-6
        value = parameters(here)[name]
        low, high = (
            rf.solve(with_parameter(here, name, value * (1 + s)), M, tolerance=TIGHT) for s in (-step, step)
        )
        assert np.array_equal(low.contact, high.contact)
        expected = (high.max_pressure - low.max_pressure) / (2 * step * value)
        scale = max(abs(expected), 1e-2 * found.found["max_pressure"] / value)
        assert abs(found.derivatives["max_pressure"][name] - expected) <= 1e-3 * scale, name


def test_hurst_exponents_stay_below_one() -> None:
    here = scene(FRACTAL.with_parameter("hurst", 1.0))
    found = sensitivity(here, rf.solve(here, M))
    assert np.isfinite(found.derivatives["contact_area"]["lower.surface[0].hurst"])


def test_what_makes_another_realisation_has_no_derivative() -> None:
    def moved(surface: rf.Surface, periodic: bool) -> set[str]:
        names = moving(scene(surface, periodic=periodic))
        return {name.partition("].")[2] for name in names if name.startswith("lower.surface")}

    assert moved(FRACTAL, False) == {"rms", "hurst", "anisotropy", "lay"}
    assert moved(FRACTAL, True) == {"rms", "hurst"}
    assert len(moved(GROUND, True)) == 4
    assert moved(replace(GROUND, correlation_length=3e-4), True) == {"rms"}
    for name in ("seed", "roll_off", "long_cut", "short_cut"):
        assert f"lower.surface[0].{name}" in parameters(scene(FRACTAL))
        with pytest.raises(rf.InputError, match=name):
            check_tolerances(scene(FRACTAL), {f"lower.surface[0].{name}": 0.1})
