"""Scenes drawn by class: every number within the range that its class promises, and most of the range."""

from __future__ import annotations

import math
from itertools import product
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from tests.verification.coverage.draws import fills
from verification.coverage.class_scenes import (
    CLASSES,
    Wave,
    decimated,
    read_heights,
    scene,
    windows_of,
)
from verification.coverage.classes import summary

SEEDS = range(40)
DRAWN = {kind: [scene(kind, seed) for seed in SEEDS] for kind in CLASSES}


def roughness(one: rf.Scene) -> Any:
    (part,) = one.parts("lower")
    return part


def rms_gradient(one: rf.Scene) -> float:
    """Rms of |grad z| of the roughness by central differences on 128 elements along the longer side."""
    z, grid = roughness(one).sample(one.grid(128)), one.grid(128)
    dx, dy = grid.spacings
    if one.periodic:
        gx = (np.roll(z, -1, 0) - np.roll(z, 1, 0)) / (2 * dx)
        gy = (np.roll(z, -1, 1) - np.roll(z, 1, 1)) / (2 * dy)
    else:
        gx, gy = np.gradient(z, dx, dy)
    return math.sqrt(float((gx**2).mean() + (gy**2).mean()))


@pytest.mark.parametrize("kind", CLASSES)
def test_what_all_classes_share(kind: str) -> None:
    """One side is 1 mm long, the other at most that; materials, friction and loads span decades."""
    drawn = DRAWN[kind]
    assert {one.periodic for one in drawn} == {False, True}
    assert {max(one.lengths) for one in drawn} == {1e-3}
    assert {one.lengths[0] < one.lengths[1] for one in drawn} == {False, True}
    slender = [max(one.lengths) / min(one.lengths) for one in drawn]
    assert any(ratio == 1 for ratio in slender)
    assert fills([ratio for ratio in slender if ratio > 1], 1, 3)
    for body in ("upper", "lower"):
        assert fills([getattr(one, body).material.E for one in drawn], 2e9, 400e9)
        assert fills([getattr(one, body).material.nu for one in drawn], 0.1, 0.49, logarithmic=False)
    assert fills([one.friction.beta for one in drawn], 0.01, 0.3)
    hard = [one.lower.material.hardness is not None for one in drawn]
    assert all(hard) if kind == "capped" else not any(hard)


@pytest.mark.parametrize("kind", CLASSES)
def test_loads_and_tau(kind: str) -> None:
    """Repeated planes touch on 5 to 60 %, by P = E* g A / 2 (Bush et al.); a ball's radius of contact is 0.1
    to 0.3 of the shorter side and squared 1.5 to 30 rms heights times R. tau is 1 to 30 % of the pressure.
    """
    shares, radii, heights, taus = [], [], [], []
    for one in DRAWN[kind]:
        lower, upper = one.lower.material, one.upper.material
        modulus = 1 / ((1 - lower.nu**2) / lower.E + (1 - upper.nu**2) / upper.E)
        pressure = 0.5 * modulus * rms_gradient(one)
        if one.periodic:
            shares.append(one.load / (pressure * one.lengths[0] * one.lengths[1]))
        else:
            (ball,) = one.parts("upper")
            assert isinstance(ball, rf.Sphere)
            a = (0.75 * one.load * ball.radius / modulus) ** (1 / 3)
            radii.append(a / min(one.lengths))
            heights.append(a**2 / ball.radius / float(np.std(roughness(one).sample(one.grid(128)))))
            pressure = max(pressure, one.load / (math.pi * a**2))
        taus.append(one.friction.tau / pressure)
        if (hardness := lower.hardness) is not None:
            assert hardness * one.lengths[0] * one.lengths[1] >= (2 - 1e-12) * one.load
            assert hardness > (0.7 - 1e-12) * pressure
    assert fills(shares, 0.05, 0.6)
    assert fills(radii, 0.1, 0.3)
    assert fills(heights, 1.5, 30)
    assert fills(taus, 0.01, 0.3)


@pytest.mark.parametrize("kind", ["isotropic", "capped"])
def test_isotropic_roughness(kind: str) -> None:
    lengths = [roughness(one).correlation_length / min(one.lengths) for one in DRAWN[kind]]
    assert fills(lengths, 0.05, 0.25)


@pytest.mark.parametrize("kind", [kind for kind in CLASSES if "lay" in kind])
def test_lays(kind: str) -> None:
    """Along or across an axis that the body slides on, or 12 to 78 degrees off both; 3 to 10 times longer."""
    lengths = [np.array(roughness(one).correlation_length) / min(one.lengths) for one in DRAWN[kind]]
    assert fills([across for _, across in lengths], 0.05, 0.15)
    assert max(along for along, _ in lengths) <= 0.9 + 1e-12
    assert fills([along / across for along, across in lengths if along < 0.9 - 1e-12], 3, 10)
    turned = [math.degrees(one.sliding_direction - roughness(one).lay) % 180 for one in DRAWN[kind]]
    if "oblique" in kind:
        assert fills([math.degrees(roughness(one).lay) for one in DRAWN[kind]], 12, 78, logarithmic=False)
        assert fills([one.sliding_direction for one in DRAWN[kind]], 0, 2 * math.pi, logarithmic=False)
    else:
        expected = 0.0 if "along" in kind else 90.0
        assert all(abs((turn - expected + 90) % 180 - 90) < 1e-6 for turn in turned)
        assert {round(math.degrees(one.sliding_direction)) for one in DRAWN[kind]} == {0, 90, 180, 270}


def test_grooves() -> None:
    waves = [roughness(one) for one in DRAWN["grooves"]]
    assert {(wave.number, wave.axis) for wave in waves} == set(product((1, 2, 3, 4), (0, 1)))
    assert fills([wave.phase for wave in waves], 0, 2 * math.pi, logarithmic=False)


