"""The discrete problem on one grid: gap, compliances and the terms that enter Eqs (6) and (7)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from refimpl.grid import Array, Grid
from refimpl.grid.window import Window
from refimpl.model.forces import resultants
from refimpl.model.friction import Mask
from refimpl.model.materials import Pair
from refimpl.model.slopes import Slopes
from refimpl.model.state import Visited
from refimpl.operators.base import Influence
from refimpl.operators.threads import keep_memory
from refimpl.scene.scene import Friction, Scene


@dataclass(frozen=True)
class Terms:
    """Which physics enters.

    ``coupled``: shear moves the bodies towards each other (c, lower minus upper); ``oblique``: slopes;
    ``slope_correction``: exact facet tractions in Eq. (7); ``tilted``: shear moves the common surface
    (c, mean of both bodies), which only the slopes feel.
    """

    coupled: bool
    oblique: bool
    slope_correction: bool
    tilted: bool = True

    def shear_moves(self) -> bool:
        """Whether tangential tractions displace anything that enters the problem."""
        return self.coupled or (self.oblique and self.tilted)


@dataclass(frozen=True, eq=False)
class Problem:
    """A scene on a grid (or on a window of it), all arrays of one shape.

    ``gap`` is ``z_upper - z_lower`` shifted to ``min h = 0``; ``mean_surface`` is the undeformed
    ``(z_lower + z_upper) / 2`` at first touch. Exactly one of ``load`` (N) and ``approach`` (m,
    counted from first touch) is given.
    """

    grid: Grid
    gap: Array
    mean_surface: Array
    pair: Pair
    friction: Friction
    direction: float
    periodic: bool
    terms: Terms
    load: float | None
    approach: float | None

    @property
    def heights(self) -> tuple[Array, Array]:
        """Undeformed heights ``(z_lower, z_upper)`` at first touch (m)."""
        half = 0.5 * self.gap
        return self.mean_surface - half, np.add(self.mean_surface, half, out=half)

    def windowed(self, window: Window) -> Problem:
        """The same problem seen on a window of its grid."""
        return replace(self, gap=self.gap[window.slices], mean_surface=self.mean_surface[window.slices])

    def tractions(
        self, pressure: Array, traction: Array, slopes: Slopes
    ) -> tuple[Array, Array, Array | None]:
        """Tractions that enter Eq. (7): down, along and across the sliding direction (Pa).

        As printed they are ``f``, ``r`` and none. With the slope correction they are the exact facet
        tractions per projected area: ``f - r tan theta_x``, ``r + f tan theta_x``, ``f tan theta_y``.
        """
        if not self.terms.slope_correction:
            return pressure, traction, None
        return (
            pressure - traction * slopes.tan_x,
            traction + pressure * slopes.tan_x,
            pressure * slopes.tan_y,
        )

    def displacements(
        self,
        operator: Influence,
        pressure: Array,
        traction: Array,
        slopes: Slopes,
        *,
        product: Array | None = None,
    ) -> tuple[Array, Array]:
        """Normal displacements ``(u_lower, u_upper)`` into each body, Eq. (7) (m).

        ``product`` is the operator's normal one of the downward traction (Pa m), if known already.
        """
        down, along, across = self.tractions(pressure, traction, slopes)
        normal = operator.normal(down) if product is None else product
        if not (self.terms.shear_moves() and (across is not None or np.any(along))):
            return self.parted(normal, None)
        shear = operator.shear(along)
        if across is not None:
            shear = shear + operator.shear_across(across)
        return self.parted(normal, shear)

    def parted(self, normal: Array, shear: Array | None) -> tuple[Array, Array]:
        """``(u_lower, u_upper)`` of the tractions' normal and shear products (Pa m), if there is any (m)."""
        lower = self.pair.lower.normal_compliance * normal
        upper = self.pair.upper.normal_compliance * normal
        if shear is not None:
            into_lower, into_upper = self._shear_compliances()
            lower = lower + into_lower * shear
            upper = upper + into_upper * shear
        return lower, upper

    def coupling(self, operator: Influence, traction: Array) -> Array:
        """What shear alone adds to ``u_lower + u_upper``, the coupling of Eq. (7); without it zero (m)."""
        if not self.terms.coupled or not np.any(traction):
            return np.broadcast_to(0.0, traction.shape)
        return self.pair.shear_compliance * operator.shear(traction)

    def _shear_compliances(self) -> tuple[float, float]:
        """Factors of ``I[s/rho^2]`` for each body: their sum couples, half their difference tilts (1/Pa)."""
        into_lower, into_upper = self.pair.lower.shear_compliance, -self.pair.upper.shear_compliance
        if not self.terms.coupled:
            tilt = 0.5 * (into_lower - into_upper)
            return tilt, -tilt
        if self.terms.oblique and not self.terms.tilted:
            approach = 0.5 * (into_lower + into_upper)
            return approach, approach
        return into_lower, into_upper

    def slopes(self, lower: Array, upper: Array) -> Slopes:
        """Slopes of the common surface, the mean of both deformed ones; flat when not oblique."""
        if not self.terms.oblique:
            return Slopes.flat(lower.shape)
        surface = self.mean_surface + 0.5 * (upper - lower)
        return Slopes.of_surface(surface, self.grid.spacing, self.direction, periodic=self.periodic)

    def load_weights(self, slopes: Slopes, support: Mask) -> tuple[Array, float]:
        """Eq. (2) as an affine map of the pressure: ``N = sum(weights f) dA - offset`` (N).

        With ``r = tau chi + beta f``: weights ``(cos theta_x - beta sin theta_x) cos theta_y`` and
        offset ``tau sum(chi sin theta_x cos theta_y) dA``.
        """
        if slopes.is_flat:
            return slopes.obliqueness, 0.0
        tau, beta = self.friction.tau, self.friction.beta
        weights = (slopes.cos_x - beta * slopes.sin_x) * slopes.cos_y
        offset = tau * float(np.sum(support * slopes.sin_x * slopes.cos_y)) * self.grid.element_area
        return weights, offset


def visit(problem: Problem, pressure: Array, traction: Array, slopes: Slopes) -> Visited:
    """What a cycle's report keeps of a state."""
    forces = resultants(pressure, traction, slopes, problem.grid.element_area)
    load = problem.load if problem.load is not None else forces.normal
    area = float(np.count_nonzero(pressure)) * problem.grid.element_area
    return Visited(forces.friction / load if load else math.nan, area)


def pose(scene: Scene, grid: Grid, terms: Terms, approach: float | None) -> Problem:
    """The scene's problem on a grid.

    ``approach`` replaces the load if given: counted from first touch, or from the mean planes when
    the scene is periodic (m).
    """
    keep_memory(grid.M**2)
    lower, upper = scene.sampled(grid)
    gap = upper - lower
    gap -= gap.min()
    if approach is not None and scene.periodic:
        approach += float(gap.mean())
    return Problem(
        grid=grid,
        gap=gap,
        mean_surface=_raised(lower, gap, upper),
        pair=scene.materials,
        friction=scene.friction,
        direction=scene.sliding_direction,
        periodic=scene.periodic,
        terms=terms,
        load=scene.load if approach is None else None,
        approach=approach,
    )


def _raised(lower: Array, gap: Array, spent: Array) -> Array:
    """``lower + gap / 2``, in the memory of heights that are no longer needed."""
    np.multiply(gap, 0.5, out=spent)
    spent += lower
    return spent
