"""Derivatives of a solution's numbers by the scene's numbers.

Pressures answer smoothly while the contact set stays as it is, so that friction, binormal force and peak
pressure follow from one linear solve a parameter (`refimpl.sensitivities.fixed_contact`). The area does not:
at a fixed set it is constant, and on a grid it is a count. It is found in two ways, and ``tau dA`` is added
to friction.

- Load, moduli and friction leave the surfaces alone, and the edges of the contact move by what the
  linear answer grows like there (`refimpl.sensitivities.edge_motion`), up to one factor. That is taken from
  the load, for which the area is differenced over two full solves.
- Shapes and roughness bring contact to new places, which no fixed set foresees: the area is differenced
  over two full solves for each. So it is for all parameters where pressures reach the hardness: there the
  edge has no such growth.

The scatter stated beside the area (and through tau beside friction) is that of counting elements in
two solves, and of comparing the edge with 5 x 5 or with 9 x 9 elements. Beside every number's answer to the
load, a shape or a roughness stands how far the fixed set's answer is from that of the two solves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from refimpl.accuracy.discretisation_error import AREA, area_scatter
from refimpl.driver.solve import solve
from refimpl.errors import InputError, require_one_of
from refimpl.grid import Array
from refimpl.model.friction import friction_per_area
from refimpl.model.problem import Problem, Terms
from refimpl.scene.discretise import discretise
from refimpl.scene.parameters import differentiable_parameters, parameters, with_parameter
from refimpl.scene.scene import Scene
from refimpl.sensitivities.edge_motion import EdgeMotion
from refimpl.sensitivities.fixed_contact import FixedContact
from refimpl.solution.solution import Solution

NUMBERS = ("friction_coefficient", "contact_area", "max_pressure", "binormal_force")
_STEP = 1e-4  # relative, of parameters: smooth at a fixed set, so the quotient errs by 1e-8
_STRIDE = 0.1  # relative, of parameters in full solves: moves an edge by several per cent of a radius
_SHIFT = 0.1  # correlation lengths by which a change of the length may move the surface at the far border
_TIED = 1e-6  # share of p_max within which pressures tie: symmetric scenes, apart from slopes
_SOLVED = 1e-3  # relative residual of a linear solve, at most: the digits of a derivative
_Found = TypeVar("_Found")


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of a solution's numbers with respect to the scene's parameters, SI.

    ``derivatives[number][parameter]``, and ``scatter`` of the same shape: the 95 % bound of what
    counting elements leaves uncertain (0 for what is smooth), and how far apart two ways to a derivative are.
    All are of the solution's grid: what that does not resolve, no scatter knows. ``found`` and ``parameters``
    are the numbers and parameters themselves. ``residual`` is the worst of the linear solves.
    """

    found: Mapping[str, float]
    parameters: Mapping[str, float]
    derivatives: Mapping[str, Mapping[str, float]]
    scatter: Mapping[str, Mapping[str, float]]
    residual: float

    def relative(self, number: str, parameter: str) -> float:
        """``(p / q) dq/dp``: the per cents that q changes by for one per cent of p.

        Raises `InputError` for a number that is zero, and for a name that is none.
        """
        require_one_of("number", number, self.derivatives)
        require_one_of("parameter", parameter, self.parameters)
        derivative, found = self.derivatives[number][parameter], self.found[number]
        if found == 0:
            raise InputError("number", number, "one that is not zero")
        return derivative * self.parameters[parameter] / found


def sensitivity(scene: Scene, solution: Solution, names: Sequence[str] | None = None) -> Sensitivity:
    """Derivatives of mu, A, f_max and Q by every parameter of `differentiable_parameters(scene)`.

    ``solution`` is the scene's own, under its load. Costs one GMRES solve a parameter, and two
    solves on the solution's grid for the load and for each number of a surface. ``names`` restricts the
    parameters to these and the load. Raises `InputError`
    for a solution that is not in contact, not certified or another scene's, `ArithmeticError` where a
    linear or full solve does not converge.
    """
    _check(scene, solution)
    base = solution.problem.with_terms(_terms(solution))
    active = solution.contact & ~solution.excluded
    fixed = FixedContact(base, solution.pressure, active, solution.slopes)
    values, yields = differentiable_parameters(scene), bool(fixed.capped.any())
    if names is not None:
        values = {name: value for name, value in values.items() if name in ("load", *names)}
    answers = {name: _answer(scene, base, fixed, name, value) for name, value in values.items()}
    quotients = {
        name: difference_quotients(scene, solution, name, value)
        for name, value in values.items()
        if name == "load" or ".surface" in name or yields
    }
    solved = {name: derivatives for name, (derivatives, _) in quotients.items()}
    # 95 % bound of what counting elements in two solves leaves uncertain, as in the error bars of one grid
    counting = 2 * math.sqrt(2) * AREA.scatter * area_scatter(solution.features)
    counted = {
        name: (derivatives["contact_area"], counting / span)
        for name, (derivatives, span) in quotients.items()
    }
    edge = EdgeMotion(fixed, counted["load"], answers["load"].pressure)
    areas = {
        name: counted[name]
        if name in counted and (yields or name != "load")
        else edge.derivative(answers[name].pressure)
        for name in values
    }
    return _gathered(scene, solution, answers, areas, solved)


