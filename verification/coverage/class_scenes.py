"""Random scenes by class for the study of error bars: roughness, lays, grooves, maps, caps, borders."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

import refimpl as rf
from refimpl.model.materials import Pair
from verification.coverage.drawing import SIDE, Ball, Dice, Wave, measured_like
from verification.coverage.textures import Pads, Profile, RoundedPunch

RMS = 1e-7  # m
GRIDS = 48, 64, 96, 128  # elements along the longer side of the grids that are judged
SIMPLE = (1, 0), (0, 1), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (3, 1), (2, 3), (3, -2)  # directions


class _Draw(Dice):
    """The random choices of a scene that its class does not make."""

    def __init__(self, kind: str, seed: int) -> None:
        super().__init__(38, *kind.encode(), seed)
        self.seed = int(self.rng.integers(2**31))
        self.periodic, ratio = bool(self.rng.integers(2)), self.rng.choice([1.0, self.log(1.0, 3.0)])
        self.size = (SIDE, SIDE / ratio) if self.rng.integers(2) else (SIDE / ratio, SIDE)
        self.lower, self.upper = self.material(), self.material()
        self.modulus = Pair(lower=self.lower, upper=self.upper).reduced_modulus
        self.direction = self.angle()
        self.ball = not self.periodic  # presses the surface, instead of a flat
        self.pressed_share = 0.05, 0.6  # range of the load over that of full contact
        self.radii = 0.1, 0.3  # range of Hertz's contact radius over the shorter side
        self.hardness = 0.7, 3.0  # range of a cap over the pressure
        self.slope: float | None = None  # rms gradient that sets the load, in place of the surface's
        self.other: rf.Surface | None = None  # roughness of the upper body
        self.known: tuple[float, float] | None = None  # load (N) and contact radius (m), in closed form

    def elements(self, low: float, high: float) -> float:
        """Return a length (m) of so many elements on one of `GRIDS`."""
        spacing = float(max(self.size)) / self.log(GRIDS[0], GRIDS[-1])
        return spacing * self.log(low, high)

    def lengths(self) -> tuple[float, float]:
        """Return the correlation lengths of a lay, three to ten to one within the shorter side."""
        side = min(self.size)
        across = side * self.log(0.05, 0.15)
        return min(across * self.log(3, 10), 0.9 * side), across


Kind = Callable[[_Draw], rf.Surface]


def _isotropic(draw: _Draw) -> rf.Surface:
    return rf.GaussianRoughness(RMS, min(draw.size) * draw.log(0.05, 0.25), draw.seed)


def _lay(turn: float) -> Kind:
    """Return a lay at an angle (rad) to sliding, which is along an axis of the grid."""

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


def _strips(draw: _Draw) -> rf.Surface:
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


def _textured(draw: _Draw, sign: float, number: int) -> rf.Surface:
    """Return pads or dimples 1 to 15 elements wide, or wider where few, with round or sharp rims."""
    draw.size = (SIDE, SIDE)
    cell = SIDE / number
    radius = min(0.5 * draw.elements(1, 15) if sign < 0 else cell * draw.log(0.15, 0.42), 0.42 * cell)
    rounded, square = bool(draw.rng.integers(2)), bool(draw.rng.random() < 0.3)
    rim = (0.48 * cell - radius) * draw.log(0.2, 1.0) if rounded else min(draw.elements(0.05, 1), 0.05 * cell)
    height = RMS * draw.log(1, 30)
    draw.slope = height / cell
    draw.ball = draw.ball or not draw.periodic
    return Pads(sign * height, (number, number), radius, rim, draw.seed, square, rounded)


def _pads(draw: _Draw) -> rf.Surface:
    return _textured(draw, 1.0, int(draw.rng.integers(1, 6)))


def _dimples(draw: _Draw) -> rf.Surface:
    return _textured(draw, -1.0, int(draw.rng.integers(2, 9)))


def _profile(draw: _Draw, shape: str) -> rf.Surface:
    draw.size = (SIDE, SIDE)
    m, n = SIMPLE[draw.rng.integers(4 if draw.rng.random() < 0.6 else len(SIMPLE))]
    number, top = int(draw.rng.integers(1, 5 if abs(m * n) < 2 else 3)), draw.log(0.1, 0.8)
    wall = min(draw.elements(0.2, 4) * math.hypot(m, n) * number / SIDE, 0.9 * (1 - top))
    height = RMS * draw.log(1, 10)
    draw.slope = height * number * math.hypot(m, n) / SIDE
    return Profile(shape, height, (m * number, n * number), float(draw.rng.random()), top, wall)


def _both_rough(draw: _Draw) -> rf.Surface:
    laws: list[Kind] = [_isotropic, _self_affine, _oblique, _grooves]
    lower, upper = (laws[k] for k in draw.rng.permutation(len(laws))[:2])
    surface: rf.Surface = lower(draw)
    other: rf.Surface = upper(draw)
    height = draw.log(0.2, 1.0)
    if isinstance(other, Wave):
        draw.other = replace(other, amplitude=height * RMS)
    else:
        draw.other = other.with_parameter("rms", height * RMS).with_parameter("seed", draw.seed + 1)
    return surface


def _short_waves(draw: _Draw) -> rf.Surface:
    short = draw.elements(0.3, 4)
    roll_off = max(min(draw.size) * draw.log(0.1, 0.4), 1.5 * short)
    return rf.SelfAffineRoughness(
        hurst=float(draw.rng.uniform(0.5, 1.0)),
        rms=RMS,
        roll_off=roll_off,
        long_cut=min(roll_off * draw.log(1.0, 2.0), min(draw.size)),
        short_cut=short,
        seed=draw.seed,
    )


def _mostly_contact(draw: _Draw) -> rf.Surface:
    draw.periodic, draw.ball, draw.pressed_share = True, False, (0.9, 2.2)
    return _isotropic(draw)


def _rounded_punch(draw: _Draw) -> rf.Surface:
    """Return a rounded punch between like bodies, of known contact radius and pressure."""
    draw.size, draw.periodic, draw.upper = (SIDE, SIDE), False, draw.lower
    draw.modulus = Pair(lower=draw.lower, upper=draw.lower).reduced_modulus
    a = SIDE * draw.log(0.08, 0.3)
    b = a * float(draw.rng.uniform(0.6, 0.98))
    x, y = (float(c) for c in draw.rng.uniform(-0.5, 0.5, 2) * (SIDE - 2.4 * a))
    punch = RoundedPunch(b, a / draw.log(1e-4, 1e-3), (x, y))
    draw.known = punch.load(a, draw.modulus), a
    return punch


def _beyond_yield(draw: _Draw) -> rf.Surface:
    """Return roughness, or a smooth flat under a ball, of which half or nearly all is at the hardness."""
    draw.hardness, draw.radii = (0.3, 1.0), (0.08, 0.22)
    return rf.Flat() if draw.ball and draw.rng.integers(2) else _isotropic(draw)


CLASSES: dict[str, Kind] = {
    "isotropic": _isotropic,
    "lay along sliding": _lay(0.0),
    "lay across sliding": _lay(math.pi / 2),
    "lay oblique to the grid": _oblique,
    "grooves": _grooves,
    "self-affine": _self_affine,
    "capped": _isotropic,
    "facets": partial(_grooves, zigzag=True),
    "strips between the axes": _strips,
    "few asperities": _few_asperities,
    "cut off by the border": _cut_off,
    "few elements": _few_elements,
    "4:1 rectangles": _slender,
    "nearly full": _nearly_full,
    "ball on data": _data,
    "rounded punches": _rounded_punch,
    "dimpled flats": _dimples,
    "steps": partial(_profile, shape="steps"),
    "saw teeth": partial(_profile, shape="teeth"),
    "pads": _pads,
    "both bodies rough": _both_rough,
    "short waves": _short_waves,
    "60 to 95 % contact": _mostly_contact,
    "capped dimples": _dimples,
    "ridges": partial(_profile, shape="ridges"),
    "capped beyond yield": _beyond_yield,
}


def scene(kind: str, seed: int) -> rf.Scene:
    """Return the scene of a seed: its class's roughness on a flat, or under a ball where it is free."""
    draw = _Draw(kind, seed)
    surface = CLASSES[kind](draw)
    probe = rf.Scene(
        upper=rf.Body(draw.upper, draw.other or rf.Flat()),
        lower=rf.Body(draw.lower, surface),
        friction=rf.Friction(),
        load=1.0,
        size=draw.size,
        periodic=draw.periodic,
    )
    if draw.known is not None:
        load, a = draw.known
        return _with_friction(draw, kind, probe, load, load / (math.pi * a**2))
    grid = probe.grid(128)
    z = surface.sample(grid) - (draw.other.sample(grid) if draw.other else 0.0)
    slope = draw.slope or math.sqrt(sum(float(np.mean(g**2)) for g in grid.gradient(z)))
    height = float(np.std(z))
    pressed = 0.5 * draw.modulus * slope  # in contact, by Bush et al. 1975
    if not draw.ball:
        share = draw.log(*draw.pressed_share)
        return _with_friction(draw, kind, probe, share * pressed * SIDE * min(draw.size), pressed)
    a = min(draw.size) * draw.log(*draw.radii)
    height = height or a / 1500  # a ball on a flat has 50 to 1000 times the contact's radius
    ball = Ball(draw.modulus, a**2 / (height * draw.log(1.5, 30)), a)
    shape: rf.Surface = rf.Sphere(ball.R)
    under = replace(probe, upper=rf.Body(draw.upper, shape + draw.other if draw.other else shape))
    return _with_friction(draw, kind, under, ball.load, max(ball.pressure, pressed))


def _with_friction(draw: _Draw, kind: str, base: rf.Scene, load: float, pressed: float) -> rf.Scene:
    friction = rf.Friction(tau=pressed * draw.log(0.01, 0.3), beta=draw.log(0.01, 0.3))
    lower = base.lower
    if kind.startswith("capped"):
        H = max(pressed * draw.log(*draw.hardness), 2 * load / (base.lengths[0] * base.lengths[1]))
        lower = rf.Body(replace(lower.material, hardness=H), lower.surface)
    return replace(base, lower=lower, friction=friction, load=load, sliding_direction=draw.direction)
