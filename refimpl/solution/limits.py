"""Limits of the model: named warnings of a solution, each with its number and its limit."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from refimpl.accuracy.digits import digits_beside
from refimpl.accuracy.iteration_error import without_rule
from refimpl.grid import Grid
from refimpl.grid.contact_patches import patch_sizes
from refimpl.half_space.influence_error import SlopeError, constant_along_an_axis, slope_error
from refimpl.half_space.model_form import ALLOWED, half_space_excess
from refimpl.measured.crop import ROUNDING
from refimpl.model.slopes import Slopes
from refimpl.planning.terms import LABELS
from refimpl.scene.scene import Body, Scene
from refimpl.solution.cause_of_failure import cause_of_failure
from refimpl.solution.domain_error import resolution
from refimpl.solution.evidence import Evidence
from refimpl.solution.model_warning import Limit, ModelWarning, Notice
from refimpl.surfaces import Flat, Sphere
from refimpl.surfaces.statistics import rms_slopes

_PLASTICITY = 1.0  # section 8: beyond it contact ceases to be purely elastic (Greenwood and Williamson 1966)
_COEFFICIENT_ERROR = 0.02  # section 4: what the paper accepts of flat-surface influence coefficients
_ADHESION = 0.1  # J/m^2: works of adhesion of polymers and rubbers are 0.05 to 0.1
_RADIUS = 3.0  # elements: whole elements add 0.30 / r to the area of a circle of radius r, here a tenth


def model_warnings(evidence: Evidence) -> tuple[ModelWarning | Notice, ...]:
    """Return the cause of a failure, a warning for every limit exceeded, notes; none without contact."""
    cause = cause_of_failure(evidence)
    first = () if cause is None else (Notice(cause),)
    if not evidence.state.contact.any():
        return first
    return (*first, *(warning for limit in _LIMITS for warning in limit(evidence)))


def _plastic_notes(evidence: Evidence) -> Iterator[Notice]:
    pair, state = evidence.problem.pair, evidence.state
    area = state.contact_area
    if pair.softer_hardness is None:
        mean = float(state.pressure.sum()) * evidence.problem.grid.element_area / area
        yield Notice(
            f"no hardness given: mean contact pressure {mean / 1e6:.4g} MPa, maximum "
            f"{state.max_pressure / 1e6:.4g} MPa; plasticity not checked"
        )
        return
    if state.plastic_area:
        yield Notice(
            f"{state.plastic_area / area:.1%} of the contact area is at the hardness (first loading): "
            "hardening, flow below the surface and growth of junctions under shear are not modelled"
        )
    if state.plastic_area == area and evidence.problem.load is not None:
        yield Notice("all contact is plastic: the approach is not unique")
    for name, material in (("lower", pair.lower), ("upper", pair.upper)):
        if material.hardness is None:
            yield Notice(f"the {name} body has no hardness: taken as unlimited")


def roughness_slope(scene: Scene, grid: Grid) -> float:
    """Return the root of both bodies' summed mean square slopes along an axis, without spheres and flats."""
    total = 0.0
    for name in ("lower", "upper"):
        rough = [part for part in scene.parts(name) if not isinstance(part, Sphere | Flat)]
        z = grid.zeros
        for part in rough:
            z += part.sample(grid)
        if rough and min(grid.shape) > 1:
            along_x, along_y = rms_slopes(z, grid.spacings)
            total += 0.5 * (along_x**2 + along_y**2)
    return math.sqrt(total)


def _plasticity(evidence: Evidence) -> Iterator[ModelWarning]:
    """Warn by Eq. (12): ``2.2 rms / length`` is the rms slope of Eq. (9) (``sqrt(4.6) = 2.14``)."""
    pair = evidence.problem.pair
    hardness = pair.softer_hardness
    if hardness is None or evidence.problem.terms.plastic:
        return
    index = pair.reduced_modulus / hardness * roughness_slope(evidence.scene, evidence.problem.grid)
    below = "pressures stay below the hardness on these elements, and may reach it on finer ones"
    advice = below if evidence.plan.requested.plastic is None else "set plastic = true"
    text = f"plasticity index {index:.3g} of Eq. (12) reaches 1: contact is no longer purely elastic; "
    if index >= _PLASTICITY:
        yield ModelWarning(Limit.PLASTICITY, index, _PLASTICITY, text + advice)


