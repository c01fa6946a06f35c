"""Where the model stops being one: named warnings about a solution, each with its number and its limit."""

from __future__ import annotations

import math
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from refimpl.grid.contact_patches import spot_sizes
from refimpl.grid.window import Window
from refimpl.model.materials import Pair
from refimpl.model.slopes import Slopes
from refimpl.scene.scene import Body, Scene
from refimpl.solution.influence_error import SlopeError, slope_error
from refimpl.surfaces import Flat, Sphere
from refimpl.surfaces.crop import ROUNDING
from refimpl.surfaces.statistics import rms_slopes

if TYPE_CHECKING:
    from refimpl.solution.solution import Solution

_PLASTICITY = 1.0  # section 8: beyond it contact ceases to be purely elastic (Greenwood and Williamson 1966)
_COEFFICIENT_ERROR = 0.02  # section 4: what the paper accepts of flat-surface influence coefficients
_CORRELATION = 4.0  # elements: a quarter of the length is where slopes count as resolved (refimpl.surfaces)
_RADIUS = 3.0  # elements: whole elements add 0.30 / r to the area of a circle of radius r, here a tenth


class Limit(StrEnum):
    """What a solution can leave."""

    PLASTICITY = "plasticity index"
    HARDNESS = "peak pressure"
    RMS_SLOPE = "rms slope"
    MAX_SLOPE = "maximum slope"
    BORDER = "border"
    CORRELATION = "correlation length"
    DATA = "points of data"
    RADIUS = "contact radius"
    TAU_SUPPORT = "tau support"
    LEFT_OUT = "left out"


class Caution(str):
    """A warning: its text, with the ``limit`` that was left, the ``number`` found and the ``allowed`` one.

    >>> Caution(Limit.RADIUS, 1.5, 3.0, "few elements").number
    1.5
    """

    limit: Limit
    number: float
    allowed: float

    def __new__(cls, limit: Limit, number: float, allowed: float, text: str) -> Caution:
        self = super().__new__(cls, text)
        self.limit, self.number, self.allowed = limit, number, allowed
        return self

    def __getnewargs__(self) -> tuple[Limit, float, float, str]:  # type: ignore[override]  # str's has text alone
        return self.limit, self.number, self.allowed, str(self)


def plain_warning(text: str) -> dict[str, Any]:
    """A warning for JSON; those without a limit say what surfaces or refinement had to remark."""
    if isinstance(text, Caution):
        return {"name": text.limit.value, "number": text.number, "limit": text.allowed, "text": str(text)}
    return {"name": "remark", "number": None, "limit": None, "text": text}


def cautions(solution: Solution, scene: Scene) -> tuple[Caution, ...]:
    """Every limit that a solution leaves; none for one without contact."""
    if not solution.contact.any():
        return ()
    found = (
        _plasticity(solution, scene),
        _hardness(solution),
        *_slopes(solution),
        _border(solution, scene),
        _correlation(solution),
        _data(solution, scene),
        _radius(solution),
        _tau_support(solution),
        *_left_out(solution),
    )
    return tuple(caution for caution in found if caution is not None)


def softer_hardness(pair: Pair) -> float | None:
    """The smaller of the hardnesses given (Pa); None when neither is."""
    given = [h for h in (pair.lower.hardness, pair.upper.hardness) if h is not None]
    return min(given, default=None)


def roughness_slope(scene: Scene, solution: Solution) -> float:
    """Root of both bodies' summed mean square slopes along an axis, of all but spheres and flats."""
    total = 0.0
    for body in (scene.lower, scene.upper):
        rough = [part for part in body.surface.parts if not isinstance(part, Sphere | Flat)]
        z = np.zeros((solution.grid.M, solution.grid.M))
        for part in rough:
            z += part.sample(solution.grid, periodic=scene.periodic)
        if rough and solution.grid.M > 1:
            along_x, along_y = rms_slopes(z, solution.grid.spacing)
            total += 0.5 * (along_x**2 + along_y**2)
    return math.sqrt(total)


def _plasticity(solution: Solution, scene: Scene) -> Caution | None:
    """Eq. (12): ``2.2 rms / length`` is the rms slope of Eq. (9)'s roughness (``sqrt(4.6) = 2.14``)."""
    pair = solution.problem.pair
    hardness = softer_hardness(pair)
    if hardness is None:
        return None
    index = pair.reduced_modulus / hardness * roughness_slope(scene, solution)
    text = f"plasticity index {index:.3g} of Eq. (12) reaches 1: contact is no longer purely elastic"
    return Caution(Limit.PLASTICITY, index, _PLASTICITY, text) if index >= _PLASTICITY else None


def _hardness(solution: Solution) -> Caution | None:
    hardness = softer_hardness(solution.problem.pair)
    if hardness is None or solution.max_pressure <= hardness:
        return None
    text = (
        f"largest pressure, {solution.max_pressure / 1e6:.4g} MPa, exceeds the softer body's hardness, "
        f"{hardness / 1e6:.4g} MPa"
    )
    return Caution(Limit.HARDNESS, solution.max_pressure, hardness, text)


