"""Random small scenes made of whole numbers: they shrink well, and print as what made them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

import refimpl as rf
from refimpl.grid import Array, Grid

SIDE = 2.0**-10
"""Edge of the square (m); a power of two, so that scaling it is exact."""
HEIGHT = SIDE / 2**13
"""One unit of height (m)."""


@dataclass(frozen=True)
class Sample:
    """A scene in whole numbers; ``M`` elements a side follow from the shape of ``bumps``.

    ``bumps`` heights of the lower surface and ``bowl`` height of the upper paraboloid at the middle of the
    edge (`HEIGHT`); ``E`` (GPa) and ``nu`` (%) of the lower and the upper body; ``pressure`` load over the
    square (1e-5 E*); ``tau`` (% of that), ``beta`` (%); ``angle`` of sliding (degrees).

    >>> Sample(bumps=((0, 1), (1, 0))).M
    2
    """

    bumps: tuple[tuple[int, ...], ...]
    bowl: int = 0
    E: tuple[int, int] = (1, 1)
    nu: tuple[int, int] = (0, 0)
    pressure: int = 1
    tau: int = 0
    beta: int = 0
    angle: int = 0
    periodic: bool = False

    @property
    def M(self) -> int:
        """Elements a side."""
        return len(self.bumps)

    @property
    def grid(self) -> Grid:
        """The grid the sample is meant for."""
        return Grid.square(SIDE, self.M, periodic=self.periodic)

    @cached_property
    def scene(self) -> rf.Scene:
        """The scene, its surfaces as arrays of the grid's shape."""
        lower, upper = (rf.Material(E * 1e9, nu / 100) for E, nu in zip(self.E, self.nu, strict=True))
        x = (2 * np.arange(self.M) + 1 - self.M) / self.M
        bowl = self.bowl * HEIGHT * (x[:, None] ** 2 + x[None, :] ** 2)
        compliance = 1 / lower.plane_strain_modulus + 1 / upper.plane_strain_modulus
        nominal = self.pressure * 1e-5 / compliance
        return rf.Scene(
            upper=rf.Body(upper, bowl),
            lower=rf.Body(lower, np.array(self.bumps, dtype=float) * HEIGHT),
            friction=rf.Friction(tau=self.tau / 100 * nominal, beta=self.beta / 100),
            load=nominal * SIDE**2,
            side=SIDE,
            sliding_direction=math.radians(self.angle),
            periodic=self.periodic,
        )

    @cached_property
    def gap(self) -> Array:
        """``z_upper - z_lower`` from first contact (m), shape ``(M, M)``."""
        lower, upper = (heights(body, self.grid) for body in (self.scene.lower, self.scene.upper))
        gap: Array = upper - lower
        return gap - float(gap.min())


def heights(body: rf.Body, grid: Grid) -> Array:
    """Heights of one body's surface (m)."""
    found: Array = body.surface.heights(grid)
    return found


def with_heights(scene: rf.Scene, grid: Grid, change: Callable[[Array], Array], **changes: Any) -> rf.Scene:
    """The scene with ``change`` applied to both surfaces' heights, and with other fields changed."""
    upper, lower = (
        rf.Body(body.material, change(heights(body, grid))) for body in (scene.upper, scene.lower)
    )
    return replace(scene, upper=upper, lower=lower, **changes)


@st.composite
def samples(
    draw: st.DrawFn,
    *,
    largest: int = 8,
    friction: bool = True,
    tau: bool = True,
    periodic: bool | None = None,
) -> Sample:
    """Samples of 2 ... ``largest`` elements a side; ``periodic=None`` draws either kind.

    Never two periodic flats: nothing deforms, and there is no length to measure a residual by.
    """
    M = draw(st.integers(2, largest))
    row = st.tuples(*[st.integers(0, 15)] * M)
    bumps = draw(st.tuples(*[row] * M))
    moduli, ratios = st.integers(1, 200), st.integers(-40, 50)
    sample = Sample(
        bumps=bumps,
        bowl=draw(st.integers(0, 60)),
        E=(draw(moduli), draw(moduli)),
        nu=(draw(ratios), draw(ratios)),
        pressure=draw(st.integers(1, 100)),
        tau=draw(st.integers(0, 60)) if friction and tau else 0,
        beta=draw(st.integers(0, 40)) if friction else 0,
        angle=draw(st.integers(-180, 360)) if friction else 0,
        periodic=draw(st.booleans()) if periodic is None else periodic,
    )
    assume(not (sample.periodic and np.ptp(sample.gap) == 0))
    return sample
