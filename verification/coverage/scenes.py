"""Random scenes for the study of error bars: one a seed, each a continuous problem that knows no grid.

Sizes follow from scale-free numbers - contact radius over the side, rms over the Hertz approach, shear
strength over the mean pressure - so that contact is neither a few elements nor everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import refimpl as rf
from refimpl.model.materials import Pair
from verification.coverage.drawing import SIDE, Ball, Barrel, Dice, Waves, measured_like


@dataclass(frozen=True, eq=False)
class Drawn:
    """A random scene and the class it belongs to."""

    seed: int
    kind: str
    scene: rf.Scene


def random_scene(seed: int) -> Drawn:
    """Return the scene of a seed; the classes take turns."""
    kinds = tuple(CLASSES)
    kind = kinds[seed % len(kinds)]
    return Drawn(seed, kind, CLASSES[kind](_Dice(seed)))


class _Dice(Dice):
    """The random numbers of a scene, by what they mean."""

    def __init__(self, seed: int) -> None:
        super().__init__(2001, seed)
        self.seeds = 2 * seed, 2 * seed + 1  # seeds of both bodies' roughness
        lower, upper = self.material(), self.material()
        self.pair = Pair(lower=lower, upper=lower if self.rng.random() < 0.2 else upper)
        self.modulus = self.pair.reduced_modulus

    def friction(self, mean_pressure: float) -> rf.Friction:
        """Draw neither, one or both of tau and beta; tau up to a third of the mean pressure."""
        tau, beta = mean_pressure * self.log(0.003, 0.3), self.log(0.01, 0.4)
        kind = self.rng.random()
        return rf.Friction(tau=0.0 if kind < 0.1 or kind > 0.9 else tau, beta=0.0 if kind < 0.2 else beta)

    def scene(
        self, upper: rf.Surface, lower: rf.Surface, load: float, pressure: float, periodic: bool = False
    ) -> rf.Scene:
        """Join both surfaces on this pair of materials; friction by the mean pressure to be expected (Pa)."""
        return rf.Scene(
            upper=rf.Body(self.pair.upper, upper),
            lower=rf.Body(self.pair.lower, lower),
            friction=self.friction(pressure),
            load=load,
            side=SIDE,
            sliding_direction=self.angle(),
            periodic=periodic,
        )

    def ball(self) -> Ball:
        """Return a ball that touches on 0.08 to 0.3 of the side."""
        return Ball(self.modulus, SIDE * self.log(2, 100), SIDE * self.log(0.08, 0.3))

    def phases(self) -> tuple[float, float]:
        """Return the phases along x and y (rad)."""
        return self.angle(), self.angle()


def _smooth(dice: _Dice) -> rf.Scene:
    ball = dice.ball()
    return dice.scene(rf.Sphere(ball.R), rf.Flat(), ball.load, ball.pressure)


def _barrel(dice: _Dice) -> rf.Scene:
    """Draw a contact up to ten to one: nearly a cylinder, without the ends singular by Eq. (7)."""
    ball, ratio = dice.ball(), dice.log(1.5, 10)
    root = math.sqrt(ratio)
    shape = Barrel(ball.R / root, ball.R * root)
    return dice.scene(shape, rf.Flat(), ball.load / root, ball.pressure)


def _wavy(dice: _Dice) -> rf.Scene:
    ball = dice.ball()
    numbers = tuple(int(n) for n in dice.rng.integers(2, 12, 2))
    waves = Waves(ball.approach * dice.log(0.02, 0.5), (numbers[0], numbers[1]), dice.phases())
    return dice.scene(rf.Sphere(ball.R), waves, ball.load, ball.pressure)


def _rough_ball(dice: _Dice) -> rf.Scene:
    ball = dice.ball()
    rms, length = ball.approach * dice.log(0.01, 0.6), SIDE * dice.log(0.05, 0.3)
    rough = rf.GaussianRoughness(rms, length, dice.seeds[0])
    return dice.scene(rf.Sphere(ball.R), rough, ball.load, ball.pressure)


def _both_rough(dice: _Dice) -> rf.Scene:
    ball = dice.ball()
    upper, lower = (
        rf.GaussianRoughness(ball.approach * dice.log(0.01, 0.3), SIDE * dice.log(0.05, 0.3), seed)
        for seed in dice.seeds
    )
    return dice.scene(rf.Sphere(ball.R) + upper, lower, ball.load, ball.pressure)


def _measured(dice: _Dice) -> rf.Scene:
    ball, points = dice.ball(), int(dice.rng.integers(48, 161))
    rms, hurst = ball.approach * dice.log(0.01, 0.4), float(dice.rng.uniform(0.6, 0.9))
    heights = measured_like(dice.rng, points, rms, hurst, roll_off=int(dice.rng.integers(3, 7)))
    return dice.scene(rf.Sphere(ball.R) + heights, rf.Flat(), ball.load, ball.pressure)


def _periodic_waves(dice: _Dice) -> rf.Scene:
    """Draw bisinusoids up to two thirds of what flattens them, ``sqrt(2) pi E* amplitude / wavelength``."""
    number, amplitude = int(dice.rng.integers(1, 4)), SIDE * dice.log(1e-4, 1e-2)
    flattening = math.sqrt(2) * math.pi * dice.modulus * amplitude * number / SIDE
    mean = flattening * dice.log(0.02, 0.66)
    waves = Waves(amplitude / number, (number, number), dice.phases())
    return dice.scene(waves, rf.Flat(), mean / number * SIDE**2, 2 * mean, periodic=True)


def _periodic_rough(dice: _Dice) -> rf.Scene:
    """Draw rough planes; contact takes about ``2 p / (E* rms gradient)`` of the area (Bush et al. 1975)."""
    rough = rf.GaussianRoughness(SIDE * dice.log(1e-4, 3e-3), SIDE * dice.log(0.08, 0.4), dice.seeds[0])
    scale = dice.modulus * math.sqrt(2) * rough.rms_slope
    mean = scale * dice.log(0.02, 0.2)
    return dice.scene(rough, rf.Flat(), mean * SIDE**2, 0.4 * scale, periodic=True)


CLASSES: dict[str, Callable[[_Dice], rf.Scene]] = {
    "smooth ball": _smooth,
    "barrel": _barrel,
    "wavy ball": _wavy,
    "rough ball": _rough_ball,
    "both rough": _both_rough,
    "measured-like": _measured,
    "periodic waves": _periodic_waves,
    "periodic rough": _periodic_rough,
}
