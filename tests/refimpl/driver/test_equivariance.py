"""Bars, derivatives and plans go with the scene: mirrored, turned, turned over, moved on where it repeats.

Numbers themselves are for the invariants of `verification.properties`; here is what is said of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from refimpl.solution.quantities import REPORTED
from verification.coverage.scenes import random_scene

M = 24


@dataclass(frozen=True)
class Image:
    """How heights ``(lower, upper)`` and the sliding direction change, and with them the sign of Q."""

    heights: Callable[[Array, Array], tuple[Array, Array]]
    direction: Callable[[float], float]
    binormal: int = 1
    swapped: bool = False
    periodic: bool = False


IMAGES = {
    "mirrored": Image(lambda low, up: (low[:, ::-1], up[:, ::-1]), lambda angle: -angle, -1),
    "transposed": Image(lambda low, up: (low.T, up.T), lambda angle: math.pi / 2 - angle, -1),
    "turned": Image(lambda low, up: (np.rot90(low), np.rot90(up)), lambda angle: angle + math.pi / 2),
    "turned over": Image(lambda low, up: (-up, -low), lambda angle: angle + math.pi, swapped=True),
    "moved": Image(
        lambda low, up: (np.roll(low, (5, 9), (0, 1)), np.roll(up, (5, 9), (0, 1))),
        lambda angle: angle,
        periodic=True,
    ),
}


def scene_of(seed: int, image: Image | None = None) -> rf.Scene:
    """The random scene of a seed on its grid's heights, or its image."""
    scene = random_scene(seed).scene
    low, up = (body.surface.sample(scene.grid(M)) for body in (scene.lower, scene.upper))
    lower, upper, angle = scene.lower.material, scene.upper.material, scene.sliding_direction
    if image is not None:
        low, up = image.heights(low, up)
        angle = image.direction(angle)
        lower, upper = (upper, lower) if image.swapped else (lower, upper)
    bodies = {"lower": rf.Body(lower, np.array(low)), "upper": rf.Body(upper, np.array(up))}
    return replace(scene, **bodies, sliding_direction=angle)


def renamed(parameter: str, image: Image) -> str:
    """A parameter's name where bodies change places."""
    body, dot, rest = parameter.partition(".")
    other = {"lower": "upper", "upper": "lower"}
    return f"{other[body]}{dot}{rest}" if image.swapped and body in other else parameter


@pytest.mark.parametrize(
    ("seed", "name"),
    [
        (seed, name)
        for seed in (9000, 9001)
        for name, image in IMAGES.items()
        if random_scene(seed).scene.periodic or not image.periodic
    ],
)
def test_what_is_said_of_an_image_is_said_of_the_scene(seed: int, name: str) -> None:
    image, scene = IMAGES[name], scene_of(seed)
    pictured = scene_of(seed, image)
    one, other = (rf.solve(s, M, tolerance=1e-11) for s in (scene, pictured))
    for number in set(REPORTED) - {"normal_force"}:
        sign, unit = (image.binormal if number == "binormal_force" else 1), unit_of(one, number)
        assert sign * getattr(other, number) == pytest.approx(getattr(one, number), rel=1e-7, abs=1e-9 * unit)
        for part in set(one.uncertainty[number]) - {"iteration"}:  # of residuals as small as rounding
            bars = (solution.uncertainty[number][part] for solution in (one, other))
            assert next(bars) == pytest.approx(next(bars), rel=2e-4, abs=1e-9 * unit), (number, part)
    assert [str(w.limit) for w in other.warnings] == [str(w.limit) for w in one.warnings]
    for here, there in zip(one.plan.terms, other.plan.terms, strict=True):
        assert (there.name, there.included) == (here.name, here.included)
        assert there.effect.larger == pytest.approx(here.effect.larger, rel=1e-4, abs=1e-12)
    found, mirrored = rf.sensitivity(scene, one), rf.sensitivity(pictured, other)
    for number, row in found.derivatives.items():
        sign, unit = (image.binormal if number == "binormal_force" else 1), unit_of(one, number)
        for parameter, derivative in row.items():
            scale = unit / found.parameters[parameter]  # of a derivative of logarithms
            there = sign * mirrored.derivatives[number][renamed(parameter, image)]
            assert there == pytest.approx(derivative, rel=1e-3, abs=1e-5 * scale), (number, parameter)


def unit_of(solution: rf.Solution, number: str) -> float:
    """What a number is small beside: forces beside the load, mu beside one, others beside themselves."""
    force, share = solution.normal_force, 1.0
    units = {"binormal_force": force, "friction_force": force, "friction_coefficient": share}
    return units.get(number, abs(getattr(solution, number)))
