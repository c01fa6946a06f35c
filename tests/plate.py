"""The test plate: a worn steel plate as a profilometer exports it, beside its known continuous surface.

A ball presses on it. What a user's map has and a formula has not is added one by one: tilt, spikes, missing
points, scars. So every number from the map has a truth, that of the surface itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.surfaces import Surface

PITCH = 1.6e-6  # m
POINTS = (500, 375)
STEEL = rf.Material(E=210e9, nu=0.3, hardness=3e9)
FRICTION = rf.Friction(tau=60e6, beta=0.10)
BALL = rf.Sphere(3e-3)


def lengths(points: tuple[int, int] = POINTS) -> tuple[float, float]:
    """Edges of a map of so many points (m)."""
    return points[0] * PITCH, points[1] * PITCH


def worn(seed: int = 1, short_cut: float = 8 * PITCH, rms: float = 0.39e-6) -> Surface:
    """The plate's continuous surface: self-affine down to ``short_cut`` (m), by default band-limited."""
    return rf.SelfAffineRoughness(
        hurst=0.8, rms=rms, roll_off=100e-6, long_cut=200e-6, short_cut=short_cut, seed=seed
    )


def scene(plate: Surface, load: float = 10.0, points: tuple[int, int] = POINTS) -> rf.Scene:
    bodies = rf.Body(STEEL, BALL), rf.Body(STEEL, plate)
    return rf.Scene(*bodies, friction=FRICTION, load=load, size=lengths(points))


@dataclass(frozen=True)
class Dirt:
    """What an instrument and a workshop add to a map: numbers of spikes, holes and scars; the tilt."""

    tilt: tuple[float, float] = (2e-3, -1e-3)
    spikes: int = 60  # single points, 2 to 8 um
    holes: int = 800  # missing points
    scars: int = 0  # whole lines along x that stand out by 0.5 to 2 um


CLEAN = Dirt(tilt=(0.0, 0.0), spikes=0, holes=0)


def sampled(plate: Surface, dirt: Dirt, points: tuple[int, int] = POINTS, seed: int = 7) -> Array:
    """Heights of the plate at the points (m), as the instrument gives them; missing ones NaN."""
    z = plate.sample(Grid(points, lengths(points)))
    draw = np.random.default_rng(seed)
    x, y = (PITCH * np.arange(n) for n in points)
    z = z + dirt.tilt[0] * x[:, None] + dirt.tilt[1] * y
    places = draw.choice(z.size, dirt.spikes + dirt.holes, replace=False)
    z.flat[places[: dirt.spikes]] += draw.uniform(2e-6, 8e-6, dirt.spikes)
    z[:, draw.choice(points[1], dirt.scars, replace=False)] += draw.uniform(0.5e-6, 2e-6, dirt.scars)
    z.flat[places[dirt.spikes :]] = np.nan
    return z


def write(z: Array, path: Path, unit: float = 1e-6) -> Path:
    """Write the map as a matrix of text without a header, a line for each x, in a unit (m)."""
    np.savetxt(path, z / unit, fmt="%.6g", delimiter=";")
    return path


def measured(path: Path, **keys: object) -> rf.MeasuredSurface:
    given: dict[str, object] = {"unit": "um", "pixel_size": PITCH} | keys
    return rf.MeasuredSurface(path, **given)  # type: ignore[arg-type]  # keys of several types
