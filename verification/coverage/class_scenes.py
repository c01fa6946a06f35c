"""Random scenes by class for the study of error bars: roughness, lays, grooves, maps, caps, borders."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.materials import Pair
from verification.coverage.drawing import SIDE, Ball, Dice, Wave, measured_like
from verification.output.files import Progress

RMS = 1e-7  # m


class _Draw(Dice):
    """The random choices of a scene that its class does not make."""

    def __init__(self, kind: str, seed: int) -> None:
        super().__init__(38, *kind.encode(), seed)
        self.seed = int(self.rng.integers(2**31))
        self.periodic, ratio = bool(self.rng.integers(2)), self.rng.choice([1.0, self.log(1.0, 3.0)])
        self.size = (SIDE, SIDE / ratio) if self.rng.integers(2) else (SIDE / ratio, SIDE)
        self.lower, self.upper = (
            rf.Material(E=self.log(2e9, 400e9), nu=float(self.rng.uniform(0.1, 0.49))) for _ in range(2)
        )
        self.modulus = Pair(lower=self.lower, upper=self.upper).reduced_modulus
        self.direction = self.angle()
        self.ball = not self.periodic  # presses the surface, instead of a flat
        self.pressed_share = 0.05, 0.6  # range of the load over that of full contact
        self.radii = 0.1, 0.3  # range of Hertz's contact radius over the shorter side

    def lengths(self) -> tuple[float, float]:
        """Correlation lengths of a lay, three to ten to one within the shorter side."""
        side = min(self.size)
        across = side * self.log(0.05, 0.15)
        return min(across * self.log(3, 10), 0.9 * side), across


Kind = Callable[[_Draw], rf.Surface]


def _isotropic(draw: _Draw) -> rf.Surface:
    return rf.GaussianRoughness(RMS, min(draw.size) * draw.log(0.05, 0.25), draw.seed)


def _lay(turn: float) -> Kind:
    """A lay at an angle (rad) to sliding, which is along an axis of the grid."""

    def lay(draw: _Draw) -> rf.Surface:
        draw.direction = float(draw.rng.integers(4)) * math.pi / 2
        return rf.GaussianRoughness(RMS, draw.lengths(), draw.seed, lay=(draw.direction + turn) % math.pi)

    return lay


def _oblique(draw: _Draw) -> rf.Surface:
    lengths, degrees = draw.lengths(), float(draw.rng.uniform(12, 78))
    return rf.GaussianRoughness(RMS, lengths, draw.seed, lay=math.radians(degrees))


def _grooves(draw: _Draw, *, zigzag: bool = False) -> rf.Surface:
    phase = draw.angle()
    number, along_y = int(draw.rng.integers(1, 5)), bool(draw.rng.integers(2))
    return Wave(RMS, (0, number) if along_y else (number, 0), phase, zigzag)


def _facets(draw: _Draw) -> rf.Surface:
    return _grooves(draw, zigzag=True)


def _strips(draw: _Draw) -> rf.Surface:
    """Grooves along a direction of small whole numbers on a square."""
    draw.size = (SIDE, SIDE)
    m, n = ((1, 1), (1, 2), (2, 1), (1, 3), (2, 3), (3, 2))[draw.rng.integers(6)]
    number = int(draw.rng.integers(1, 3))
    return Wave(RMS, (m * number, n * number * int(draw.rng.choice([-1, 1]))), draw.angle())


def _few_asperities(draw: _Draw) -> rf.Surface:
    return rf.GaussianRoughness(RMS, min(draw.size) * draw.log(0.25, 0.45), draw.seed)


def _cut_off(draw: _Draw) -> rf.Surface:
    draw.periodic = draw.ball = False
    return _isotropic(draw)


def _few_elements(draw: _Draw) -> rf.Surface:
    """A smooth ball whose contact is a few elements wide."""
    draw.periodic, draw.ball, draw.radii = False, True, (0.02, 0.06)
    return rf.Flat()


def _slender(draw: _Draw) -> rf.Surface:
    draw.size = (SIDE, SIDE / 4) if draw.rng.integers(2) else (SIDE / 4, SIDE)
    return rf.GaussianRoughness(RMS, min(draw.size) * draw.log(0.2, 0.6), draw.seed)


def _nearly_full(draw: _Draw) -> rf.Surface:
    draw.periodic, draw.ball, draw.pressed_share = True, False, (1.5, 5.0)
    return _isotropic(draw)


def _data(draw: _Draw) -> rf.Surface:
    draw.size, draw.periodic, draw.ball = (SIDE, SIDE), False, True
    points, hurst = int(draw.rng.integers(100, 301)), float(draw.rng.uniform(0.6, 0.9))
    return rf.ArraySurface(measured_like(draw.rng, points, RMS, hurst, roll_off=int(draw.rng.integers(3, 7))))


def _self_affine(draw: _Draw) -> rf.Surface:
    roll_off = min(draw.size) * draw.log(0.15, 0.4)
    return rf.SelfAffineRoughness(
        hurst=float(draw.rng.uniform(0.5, 1.0)),
        rms=RMS,
        roll_off=roll_off,
        long_cut=roll_off * draw.log(1.0, 2.0),
        short_cut=roll_off / draw.log(4, 10),
        seed=draw.seed,
    )


CLASSES: dict[str, Kind] = {
    "isotropic": _isotropic,
    "lay along sliding": _lay(0.0),
    "lay across sliding": _lay(math.pi / 2),
    "lay oblique to the grid": _oblique,
    "grooves": _grooves,
    "self-affine": _self_affine,
    "capped": _isotropic,
    "facets": _facets,
    "strips between the axes": _strips,
    "few asperities": _few_asperities,
    "cut off by the border": _cut_off,
    "few elements": _few_elements,
    "4:1 rectangles": _slender,
    "nearly full": _nearly_full,
    "ball on data": _data,
}


MEASURED, DECIMATED = "windows of a measured map", "decimated maps"
WHOLE = 256  # points of a window that is decimated


def read_heights(path: Path) -> Array:
    """Return the heights of a measured surface at its own points (m)."""
    surface = rf.MeasuredSurface(path)
    lengths = surface.extent((0.0, 0.0))
    pitch = surface.pitch(lengths)
    shape = round(lengths[0] / pitch), round(lengths[1] / pitch)
    return surface.sample(rf.Grid(shape, lengths))


def windows_of(heights: Array, *, whole: bool = False) -> Kind:
    """Return the class of random square windows of a measured map, at one rms height: 100 to 300 points, or
    `WHOLE`."""

    def window(draw: _Draw) -> rf.Surface:
        points = WHOLE if whole else min(int(draw.rng.integers(100, 301)), *heights.shape)
        i, j = (int(draw.rng.integers(length - points + 1)) for length in heights.shape)
        z = heights[i : i + points, j : j + points]
        draw.size, draw.periodic = (SIDE, SIDE), False
        return rf.ArraySurface(RMS * (z - z.mean()) / z.std())

    return window


def decimated(one: rf.Scene, seed: int) -> tuple[rf.Scene, int]:
    """Return the scene with every second or fourth point of its map, and a grid of two elements a point."""
    step = (2, 4)[seed % 2]
    z = one.lower.surface.parts[0].sample(one.grid(WHOLE))[::step, ::step]
    return replace(one, lower=rf.Body(one.lower.material, rf.ArraySurface(z))), 2 * len(z)


def options(module: str, description: str | None, scenes: int) -> argparse.ArgumentParser:
    """Return the options of a study by class: seeds, a measured map, and the file to write."""
    parser = argparse.ArgumentParser(
        prog=f"python -m verification.coverage.{module}", description=description
    )
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--scenes", type=int, default=scenes, help="of each class")
    parser.add_argument("--map", type=Path, help="a measured surface, of which windows are a class more")
    parser.add_argument("--json", type=Path, required=True)
    return parser


def each(classes: Mapping[str, Kind], first: int, scenes: int) -> Iterator[tuple[str, int]]:
    """Yield class and seed of every scene, with a line of progress."""
    progress = Progress(len(classes) * scenes)
    for kind in classes:
        for seed in range(first, first + scenes):
            yield kind, seed
            progress.tick(f"{kind}, {seed}")
    progress.close()


def scene(kind: str, seed: int, classes: Mapping[str, Kind] = CLASSES) -> rf.Scene:
    """Return the scene of a seed: its class's roughness on a flat, or under a ball where it is free."""
    draw = _Draw(kind, seed)
    surface = classes[kind](draw)
    probe = rf.Scene(
        upper=rf.Body(draw.upper, rf.Flat()),
        lower=rf.Body(draw.lower, surface),
        friction=rf.Friction(),
        load=1.0,
        size=draw.size,
        periodic=draw.periodic,
    )
    grid = probe.grid(128)
    slope = math.sqrt(sum(float(np.mean(g**2)) for g in grid.gradient(surface.sample(grid))))
    height = float(np.std(surface.sample(grid)))
    if not draw.ball:
        pressed = 0.5 * draw.modulus * slope  # in contact, by Bush et al. 1975
        share = draw.log(*draw.pressed_share)
        return _with_friction(draw, kind, probe, share * pressed * SIDE * min(draw.size), pressed)
    a = min(draw.size) * draw.log(*draw.radii)
    height = height or a / 1500  # a ball on a flat has 50 to 1000 times the contact's radius
    ball = Ball(draw.modulus, a**2 / (height * draw.log(1.5, 30)), a)
    pressed = max(ball.pressure, 0.5 * draw.modulus * slope)
    under = replace(probe, upper=rf.Body(draw.upper, rf.Sphere(ball.R)))
    return _with_friction(draw, kind, under, ball.load, pressed)


def _with_friction(draw: _Draw, kind: str, base: rf.Scene, load: float, pressed: float) -> rf.Scene:
    friction = rf.Friction(tau=pressed * draw.log(0.01, 0.3), beta=draw.log(0.01, 0.3))
    lower = base.lower
    if kind == "capped":
        H = max(pressed * draw.log(0.7, 3), 2 * load / (base.lengths[0] * base.lengths[1]))
        lower = rf.Body(replace(lower.material, hardness=H), lower.surface)
    return replace(base, lower=lower, friction=friction, load=load, sliding_direction=draw.direction)