def _check(scene: Scene, solution: Solution) -> None:
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    if not isinstance(solution, Solution):
        raise InputError("solution", solution, "a Solution")
    if not scene.friction.is_linear:
        raise InputError("friction", scene.friction, "a law that is linear, for derivatives")
    if not solution.contact.any():
        raise InputError("solution", solution.status.value, "a solution in contact")
    if not solution.certified:
        raise InputError("solution", solution.status.value, "a solution whose certificate holds")
    problem = solution.problem
    if solution.plastic_area == solution.contact_area:
        raise InputError("solution", "all contact at the hardness", "one with elastic contact")
    if not (problem.gap.any() or problem.counts_from_first_contact):
        raise InputError("solution", "two periodic flats", "one whose approach is not zero")
    if problem.load != scene.load:
        raise InputError("solution", problem.load, f"one under the scene's load of {scene.load:g} N")
    grid = problem.grid
    found = problem.pair, problem.friction, problem.direction, grid.lengths, grid.periodic
    own = scene.materials, scene.friction, scene.sliding_direction, scene.lengths, scene.periodic
    if found != own:
        raise InputError("solution", "another scene's", "the scene's own")


def _terms(solution: Solution) -> Terms:
    """The solution's, with all that shear moves unless the user forces it out.

    Where two bodies' compliances cancel it is left out of the solve, and comes in with the first change.
    """
    requested = solution.plan.requested
    coupled, tilted = (choice is not False for choice in (requested.coupled, requested.tilted))
    return replace(solution.problem.terms, coupled=coupled, tilted=tilted)


@dataclass(frozen=True, eq=False)
class _Answer:
    """Derivatives at the fixed set: pressures (window's shape), their peak, F and Q over the parameter.

    Of peaks that tie the middle one counts, as for a central difference; ``torn`` is how far others are off.
    """

    pressure: Array
    peak: float
    torn: float
    friction: float
    binormal: float
    residual: float


def _answer(scene: Scene, base: Problem, fixed: FixedContact, name: str, value: float) -> _Answer:
    (low, below), (high, above) = _both_sides(
        name,
        value,
        _STEP,
        lambda at: _changed(scene, base, with_parameter(scene, name, at)).windowed(fixed.window),
    )
    span = high - low
    residuals = [fixed.residual(problem, fixed.pressure, fixed.approach) for problem in (below, above)]
    found = fixed.response((residuals[1] - residuals[0]) / span)
    if not found.residual <= _SOLVED:
        raise ArithmeticError(f"the derivative over {name} is not found: {found.residual:.1e} is left of it")
    before, after = (
        fixed.forces(
            problem,
            fixed.pressure + (at - value) * found.pressure,
            fixed.approach + (at - value) * found.approach,
        )
        for problem, at in ((below, low), (above, high))
    )
    pressure = found.pressure
    if fixed.capped.any():
        pressure = np.where(fixed.capped, (above.cap - below.cap) / span, pressure)
    tied = pressure[fixed.pressure >= (1 - _TIED) * fixed.peak]
    return _Answer(
        pressure=pressure,
        peak=0.5 * float(tied.max() + tied.min()),
        torn=0.5 * float(np.ptp(tied)),
        friction=(after.friction - before.friction) / span,
        binormal=(after.binormal - before.binormal) / span,
        residual=found.residual,
    )


def _both_sides(
    name: str, value: float, step: float, make: Callable[[float], _Found]
) -> tuple[tuple[float, _Found], tuple[float, _Found]]:
    """Return the values a relative step below and above a parameter, each with what is made of it.

    Where one side is refused the value itself takes its place. Raises `InputError` where both are.
    """
    found: dict[float, _Found] = {}
    for at in (value * (1 - step), value * (1 + step)):
        with suppress(InputError):
            found[at] = make(at)
    if not found:
        raise InputError(name, value, f"a value with another allowed one {step:.2g} of it below or above")
    if len(found) == 1:
        found[value] = make(value)
    low, high = sorted(found)
    return (low, found[low]), (high, found[high])


def _changed(scene: Scene, base: Problem, changed: Scene) -> Problem:
    """The changed scene's problem; surfaces are sampled again only where they changed."""
    if changed.upper.surface is scene.upper.surface and changed.lower.surface is scene.lower.surface:
        elasticity = replace(base.elasticity, pair=changed.materials)
        return replace(base, elasticity=elasticity, friction=changed.friction, load=changed.load)
    return discretise(changed, base.grid, base.terms)