def _slopes(solution: Solution) -> list[Caution | None]:
    error = _error_at_slopes(solution)
    return [
        _slope(Limit.RMS_SLOPE, error.rms_slope, error.at_rms),
        _slope(Limit.MAX_SLOPE, error.max_slope, error.at_max),
    ]


def _error_at_slopes(solution: Solution) -> SlopeError:
    """As quoted by the solution; where the user forced the slopes out, that of the returned surfaces."""
    term = solution.plan.term("obliqueness")
    if term.included or term.small:
        return solution.slope_error
    near = Window.around(solution.contact, margin=1)  # slopes in contact take no heights from farther away
    if solution.problem.periodic:
        near = Window.full(solution.grid.M)
    surface = 0.5 * (solution.surface_lower[near.slices] + solution.surface_upper[near.slices])
    slopes = Slopes.of_surface(surface, solution.grid.spacing, 0.0, periodic=solution.problem.periodic)
    pair = solution.problem.pair
    return slope_error(slopes.tan_x, slopes.tan_y, solution.pressure[near.slices], pair.lower, pair.upper)


def _slope(limit: Limit, slope: float, error: float | None) -> Caution | None:
    if error is not None and error <= _COEFFICIENT_ERROR:
        return None
    size = "beyond Appendix A's table" if error is None else f"by {error:.1%}, above 2 %, by Appendix A"
    text = f"{limit.value} {math.degrees(slope):.3g} degrees: influence coefficients of a flat are off {size}"
    return Caution(limit, math.inf if error is None else error, _COEFFICIENT_ERROR, text)


def _border(solution: Solution, scene: Scene) -> Caution | None:
    if solution.problem.periodic:
        return None
    border = solution.contact.copy()
    border[1:-1, 1:-1] = False
    touching = int(np.count_nonzero(border))
    bowls = [name for name, sign in (("lower", 1), ("upper", -1)) if _is_bowl(getattr(scene, name), sign)]
    advice = (
        f"the {' and '.join(bowls)} body is a bowl (sign of its radius?)" if bowls else "enlarge the side"
    )
    text = f"contact reaches the border of the domain on {touching} elements: {advice}"
    return Caution(Limit.BORDER, touching, 0, text) if touching else None


def _is_bowl(body: Body, sign: int) -> bool:
    """Whether its paraboloids together are hollow: a positive radius below, a negative one above."""
    return sign * sum(1 / part.radius for part in body.surface.parts if isinstance(part, Sphere)) > 0


def _correlation(solution: Solution) -> Caution | None:
    asked = solution.plan.resolution
    if asked is None or asked.elements >= _CORRELATION:
        return None
    text = (
        f"{asked.elements:.2g} elements per correlation length, {asked.correlation_length:.3g} m: "
        "slopes of the roughness are not resolved below 4"
    )
    return Caution(Limit.CORRELATION, asked.elements, _CORRELATION, text)


def _data(solution: Solution, scene: Scene) -> Caution | None:
    """Of measured heights and arrays, which are sampled and not averaged."""
    parts = (*scene.lower.surface.parts, *scene.upper.surface.parts)
    pitches = [pitch for part in parts if (pitch := part.pitch(scene.side)) is not None]
    points = solution.grid.spacing / min(pitches, default=math.inf)
    text = (
        f"{points:.2g} points of a surface's data per element: those between the elements' centres are not "
        "seen, and error bars do not know of them"
    )
    return Caution(Limit.DATA, points, 1, text) if points > 1 + ROUNDING else None


def _radius(solution: Solution) -> Caution | None:
    """Of a mean circle; full contact has no edge to resolve."""
    if solution.contact.all():
        return None
    periodic = solution.problem.periodic
    box = Window.full(solution.grid.M) if periodic else Window.around(solution.contact, margin=0)
    spots = spot_sizes(solution.contact[box.slices], periodic=periodic).size
    radius = math.sqrt(np.count_nonzero(solution.contact) / (math.pi * spots))
    text = (
        f"spots of contact have a mean radius of {radius:.2g} elements: below 3 areas are coarse, and bars "
        "of areas, peaks and approaches may be too short where they have an end"
    )
    return Caution(Limit.RADIUS, radius, _RADIUS, text) if radius < _RADIUS else None


def _tau_support(solution: Solution) -> Caution | None:
    withheld = int(np.count_nonzero(solution.withheld & solution.contact))
    text = f"tau's support is ambiguous: {withheld} elements in contact are settled without it"
    return Caution(Limit.TAU_SUPPORT, withheld, 0, text) if withheld else None


def _left_out(solution: Solution) -> list[Caution | None]:
    """Terms left out as small whose estimate, made again from the solution, exceeds what was asked for.

    Without friction the plan may allow more than that: a share of what the grid leaves open.
    """
    demand = max(solution.plan.demand, solution.plan.budget)
    return [
        Caution(
            Limit.LEFT_OUT,
            effect.larger,
            demand,
            f"{name} was left out, but may change a result by {effect.larger:.2g}, more than {demand:.2g}: "
            "force it in",
        )
        for name, effect in solution.left_out.items()
        if effect.larger > demand
    ]
