"""Invariants under changes of the frame, of the units, and of which body is called the upper one."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.properties.registry import Solver, invariant, require
from verification.properties.samples import SIDE, Sample, array_body, heights, samples, with_heights
from verification.properties.states import RESIDUAL, from_first_contact, solved

FORCES = ("normal_force", "friction_force")


def equal_states(moved: rf.Solution, pressure: Array, base: rf.Solution, sample: Sample, sign: float) -> None:
    """Require moved pressures to be ``pressure``, forces and approach ``base``'s; Q times ``sign``."""
    require(moved.converged)
    require(np.array_equal(moved.pressure > 0, pressure > 0))
    require(np.abs(moved.pressure - pressure).max() <= RESIDUAL * base.max_pressure)
    load = sample.scene.load
    for name in FORCES:
        require(abs(getattr(moved, name) - getattr(base, name)) <= RESIDUAL * load)
    require(abs(moved.binormal_force - sign * base.binormal_force) <= RESIDUAL * load)
    require(abs(moved.approach - base.approach) <= RESIDUAL * from_first_contact(sample, base))


@invariant("the mirror image slides like the original", samples())
def mirror(solver: Solver, sample: Sample) -> None:
    """x -> -x: the direction becomes pi - phi, and the binormal force changes its sign."""
    scene, base = sample.scene, solved(solver, sample)
    flipped = with_heights(scene, sample.grid, np.flipud, sliding_direction=math.pi - scene.sliding_direction)
    equal_states(solver(flipped, sample.shape), np.flipud(base.pressure), base, sample, -1.0)


@invariant("a scene turned by 90 degrees slides like the original", samples())
def quarter_turn(solver: Solver, sample: Sample) -> None:
    """(x, y) -> (-y, x), anticlockwise: i of the new array is M - 1 - j of the old, and both sides change."""
    scene, base = sample.scene, solved(solver, sample)
    phi, lengths = scene.sliding_direction + math.pi / 2, scene.lengths[::-1]

    def turn(z: Array) -> Array:
        return np.ascontiguousarray(z.T[::-1])

    turned = with_heights(scene, sample.grid, turn, sliding_direction=phi, size=lengths)
    equal_states(solver(turned, sample.shape[::-1]), turn(base.pressure), base, sample, 1.0)