def difference_quotients(
    scene: Scene, solution: Solution, name: str, value: float
) -> tuple[dict[str, float], float]:
    """Return each number's derivative over a parameter by two solves, and how far apart their values are.

    A tenth of the value to either side, or to one where the other is not allowed. Raises `ArithmeticError`
    where one of both solves does not converge, `InputError` where neither side is allowed.
    """
    step, plastic = _stride(scene, name, value), solution.problem.terms.plastic
    (low, below), (high, above) = _both_sides(
        name, value, step, lambda at: solved_again(with_parameter(scene, name, at), solution, plastic=plastic)
    )
    for ended in (below, above):
        if not ended.converged:
            raise ArithmeticError(f"a solve with {name} changed by {step:.2g} ended as {ended.status.value}")
    span = high - low
    return {number: (getattr(above, number) - getattr(below, number)) / span for number in NUMBERS}, span


def solved_again(
    scene: Scene, solution: Solution, *, plastic: bool | None, approach: float | None = None
) -> Solution:
    """Solve a scene on a solution's grid, with its terms and its tolerance."""
    terms = solution.problem.terms
    corrected = terms.slope_correction and not plastic
    return solve(
        scene,
        solution.grid.shape,
        approach=approach,
        oblique=terms.oblique,
        slope_correction=corrected,
        coupled=None if terms.slope_correction else terms.coupled,  # facet tractions include shear
        tilted=terms.tilted,
        plastic=plastic,
        tolerance=solution.tolerance,
    )


def _stride(scene: Scene, name: str, value: float) -> float:
    """The relative step of full solves. Numbers that deform a surface about its corner move it farthest at
    the other border: by no more than a share of its finest length."""
    head, _, key = name.rpartition(".")
    if key.startswith("correlation_length"):
        return min(_STRIDE, _SHIFT * value / max(scene.lengths))
    if key in ("lay", "anisotropy"):
        which, _, place = head.partition(".")
        part = getattr(scene, which).surface.parts[int(place[len("surface[") : -1])]
        finest: float = part.detail(max(scene.lengths)).length
        turn = abs(value) if key == "lay" else 1.0
        return min(_STRIDE, _SHIFT * finest / max(scene.lengths) / turn)
    return _STRIDE


def _gathered(
    scene: Scene,
    solution: Solution,
    answers: Mapping[str, _Answer],
    areas: Mapping[str, tuple[float, float]],
    solved: Mapping[str, Mapping[str, float]],
) -> Sensitivity:
    load, dmu_dA = scene.load, friction_per_area(scene.friction, scene.load)
    derivatives: dict[str, dict[str, float]] = {number: {} for number in NUMBERS}
    scatter: dict[str, dict[str, float]] = {number: {} for number in NUMBERS}
    for name, answer in answers.items():
        area, loose = areas[name]
        friction = answer.friction / load + dmu_dA * area
        if name == "load":
            friction -= solution.friction_coefficient / load
        found = (friction, area, answer.peak, answer.binormal)
        spreads = dmu_dA * loose, loose, answer.torn, 0.0
        for number, derivative, spread in zip(NUMBERS, found, spreads, strict=True):
            # the fixed set has no contact at new places; where two solves exist, their difference is included
            apart = abs(derivative - solved[name][number]) if name in solved else 0.0
            derivatives[number][name], scatter[number][name] = derivative, math.hypot(spread, apart)
    return Sensitivity(
        found={number: float(getattr(solution, number)) for number in NUMBERS},
        parameters={name: parameters(scene)[name] for name in answers},
        derivatives=derivatives,
        scatter=scatter,
        residual=max(answer.residual for answer in answers.values()),
    )


def friction_slopes(scene: Scene, solution: Solution) -> tuple[float, float]:
    """Return ``d mu / d tau`` (1/Pa) and ``d mu / d beta`` at the solution's contact set.

    Two GMRES solves and no solve of the scene. The motion of the contact's edge is neglected: `sensitivity`
    includes it. Where all contact is at the hardness, pressures are fixed and the slopes are sums.
    Both parameters must be positive. Raises as `sensitivity` does.
    """
    base = solution.problem.with_terms(_terms(solution))
    active = solution.contact & ~solution.excluded
    if solution.contact.any() and solution.plastic_area == solution.contact_area:
        along = solution.slopes.cos_x * solution.slopes.cos_y * solution.grid.element_area / scene.load
        return float(np.sum(active * along)), float(np.sum(solution.pressure * along))
    _check(scene, solution)
    fixed = FixedContact(base, solution.pressure, active, solution.slopes)
    found = parameters(scene)
    adhesive, pressed = (
        _answer(scene, base, fixed, name, found[name]).friction / scene.load
        for name in ("friction.tau", "friction.beta")
    )
    return adhesive, pressed
