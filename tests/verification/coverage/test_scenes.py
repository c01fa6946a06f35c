"""Random scenes of the study of error bars: every number within the range that its class promises."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from tests.verification.coverage.draws import fills
from verification.coverage.scenes import CLASSES, random_scene
from verification.coverage.shapes import Barrel, Waves, measured_like

SIDE = 1e-3
DRAWN = {
    kind: [random_scene(8 * k + place) for k in range(40)] for place, kind in enumerate(CLASSES)
}  # classes take turns
ALL = [drawn for several in DRAWN.values() for drawn in several]
BALLS = [kind for kind in CLASSES if not kind.startswith("periodic")]


def modulus(one: rf.Scene) -> float:
    return 1 / sum((1 - body.material.nu**2) / body.material.E for body in (one.upper, one.lower))


def part(one: rf.Scene, name: str, kind: type) -> Any:
    (found,) = [part for part in one.parts(name) if isinstance(part, kind)]
    return found


def contact(one: rf.Scene) -> tuple[float, float]:
    """Radius of contact of the ball and its approach (m), by Hertz: a^3 = 3 P R / (4 E*), a^2 / R."""
    R = part(one, "upper", rf.Sphere).radius
    a = (0.75 * one.load * R / modulus(one)) ** (1 / 3)
    return a, a**2 / R


def test_classes_take_turns_on_one_square() -> None:
    for kind, several in DRAWN.items():
        assert {drawn.kind for drawn in several} == {kind}
        assert {drawn.scene.lengths for drawn in several} == {(SIDE, SIDE)}
        assert {drawn.scene.periodic for drawn in several} == {kind.startswith("periodic")}


def test_materials_and_friction() -> None:
    """A fifth of the pairs are of one material; a fifth has no tau, a fifth no beta, and a tenth neither."""
    for name in ("upper", "lower"):
        assert fills([getattr(drawn.scene, name).material.E for drawn in ALL], 2e9, 400e9)
        assert fills([getattr(drawn.scene, name).material.nu for drawn in ALL], 0.1, 0.49, logarithmic=False)
    alike = np.mean([drawn.scene.upper.material == drawn.scene.lower.material for drawn in ALL])
    no_tau, no_beta = (
        np.array([getattr(d.scene.friction, name) == 0 for d in ALL]) for name in ("tau", "beta")
    )
    for share, expected in (
        (alike, 0.2), (no_tau.mean(), 0.2), (no_beta.mean(), 0.2), ((no_tau & no_beta).mean(), 0.1)
    ):  # fmt: skip
        assert abs(share - expected) < 3 * math.sqrt(expected / 320)  # three standard deviations at least
    assert fills([d.scene.friction.beta for d in ALL if d.scene.friction.beta], 0.01, 0.4)
    assert fills([d.scene.sliding_direction for d in ALL], 0, 2 * math.pi, logarithmic=False)


@pytest.mark.parametrize("kind", [kind for kind in BALLS if kind != "barrel"])
def test_balls_touch_on_a_part_of_the_side(kind: str) -> None:
    """P = 4 E* a^3 / (3 R): a is 0.08 to 0.3 of the side, R 2 to 100 of it; tau up to 0.3 of P / (pi a^2)."""
    scenes = [drawn.scene for drawn in DRAWN[kind]]
    assert fills([contact(one)[0] / SIDE for one in scenes], 0.08, 0.3)
    assert fills([part(one, "upper", rf.Sphere).radius / SIDE for one in scenes], 2, 100)
    means = [one.load / (math.pi * contact(one)[0] ** 2) for one in scenes]
    shares = [one.friction.tau / mean for one, mean in zip(scenes, means, strict=True) if one.friction.tau]
    assert fills(shares, 0.003, 0.3)


def test_barrels() -> None:
    """Radii R / k and R k, k^2 from 1.5 to 10, under 1 / k of the load that a ball of R would touch a by."""
    ratios, contacts, radii = [], [], []
    for drawn in DRAWN["barrel"]:
        barrel = part(drawn.scene, "upper", Barrel)
        R = math.sqrt(barrel.across * barrel.along)
        ratios.append(barrel.along / barrel.across)
        radii.append(R / SIDE)
        load = drawn.scene.load * math.sqrt(ratios[-1])
        contacts.append((0.75 * load * R / modulus(drawn.scene)) ** (1 / 3) / SIDE)
    assert fills(ratios, 1.5, 10)
    assert fills(radii, 2, 100)
    assert fills(contacts, 0.08, 0.3)


def test_wavy_balls() -> None:
    waves = [(part(d.scene, "lower", Waves), contact(d.scene)[1]) for d in DRAWN["wavy ball"]]
    assert fills([wave.amplitude / approach for wave, approach in waves], 0.02, 0.5)
    for axis in (0, 1):
        numbers = [wave.numbers[axis] for wave, _ in waves]
        assert (min(numbers), max(numbers)) == (2, 11)
        assert fills([wave.phases[axis] for wave, _ in waves], 0, 2 * math.pi, logarithmic=False)
    assert any(wave.numbers[0] != wave.numbers[1] for wave, _ in waves)


@pytest.mark.parametrize(
    ("kind", "name", "most", "odd"),
    [("rough ball", "lower", 0.6, 0), ("both rough", "upper", 0.3, 0), ("both rough", "lower", 0.3, 1)],
)
def test_rough_balls(kind: str, name: str, most: float, odd: int) -> None:
    """Seeds of roughness are twice the scene's, and one more of the lower body where both are rough."""
    rough = [(part(d.scene, name, rf.GaussianRoughness), contact(d.scene)[1], d.seed) for d in DRAWN[kind]]
    assert fills([one.rms / approach for one, approach, _ in rough], 0.01, most)
    assert fills([one.correlation_length / SIDE for one, *_ in rough], 0.05, 0.3)
    assert [one.seed for one, *_ in rough] == [2 * seed + odd for *_, seed in rough]


