"""The discrete problem on one grid: gap, elasticity, friction and the terms of Eqs (6) and (7)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array, Grid, Window
from refimpl.model.elasticity import Elasticity, Influence
from refimpl.model.friction import FrictionLaw
from refimpl.model.materials import Pair
from refimpl.model.slopes import Slopes


@dataclass(frozen=True)
class Terms:
    """Switches of the optional terms: True, False, or None where the scene decides (`refimpl.planning`).

    coupled : shear closes the gap (c, lower minus upper): normal-tangential coupling
    oblique : slope terms; without them cosines are 1 and sines 0 (small-slope approximation)
    tilted : shear moves the common surface (c, mean of both bodies): slope change by shear
    slope_correction : exact facet tractions in Eq. (7); False unless requested
    plastic : pressures are capped at the hardness of the softer body
    """

    coupled: bool | None = None
    oblique: bool | None = None
    tilted: bool | None = None
    slope_correction: bool = False
    plastic: bool | None = None

    def check(self) -> None:
        """Raise `InputError` for other values, and for requests that exclude one another."""
        for name in ("oblique", "coupled", "tilted", "plastic"):
            if not isinstance(getattr(self, name), bool | None):
                raise InputError(name, getattr(self, name), "True, False, or None to let the scene decide")
        if not isinstance(self.slope_correction, bool):
            raise InputError("slope_correction", self.slope_correction, "True or False")
        if self.slope_correction and self.oblique is False:
            raise InputError("oblique", self.oblique, "true or unset: the slope correction needs the slopes")
        if self.slope_correction and self.coupled is False:
            raise InputError("coupled", self.coupled, "true or unset: facet tractions include shear")
        if self.slope_correction and self.plastic:
            raise InputError("plastic", self.plastic, "false or unset with the slope correction")

    @property
    def decided(self) -> Terms:
        """The switches of a `Problem`: where nothing is decided all terms enter, and no pressure cap."""
        coupled, oblique, tilted = (s is not False for s in (self.coupled, self.oblique, self.tilted))
        return Terms(coupled, oblique, tilted, self.slope_correction, bool(self.plastic))


@dataclass(frozen=True, eq=False)
class Problem:
    """The contact problem on a grid or on a window of it; all arrays have one shape.

    grid : shape, lengths and topology
    gap : ``h = z_upper - z_lower`` shifted to ``min h = 0`` (m)
    mean_surface : the undeformed ``(z_lower + z_upper) / 2`` at first contact (m)
    elasticity : tractions to displacements, Eq. (7)
    friction : the local friction law, Eq. (1)
    direction : sliding direction phi (rad)
    terms : which optional terms enter; decided, all of them
    load, approach : exactly one is given; N, or m from first contact
    datum : approach from first contact minus the reported approach (m); 0 on a free domain
    """

    grid: Grid
    gap: Array
    mean_surface: Array
    elasticity: Elasticity
    friction: FrictionLaw
    direction: float
    terms: Terms
    load: float | None
    approach: float | None
    datum: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "terms", self.terms.decided)

    @property
    def pair(self) -> Pair:
        """The two materials."""
        return self.elasticity.pair

    @property
    def cap(self) -> float:
        """Upper limit of the pressure (Pa): the hardness of the softer body, infinite without a cap."""
        hardness = self.pair.softer_hardness
        return hardness if self.terms.plastic and hardness is not None else math.inf

    @property
    def heights(self) -> tuple[Array, Array]:
        """Undeformed heights ``(z_lower, z_upper)`` at first contact (m)."""
        half = 0.5 * self.gap
        return self.mean_surface - half, np.add(self.mean_surface, half, out=half)

    @property
    def counts_from_first_contact(self) -> bool:
        """True if the reported approach does; that of a periodic problem counts from the mean planes."""
        return not self.grid.periodic

    def with_terms(self, terms: Terms) -> Problem:
        """Return the problem with other terms.

        Without slope terms nothing feels the common surface, and shear moves both bodies by what they are.
        Facet tractions include shear: with the slope correction it always closes the gap.
        """
        terms = terms.decided
        coupled = terms.coupled or terms.slope_correction
        tilted = bool(terms.tilted) if terms.oblique else coupled
        elasticity = replace(self.elasticity, coupled=coupled, tilted=tilted)
        return replace(self, terms=terms, elasticity=elasticity)

    def windowed(self, window: Window) -> Problem:
        """Return the problem seen on a window of its grid."""
        return replace(self, gap=self.gap[window.slices], mean_surface=self.mean_surface[window.slices])

    def tractions(
        self, pressure: Array, traction: Array, slopes: Slopes
    ) -> tuple[Array, Array, Array | None]:
        """Return the tractions that enter Eq. (7): down, along and across the sliding direction (Pa).

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
        normal: Array | None = None,
    ) -> tuple[Array, Array]:
        """Return the normal displacements ``(u_lower, u_upper)`` into each body, Eq. (7) (m).

        ``normal`` is ``a f`` (m), if it is known already and the tractions are the printed ones.
        """
        down, along, across = self.tractions(pressure, traction, slopes)
        if normal is None or self.terms.slope_correction:
            normal = self.elasticity.normal(operator, down)
        shear: Array | None = None
        if self.elasticity.shear_displaces and (across is not None or np.any(along)):
            shear = operator.shear(along)
            if across is not None:
                shear = shear + operator.shear_across(across)
        return self.elasticity.body_displacements(normal, down, shear)

    def slopes(self, lower: Array, upper: Array, indentation: Array | None = None) -> Slopes:
        """Return the slopes of the common surface from the displacements of both bodies (m).

        The common surface is the mean of both deformed surfaces, the softer one lowered into itself by the
        plastic ``indentation`` (m); without slope terms the slopes are zero.
        """
        if not self.terms.oblique:
            return Slopes.flat(lower.shape)
        surface = upper - lower
        surface *= 0.5
        surface += self.mean_surface
        if indentation is not None:
            surface -= 0.5 * self.pair.softer_sign * indentation
        return Slopes.of_surface(surface, self.grid, self.direction)

    def indentation(self, pressure: Array, displacement: Array, K: Array, approach: float) -> Array | None:
        """Return the plastic indentation ``w_p = (approach - v) K`` where ``f = H`` (m); None without a cap.

        ``displacement`` is ``u_lower + u_upper`` (m), and ``v = displacement / K + h``.
        """
        if math.isinf(self.cap):
            return None
        depth = K * (approach - self.gap) - displacement
        return np.where(pressure >= self.cap, np.maximum(depth, 0.0), 0.0)

    def load_weights(self, slopes: Slopes, shear_offset: Array) -> tuple[Array, float]:
        """Return Eq. (2) as an affine map of the pressure: ``N = sum(weights f) dA - offset`` (N).

        With ``r = held + beta f``: weights ``(cos theta_x - beta sin theta_x) cos theta_y`` and offset
        ``sum(held sin theta_x cos theta_y) dA``.
        """
        if slopes.is_flat:
            return slopes.cosine_product, 0.0
        weights = (slopes.cos_x - self.friction.slope * slopes.sin_x) * slopes.cos_y
        offset = float(np.sum(shear_offset * slopes.sin_x * slopes.cos_y)) * self.grid.element_area
        return weights, offset

    def largest_load(self, slopes: Slopes) -> float:
        """Return what pressures up to the hardness carry at most on given slopes (N); infinite without a cap.

        Elements whose shear drags down more than their pressure carries count as without pressure.
        """
        if math.isinf(self.cap):
            return math.inf
        f = np.full(self.gap.shape, self.cap)
        r = self.friction.traction(f, f > 0)
        each = (f * slopes.cos_x - r * slopes.sin_x) * slopes.cos_y
        return float(np.maximum(each, 0.0).sum()) * self.grid.element_area

    def nominal_load(self, normal_force: float) -> float:
        """Return the load of Eq. (4): the prescribed one, or N at a prescribed approach (N)."""
        return self.load if self.load is not None else normal_force
