"""Derivatives with respect to the numbers of random roughness, and which of them have one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from refimpl.scene.parameters import check_tolerances, differentiable_parameters, parameters, with_parameter
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
    free, periodic = (
        {
            name.partition("].")[2]
            for name in differentiable_parameters(scene(FRACTAL, periodic=p))
            if name.startswith("lower.surface")
        }
        for p in (False, True)
    )
    assert free == {"rms", "hurst", "anisotropy", "lay"}
    assert periodic == {"rms", "hurst"}
    for name in ("seed", "roll_off", "long_cut", "short_cut"):
        assert f"lower.surface[0].{name}" in parameters(scene(FRACTAL))
        with pytest.raises(rf.InputError, match=name):
            check_tolerances(scene(FRACTAL), {f"lower.surface[0].{name}": 0.1})
    two = differentiable_parameters(scene(GROUND, periodic=True))
    assert sum(name.startswith("lower.surface") for name in two) == 4
    one = replace(GROUND, correlation_length=3e-4)
    found = differentiable_parameters(scene(one, periodic=True))
    assert [n for n in found if n.startswith("lower.surface")] == ["lower.surface[0].rms"]


def test_every_number_can_be_changed_by_name() -> None:
    for surface in (GROUND, FRACTAL):
        here = scene(surface)
        for name, value in parameters(here).items():
            other = value + 4 if name.endswith(".seed") else 0.95 * value
            changed = parameters(with_parameter(here, name, other))
            assert changed.pop(name) == pytest.approx(other)
            assert changed.items() <= parameters(here).items()


def test_scenes_keep_roughness_through_toml(tmp_path: Path) -> None:
    for surface in (GROUND, FRACTAL, replace(GROUND, acf_level=0.2)):
        text = rf.scene_to_toml(scene(surface))
        path = tmp_path / "scene.toml"
        path.write_text(text)
        assert rf.read_scene(path).lower.surface == surface