def test_arrays_that_look_measured() -> None:
    arrays = [
        (part(d.scene, "upper", rf.ArraySurface).data, contact(d.scene)[1]) for d in DRAWN["measured-like"]
    ]
    assert fills([z.std() / approach for z, approach in arrays], 0.01, 0.4)
    sizes = [len(z) for z, _ in arrays]
    assert all(z.shape == (len(z), len(z)) for z, _ in arrays)
    assert fills(sizes, 48, 160, logarithmic=False)


def spectrum(z: Array) -> tuple[Array, Array]:
    """Waves per side, and the size of the Fourier coefficient there."""
    q = np.fft.fftfreq(len(z)) * len(z)
    return np.hypot(q[:, None], q[None, :]), np.abs(np.fft.fft2(z))


def test_heights_that_look_measured_are_self_affine_and_worn() -> None:
    """The mean spectrum falls by 2^1.7 from 8 to 16 waves at a Hurst exponent of 0.7, is level below the
    roll-off, and ends at a quarter of the points; summits are blunter than valleys are.
    """
    rng = np.random.default_rng(3)
    drawn = [measured_like(rng, 96, 1e-6, 0.7, roll_off=6) for _ in range(60)]
    q = spectrum(drawn[0])[0]
    power = np.mean([spectrum(z)[1] ** 2 for z in drawn], axis=0)
    levels = {k: math.sqrt(float(power[np.abs(q - k) < 0.5].mean())) for k in (2, 4, 5, 8, 16, 28)}
    assert levels[8] / levels[16] == pytest.approx(2**1.7, rel=0.15)
    assert levels[2] / levels[5] == pytest.approx(1, rel=0.15)
    assert levels[28] < 0.2 * levels[16]
    assert np.mean([float(((z - z.mean()) ** 3).mean()) for z in drawn]) < -0.3e-18


def test_repeated_waves_press_up_to_two_thirds_of_what_flattens_them() -> None:
    """A wave of amplitude g in both directions is flat under sqrt(2) pi E* g / l (Johnson 1985); n waves to a
    side have l = side / n, and g is the drawn amplitude over n: so what flattens them is n times less.
    """
    shares, amplitudes, numbers = [], [], []
    for drawn in DRAWN["periodic waves"]:
        one, wave = drawn.scene, part(drawn.scene, "upper", Waves)
        (n, same) = wave.numbers
        assert n == same
        numbers.append(n)
        amplitudes.append(wave.amplitude * n / SIDE)
        flattening = math.sqrt(2) * math.pi * modulus(one) * wave.amplitude * n / SIDE
        shares.append(one.load / SIDE**2 / flattening)
    assert set(numbers) == {1, 2, 3}
    assert fills(amplitudes, 1e-4, 1e-2)
    assert fills(shares, 0.02, 0.66)


def test_repeated_rough_planes() -> None:
    """A rms gradient g of sqrt(2) sqrt(4.6) rms / l; loads of 0.02 to 0.2 E* g, tau up to 0.3 of 0.4 E* g."""
    rough, loads, taus = [], [], []
    for drawn in DRAWN["periodic rough"]:
        one, surface = drawn.scene, part(drawn.scene, "upper", rf.GaussianRoughness)
        assert surface.seed == 2 * drawn.seed
        rough.append(surface)
        pressure = modulus(one) * math.sqrt(9.2) * surface.rms / surface.correlation_length
        loads.append(one.load / SIDE**2 / pressure)
        taus += [one.friction.tau / (0.4 * pressure)] if one.friction.tau else []
    assert fills([surface.rms / SIDE for surface in rough], 1e-4, 3e-3)
    assert fills([surface.correlation_length / SIDE for surface in rough], 0.08, 0.4)
    assert fills(loads, 0.02, 0.2)
    assert fills(taus, 0.003, 0.3)


def test_heights_of_barrels_and_waves() -> None:
    """A barrel's middle is the domain's; at x = 0.25, y = 0.1 of 1 x 0.4 mm, moved by 0.05 and 0.02 mm, it is
    0.2 mm from it along x and 0.08 mm along y. Waves there, 3 and 2: 0.9 and 0.6 of a turn.
    """
    grid = rf.Grid((2, 2), (1e-3, 4e-4))
    barrel = Barrel(across=2e-2, along=5e-2).heights(grid, (5e-5, 2e-5))
    assert barrel[0, 0] == pytest.approx(4e-8 / 4e-2 + 64e-10 / 0.1)
    waves = Waves(2e-6, (3, 2), (0.3, 0.5)).heights(grid, (5e-5, 2e-5))
    expected = math.cos(1.8 * math.pi + 0.3) + math.cos(1.2 * math.pi + 0.5)
    assert waves[0, 0] == pytest.approx(2e-6 * expected)
