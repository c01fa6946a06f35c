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
"""Length of the domain along x (m); a power of two, so that scaling it is exact."""
HEIGHT = SIDE / 2**13
"""One unit of height (m)."""


@dataclass(frozen=True)
class Sample:
    """A scene in whole numbers on a rectangle; its grid's ``shape`` is that of ``bumps``.

    ``bumps`` heights of the lower surface and ``upper`` height of the upper paraboloid at the middle of the
    edges (`HEIGHT`); ``E`` (GPa) and ``nu`` (%) of the lower and the upper body; ``pressure`` load over the
    domain (1e-5 E*); ``tau`` (% of that), ``beta`` (%); ``angle`` of sliding (degrees); ``stretch`` of
    elements along y, ``4 dy/dx``.

    >>> Sample(bumps=((0, 1, 1), (1, 0, 1)), stretch=2).grid.spacings
    (0.00048828125, 0.000244140625)
    """

    bumps: tuple[tuple[int, ...], ...]
    upper: int = 0
    E: tuple[int, int] = (1, 1)
    nu: tuple[int, int] = (0, 0)
    pressure: int = 1
    tau: int = 0
    beta: int = 0
    angle: int = 0
    periodic: bool = False
    stretch: int = 4

    @property
    def shape(self) -> tuple[int, int]:
        """Elements along x and y."""
        return len(self.bumps), len(self.bumps[0])

    @property
    def grid(self) -> Grid:
        """The grid the sample is meant for."""
        nx, ny = self.shape
        return Grid(self.shape, (SIDE, SIDE * (ny * self.stretch) / (nx * 4)), self.periodic)

    @cached_property
    def scene(self) -> rf.Scene:
        """The scene, its surfaces as arrays of the grid's shape."""
        lower, upper = (rf.Material(E * 1e9, nu / 100) for E, nu in zip(self.E, self.nu, strict=True))
        x, y = ((2 * np.arange(n) + 1 - n) / n for n in self.shape)
        heights = self.upper * HEIGHT * (x[:, None] ** 2 + y[None, :] ** 2)
        compliance = 1 / lower.plane_strain_modulus + 1 / upper.plane_strain_modulus
        nominal = self.pressure * 1e-5 / compliance
        lengths = self.grid.lengths
        return rf.Scene(
            upper=array_body(upper, heights, lengths),
            lower=array_body(lower, np.array(self.bumps, dtype=float) * HEIGHT, lengths),
            friction=rf.Friction(tau=self.tau / 100 * nominal, beta=self.beta / 100),
            load=nominal * self.grid.nominal_area,
            size=lengths,
            sliding_direction=math.radians(self.angle),
            periodic=self.periodic,
        )

    @cached_property
    def gap(self) -> Array:
        """``z_upper - z_lower`` from first contact (m), in the grid's shape."""
        lower, upper = (heights(body, self.grid) for body in (self.scene.lower, self.scene.upper))
        gap: Array = upper - lower
        return gap - float(gap.min())


def heights(body: rf.Body, grid: Grid) -> Array:
    """Return the heights of one body's surface (m)."""
    found: Array = body.surface.heights(grid)
    return found


def array_body(material: rf.Material, z: Array, lengths: tuple[float, float]) -> rf.Body:
    """Return a body of heights (m) that span a domain of those lengths (m), with pixels of any shape."""
    (nx, ny), (Lx, Ly) = z.shape, lengths
    return rf.Body(material, rf.ArraySurface(z, pixel=(Lx / nx, Ly / ny)))


def with_heights(scene: rf.Scene, grid: Grid, change: Callable[[Array], Array], **changes: Any) -> rf.Scene:
    """Return the scene with ``change`` applied to both surfaces' heights, and with other fields changed."""
    lengths = changes.get("size", scene.lengths)
    upper, lower = (
        array_body(body.material, change(heights(body, grid)), lengths) for body in (scene.upper, scene.lower)
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
    """Draw samples of 2 ... ``largest`` elements along x and along y; ``periodic=None`` draws either kind.

    Never two periodic flats: nothing deforms, and there is no length to measure a residual by.
    """
    rows, columns = draw(st.integers(2, largest)), draw(st.integers(2, largest))
    row = st.tuples(*[st.integers(0, 15)] * columns)
    bumps = draw(st.tuples(*[row] * rows))
    moduli, ratios = st.integers(1, 200), st.integers(-40, 50)
    sample = Sample(
        bumps=bumps,
        upper=draw(st.integers(0, 60)),
        E=(draw(moduli), draw(moduli)),
        nu=(draw(ratios), draw(ratios)),
        pressure=draw(st.integers(1, 100)),
        tau=draw(st.integers(0, 60)) if friction and tau else 0,
        beta=draw(st.integers(0, 40)) if friction else 0,
        angle=draw(st.integers(-180, 360)) if friction else 0,
        periodic=draw(st.booleans()) if periodic is None else periodic,
        stretch=draw(st.integers(1, 16)),
    )
    assume(not (sample.periodic and np.ptp(sample.gap) == 0))
    return sample
