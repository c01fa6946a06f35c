"""Derivatives of a solution's numbers by the scene's numbers.

Friction and area are the corrected ones, without the mean excess of counted edges. Pressures answer smoothly
while the contact set stays as it is, so that friction, binormal force and peak pressure follow from one
linear solve a parameter (`refimpl.sensitivities.fixed_contact`). The area does not: at a fixed set it is
constant, and on a grid it is a count. It is found in two ways, and ``tau dA`` is added to friction.

- Load, moduli and friction leave the surfaces alone, and the edges of the contact move by what the
  linear answer grows like there (`EdgeMotion`), up to one factor. That is taken from the load, for which the
  area is differenced over two full solves.
- Shapes and roughness bring contact to new places, which no fixed set foresees: the area is differenced
  over two full solves for each. So it is for all parameters where pressures reach the hardness: there the
  edge has no such growth.

The scatter beside a derivative has in squares (that of the area through tau beside friction): counts in two
solves, the cubic term, the edge compared with 5 x 5 or 9 x 9 elements, the fixed set's answer against two
solves, half the elements along each side, and the number's own bar over a factor of e of the parameter.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from refimpl.errors import Error, InputError, require_one_of
from refimpl.model.friction import friction_per_area
from refimpl.model.problem import Terms
from refimpl.scene.parameters import differentiable_parameters, parameters
from refimpl.scene.scene import Scene
from refimpl.sensitivities.difference_quotients import (
    NUMBERS,
    area_bound,
    difference_quotients,
    solved_again,
)
from refimpl.sensitivities.fixed_contact import Answer, EdgeMotion, FixedContact, fixed_answer
from refimpl.solution.quantities import error_bound
from refimpl.solution.solution import Solution


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of a solution's numbers with respect to the scene's parameters, SI.

    ``derivatives[number][parameter]``, and ``scatter`` of the same shape: a 95 % half-width, infinite where
    half the grid has no such derivative. ``found`` and ``parameters`` are the numbers and parameters
    themselves. ``residual`` is the worst of the linear solves. ``edge_growth`` is the part of mu's
    derivatives by tau on the area that the contact gains. ``contact_stiffness`` is ``dN / d(approach)``
    (N/m), at the contact set, which it does not change to first order.
    """

    found: Mapping[str, float]
    parameters: Mapping[str, float]
    derivatives: Mapping[str, Mapping[str, float]]
    scatter: Mapping[str, Mapping[str, float]]
    residual: float
    edge_growth: Mapping[str, float] = field(default_factory=dict)
    contact_stiffness: float = math.nan

    def relative(self, number: str, parameter: str) -> float:
        """Return ``(p / q) dq/dp``: the per cents that q changes by for one per cent of p.

        Raises `InputError` for a number that is zero or an unknown name.
        """
        require_one_of("number", number, self.derivatives)
        require_one_of("parameter", parameter, self.parameters)
        derivative, found = self.derivatives[number][parameter], self.found[number]
        if found == 0:
            raise InputError("number", number, "one that is not zero")
        return derivative * self.parameters[parameter] / found


def sensitivity(scene: Scene, solution: Solution, names: Sequence[str] | None = None) -> Sensitivity:
    """Return the derivatives of mu, A, f_max and Q by every parameter of `differentiable_parameters(scene)`.

    ``solution`` is the scene's own, under its load. Costs one GMRES solve a parameter, two solves on the
    solution's grid for the load and for each number of a surface, and as much on half the elements a side.
    ``names`` restricts the parameters to these and the load. Raises `InputError` for a solution that is not
    in contact, not certified or another scene's, `NotConverged` where a linear or full solve does not
    converge.
    """
    _check(scene, solution)
    found, coarse = grid_sensitivity(scene, solution, names), None
    half = [max(1, n // 2) for n in solution.grid.shape]
    with suppress(Error):
        again = solved_again(
            scene, solution, plastic=solution.details.problem.terms.plastic, grid=(half[0], half[1])
        )
        _check(scene, again)
        coarse = grid_sensitivity(scene, again, names)

    def scatter(number: str, name: str) -> float:
        if coarse is None:
            return math.inf
        change = found.derivatives[number][name] - coarse.derivatives[number][name]
        moved = error_bound(solution, number) / found.parameters[name]
        return math.hypot(found.scatter[number][name], change, moved)

    return replace(
        found,
        scatter={number: {name: scatter(number, name) for name in found.parameters} for number in NUMBERS},
    )


def grid_sensitivity(scene: Scene, solution: Solution, names: Sequence[str] | None = None) -> Sensitivity:
    """Return one grid's derivatives, without the scatter between grids. Raises as `sensitivity`."""
    base = solution.details.problem.with_terms(_terms(solution))
    active = solution.contact & ~solution.details.excluded
    fixed = FixedContact(base, solution.pressure, active, solution.slopes)
    values, yields = differentiable_parameters(scene), bool(fixed.capped.any())
    if names is not None:
        values = {name: value for name, value in values.items() if name in ("load", *names)}
    excess = solution.details.features.excess
    answers = {name: fixed_answer(scene, base, fixed, name, value, excess) for name, value in values.items()}
    quotients = {
        name: difference_quotients(scene, solution, name, value)
        for name, value in values.items()
        if name == "load" or ".surface" in name or yields
    }
    solved = {name: derivatives for name, (derivatives, _) in quotients.items()}
    loose = {name: area_bound(solution, values[name], span) for name, (_, span) in quotients.items()}

    # derivatives of the area, with their scatter
    counted = {name: (derivatives[NUMBERS[1]], loose[name]) for name, derivatives in solved.items()}
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
    if not solution.details.certified:
        raise InputError("solution", solution.status.value, "a solution whose certificate holds")
    problem = solution.details.problem
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
    """Return the solution's terms, with all that shear moves unless the user forces it out."""
    requested = solution.plan.requested
    coupled, tilted = (choice is not False for choice in (requested.coupled, requested.tilted))
    return replace(solution.details.problem.terms, coupled=coupled, tilted=tilted)


def _gathered(
    scene: Scene,
    solution: Solution,
    answers: Mapping[str, Answer],
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
            friction -= solution.friction_coefficient_corrected / load
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
        edge_growth={name: dmu_dA * area for name, (area, _) in areas.items()},
        contact_stiffness=1 / answers["load"].approach,
    )


def friction_slopes(scene: Scene, solution: Solution) -> tuple[float, float]:
    """Return ``d mu / d tau`` (1/Pa) and ``d mu / d beta`` of the corrected mu at the contact set.

    Costs two GMRES solves. The motion of the contact's edge is neglected. If all contact is at the hardness,
    pressures are fixed and both numbers are sums. Both parameters must be positive. Raises as `sensitivity`.
    """
    base = solution.details.problem.with_terms(_terms(solution))
    active, excess = solution.contact & ~solution.details.excluded, solution.details.features.excess
    if solution.contact.any() and solution.plastic_area == solution.contact_area:
        along = solution.slopes.cos_x * solution.slopes.cos_y * solution.grid.element_area / scene.load
        mean_area = float(np.sum(active * along)) - excess / scene.load
        return mean_area, float(np.sum(solution.pressure * along))
    _check(scene, solution)
    fixed = FixedContact(base, solution.pressure, active, solution.slopes)
    found = parameters(scene)
    adhesive, pressed = (
        fixed_answer(scene, base, fixed, name, found[name], excess).friction / scene.load
        for name in ("friction.tau", "friction.beta")
    )
    return adhesive, pressed