def _hardness(evidence: Evidence) -> Iterator[ModelWarning]:
    hardness, state = evidence.problem.pair.softer_hardness, evidence.state
    largest = state.max_pressure
    if hardness is None or largest <= hardness:
        return
    least = state.forces.normal / hardness / state.contact_area - 1
    missing = f" (at the hardness A is at least P/H, {least:.1%} more)" if least > 0 else ""
    text = (
        f"maximum contact pressure, {largest / 1e6:.4g} MPa, exceeds the softer body's hardness, "
        f"{hardness / 1e6:.4g} MPa: A, mu and pressures are not reliable{missing}; set plastic = true"
    )
    yield ModelWarning(Limit.HARDNESS, largest, hardness, text)


def _shear(evidence: Evidence) -> Iterator[ModelWarning]:
    """Warn of friction above the softer body's shear strength, ``H / (3 sqrt 3)``.

    H is three times the yield stress (Tabor 1951); von Mises' shear strength is that stress over sqrt 3.
    """
    problem, state = evidence.problem, evidence.state
    hardness = problem.pair.softer_hardness
    if hardness is None:
        return
    strength, active = hardness / (3 * math.sqrt(3)), state.contact & ~state.excluded
    shear = problem.friction.traction(np.minimum(state.pressure, hardness), active)[active]
    if (shear > strength).any():
        largest = float(shear.max())
        text = (
            f"local friction reaches {largest / 1e6:.4g} MPa, the softer body's shear strength is about "
            f"{strength / 1e6:.4g} MPa, H / (3 sqrt 3): on {np.mean(shear > strength):.1%} of the contact it "
            "flows and junctions grow, which no error bar includes"
        )
        yield ModelWarning(Limit.SHEAR, largest, strength, text)


def _law(evidence: Evidence) -> Iterator[Notice]:
    law = evidence.problem.friction
    if without_rule(law):
        yield Notice(f"{type(law).__name__} is not r = tau + beta f: no rule gives error bars of mu and F")


def _adhesion(evidence: Evidence) -> Iterator[Notice]:
    """Note the work of adhesion whose pull-off force of a smooth ball, ``1.5 pi w R`` (JKR), is the load."""
    scene, load = evidence.scene, evidence.problem.load
    if load and scene.curvature > 0 and (work := load * scene.curvature / (1.5 * math.pi)) < _ADHESION:
        yield Notice(
            f"adhesion is not modelled: a work of adhesion of {work:.2g} J/m^2 would pull smooth bodies "
            "together with a force as large as the load"
        )


def _slopes(evidence: Evidence) -> Iterator[ModelWarning]:
    """Warn by both slopes; errors across are None for plane problems."""
    error = _error_at_slopes(evidence)
    for limit, slope, in_line, across in (
        (Limit.RMS_GRADIENT, error.rms_gradient, error.at_rms, error.across_at_rms),
        (Limit.MAX_SLOPE, error.max_slope, error.at_max, error.across_at_max),
    ):
        largest = math.inf if in_line is None else max(in_line, across or 0.0)
        size = "beyond Appendix A's table"
        if in_line is not None:
            both = "" if across is None else f" in line and {across:.1%} across"
            size = f"by {in_line:.1%}{both}, above 2 %, by Appendix A"
        angle = f"{limit.value} {math.degrees(slope):.3g} degrees"
        if largest > _COEFFICIENT_ERROR:
            text = f"{angle}: influence coefficients of a flat are off {size}"
            yield ModelWarning(limit, largest, _COEFFICIENT_ERROR, text)


def _error_at_slopes(evidence: Evidence) -> SlopeError:
    """Return the error as quoted, or at the deformed surfaces where slope terms are excluded."""
    term = evidence.plan.term("oblique")
    if term.included or term.negligible:
        return evidence.slope_error
    problem, state = evidence.problem, evidence.state
    near = problem.grid.window_around(state.contact, margin=1).slices
    surface = 0.5 * (state.displacement_upper[near] - state.displacement_lower[near])
    surface += problem.mean_surface[near]
    slopes = Slopes.of_surface(surface, problem.grid, 0.0)
    plane = constant_along_an_axis(problem.gap, problem.mean_surface)
    return slope_error(slopes, state.pressure[near], problem.pair, plane=plane)


def _half_space(evidence: Evidence) -> Iterator[ModelWarning]:
    if (found := half_space_excess(evidence.problem, evidence.state)) is not None:
        yield ModelWarning(Limit.HALF_SPACE, found[0], ALLOWED, found[1])