def test_heights_of_grooves() -> None:
    """3 waves along y on 0.6 mm: one is 0.2 mm long; at y = 0.05 mm, moved by 0.01 mm, it has turned 108
    degrees, and 0.4 rad.
    """
    grid = rf.Grid((2, 6), (1e-3, 6e-4))
    z = Wave(2e-6, 3, 0.4, axis=1).heights(grid, (7e-5, 1e-5))
    assert z[:, 0] == pytest.approx(np.full(2, 2e-6 * math.cos(math.radians(108) + 0.4)))
    z = Wave(2e-6, 1, 0.4, axis=0).heights(grid, (7e-5, 1e-5))  # at 0.25 and 0.07 mm of 1: 115.2 degrees
    assert z[0] == pytest.approx(np.full(6, 2e-6 * math.cos(math.radians(115.2) + 0.4)))


def test_self_affine_roughness() -> None:
    drawn = [(roughness(one), min(one.lengths)) for one in DRAWN["self-affine"]]
    assert fills([part.roll_off / side for part, side in drawn], 0.15, 0.4)
    assert fills([part.long_cut / part.roll_off for part, _ in drawn], 1, 2)
    assert fills([part.roll_off / part.short_cut for part, _ in drawn], 4, 10)
    assert fills([part.hurst for part, _ in drawn], 0.5, 1, logarithmic=False)


class Told:
    """A generator of random integers that are told, and the bounds that were asked for."""

    def __init__(self, *numbers: int) -> None:
        self.numbers, self.asked = list(numbers), list[tuple[int, ...]]()

    def integers(self, *bounds: int) -> int:
        self.asked.append(bounds)
        return self.numbers.pop(0)


MAP: Array = np.random.default_rng(8).gamma(2.0, 3e-6, (310, 420))


@pytest.mark.parametrize(
    ("whole", "told", "asked"),
    [
        (False, (120, 17, 300), [(100, 301), (191,), (301,)]),
        (True, (54, 0), [(55,), (165,)]),  # 256 points: the first of both bounds is out of the map
    ],
)
def test_windows_of_a_map(whole: bool, told: tuple[int, ...], asked: list[tuple[int, ...]]) -> None:
    """A square of free heights from anywhere in the map, with 0.1 um rms about zero."""
    draw: Any = SimpleNamespace(rng=Told(*told), size=(1e-3, 4e-4), periodic=True)
    surface: Any = windows_of(MAP, whole=whole)(draw)
    assert draw.rng.asked == asked
    assert (draw.size, draw.periodic) == ((1e-3, 1e-3), False)
    i, j, points = (54, 0, 256) if whole else (17, 300, 120)
    expected = MAP[i : i + points, j : j + points]
    assert (surface.data.mean(), surface.data.std()) == (pytest.approx(0, abs=1e-18), pytest.approx(1e-7))
    assert np.corrcoef(surface.data.ravel(), expected.ravel())[0, 1] == pytest.approx(1, abs=1e-12)


def test_a_map_smaller_than_a_window_is_taken_whole() -> None:
    draw: Any = SimpleNamespace(rng=Told(300, 0, 30), size=(1e-3, 1e-3), periodic=False)
    surface: Any = windows_of(MAP[:90, :120])(draw)
    assert draw.rng.asked[1:] == [(1,), (31,)]
    assert surface.data.shape == (90, 90)


@pytest.mark.parametrize(("seed", "step", "elements"), [(6, 2, 256), (9, 4, 128)])
def test_decimated_maps(seed: int, step: int, elements: int) -> None:
    """Every second or fourth of 256 points, on a grid of two elements a point; all else as it was."""
    whole = scene("map", seed, {"map": windows_of(MAP, whole=True)})
    thin, grid = decimated(whole, seed)
    before, after = roughness(whole).data, roughness(thin).data
    assert after.shape == (256 // step, 256 // step)
    assert (after[3, 5], after[20, 0]) == (before[3 * step, 5 * step], before[20 * step, 0])
    assert grid == elements
    for name in ("upper", "friction", "load", "lengths", "periodic", "sliding_direction"):
        assert getattr(thin, name) == getattr(whole, name)
    assert thin.lower.material == whole.lower.material


def test_heights_of_a_map_at_its_own_points(tmp_path: Path) -> None:
    """Heights as they stand in the file, 5 x 4 points of 2 um, written from the top."""
    heights = np.random.default_rng(2).uniform(-3e-7, 5e-7, (5, 4))
    head = "# Channel: Topography\n# Width: 10 \xb5m\n# Height: 8 \xb5m\n# Value units: m\n"
    rows = "\n".join("\t".join(f"{z:.9e}" for z in line) for line in heights.T[::-1])
    (tmp_path / "map.txt").write_bytes((head + rows + "\n").encode("latin-1"))
    read = read_heights(tmp_path / "map.txt")
    assert read.shape == (5, 4)
    plane = read - heights  # levelled or not: what differs is a plane
    i, j = np.indices(read.shape)
    fit = np.stack([np.ones(20), i.ravel(), j.ravel()], axis=1)
    assert np.linalg.lstsq(fit, plane.ravel(), rcond=None)[1] == pytest.approx(0, abs=1e-28)


def test_bars_that_hold_more_often_than_they_need_are_no_failure() -> None:
    """All of 100: p is 1, for only too few count. 90 of 100: P(at most 90, each at 92 %) is 0.2780."""
    row = {"error": 0.1, "bar": 0.2, "reference_bound": 0.0}
    missed = row | {"error": 0.3}
    assert summary(100 * [row])["p"] == pytest.approx(1.0)
    assert summary(90 * [row] + 10 * [missed])["p"] == pytest.approx(0.2780, abs=5e-5)
