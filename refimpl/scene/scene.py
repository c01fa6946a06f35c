"""The scene: two bodies, their friction, the load and the frame."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from refimpl.errors import (
    MOST,
    InputError,
    keep_doubles,
    printable,
    require_number,
    require_size,
    size_text,
    within,
)
from refimpl.grid import MAX_COUNT, Array, Grid
from refimpl.model.friction import Friction, require_law
from refimpl.model.materials import Material, Pair
from refimpl.surfaces import Surface, SurfaceSum, SurfaceWarning, as_surface
from refimpl.surfaces.shapes import Sphere

# Arguments of a surface, by the names of the scene's fields.
_ASKED_OF_SURFACES = {"side": "side", "periodic": "periodic", "offset": "sliding_offset"}
MAX_RATIO = 1000.0  # ratio of the domain's lengths, and of an element's edges; larger: an error
_FAVOURED = 16  # a divisor of all sizes in `refimpl.accuracy.refinement`
_OF_FORMULAS, _OF_A_MAP = 256, 512  # elements along the longer side by default; of a map's points at most
_SLENDER = 4.0  # lengths' ratio from which a refinement's grids are finer along the longer side


@dataclass(frozen=True)
class Body:
    """A half-space of one material with a rough surface (a `Surface`, an array of heights, or a sum)."""

    material: Material
    surface: Surface

    def __init__(self, material: Material, surface: Any) -> None:
        if not isinstance(material, Material):
            raise InputError("material", material, "a Material")
        object.__setattr__(self, "material", material)
        object.__setattr__(self, "surface", as_surface(surface))

    def with_parts(self, parts: Sequence[Surface]) -> Body:
        """Return the body with these parts as its surface."""
        return Body(self.material, parts[0] if len(parts) == 1 else SurfaceSum(tuple(parts)))


@dataclass(frozen=True)
class Scene:
    """Two rough half-spaces sliding under a normal load.

    Parameters
    ----------
    upper, lower : the two bodies; the upper one slides along ``(cos phi, sin phi)``
    friction : local friction law: `Friction`, Eq. (1), or a `FrictionLaw` of your own
    load : normal load P (N)
    side : edge of a square domain (m)
    sliding_direction : phi (rad)
    sliding_offset : how far the upper body has slid (m); the lower surface is sampled at x + offset
    periodic : the doubly periodic problem instead of a half-space that is free outside the domain
    plastic : whether pressures are capped at the hardness of the softer body; None: where they reach it
    size : lengths ``(Lx, Ly)`` of a rectangular domain (m), in place of ``side``

    Raises
    ------
    InputError
        names the field

    Notes
    -----
    With measured surfaces neither side nor size need be given: the domain is then the largest rectangle that
    all of them cover at the offset, centres on one another. A measured surface on the upper body is turned
    over about the x axis, unless stated otherwise (`refimpl.MeasuredSurface`); arrays are used as given.
    """

    upper: Body
    lower: Body
    friction: Friction | Any  # a `FrictionLaw`; Any, since a reader of its tau knows that it is a Friction
    load: float
    side: float | None = None
    sliding_direction: float = 0.0
    sliding_offset: float = 0.0
    periodic: bool = False
    size: tuple[float, float] | None = field(default=None, kw_only=True)
    plastic: bool | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        for name in ("upper", "lower"):
            if not isinstance(getattr(self, name), Body):
                raise InputError(name, getattr(self, name), "a Body")
        require_law(self.friction)
        require_number("load", self.load, "a positive normal load in N", above=0)
        require_number("sliding_direction", self.sliding_direction, "a finite angle in rad")
        allowed = f"a finite length in m, at most {MOST} either way"
        require_number("sliding_offset", self.sliding_offset, allowed, at_least=-MOST, at_most=MOST)
        if not isinstance(self.periodic, bool):
            raise InputError("periodic", self.periodic, "true or false")
        if not isinstance(self.plastic, bool | None):
            raise InputError("plastic", self.plastic, "true, false, or unset to let the hardness decide")
        keep_doubles(self, "load", "sliding_direction", "sliding_offset")
        self._check_lengths()
        if self.upper.material.is_rigid and self.lower.material.is_rigid:
            raise InputError("upper.material.E", math.inf, "a finite modulus beside a rigid lower body")

    def _check_lengths(self) -> None:
        if self.side is not None:
            if self.size is not None:
                raise InputError("size", self.size, f"none beside side = {self.side!r}")
            require_size("side", self.side, "a positive length in m")
            keep_doubles(self, "side")
        elif self.size is not None:
            given, allowed = self.size, "two positive lengths in m, (Lx, Ly)"
            object.__setattr__(self, "size", _two("size", given, allowed))
            try:
                for length in self.size:
                    require_size("size", length, allowed)
            except InputError as refused:
                raise InputError("size", given, refused.allowed) from None
        low, high = sorted(self.lengths)
        if high > MAX_RATIO * low:
            raise InputError("size", self.lengths, f"lengths whose ratio is at most {MAX_RATIO:g}")

    @property
    def materials(self) -> Pair:
        """The two materials with their combined compliances."""
        return Pair(lower=self.lower.material, upper=self.upper.material)

    @cached_property
    def lengths(self) -> tuple[float, float]:
        """Lengths of the domain along x and y (m)."""
        if self.side is not None:
            return self.side, self.side
        return self.size or self._covered()

    def _covered(self) -> tuple[float, float]:
        """Return the largest rectangle (m) that all measured surfaces cover at the scene's offset."""
        found = []
        for name, offset in (("lower", self._offset), ("upper", (0.0, 0.0))):
            for k, part in enumerate(self.parts(name)):
                with within(f"{name}.surface[{k}]"):
                    found.append(part.extent(offset))
        known = [lengths for lengths in found if lengths is not None]
        if not known:
            allowed = "a length in m, or size = (Lx, Ly): no surface is measured, and has a size of its own"
            raise InputError("side", None, allowed)
        x, y = (min(lengths[axis] for lengths in known) for axis in (0, 1))
        if not min(x, y) > 0:
            raise InputError(
                "sliding_offset", self.sliding_offset, "an offset at which measured areas overlap"
            )
        return x, y

    def grid(self, elements: int | Sequence[int]) -> Grid:
        """Return the grid of ``(Mx, My)`` elements, or of M along the longer side.

        The other number is then the one for elements nearest to square. Raises `InputError` unless numbers
        are whole and positive, and an element's edges differ by a factor of at most 1000.

        >>> rigid = Body(Material(E=math.inf, nu=0.3), np.zeros((4, 4)))
        >>> soft = Body(Material(E=1e9, nu=0.3), np.zeros((4, 4)))
        >>> strip = Scene(rigid, soft, Friction(), load=1.0, size=(0.1, 0.3))
        >>> strip.grid(64).shape, strip.grid((8, 8)).shape
        ((21, 64), (8, 8))
        """
        if isinstance(elements, list | tuple):
            shape = _two("grid", elements, "a number of elements, or two, (Mx, My)")
        else:
            shape = self._nearest_to_square(elements)
        grid = Grid(shape, self.lengths, self.periodic)
        low, high = sorted(grid.spacings)
        if high > MAX_RATIO * low:
            raise InputError("grid", elements, f"elements whose edges' ratio is at most {MAX_RATIO:g}")
        return grid

    def _nearest_to_square(self, longest: Any) -> tuple[Any, Any]:
        (Lx, Ly), high = self.lengths, max(self.lengths)
        if Lx == Ly or not isinstance(longest, int | np.integer) or longest > MAX_COUNT:
            return longest, longest
        exact = float(longest) * min(Lx, Ly) / high
        fewer = math.floor(exact)
        other = max(1, fewer + (exact**2 > fewer * (fewer + 1)))  # nearer neighbour by ratio
        return (longest, other) if Lx == high else (other, longest)

    @property
    def pitch(self) -> float | None:
        """Smallest distance of neighbouring points of measured surfaces and arrays (m); None without any."""
        parts = (*self.parts("lower"), *self.parts("upper"))
        found = [pitch for part in parts if (pitch := part.pitch(self.lengths)) is not None]
        return min(found, default=None)

    @property
    def default_grid(self) -> int:
        """Elements along the longer side by default: a point of the finest map each, up to 512; else 256."""
        pitch = self.pitch
        return _OF_FORMULAS if pitch is None else max(1, min(_OF_A_MAP, round(max(self.lengths) / pitch)))

    @property
    def slenderness(self) -> int:
        """Factor by which the longer side has more elements than a square's in a refinement."""
        return math.ceil(max(self.lengths) / min(self.lengths) / _SLENDER)

    def refined(self, M: int) -> Grid:
        """Return the grid of M elements along the longer side, a multiple of ``16 slenderness``.

        An element's ratio of edges is nearly 1, and the same for every M.
        """
        nx, ny = self.grid(_FAVOURED * self.slenderness).shape
        return self.grid((nx * M // max(nx, ny), ny * M // max(nx, ny)))

    def check_approach(self, approach: float) -> None:
        """Raise `InputError` unless an approach (m) is finite, and below the mean planes if periodic."""
        if self.periodic:
            require_number("approach", approach, "an approach below 0 m (mean planes)", below=0)
        require_number("approach", approach, "a finite approach in m")

    def heights(self, grid: Grid) -> tuple[Array, Array]:
        """Return heights ``(z_lower, z_upper)`` at the element centres, each about its own mid-height (m).

        Mid-heights are subtracted because only the gap enters: heights may come with any datum.

        Raises `InputError` when a surface's peak-to-valley exceeds the side, which means a wrong unit; warns
        (`SurfaceWarning`) of `notes`.
        """
        for caution in self.notes(grid):
            warnings.warn(caution, SurfaceWarning, stacklevel=2)
        return self.sampled(grid)

    def notes(self, grid: Grid) -> tuple[str, ...]:
        """Return the notes on how the heights of this grid are computed, each once."""
        parts = (*self.parts("lower"), *self.parts("upper"))
        lines = [line for part in parts for line in part.notes(grid)]
        if self.side is None and self.size is None:
            shown = size_text(self.lengths)
            lines.append(f"no size given: {shown} m, the largest rectangle that all measured surfaces cover")
        given = self.upper.surface.parts
        for part, placed in zip(given, self.parts("upper"), strict=True):
            if placed is not part:
                lines.append(
                    f"{placed.label}: on the upper body, so turned over about the x axis, "
                    "z(x, y) -> -z(x, -y) (turn_over = false uses it as it lies)"
                )
        return tuple(dict.fromkeys(map(printable, lines)))

    def parts(self, name: str) -> tuple[Surface, ...]:
        """Return the surfaces of the "lower" or the "upper" body, as they lie on it."""
        given: tuple[Surface, ...] = getattr(self, name).surface.parts
        return tuple(part.on_upper_body() for part in given) if name == "upper" else given

    @property
    def continues(self) -> bool:
        """True if the bodies go on beyond a free domain: paraboloids do, whose sum is no flat."""
        return not self.periodic and self.curvature != 0

    @property
    def curvature(self) -> float:
        """Sum of the curvatures of all paraboloids (1/m): positive of bodies that are convex together."""
        spheres = [(part, 1) for part in self.parts("upper")] + [(part, -1) for part in self.parts("lower")]
        return sum(sign / part.radius for part, sign in spheres if isinstance(part, Sphere))

    @property
    def _offset(self) -> tuple[float, float]:
        """Where the lower surface is sampled, along x and y (m)."""
        angle = self.sliding_direction
        return self.sliding_offset * math.cos(angle), self.sliding_offset * math.sin(angle)

    def sampled(self, grid: Grid) -> tuple[Array, Array]:
        """Return the `heights`, without a warning."""
        lower, upper = self._summed("lower", grid, self._offset), self._summed("upper", grid, (0.0, 0.0))
        return _centred("lower", lower, grid), _centred("upper", upper, grid)

    def _summed(self, name: str, grid: Grid, offset: tuple[float, float]) -> Array:
        """Return the sum of a body's parts (m); a refusal names the part, or the scene's field."""
        z = grid.zeros
        for k, part in enumerate(self.parts(name)):
            try:
                z += part.sample(grid, offset)
            except InputError as refused:
                field, value = f"{name}.surface[{k}].{refused.field}", refused.value
                if refused.field in _ASKED_OF_SURFACES:
                    field = _ASKED_OF_SURFACES[refused.field]
                    if field == "side" and self.side is None:
                        field = "size"
                    value = self.lengths if field == "size" else getattr(self, field)
                raise InputError(field, value, refused.allowed) from refused.__cause__
        return z


def _two(field: str, value: Any, allowed: str) -> tuple[Any, Any]:
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise InputError(field, value, allowed)
    first, second = (float(item) if isinstance(item, np.floating) else item for item in value)
    return first, second


def _centred(name: str, heights: Array, grid: Grid) -> Array:
    """Return the heights about their mid-height, in place."""
    if not np.all(np.isfinite(heights)):
        raise InputError(f"{name}.surface", "NaN or infinite heights", "finite heights in m")
    low, high = float(heights.min()), float(heights.max())
    side = max(grid.lengths)
    if high - low > side:
        raise InputError(
            f"{name}.surface",
            f"peak-to-valley {high - low:.3g} m",
            f"heights in m whose peak-to-valley is at most the longer side, {side:.3g} m (unit of heights, "
            "or of pixel_size and side? Without slope terms, heights and approach times s with moduli over s "
            "have the same pressures)",
        )
    heights -= low + 0.5 * (high - low)
    return heights
