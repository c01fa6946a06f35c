"""Scenes drawn by class: every number within the range that its class promises, and most of the range."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

import refimpl as rf
from verification.coverage.class_scenes import CLASSES, scene


@cache
def drawn_of(kind: str, number: int = 20) -> list[rf.Scene]:
    return [scene(kind, seed) for seed in range(number)]


def fills(
    values: Sequence[float], low: float, high: float, *, outer: float, logarithmic: bool = True
) -> bool:
    """Whether values lie between the bounds, some in the outer share at each end."""
    places = np.log(values) if logarithmic else np.array(values)
    ends = np.log([low, high]) if logarithmic else np.array([low, high])
    place = (places - ends[0]) / (ends[1] - ends[0])
    return bool(-1e-9 <= place.min() < outer and 1 - outer < place.max() <= 1 + 1e-9)


class Range(NamedTuple):
    """A number of the scenes of a class, None of a scene without it, and the ends that its draws fill."""

    kind: str
    name: str
    of: Callable[[Any], float | None]
    low: float
    high: float
    logarithmic: bool = True

    def filled_by(self, drawn: Iterable[Any], outer: float) -> bool:
        """Whether the numbers of these scenes fill the range, some in the outer share at each end."""
        values = [value for one in drawn if (value := self.of(one)) is not None]
        return fills(values, self.low, self.high, outer=outer, logarithmic=self.logarithmic)


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


def slenderness(one: rf.Scene) -> float:
    return max(one.lengths) / min(one.lengths)


def share_of_plane(one: rf.Scene) -> float | None:
    """Share of a repeated plane in contact, by P = E* g A / 2 (Bush et al. 1975)."""
    area = one.lengths[0] * one.lengths[1]
    return one.load / (0.5 * modulus(one) * rms_gradient(one) * area) if one.periodic else None


def modulus(one: rf.Scene) -> float:
    return 1 / sum((1 - body.material.nu**2) / body.material.E for body in (one.lower, one.upper))


def contact_radius(one: rf.Scene) -> tuple[float, float] | None:
    """Radii of the ball and of its contact (m), by Hertz; None of a plane."""
    if one.periodic:
        return None
    (ball,) = one.parts("upper")
    assert isinstance(ball, rf.Sphere)
    return ball.radius, (0.75 * one.load * ball.radius / modulus(one)) ** (1 / 3)


def radius_share(one: rf.Scene) -> float | None:
    return found[1] / min(one.lengths) if (found := contact_radius(one)) else None


def pressure(one: rf.Scene) -> float:
    """Pressure in contact (Pa): of the roughness, or the mean one of the ball if that is more."""
    found = contact_radius(one)
    of_ball = one.load / (math.pi * found[1] ** 2) if found else 0.0
    return max(0.5 * modulus(one) * rms_gradient(one), of_ball)


OF_EVERY_CLASS = [
    ("E, upper", lambda one: one.upper.material.E, 2e9, 400e9),
    ("E, lower", lambda one: one.lower.material.E, 2e9, 400e9),
    ("nu, upper", lambda one: one.upper.material.nu, 0.1, 0.49, False),
    ("nu, lower", lambda one: one.lower.material.nu, 0.1, 0.49, False),
    ("beta", lambda one: one.friction.beta, 0.01, 0.3),
]
USUAL = [kind for kind in CLASSES if "lay" in kind]
USUAL += ["isotropic", "grooves", "self-affine", "capped", "facets"]
OF_USUAL_CLASSES = [
    ("slenderness", lambda one: slenderness(one) if slenderness(one) > 1 else None, 1, 3),
    ("tau", lambda one: one.friction.tau / pressure(one), 0.01, 0.3),
    ("share in contact", share_of_plane, 0.05, 0.6),
    ("a / side", radius_share, 0.1, 0.3),
]
RANGES = [
    *(Range(kind, *row) for kind in CLASSES for row in OF_EVERY_CLASS),
    *(Range(kind, *row) for kind in USUAL for row in OF_USUAL_CLASSES),
    Range("nearly full", "share in contact", share_of_plane, 1.5, 5),
    Range("few elements", "a / side", radius_share, 0.02, 0.06),
    Range("few elements", "R / a", lambda one: np.divide(*contact_radius(one)), 50, 1000),
    Range("lay oblique to the grid", "lay", lambda one: math.degrees(roughness(one).lay), 12, 78, False),
    Range("self-affine", "long cut", lambda one: roughness(one).long_cut / roughness(one).roll_off, 1, 2),
    Range("self-affine", "short cut", lambda one: roughness(one).roll_off / roughness(one).short_cut, 4, 10),
]


@pytest.mark.parametrize("kind", CLASSES)
def test_draws_fill_the_ranges_of_their_class(kind: str) -> None:
    """20 draws miss an outer third in 1 of 1700."""
    ranges = [one for one in RANGES if one.kind == kind]
    assert [one.name for one in ranges if not one.filled_by(drawn_of(kind), 1 / 3)] == []


@pytest.mark.parametrize("kind", USUAL)
def test_domains_and_hardness(kind: str) -> None:
    """One side is 1 mm long, the other at most that. Only the capped class yields, at no less than twice the
    mean pressure on the domain and 0.7 of the pressure in contact."""
    drawn = drawn_of(kind)
    assert {one.periodic for one in drawn} == {False, True}
    assert {max(one.lengths) for one in drawn} == {1e-3}
    assert {one.lengths[0] < one.lengths[1] for one in drawn} == {False, True}
    assert any(slenderness(one) == 1 for one in drawn)
    for one in drawn:
        hardness = one.lower.material.hardness
        assert (hardness is not None) == (kind == "capped")
        if hardness is not None:
            assert hardness * one.lengths[0] * one.lengths[1] >= (2 - 1e-12) * one.load
            assert hardness > (0.7 - 1e-12) * pressure(one)
