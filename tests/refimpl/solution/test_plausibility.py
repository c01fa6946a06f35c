"""Notes on inputs that are seldom meant: each on both sides of its limit, and about the body it is of."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.scene.scene_file import scene_from_dict
from refimpl.solution.model_warning import Limit, ModelWarning
from refimpl.solution.plausibility import implausible

SIZE = (3e-3, 2e-3)
STEEL, BRASS = rf.Material(210e9, 0.28, hardness=6e9), rf.Material(105e9, 0.35, hardness=2e9)
ROUGH = rf.GaussianRoughness(rms=1e-6, correlation_length=2e-4, seed=4)
SCENE = rf.Scene(
    upper=rf.Body(STEEL, rf.Flat()),
    lower=rf.Body(BRASS, ROUGH),
    friction=rf.Friction(tau=3e7, beta=0.1),
    load=11.0,
    size=SIZE,
)


def notes(scene: rf.Scene, *, mean_pressure: float = 1e9) -> list[str]:
    plan: Any = SimpleNamespace(contact=SimpleNamespace(mean_pressure=mean_pressure))
    return list(implausible(scene, plan))


def with_body(body: str, one: rf.Body, scene: rf.Scene = SCENE) -> rf.Scene:
    changes: dict[str, Any] = {body: one}
    return replace(scene, **changes)


def changed(body: str, **material: Any) -> rf.Scene:
    one: rf.Body = getattr(SCENE, body)
    return with_body(body, rf.Body(replace(one.material, **material), one.surface))


def self_affine(short_cut: float) -> rf.SelfAffineRoughness:
    return rf.SelfAffineRoughness(
        hurst=0.7, rms=1e-6, roll_off=40e-3, long_cut=50e-3, short_cut=short_cut, seed=2
    )


def test_what_is_usual_is_not_remarked_on() -> None:
    assert notes(SCENE) == []


ROOT = Path(__file__).parents[3]
PAGES = [
    block
    for page in ROOT.glob("docs/*.md")
    for block in re.findall(r"```toml.*?\n(.*?)```", page.read_text(), re.S)
]
PUBLISHED = [
    *map(rf.read_scene, rf.shipped_scenes()),
    *map(rf.read_scene, sorted(ROOT.glob("verification/experiments/scenes/*.toml"))),
    *(
        scene_from_dict(tomllib.loads(text), ROOT)
        for text in PAGES
        if "[friction]" in text and "path" not in text
    ),
]


@pytest.mark.parametrize("scene", PUBLISHED, ids=range(len(PUBLISHED)))
def test_no_published_scene_is_implausible(scene: rf.Scene) -> None:
    assert [text for text in rf.solve(scene, 32).warnings if text.limit == Limit.INPUT] == []


@pytest.mark.parametrize("body", ["lower", "upper"])
@pytest.mark.parametrize(
    ("E", "says"),
    [
        (0.99e6, "did you mean GPa or MPa (200 GPa is 200e9)?"),
        (1.01e6, None),
        (1.99e12, None),
        (2.01e12, "a rigid body is E = rigid"),
        (math.inf, None),
    ],
)
def test_moduli_from_gels_to_twice_diamond(body: str, E: float, says: str | None) -> None:
    scene = changed(body, E=E, hardness=None)
    found = notes(replace(scene, friction=rf.Friction(tau=1e3, beta=0.1)), mean_pressure=1e6)
    expected = [f"{body}.E, {E:.4g} Pa, is outside 1e+06 to 2e+12 Pa: {says}"]
    assert found == ([] if says is None else expected)


@pytest.mark.parametrize("body", ["lower", "upper"])
def test_hardness_between_tau_and_a_fifth_of_the_modulus(body: str) -> None:
    """tau is 30 MPa; a fifth of 210 and 105 GPa is 42 and 21 GPa."""
    fifth = {"upper": 42e9, "lower": 21e9}[body]
    assert notes(changed(body, hardness=0.999 * fifth)) == []
    (note,) = notes(changed(body, hardness=1.001 * fifth))
    assert note.startswith(f"{body}.hardness, {1.001 * fifth:.4g} Pa, is above a fifth of E")
    assert notes(changed(body, hardness=3.003e7)) == []
    (note,) = notes(changed(body, hardness=2.997e7))
    assert note == f"{body}.hardness, 2.997e+07 Pa, is below tau, 3e+07 Pa: are both in Pa?"
    assert notes(changed(body, hardness=None)) == []


def test_tau_of_ten_mean_pressures() -> None:
    assert notes(SCENE, mean_pressure=3.01e6) == []
    (note,) = notes(SCENE, mean_pressure=2.5e6)
    assert note.startswith("tau, 3e+07 Pa, is 12 times the mean contact pressure")
    assert "MPa" in note
    assert notes(SCENE, mean_pressure=0.0) == []


@pytest.mark.parametrize("body", ["lower", "upper"])
@pytest.mark.parametrize(
    ("surface", "says"),
    [
        (rf.Sphere(3.01e-3), None),
        (rf.Sphere(2.99e-3), "radius 0.00299 m is below the domain's 0.003 m: a paraboloid"),
        (replace(ROUGH, correlation_length=1.99e-3), None),
        (replace(ROUGH, correlation_length=2.01e-3), "correlation_length 0.00201 m is beyond the domain's"),
        (replace(ROUGH, correlation_length=(1e-4, 2.5e-3)), "correlation_length[1] 0.0025 m is beyond"),
        (self_affine(1.9e-3), None),
        (
            self_affine(2.1e-3),
            "short_cut 0.0021 m is beyond the domain's 0.002 m: did you mean um",
        ),
    ],
)  # fmt: skip
def test_lengths_beyond_the_domain(body: str, surface: rf.Surface, says: str | None) -> None:
    one: rf.Body = getattr(SCENE, body)
    found = notes(with_body(body, rf.Body(one.material, surface)))
    assert len(found) == (says is not None)
    assert all(note.startswith(f"{body}: {says}") for note in found)


def test_heights_beyond_the_domain() -> None:
    """Without a hardness: with one the plasticity index would be remarked on as well."""
    flat = rf.Body(replace(BRASS, hardness=None), replace(ROUGH, rms=2.1e-3))
    upper = rf.Body(replace(STEEL, hardness=None), rf.Flat())
    (note,) = notes(replace(SCENE, lower=flat, upper=upper))
    assert note == "lower: rms 0.0021 m is beyond the domain's 0.002 m: did you mean um?"
    assert notes(replace(SCENE, lower=replace(flat, surface=replace(ROUGH, rms=1.9e-3)), upper=upper)) == []


def test_the_plasticity_index_is_that_of_both_bodies_slopes() -> None:
    """Slopes sqrt(2 * 2.3) rms / l of each body add in squares: 0.10724 and 0.14299 make 0.17873. With
    1 / E* = (1 - 0.28^2) / 210 + (1 - 0.35^2) / 105 = 0.012746 per GPa 1000 at an H of 14.02 MPa.
    """
    rough = replace(
        SCENE,
        upper=rf.Body(STEEL, replace(ROUGH, rms=1e-5)),
        lower=rf.Body(BRASS, replace(ROUGH, rms=1e-5, correlation_length=1.5e-4)),
        friction=rf.Friction(tau=1e6, beta=0.1),
    )
    for body, other in (("lower", "upper"), ("upper", "lower")):
        one: rf.Body = getattr(rough, body)
        less, more = (replace(one, material=replace(one.material, hardness=H)) for H in (13.9e6, 14.2e6))
        (note,) = notes(with_body(body, less, rough))
        assert note.startswith("plasticity index 1.01e+03 is beyond 1000: units of E, hardness")
        assert notes(with_body(body, more, rough)) == []
        alone: rf.Body = getattr(rough, other)
        without = replace(alone, material=replace(alone.material, hardness=None))
        assert len(notes(with_body(other, without, with_body(body, less, rough)))) == 1


def test_a_tau_without_effect_asks_for_its_unit() -> None:
    """0.1 of beta: 60 Pa of a mean pressure of 1 GPa are nothing, 60 MPa are three eighths of mu."""
    law = [rf.Friction(tau=tau, beta=0.1) for tau in (60.0, 60e6, 0.0)]
    found = [notes(replace(SCENE, friction=one)) for one in law]
    assert ["MPa" in " ".join(lines) for lines in found] == [True, False, False]


def test_an_implausible_input_is_a_warning_not_a_note() -> None:
    turned = replace(SCENE, sliding_direction=45.0)
    (found,) = (w for w in rf.solve(turned, 24).warnings if "did you mean" in w)
    assert isinstance(found, ModelWarning)
    assert (found.limit, found.number, found.allowed) == (Limit.INPUT, 45.0, pytest.approx(2 * math.pi, 1e-3))


@pytest.mark.parametrize("body", ["lower", "upper"])
def test_every_angle_beyond_a_full_turn_asks_for_degrees(body: str) -> None:
    for lay, says in ((30.0, 1), (6.28, 0), (-6.28, 0), (-7.0, 1)):
        found = notes(with_body(body, rf.Body(STEEL, replace(ROUGH, lay=lay))))
        assert len(found) == says
        assert all(note.startswith(f"{body}: lay, {lay:.4g} rad, is beyond a full turn") for note in found)
        assert all("did you mean degrees" in note for note in found)


def test_a_beta_in_per_cent_or_in_place_of_tau() -> None:
    for beta, says in ((2.01, 1), (1.99, 0)):
        found = notes(replace(SCENE, friction=rf.Friction(tau=3e7, beta=beta)))
        assert len(found) == says
        assert all("per cent" in note and "Friction(tau, beta)" in note for note in found)
    with pytest.raises(rf.InputError, match="order is tau, beta"):
        rf.Friction(0.08, 15e6)


def test_a_tau_beyond_the_pressures_of_a_large_domain_asks_for_metres() -> None:
    for size, unit in ((0.09, False), (0.11, True)):
        (note,) = notes(replace(SCENE, size=(size, size)), mean_pressure=2.5e6)
        assert ("are lengths in m (1 mm is 1e-3)" in note) == unit


def test_a_refused_number_of_the_scene_comes_with_what_is_implausible() -> None:
    """Moduli and hardness in MPa: the load is what cannot be, its cause are the pressures."""
    soft = replace(SCENE, lower=rf.Body(rf.Material(105e3, 0.35, hardness=0.2), ROUGH))
    with pytest.raises(rf.InputError, match=r"^load = .*; lower.E, 1.05e\+05 Pa, is outside .* GPa or MPa"):
        rf.solve(replace(soft, friction=rf.Friction(tau=0.03, beta=0.1)), 16)
    far = replace(SCENE, size=(300.0, 300.0), lower=rf.Body(BRASS, rf.Flat()))
    far = with_body("upper", rf.Body(STEEL, rf.Sphere(0.01)), far)
    with pytest.raises(rf.InputError, match=r"^upper.surface = .*is pixel_size, or the domain's size, in m"):
        rf.solve(far, 16)
    with pytest.raises(rf.InputError, match=r"^grid = (?!.*radius)"):  # no number of the scene
        rf.solve(far, -1)


def test_a_domain_of_hundred_balls_asks_for_the_unit_of_the_pixel() -> None:
    for size, unit in ((0.99, False), (1.01, True)):
        scene = replace(SCENE, upper=rf.Body(STEEL, rf.Sphere(0.01)), size=(size, size))
        (note,) = (line for line in notes(scene) if "radius" in line)
        assert ("is pixel_size, or the domain's size, in m (1 um is 1e-6)?" in note) == unit


def test_a_load_beyond_the_hardness_asks_for_mN_where_they_would_fit() -> None:
    """2e9 Pa on 6 mm^2 bear 12 kN."""
    for load, fits in ((11.9e6, True), (12.1e6, False)):
        with pytest.raises(rf.InputError, match=r"^load = ") as refused:
            rf.solve(replace(SCENE, load=load), 16)
        assert ("load in mN?" in str(refused.value)) == fits


def test_a_load_beyond_the_hardness_names_a_domain_of_nanometres() -> None:
    hard = rf.Body(rf.Material(E=210e9, nu=0.3, hardness=3e9), rf.Flat())
    scene = rf.Scene(hard, hard, friction=rf.Friction(), load=10.0, size=(256e-9, 256e-9))
    with pytest.raises(rf.InputError, match="units of the map"):
        rf.solve(scene, 16)


@pytest.mark.parametrize(
    ("unit", "pixel", "bound"), [("m", 1e-6, 10.0), ("nm", 1e-3, 1e-4), ("um", 1e-6, None)]
)
def test_a_slope_of_a_wrong_unit_is_a_warning(
    tmp_path: Path, unit: str, pixel: float, bound: float | None
) -> None:
    """White noise of 0.1 m, nm or um: the rms gradient is 0.2 over the pixel, 2e5, 2e-7 and 0.2."""
    np.save(tmp_path / "a.npy", 0.1 * np.random.default_rng(2).normal(size=(40, 40)))
    surface = rf.MeasuredSurface(tmp_path / "a.npy", unit=unit, pixel_size=pixel)
    scene = with_body("lower", rf.Body(BRASS, surface), replace(SCENE, size=(40 * pixel, 40 * pixel)))
    found: Any = [line for line in notes(scene) if "is unit right?" in line]
    assert [(one.limit, one.allowed) for one in found] == ([] if bound is None else [(Limit.INPUT, bound)])
    assert any("rms slope" in line for line in rf.inspect_surface(surface).document()["notes"]) == bool(bound)
