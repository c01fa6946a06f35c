"""Friction of one row by the model: mu at given parameters, its slopes, its bars and its contact."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, MutableMapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from refimpl.accuracy.discretisation_error import EXCESS_SPREAD
from refimpl.driver.solve import solve
from refimpl.errors import InputError, NotConverged
from refimpl.grid import Array
from refimpl.scene.parameters import BODIES, parameters, with_parameter
from refimpl.scene.scene import Scene
from refimpl.sensitivities.difference_quotients import difference_quotients
from refimpl.sensitivities.sensitivity import friction_slopes, grid_sensitivity
from refimpl.solution.quantities import error_bound
from refimpl.solution.solution import Solution

COVERAGE = 1.959963984540054  # half-width of 95 % over the standard uncertainty, normal distribution
NAMES = ("friction.tau", "friction.beta")
_FLOOR = 1e-4  # share of the friction below which a parameter is not solved for: slopes extrapolate to zero
_QUANTILES = 64  # pressures that stand for a contact in other laws: mu to 1e-3
_DIFFERENCE_SOLVES = 2  # solves that a derivative by the load, a hardness or a number of a surface takes
Memory = MutableMapping[str, Mapping[str, Any]]
Key = Callable[[Scene, Any], str]
_ROUGHNESS = (".rms", ".rms_gradient")


@dataclass(frozen=True)
class Response:
    """Model of one row, linear about the parameters ``at``: tau (Pa), beta, logarithms of further ones.

    mu : friction coefficient, without tau on the mean excess of the contact edge
    slopes : ``d mu / d tau`` (1/Pa), ``d mu / d beta``, ``d mu / d ln p``
    numerical, contact_edge : 95 % half-widths of mu: error bar, and choice at contact edges
    shared : the part of ``numerical`` that all rows have in common, by the factor of the mean excess
    inputs : 95 % half-widths of mu by toleranced parameter, with the sign of the derivative
    contact_fraction : A / A0, without the mean excess
    border, plastic : shares of the contact on the border, at the hardness
    pressures, weights : pressures (Pa) and ``cos cos dA / P`` (1/Pa) that stand for the contact
    solves : solves of the scene; warnings : the solution's
    scatter : standard uncertainty of mu by the choice of a realisation, where this is a mean over several
    """

    at: tuple[float, ...]
    mu: float
    slopes: tuple[float, ...]
    numerical: float
    shared: float
    contact_edge: float
    inputs: Mapping[str, float]
    contact_fraction: float
    border: float
    plastic: float
    pressures: tuple[float, ...]
    weights: tuple[float, ...]
    solves: int
    warnings: tuple[str, ...]
    scatter: float = 0.0

    def predict(self, theta: Array) -> float:
        """Return mu at other parameters, by the slopes."""
        return self.mu + float(np.dot(self.slopes, np.subtract(theta, self.at)))


class Forward:
    """Responses of scenes on one grid; ``memory`` keeps them by ``key``, for a fit that goes on later.

    ``further`` names parameters that are fitted beside tau and beta, by their logarithms; ``realisations`` is
    the number of draws of random surfaces.
    """

    def __init__(
        self,
        grid: int | tuple[int, int] | None,
        memory: Memory | None = None,
        key: Key | None = None,
        report: Callable[[str], None] | None = None,
        further: Sequence[str] = (),
        realisations: int = 1,
    ) -> None:
        self.grid, self.solves, self.further, self.realisations = grid, 0, tuple(further), realisations
        self._memory, self._key, self._report = memory, key, report

    def respond(self, scene: Scene, theta: Array, tolerances: Mapping[str, float] | None = None) -> Response:
        """Return the response at ``(tau, beta, ln p, ...)``; raises as `refimpl.solve`, or `NotConverged`."""
        if self._report is not None:
            self._report(f"solve {self.solves + 1}: {scene.load:.4g} N")
        friction = np.maximum(theta[: len(NAMES)], least_parameters(scene))
        for name, value in zip(NAMES, friction, strict=True):
            scene = with_parameter(scene, name, float(value))
        for name, logarithm in zip(self.further, theta[len(NAMES) :], strict=True):
            scene = with_parameter(scene, name, math.exp(logarithm))
        at = (*map(float, friction), *map(float, theta[len(NAMES) :]))
        tolerances = dict(tolerances or {})
        settings = {"grid": self.grid, "tolerances": tolerances, "further": self.further}
        key = None if self._memory is None or self._key is None else self._key(scene, settings)
        if self._memory is not None and key is not None and (stored := self._memory.get(key)) is not None:
            return response_from_dict(stored)
        found = _response(scene, self.grid, at, tolerances, self.further)
        if self._memory is not None and key is not None:
            self._memory[key] = asdict(found)
        self.solves += found.solves
        return found


def response_from_dict(stored: Mapping[str, Any]) -> Response:
    """Return a response from its fields, as JSON keeps them."""
    tuples = {name: tuple(value) for name, value in stored.items() if isinstance(value, list | tuple)}
    return Response(**{**stored, **tuples})


def least_parameters(scene: Scene) -> tuple[float, float]:
    """Return the least parameters that are solved for (Pa, 1): they do not matter, and have slopes."""
    return _FLOOR * 1e-4 * scene.materials.reduced_modulus, _FLOOR * 1e-2


def _response(
    scene: Scene, grid: Any, at: tuple[float, ...], tolerances: Mapping[str, float], further: Sequence[str]
) -> Response:
    solution = solve(scene, grid)
    if not solution.converged or not solution.contact.any():
        share = 100 * float(solution.contact.mean())
        raise NotConverged(
            f"the solve at {scene.load:.4g} N ended as {solution.status.value} with {share:.3g} % of the "
            "domain in contact: check the units of load and friction"
        )
    inputs, solves = _inputs(scene, solution, tolerances)
    by_tau, by_beta = friction_slopes(scene, solution)
    excess = solution.details.features.excess
    factor = COVERAGE * EXCESS_SPREAD * abs(excess)
    slopes = (by_tau, by_beta, *(_log_slope(scene, solution, name) for name in further))
    name = "friction_coefficient_corrected"
    edge = solution.uncertainty[name].get("active set") or 0.0
    rest = error_bound(solution, name) - edge
    pressures, weights = _condensed(solution, scene.load)
    contact = solution.contact
    on_border = float(contact.sum() - contact[1:-1, 1:-1].sum()) / float(contact.sum())
    return Response(
        at=at,
        mu=solution.friction_coefficient_corrected,
        slopes=slopes,
        numerical=min(rest, 10 * abs(solution.friction_coefficient)),
        shared=factor / scene.load * solution.details.problem.friction.jump,
        contact_edge=edge,
        inputs=inputs,
        contact_fraction=(solution.contact_area - excess) / solution.grid.nominal_area,
        border=on_border * solution.details.problem.counts_from_first_contact,
        plastic=solution.plastic_area / solution.contact_area,
        pressures=pressures,
        weights=weights,
        solves=1 + solves + _DIFFERENCE_SOLVES * len(further),
        warnings=tuple(str(text) for text in solution.warnings if getattr(text, "number", None) is not None),
    )


def _log_slope(scene: Scene, solution: Solution, name: str) -> float:
    """Return ``d mu / d ln p`` by two solves: areas are counted (`grid_sensitivity`)."""
    value = parameters(scene)[name]
    return value * difference_quotients(scene, solution, name, value)[0]["friction_coefficient_corrected"]


def _inputs(
    scene: Scene, solution: Solution, tolerances: Mapping[str, float]
) -> tuple[dict[str, float], int]:
    """Return the changes of mu at the tolerances (95 %), and the solves that they take."""
    if not tolerances:
        return {}, 0
    found = grid_sensitivity(scene, solution, tuple(tolerances))
    derivatives = found.derivatives["friction_coefficient_corrected"]
    differenced = sum(name == "load" or ".surface" in name for name in found.parameters)
    if solution.plastic_area > 0:
        differenced = len(found.parameters)
    inputs = {name: derivatives[name] * found.parameters[name] * tol for name, tol in tolerances.items()}
    return inputs, _DIFFERENCE_SOLVES * differenced


def _condensed(solution: Solution, load: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the mean pressures of groups of elements, ordered by pressure, and the groups' weights."""
    active = solution.contact & ~solution.details.excluded
    slopes = solution.slopes
    along = (slopes.cos_x * slopes.cos_y + solution.grid.zeros)[active] * solution.grid.element_area / load
    pressure = solution.pressure[active]
    order = np.argsort(pressure)
    groups = [group for group in np.array_split(order, _QUANTILES) if len(group)]
    weights = tuple(float(along[group].sum()) for group in groups)
    means = tuple(float(np.average(pressure[group], weights=along[group])) for group in groups)
    return means, weights


