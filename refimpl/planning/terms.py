"""Which terms enter: those that the user forces, those that are not exactly zero and not small enough."""

from __future__ import annotations

from dataclasses import dataclass

from refimpl.errors import InputError
from refimpl.planning import term_effects
from refimpl.planning.expected_contact import Outlook
from refimpl.planning.term_effects import NONE, Effect, Scales
from refimpl.scene.scene import Scene

_BUDGET = 0.5  # share of the demand that all terms left out may add up to
_OF_THE_GRID = 0.01  # of the grid's own error: what may be left out where no friction force is at stake


@dataclass(frozen=True)
class Term:
    """One piece of physics: whether it is modelled, why, and what leaving it out changes (an estimate)."""

    name: str
    included: bool
    reason: str
    effect: Effect = NONE
    small: bool = False


@dataclass(frozen=True)
class Forced:
    """What the user says of each term: in, out, or nothing (None)."""

    coupled: bool | None = None
    oblique: bool | None = None
    tilted: bool | None = None
    slope_correction: bool = False

    def check(self) -> None:
        """Raise `InputError` for terms that exclude each other."""
        if self.slope_correction and self.oblique is False:
            raise InputError("oblique", self.oblique, "true or unset: the slope correction needs the slopes")
        if self.slope_correction and self.coupled is False:
            raise InputError("coupled", self.coupled, "true or unset: facet tractions include shear")


def affordable(scene: Scene, outlook: Outlook, demand: float) -> float:
    """What all terms left out may add up to: half the demand.

    Without friction, symmetric surfaces have neither F nor Q, and slopes enter by their squares alone,
    as a change of A and f: there it is a hundredth of the grid's own error of A, if that is more.
    """
    if scene.friction.is_zero and outlook.symmetric:
        return max(_BUDGET * demand, _OF_THE_GRID * outlook.edge_error)
    return _BUDGET * demand


def choose(
    scene: Scene, outlook: Outlook, forced: Forced, budget: float, *, of_mu: bool = False
) -> tuple[Term, ...]:
    """All terms in a fixed order; those left out as small add up to no more than the budget.

    Where the budget is ``of_mu`` and there is no friction, slopes are all of mu and never small.
    """
    scales = Scales(outlook, scene.materials, scene.friction)
    coupling, slopes = term_effects.shear_coupling(scales), term_effects.obliqueness(scales)
    open_terms: dict[str, float] = {}
    if forced.coupled is None and coupling != NONE and not forced.slope_correction:
        open_terms["shear coupling"] = coupling.larger
    if forced.oblique is None and not forced.slope_correction and not (of_mu and slopes.bare > 0):
        open_terms["obliqueness"] = slopes.larger
    small, budget = _smallest(open_terms, budget)
    coupled = _coupling(scene, forced, coupling, small)
    oblique = _obliqueness(forced, slopes, small)
    tilted = _tilt(scene, forced, scales, coupled, oblique, budget)
    moved = coupled.included or oblique.included
    correction = Term(
        "slope correction",
        forced.slope_correction,
        "asked for" if forced.slope_correction else "not asked for: Eq. (7) as printed",
        term_effects.slope_correction(scales),
    )
    return coupled, oblique, tilted, correction, _tau_support(scene, moved or correction.included)


def _smallest(effects_of: dict[str, float], budget: float) -> tuple[set[str], float]:
    """The names whose effects, smallest first, add up to no more than the budget; and what is left of it."""
    names: set[str] = set()
    for name, effect in sorted(effects_of.items(), key=lambda item: item[1]):
        if effect > budget:
            break
        names.add(name)
        budget -= effect
    return names, budget


def _coupling(scene: Scene, forced: Forced, effect: Effect, small: set[str]) -> Term:
    name = "shear coupling"
    if forced.coupled is not None:
        return Term(name, forced.coupled, "forced in" if forced.coupled else "forced out", effect)
    if scene.materials.shear_compliance == 0:
        return Term(name, False, _why_uncoupled(scene))
    if scene.friction.is_zero and not forced.slope_correction:
        return Term(name, False, "no friction")
    if name in small:
        return Term(name, False, "too small to matter", effect, small=True)
    return Term(name, True, "shear compliances of the bodies differ", effect)


def _why_uncoupled(scene: Scene) -> str:
    if scene.materials.lower.shear_compliance == 0:
        return "nu = 0.5 on both: shear does not displace"
    return "lower and upper shear compliances cancel exactly"


def _obliqueness(forced: Forced, effect: Effect, small: set[str]) -> Term:
    name = "obliqueness"
    if forced.oblique is not None:
        reason = "forced in" if forced.oblique else "forced out: cosines 1, sines 0"
        return Term(name, forced.oblique, reason, effect)
    if name in small:
        return Term(name, False, "flat tips: cosines 1, sines 0", effect, small=effect != NONE)
    return Term(name, True, "slopes enter Eqs (2), (3) and (6)", effect)


def _tilt(scene: Scene, forced: Forced, scales: Scales, coupled: Term, oblique: Term, budget: float) -> Term:
    """Shear's motion of the common surface: with coupling in, its kernel is there and costs nothing more."""
    name = "shear tilt"
    effect = term_effects.shear_tilt(scales)
    if not oblique.included:
        return Term(name, False, "no slopes to tilt")
    if forced.tilted is not None:
        return Term(name, forced.tilted, "forced in" if forced.tilted else "forced out", effect)
    if scene.friction.is_zero and not forced.slope_correction:
        return Term(name, False, "no friction")
    lower, upper = scene.materials.lower, scene.materials.upper
    if lower.shear_compliance + upper.shear_compliance == 0:
        return Term(name, False, _why_uncoupled(scene))
    if forced.slope_correction or coupled.included:
        return Term(name, True, "comes with the coupling's kernel", effect)
    if effect.larger <= budget:
        return Term(name, False, "too small to matter", effect, small=True)
    return Term(name, True, "shear moves the common surface", effect)


def _tau_support(scene: Scene, moved: bool) -> Term:
    name = "tau support"
    if scene.friction.tau == 0:
        return Term(name, False, "tau is zero")
    if not moved:
        return Term(name, False, "tau moves nothing: it acts where contact is")
    return Term(name, True, "tau > 0 moves the contact that it acts on")
