"""Sources of a number's uncertainty, after ASME V&V 20 (2009): numerical, input, sampling, model form.

Every entry is a half-width in the number's unit that holds with 95 %.

- numerical: the sum of the solution's parts (iteration, active set, neglected terms, discretisation), which
  are bounds.
- input: ``sqrt(sum (dq/dp U_p)^2)`` over the scene's parameters with a stated tolerance, by the
  derivatives of `refimpl.sensitivity` (V&V 20, section 3-2).
- sampling: of a mean over realisations of roughness; of one realisation there is none to state.
- model form: four sources that can be found from within, where V&V 20 has experiments. "coefficients": a
  flat half-space's influence coefficients on a slope (`refimpl.half_space.influence_error`), as if both
  moduli were wrong by as much as the worst neighbour. "half-space": what the undeformed surfaces' own error
  (`refimpl.sensitivities.half_space`) exceeds that by. "cosines": printed cosines against a facet's exact
  tractions. "plasticity": of an elastic solution beyond a hardness, the difference to the capped one.

Independent sources add in squares; a model's error is no matter of chance, and is added as it is:
``total = model form + sqrt(numerical^2 + input^2 + sampling^2)``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from refimpl.errors import InputError, NotConverged, require_number
from refimpl.model.forces import facet_resultants
from refimpl.scene.parameters import check_tolerances
from refimpl.scene.scene import Scene
from refimpl.sensitivities.difference_quotients import NUMBERS, solved_again
from refimpl.sensitivities.half_space import half_space_error
from refimpl.sensitivities.sensitivity import Sensitivity, sensitivity
from refimpl.solution.quantities import error_bound
from refimpl.solution.solution import Solution


@dataclass(frozen=True)
class Budget:
    """One number's uncertainty in parts (95 % half-widths in its unit).

    ``inputs`` holds each toleranced parameter's share, ``sources`` each part of the model form's;
    ``sampling`` is None where no ensemble was given. An unbounded part is infinite.
    """

    value: float
    numerical: float
    inputs: Mapping[str, float]
    sources: Mapping[str, float]
    sampling: float | None = None

    @property
    def input(self) -> float:
        """All tolerances together."""
        return math.hypot(*self.inputs.values())

    @property
    def model_form(self) -> float:
        """All known sources of the model's own error together."""
        return sum(self.sources.values())

    @property
    def total(self) -> float:
        """Model form, and the rest in squares."""
        return self.model_form + math.hypot(self.numerical, self.input, self.sampling or 0.0)


@dataclass(frozen=True)
class Budgets:
    """The budgets of a solution's numbers, with the derivatives that they rest on."""

    numbers: Mapping[str, Budget]
    derivatives: Sensitivity
    tolerances: Mapping[str, float] = field(default_factory=dict)


def budget(
    scene: Scene,
    solution: Solution,
    tolerances: Mapping[str, float] | None = None,
    sampling: Mapping[str, float] | None = None,
) -> Budgets:
    """Return the budgets of mu and A (the corrected ones), f_max and Q.

    Parameters
    ----------
    tolerances : relative 95 % half-widths by the names of `refimpl.scene.parameters`; none by default
    sampling : 95 % half-widths of ensemble means by the numbers' names, where there is an ensemble

    Raises
    ------
    InputError
        unknown names, and as `refimpl.sensitivity`
    """
    tolerances, sampling = _mapping("tolerances", tolerances), _mapping("sampling", sampling)
    check_tolerances(scene, tolerances)
    for number, half_width in sampling.items():
        if number not in NUMBERS:
            raise InputError(f"sampling.{number!r}", half_width, f"one of {', '.join(NUMBERS)}")
        require_number(f"sampling.{number!r}", half_width, "a half-width, not negative", at_least=0)
    derivatives = sensitivity(scene, solution)
    sources = _model_form(solution, derivatives)
    for number, more in _half_space(scene, solution, sources).items():
        sources[number]["half-space"] = more
    for number, change in _plasticity(scene, solution).items():
        sources[number]["plasticity"] = change
    numbers = {
        number: Budget(
            value=derivatives.found[number],
            numerical=error_bound(solution, number),
            inputs={
                name: abs(derivatives.derivatives[number][name] * derivatives.parameters[name]) * tolerance
                for name, tolerance in tolerances.items()
            },
            sources=sources[number],
            sampling=sampling.get(number),
        )
        for number in NUMBERS
    }
    return Budgets(numbers, derivatives, tolerances)


def _mapping(name: str, given: Mapping[str, float] | None) -> dict[str, float]:
    if not isinstance(given, Mapping | None):
        raise InputError(name, given, "numbers by name")
    return dict(given or {})


def _model_form(solution: Solution, derivatives: Sensitivity) -> dict[str, dict[str, float]]:
    """Return both sources for each number; infinite where the slope is beyond Appendix A's table."""
    at = solution.details.slope_error
    wrong = None if at.at_rms is None else max(at.at_rms, at.across_at_rms or 0.0)
    cosines = _cosines(solution, derivatives)
    moduli = [name for name in derivatives.parameters if name.endswith(".E")]
    found = {}
    for number in NUMBERS:
        stiffness = sum(
            derivatives.derivatives[number][name] * derivatives.parameters[name] for name in moduli
        )
        coefficients = math.inf if wrong is None else abs(stiffness) * wrong
        found[number] = {"coefficients": coefficients, "cosines": cosines[number]}
    return found


def _half_space(
    scene: Scene, solution: Solution, sources: Mapping[str, Mapping[str, float]]
) -> dict[str, float]:
    """Return what the surfaces' error exceeds "coefficients" by; infinite where a solve fails."""
    try:
        error = half_space_error(scene, solution)
    except NotConverged:
        return dict.fromkeys(NUMBERS, math.inf)
    stated = {number: error.stated(number.removesuffix("_corrected")) for number in NUMBERS}
    return {number: max(0.0, stated[number] - sources[number]["coefficients"]) for number in NUMBERS}


def _plasticity(scene: Scene, solution: Solution) -> dict[str, float]:
    """Return differences to the capped solution, infinite where none converges; empty below H."""
    hardness, problem = solution.details.problem.pair.softer_hardness, solution.details.problem
    if hardness is None or solution.max_pressure <= hardness or problem.terms.plastic:
        return {}
    if scene.load > hardness * problem.grid.nominal_area:
        return dict.fromkeys(NUMBERS, math.inf)
    capped = solved_again(scene, solution, plastic=True)
    return {
        number: abs(getattr(capped, number) - getattr(solution, number)) if capped.converged else math.inf
        for number in NUMBERS
    }


def _cosines(solution: Solution, derivatives: Sensitivity) -> dict[str, float]:
    """Change of each number between printed and exact resultants; of N, as a misjudged load."""
    exact = facet_resultants(
        solution.pressure, solution.traction, solution.slopes, solution.grid.element_area
    )
    misjudged = exact.normal - solution.normal_force
    change = {number: abs(derivatives.derivatives[number]["load"] * misjudged) for number in NUMBERS}
    change["friction_coefficient_corrected"] = abs(
        exact.friction / exact.normal - solution.friction_coefficient
    )
    change["binormal_force"] = abs(exact.binormal - solution.binormal_force)
    return change