def further_parameters(scene: Scene, names: Sequence[str]) -> tuple[str, ...]:
    """Return the parameters' whole names; `InputError` for none, for two parameters, for repetition.

    The height of a random roughness is none of them. Friction hardly determines it where the surface is known
    by its statistics: on twins of rough balls its 95 % interval spans a factor of about 3 either way, over
    which mu is not linear, and intervals of tau that rest on it are too short. A measured height with its
    tolerance is an input (`identify(..., tolerances=...)`).
    """
    if isinstance(names, str):
        raise InputError("fit", names, "a list of names")
    found = tuple(_whole(scene, name) for name in names)
    if len(set(found)) < len(found):
        raise InputError("fit", ", ".join(found), "each parameter once")
    return found


def _whole(scene: Scene, name: str) -> str:
    softest = scene.materials.softer_hardness
    hardnesses = [
        f"{body}.material.hardness"
        for body in BODIES
        if softest is not None and getattr(scene, body).material.hardness == softest
    ]
    if name == "roughness" or name.endswith(_ROUGHNESS):
        raise InputError(
            "fit", name, "no height of a roughness, which friction hardly determines; give it in [tolerances]"
        )
    if name != "hardness" and name not in hardnesses:
        raise InputError("fit", name, f"one of {', '.join(['hardness', *hardnesses])}")
    if not hardnesses:
        raise InputError("fit", name, "a scene with a hardness: its value is the first guess")
    if len(hardnesses) > 1:
        raise InputError("fit", name, "two hardnesses that differ, or one: the smaller of them is fitted")
    return hardnesses[0]