@invariant("a periodic scene shifted by whole elements slides like the original", samples(periodic=True))
def periodic_translation(solver: Solver, sample: Sample) -> None:
    """Rolling both surfaces rolls the state."""
    base, shift = solved(solver, sample), (1, sample.shape[1] // 2)

    def roll(z: Array) -> Array:
        return np.roll(z, shift, axis=(0, 1))

    rolled = with_heights(sample.scene, sample.grid, roll)
    equal_states(solver(rolled, sample.shape), roll(base.pressure), base, sample, 1.0)


ROUNDED = Sample(
    bumps=((12, 0, 0, 10, 0), (0, 8, 0, 14, 0), (12, 8, 0, 10, 0), (0, 0, 9, 0, 0), (0, 13, 0, 0, 13)),
    upper=3,
    E=(156, 114),
    nu=(-17, -16),
    pressure=100,
    tau=47,
    beta=3,
    angle=246,
)
"""A residual that met the tolerance in the solver's loop and, rounded otherwise, not in the certificate."""


@invariant(
    "where contact lies on a free half-space does not matter",
    samples(periodic=False, largest=6),
    found=(ROUNDED,),
)
def translation(solver: Solver, sample: Sample) -> None:
    """The scene in the middle and in corners of larger rectangles, amid a moat too deep to touch.

    Slopes are off: the moat's walls would change those of the elements beside them.
    """
    (n, m), scene, (dx, dy) = sample.shape, sample.scene, sample.grid.spacings
    found = []
    for before, after in (((0, 0), (3, 3)), ((1, 1), (2, 2)), ((3, 0), (0, 1)), ((0, 2), (2, 0))):
        padding = tuple(zip(before, after, strict=True))

        def widened(z: Array, fill: float, pad: tuple[tuple[int, int], ...] = padding) -> Array:
            return np.pad(z, pad, constant_values=fill)

        deep = 0.4 * SIDE
        lower = widened(heights(scene.lower, sample.grid), -deep)
        upper = widened(heights(scene.upper, sample.grid), 0.0)
        lengths = dx * lower.shape[0], dy * lower.shape[1]
        wide = replace(
            scene,
            size=lengths,
            lower=array_body(scene.lower.material, lower, lengths),
            upper=array_body(scene.upper.material, upper, lengths),
        )
        state = solver(wide, (lower.shape[0], lower.shape[1]), oblique=False)
        require(state.converged)
        found.append(state.pressure[before[0] : before[0] + n, before[1] : before[1] + m])
    for other in found[1:]:
        # the moat's depth, half the side, costs the heights about five digits
        require(np.abs(other - found[0]).max() <= 1e-8 * found[0].max())


@invariant("turned upside down it is the same contact", samples())
def swapped_bodies(solver: Solver, sample: Sample) -> None:
    """z -> -z: the bodies change places and heights their sign; the new upper body slides the other way.

    Both slope angles keep their sign, since height and direction change theirs: N, F and Q stay.
    """
    scene, grid, base = sample.scene, sample.grid, solved(solver, sample)
    overturned = replace(
        scene,
        upper=array_body(scene.lower.material, -heights(scene.lower, grid), scene.lengths),
        lower=array_body(scene.upper.material, -heights(scene.upper, grid), scene.lengths),
        sliding_direction=scene.sliding_direction + math.pi,
    )
    equal_states(solver(overturned, sample.shape), base.pressure, base, sample, 1.0)


@invariant(
    "two measured maps: the bodies swapped, and the frame turned over with them", samples(periodic=False)
)
def swapped_maps(solver: Solver, sample: Sample) -> None:
    """Half a turn about the x axis: phi -> pi - phi. N, F, mu, A and the pressures stay, Q changes sign.

    A measured map on the upper body is turned over by itself, so both maps only change places.
    """
    scene, grid = sample.scene, sample.grid
    (dx, dy), bodies = grid.spacings, dict[str, rf.Body]()
    with TemporaryDirectory() as folder:
        for name in ("upper", "lower"):
            body, path = getattr(scene, name), Path(folder) / f"{name}.npy"
            np.save(path, np.kron(heights(body, grid), np.ones((3, 3))))  # a window has four pixels at least
            surface = rf.MeasuredSurface(path, unit="m", pixel_size=(dx / 3, dy / 3), level="none")
            bodies[name] = rf.Body(body.material, surface)
        here = replace(scene, upper=bodies["upper"], lower=bodies["lower"])
        there = replace(
            scene,
            upper=bodies["lower"],
            lower=bodies["upper"],
            sliding_direction=math.pi - scene.sliding_direction,
        )
        base, swapped = solver(here, sample.shape), solver(there, sample.shape)
    require(base.converged)
    require(abs(swapped.contact_area - base.contact_area) <= RESIDUAL * base.contact_area)
    require(abs(swapped.max_pressure - base.max_pressure) <= RESIDUAL * base.max_pressure)
    require(abs(swapped.friction_coefficient - base.friction_coefficient) <= RESIDUAL)
    equal_states(swapped, base.pressure[:, ::-1], base, sample, -1.0)


@invariant("the height's datum does not matter", samples())
def datum(solver: Solver, sample: Sample) -> None:
    """A body may be lifted, or lowered, by any length, here a power of two of some ten times the gap."""
    base = solved(solver, sample)
    scene, lift = sample.scene, SIDE / 64
    raised = heights(scene.upper, sample.grid) + lift
    lifted = replace(scene, upper=array_body(scene.upper.material, raised, scene.lengths))
    equal_states(solver(lifted, sample.shape), base.pressure, base, sample, 1.0)


@invariant("lengths in another unit", samples())
def length_unit(solver: Solver, sample: Sample) -> None:
    """All lengths times 2^10, the load times 2^20: pressures keep every bit, forces follow the load."""
    scene, base, factor = sample.scene, solved(solver, sample), 2.0**10
    large = with_heights(
        scene,
        sample.grid,
        lambda z: factor * z,
        size=tuple(factor * length for length in scene.lengths),
        load=factor**2 * scene.load,
    )
    moved = solver(large, sample.shape)
    require(np.array_equal(moved.pressure, base.pressure))
    require(moved.approach == factor * base.approach)
    require(moved.friction_coefficient == base.friction_coefficient)


@invariant("stresses in another unit", samples())
def stress_unit(solver: Solver, sample: Sample) -> None:
    """Moduli, tau and load times 2^-7: geometry keeps every bit, pressures follow the moduli."""
    scene, base, factor = sample.scene, solved(solver, sample), 2.0**-7
    lower, upper = (
        rf.Body(rf.Material(factor * body.material.E, body.material.nu), body.surface)
        for body in (scene.lower, scene.upper)
    )
    friction = rf.Friction(tau=factor * scene.friction.tau, beta=scene.friction.beta)
    soft = replace(scene, friction=friction, load=factor * scene.load, lower=lower, upper=upper)
    moved = solver(soft, sample.shape)
    require(np.array_equal(moved.pressure, factor * base.pressure))
    require(moved.approach == base.approach)
    require(moved.friction_coefficient == base.friction_coefficient)
