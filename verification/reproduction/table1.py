"""The paper's pair of Table 1 (a steel ball on copper) as scenes, and its smooth limit by Hertz."""

from __future__ import annotations

import math
from dataclasses import replace

import refimpl as rf
from refimpl.scene.scene_file import read_scene
from verification.exact.hertz import Sphere
from verification.reproduction.printed import CORRELATION_LENGTH

RADIUS = 0.14  # m
SMOOTH = read_scene("table1-smooth")
FIRST_SEED = 2001  # as in the shipped studies: realisation k has the seeds FIRST_SEED + 2 k and + 1


def rough(
    lower_rms: float,
    upper_rms: float = 0.0,
    realisation: int = 0,
    *,
    friction: rf.Friction | None = None,
    load: float = SMOOTH.load,
    sliding_direction: float = 0.0,
    radius: float = RADIUS,
) -> rf.Scene:
    """Return Table 1 with roughness (m) on the flat and on the sphere; each realisation scaled to its rms."""
    ball = rf.Body(SMOOTH.upper.material, rf.Sphere(radius))

    def body(name: str, rms: float, seed: int) -> rf.Body:
        smooth = ball if name == "upper" else SMOOTH.lower
        if rms == 0:
            return smooth
        roughness = rf.GaussianRoughness(rms, CORRELATION_LENGTH, seed, normalise=True)
        return rf.Body(smooth.material, smooth.surface + roughness)

    return replace(
        SMOOTH,
        upper=body("upper", upper_rms, FIRST_SEED + 2 * realisation),
        lower=body("lower", lower_rms, FIRST_SEED + 2 * realisation + 1),
        friction=SMOOTH.friction if friction is None else friction,
        load=load,
        sliding_direction=sliding_direction,
    )


def coupling() -> float:
    """Return ``c0`` of `verification.exact.coupled_indentation` (1/Pa), from the moduli as printed."""

    def factor(m: rf.Material) -> float:
        return (1 + m.nu) * (1 - 2 * m.nu) / (2 * math.pi * m.E)

    return factor(SMOOTH.lower.material) - factor(SMOOTH.upper.material)


def hertz(load: float = SMOOTH.load, radius: float = RADIUS) -> Sphere:
    """Return the smooth, frictionless contact with Table 1's moduli."""
    return Sphere(load, radius, SMOOTH.materials.reduced_modulus)
