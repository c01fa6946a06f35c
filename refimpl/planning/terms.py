"""Which terms enter: those that are requested, and those whose effect is neither zero nor negligible."""

from __future__ import annotations

from dataclasses import dataclass

from refimpl.model.friction import is_frictionless
from refimpl.model.problem import Problem, Terms
from refimpl.planning.expected_contact import ExpectedContact
from refimpl.planning.term_effects import ESTIMATES, NONE, Effect, Scales

_SHARE_OF_DEMAND = 0.5  # share of the accuracy, for all neglected terms together
_PEAK_OVER_MEAN = 3.0  # maximum over expected mean pressure: 1.5 of Hertz, 1.4 to 5.1 on 40 random scenes
_SHARE_OF_EDGE_ERROR = 0.01  # share of the grid's own error of A, without friction

LABELS = {
    "coupled": "normal-tangential coupling",
    "oblique": "slope terms",
    "tilted": "slope change by shear",
    "slope_correction": "slope correction",
    "active_set": "active set of tau",
    "plastic": "pressure cap at the hardness",
}
"""The terms of a plan, by the names of their switches, as people read them."""


@dataclass(frozen=True)
class Term:
    """One term of a plan.

    name : its switch, or "active_set"
    included : whether it is modelled
    reason : why, or why not
    effect : estimated effect of neglecting it
    negligible : whether it is neglected because its effect is small, but not zero
    """

    name: str
    included: bool
    reason: str
    effect: Effect = NONE
    negligible: bool = False

    @property
    def label(self) -> str:
        """The name as people read it."""
        return LABELS[self.name]


def budget_of(problem: Problem, contact: ExpectedContact, demand: float) -> float:
    """Return the sum that the effects of all neglected terms may reach: half the demand.

    Frictionless symmetric surfaces have slopes by squares alone: a hundredth of the grid's error of A.
    """
    if is_frictionless(problem.friction) and contact.symmetric:
        return max(_SHARE_OF_DEMAND * demand, _SHARE_OF_EDGE_ERROR * contact.edge_error)
    return _SHARE_OF_DEMAND * demand


def choose(
    problem: Problem,
    contact: ExpectedContact,
    requested: Terms,
    budget: float,
    *,
    for_mu: bool = False,
) -> tuple[Term, ...]:
    """Return all terms; negligible ones add up to the budget. Frictionless slopes are all of mu."""
    choice = _Choice(problem, Scales(contact, problem.pair, problem.friction), requested)
    return choice.terms(budget, for_mu)


class _Choice:
    """What the choice of every term looks at."""

    def __init__(self, problem: Problem, scales: Scales, requested: Terms) -> None:
        self.problem, self.pair = problem, problem.pair
        self.requested = requested
        self.frictionless = scales.frictionless
        self.peak = _PEAK_OVER_MEAN * scales.contact.mean_pressure
        self.effects = {name: estimate(scales) for name, estimate in ESTIMATES.items()}

    def terms(self, budget: float, for_mu: bool) -> tuple[Term, ...]:
        """Return all terms; the budget is spent on coupling and slope terms first."""
        requested, effects = self.requested, self.effects
        open_terms: dict[str, float] = {}
        if requested.coupled is None and effects["coupled"] != NONE and not requested.slope_correction:
            open_terms["coupled"] = effects["coupled"].larger
        slopes_are_mu = for_mu and effects["oblique"].bare > 0
        if requested.oblique is None and not requested.slope_correction and not slopes_are_mu:
            open_terms["oblique"] = effects["oblique"].larger
        negligible, left = _smallest(open_terms, budget)
        coupled = self._coupled(negligible)
        oblique = self._oblique(negligible)
        tilted = self._tilted(coupled, oblique, left)
        correction = self._slope_correction()
        moved = coupled.included or oblique.included or correction.included
        return coupled, oblique, tilted, correction, self._active_set(moved), self._plastic()

    def _requested(self, name: str, excluded: str = "excluded") -> Term | None:
        """Return the term as the user requests it; None where the scene decides."""
        included = getattr(self.requested, name)
        if included is None:
            return None
        return Term(name, included, "requested" if included else excluded, self.effects.get(name, NONE))

    def _coupled(self, negligible: set[str]) -> Term:
        name, effect = "coupled", self.effects["coupled"]
        if (requested := self._requested(name)) is not None:
            return requested
        if self.pair.coupling_ratio == 0:
            return Term(name, False, self._why_uncoupled())
        if self.frictionless and not self.requested.slope_correction:
            return Term(name, False, "no friction")
        if name in negligible:
            return Term(name, False, "negligible", effect, negligible=True)
        return Term(name, True, "shear compliances of the bodies differ", effect)

    def _why_uncoupled(self) -> str:
        if self.pair.shear_ratio == 0:
            return "nu = 0.5 on both: shear does not displace"
        return "lower and upper shear compliances cancel exactly"

    def _oblique(self, negligible: set[str]) -> Term:
        name, effect = "oblique", self.effects["oblique"]
        if (requested := self._requested(name, "excluded: small-slope approximation")) is not None:
            return requested
        if name in negligible:
            reason = "negligible: small-slope approximation"
            return Term(name, False, reason, effect, negligible=effect != NONE)
        return Term(name, True, "slopes enter Eqs (2), (3) and (6)", effect)

    def _tilted(self, coupled: Term, oblique: Term, budget: float) -> Term:
        """Plan the term: with coupling the kernel of shear is there, and this term costs nothing more."""
        name, effect, correction = "tilted", self.effects["tilted"], self.requested.slope_correction
        if not oblique.included:
            return Term(name, False, "no slope terms")
        if (requested := self._requested(name)) is not None:
            return requested
        if self.frictionless and not correction:
            return Term(name, False, "no friction")
        if self.pair.shear_ratio == 0:
            return Term(name, False, self._why_uncoupled())
        if correction or coupled.included:
            return Term(name, True, "comes with the coupling's kernel", effect)
        if effect.larger <= budget:
            return Term(name, False, "negligible", effect, negligible=True)
        return Term(name, True, "shear moves the common surface", effect)

    def _slope_correction(self) -> Term:
        found = self._requested("slope_correction", "not requested: Eq. (7) as printed")
        assert found is not None  # the scene never decides it
        return found

    def _active_set(self, moved: bool) -> Term:
        name = "active_set"
        if self.problem.friction.jump == 0:
            return Term(name, False, "tau is zero")
        if not moved:
            return Term(name, False, "tau moves nothing: it acts where contact is")
        return Term(name, True, "tau > 0 moves the contact that it acts on")

    def _plastic(self) -> Term:
        """Plan the cap: without a request it enters where expected pressures come near the hardness."""
        name, hardness = "plastic", self.pair.softer_hardness
        if (requested := self._requested(name, "excluded: elastic at any pressure")) is not None:
            return requested
        if hardness is None:
            return Term(name, False, "no hardness given")
        if self.peak < hardness:
            return Term(name, False, "pressures are expected to stay below the hardness")
        return Term(name, True, "pressures may reach the hardness")


def _smallest(effects_of: dict[str, float], budget: float) -> tuple[set[str], float]:
    """Return the names of the smallest effects that add up to at most the budget; and what is left."""
    names: set[str] = set()
    for name, effect in sorted(effects_of.items(), key=lambda item: item[1]):
        if effect > budget:
            break
        names.add(name)
        budget -= effect
    return names, budget