def _border(evidence: Evidence) -> Iterator[ModelWarning]:
    scene, touching = evidence.scene, evidence.problem.grid.on_border(evidence.state.contact)
    if not touching:
        return
    concave = [
        name for name, sign in (("lower", 1), ("upper", -1)) if _is_concave(getattr(scene, name), sign)
    ]
    if concave:
        advice = f"the {' and '.join(concave)} body is concave (sign of its radius?)"
    elif scene.continues:
        advice = f"enlarge the domain{_expected_size(evidence)}"
    else:
        advice = "flat bodies end there; a larger domain or map, or periodic = true, has less of a border"
    text = f"contact reaches the border of the domain on {touching} elements: {advice}"
    yield ModelWarning(Limit.BORDER, touching, 0, text)


def _expected_size(evidence: Evidence) -> str:
    """Estimate by Hertz, of the paraboloids alone under the load; their contact goes on beyond the border."""
    scene, problem = evidence.scene, evidence.problem
    if not scene.continues or not problem.load or scene.curvature < 0:
        return ""
    radius = (0.75 * problem.load / (problem.pair.reduced_modulus * scene.curvature)) ** (1 / 3)
    half = min(problem.grid.lengths) / 2
    right = f"the load, {problem.load:.4g} N, and the radius, {1 / scene.curvature:.3g} m, right"
    unit = f" (are {right}?)" if radius > half else ""
    return f": Hertz's contact radius is {radius:.3g} m, half of the domain {half:.3g} m{unit}"


def _is_concave(body: Body, sign: int) -> bool:
    return sign * sum(1 / part.radius for part in body.surface.parts if isinstance(part, Sphere)) > 0


def _correlation(evidence: Evidence) -> Iterator[ModelWarning]:
    found = resolution(evidence.scene, evidence.problem.grid, evidence.plan.demand)
    if found is None or found.elements >= found.detail.resolved:
        return
    detail = found.detail
    missed = f"; the grid misses {detail.missed}" if detail.missed else ""
    per = digits_beside(found.elements, detail.resolved)
    text = (
        f"{per} elements per {detail.name}, {detail.length:.3g} m: slopes of the roughness are not "
        f"resolved below {detail.resolved:.0f}{missed}; A, and mu by the share of tau, come out too large"
    )
    yield ModelWarning(Limit(detail.name), found.elements, detail.resolved, text)


def _data(evidence: Evidence) -> Iterator[ModelWarning]:
    points = max(evidence.problem.grid.spacings) / (evidence.scene.pitch or math.inf)
    text = (
        f"{digits_beside(points, 1)} points of a surface's data per element: points between the elements' "
        "centres are not sampled, and error bars do not include them"
    )
    if points > 1 + ROUNDING:
        yield ModelWarning(Limit.DATA, points, 1, text)


def _radius(evidence: Evidence) -> Iterator[ModelWarning]:
    """Warn by the mean radius of circles; full contact has no edge to resolve."""
    contact, grid = evidence.state.contact, evidence.problem.grid
    if contact.all():
        return
    box = grid.window_around(contact, margin=0)
    patches = patch_sizes(contact[box.slices], periodic=grid.periodic).size
    radius = math.sqrt(np.count_nonzero(contact) / (math.pi * patches))
    text = (
        f"contact patches have a mean radius of {digits_beside(radius, _RADIUS)} elements: below 3 areas are "
        "coarse, and error bars of areas, peaks and approaches may be too short where they are finite"
    )
    if radius < _RADIUS:
        yield ModelWarning(Limit.RADIUS, radius, _RADIUS, text)


def _active_set(evidence: Evidence) -> Iterator[ModelWarning]:
    if excluded := int(np.count_nonzero(evidence.state.excluded & evidence.state.contact)):
        text = (
            f"the contact edge alternates under tau: {excluded} elements in contact carry no adhesive shear; "
            "mu's error bar includes them"
        )
        yield ModelWarning(Limit.ACTIVE_SET, excluded, 0, text)


def _neglected(evidence: Evidence) -> Iterator[ModelWarning]:
    """Warn of neglected terms whose effect, by the solution, exceeds the demand and the budget."""
    demand = max(evidence.plan.demand, evidence.plan.budget)
    for name, effect in evidence.neglected.items():
        if effect.larger > demand:
            text = (
                f"{LABELS[name]} neglected, but may change a result by {effect.larger:.2g}, more than "
                f"{demand:.2g}: request it ({name} = true)"
            )
            yield ModelWarning(Limit.NEGLECTED, effect.larger, demand, text)


_LIMITS: tuple[Callable[[Evidence], Iterator[ModelWarning | Notice]], ...] = (
    _plasticity,
    _hardness,
    _shear,
    _slopes,
    _half_space,
    _border,
    _correlation,
    _data,
    _radius,
    _active_set,
    _neglected,
    _plastic_notes,
    _law,
    _adhesion,
)
