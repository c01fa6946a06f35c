"""From measured friction to tau and beta: fit, uncertainty in parts, identifiability."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.stats import chi2

from refimpl.errors import InputError, require_number
from refimpl.grid import Array
from refimpl.identification.data_table import Row, check_rows
from refimpl.identification.design import MAX_BORDER, Proposal, propose, trial_responses
from refimpl.identification.fit import Fit, fit, profile_of, shares
from refimpl.identification.forward import COVERAGE, NAMES, Forward, Key, Memory, Response, floors
from refimpl.identification.laws import DECISIVE, Law, compare
from refimpl.identification.profile import Profile
from refimpl.scene.parameters import check_tolerances, parameters
from refimpl.scene.scene import Body, Scene
from refimpl.surfaces import SurfaceSum

WIDE = 0.2  # relative half-width of tau's interval from which the warning appears
OUTLIER = 3.0  # residual in standard uncertainties
_UNLIKELY = 0.01  # probability of a chi-square as large, below which the model or the data are doubted
MIN_REALISATIONS = 3
_SEED_STEP = 1000  # between realisations: far from the seeds of both bodies


@dataclass(frozen=True)
class Interval:
    """A value and its 95 % interval."""

    value: float
    low: float
    high: float

    @property
    def relative(self) -> float:
        """Half of the interval over the value; infinite for a value of zero."""
        return 0.5 * (self.high - self.low) / self.value if self.value > 0 else math.inf


@dataclass(frozen=True)
class Prediction:
    """Predicted mu at a load (N), with its 95 % interval."""

    load: float
    mu: Interval


@dataclass(frozen=True, eq=False)
class Identification:
    """Result of `identify`.

    values : "tau" (Pa) and "beta" with their intervals; covariance : (2, 2), of tau and beta without bounds
    shares : standard uncertainties of tau and of beta by source
    method : "ellipse", or "profile likelihood" where a bound cuts the interval
    combination : ``k tau + beta``, what the data determine best; ``factor`` is k (1/Pa), near A / P
    predictions : at the measured loads, then at the new ones
    chi_square, degrees, probability : of the residuals; ``residuals`` in standard uncertainties
    laws : compared by AICc; proposal : further loads, where tau is not determined
    solves, passes : forward solves, and how often all rows were linearised
    """

    rows: tuple[Row, ...]
    values: Mapping[str, Interval]
    covariance: Array
    shares: Mapping[str, tuple[float, float]]
    method: str
    factor: float
    combination: Interval
    predictions: tuple[Prediction, ...]
    residuals: tuple[float, ...]
    chi_square: float
    degrees: int
    probability: float
    laws: tuple[Law, ...]
    proposal: Proposal | None
    warnings: tuple[str, ...]
    solves: int
    passes: int
    fitted: Fit = field(repr=False)

    @property
    def is_identified(self) -> bool:
        """False where tau's interval is too wide to be used apart from beta's."""
        return self.values["tau"].relative <= WIDE


def identify(
    scene: Scene,
    rows: Sequence[Row],
    grid: int | tuple[int, int],
    *,
    loads: Sequence[float] = (),
    tolerances: Mapping[str, float] | None = None,
    realisations: int = 1,
    design: bool = True,
    memory: Memory | None = None,
    key: Key | None = None,
    report: Callable[[str], None] | None = None,
) -> Identification:
    """Find tau and beta from measured friction, with 95 % intervals.

    Parameters
    ----------
    scene : surfaces, materials and frame; its friction is the first guess, its load is not used
    rows : measurements (`read_rows`), of at least two loads
    grid : as in `refimpl.solve`
    loads : further loads (N) at which mu is predicted
    tolerances : relative half-widths (95 %) of inputs, as in `refimpl.budget`; friction is none of them
    realisations : solve that many draws of random surfaces (their seeds moved), where no map is measured
    design : propose further loads where tau is not determined
    memory, key : keep solves by a key of scene and settings, so that a stopped fit goes on
    report : called with a line of text before each solve

    Raises `InputError` for input that is out of range, `ArithmeticError` where a solve does not converge.
    """
    rows, tolerances = check_rows(rows), dict(tolerances or {})
    _check(scene, loads, tolerances, realisations)
    forward = Forward(grid, memory, key, report)
    start = _start(scene, rows)
    fits = []
    for k in range(realisations):
        drawn = _redrawn(scene, k)
        fits.append(fit(rows, [row.of(drawn) for row in rows], forward, start))
        start = fits[0].theta
    fitted = fits[0]
    scenes = [row.of(scene) for row in rows]
    inputs = [forward.respond(one, fitted.theta, tolerances).inputs for one in scenes] if tolerances else []
    parts = shares(rows, fitted, inputs)
    if realisations > 1:
        drawn_free = np.array([one.free for one in fits])
        fitted = replace(fitted, free=drawn_free.mean(axis=0))
        parts["realisations"] = np.cov(drawn_free.T) * (1 + 1 / realisations)
    covariance = np.asarray(sum(parts.values()))
    profile = profile_of(fitted, covariance)
    fitted = replace(fitted, theta=profile.optimum) if realisations > 1 else fitted
    values = {
        name: Interval(float(fitted.theta[j]), *profile.interval(np.eye(2)[j]))
        for j, name in enumerate(("tau", "beta"))
    }
    mean = np.mean([response.slopes for response in fitted.responses], axis=0)
    factor = _best_factor(covariance, mean)
    gradient = np.array([factor, 1.0])
    combination = Interval(float(gradient @ fitted.theta), *profile.interval(gradient))
    new = [forward.respond(replace(scene, load=load), fitted.theta) for load in loads]
    responses, at = (*fitted.responses, *new), (*(row.load for row in rows), *loads)
    predictions = tuple(
        _prediction(load, response, fitted.theta, profile)
        for load, response in zip(at, responses, strict=True)
    )
    degrees = max(len(rows) - 2, 0)
    proposal = None
    if design and values["tau"].relative > WIDE:
        trials = trial_responses(scene, rows, forward, fitted.theta)
        relative = float(np.median([row.u_mu / max(row.mu, row.u_mu) for row in rows]))
        proposal = propose(fitted.theta, covariance, trials, relative)
    result = Identification(
        rows=rows,
        values=values,
        covariance=covariance,
        shares={name: _two(np.sqrt(np.diag(part))) for name, part in parts.items()},
        method="profile likelihood" if profile.is_bounded else "ellipse",
        factor=factor,
        combination=combination,
        predictions=predictions,
        residuals=tuple(map(float, fitted.residuals)),
        chi_square=fitted.chi_square,
        degrees=degrees,
        probability=float(chi2.sf(fitted.chi_square, degrees)) if degrees else 1.0,
        laws=compare(rows, fitted),
        proposal=proposal,
        warnings=(),
        solves=forward.solves,
        passes=fitted.passes,
        fitted=fitted,
    )
    return replace(result, warnings=tuple(_warnings(result)))


def _two(pair: Array) -> tuple[float, float]:
    return float(pair[0]), float(pair[1])


def _check(scene: Scene, loads: Sequence[float], tolerances: Mapping[str, float], realisations: int) -> None:
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    for load in loads:
        require_number("loads", load, "positive loads in N", above=0)
    for name, tolerance in tolerances.items():
        if name in NAMES:
            raise InputError(f"tolerances.{name!r}", tolerance, "no friction: it is what is identified")
    check_tolerances(scene, tolerances)
    allowed = f"1, or from {MIN_REALISATIONS} to 100"
    require_number("realisations", realisations, allowed, at_least=1, at_most=100)
    if int(realisations) != realisations or 1 < realisations < MIN_REALISATIONS:
        raise InputError("realisations", realisations, allowed)
    random = any(hasattr(part, "seed") for body in (scene.upper, scene.lower) for part in body.surface.parts)
    if realisations > 1 and not random:
        raise InputError("realisations", realisations, "1: no surface of the scene is random")


def _start(scene: Scene, rows: Sequence[Row]) -> Array:
    """First guess: the scene's friction, or half of mu by each part at a mean pressure of E* / 100."""
    found = np.array([parameters(scene)[name] for name in NAMES])
    if found.all():
        return found
    mu = float(np.mean([row.mu for row in rows]))
    guess = np.array([0.5 * mu * 0.01 * scene.materials.reduced_modulus, 0.5 * mu])
    return np.asarray(np.maximum(guess, floors(scene)), dtype=np.float64)


def _redrawn(scene: Scene, k: int) -> Scene:
    """The scene with the seeds of its random surfaces moved."""
    if k == 0:
        return scene
    bodies: dict[str, Any] = {}
    for name in ("upper", "lower"):
        body = getattr(scene, name)
        parts: tuple[Any, ...] = tuple(
            replace(part, seed=part.seed + k * _SEED_STEP) if hasattr(part, "seed") else part
            for part in body.surface.parts
        )
        bodies[name] = Body(body.material, parts[0] if len(parts) == 1 else SurfaceSum(parts))
    return replace(scene, **bodies)


def _best_factor(covariance: Array, mean: Array) -> float:
    """``k`` (1/Pa) of the combination ``k tau + beta`` with the least variance; never below zero."""
    best = -float(covariance[0, 1] / covariance[0, 0])
    return best if best > 0 else float(mean[0] / mean[1])


def _prediction(load: float, response: Response, theta: Array, profile: Profile) -> Prediction:
    """Interval of mu: parameters by their likelihood, and the bars of mu at this load, in squares."""
    mu = response.predict(theta)
    slopes = np.maximum(np.array(response.slopes), 0.0)
    middle = float(slopes @ theta)
    low, high = profile.interval(slopes)
    bar = math.hypot(response.numerical, response.contact_edge)
    return Prediction(
        load, Interval(mu, mu - math.hypot(middle - low, bar), mu + math.hypot(high - middle, bar))
    )


def _warnings(result: Identification) -> list[str]:
    """Texts, the most important first."""
    tau, combination = result.values["tau"], result.combination
    found = []
    if not result.is_identified:
        width = f"+-{100 * tau.relative:.0f} %" if math.isfinite(tau.relative) else "unbounded"
        text = (
            f"tau is not determined apart from beta (95 % interval {width}): A/P hardly changes; "
            f"the data determine {result.factor:.3g}/Pa tau + beta = {combination.value:.4g} "
            f"({combination.low:.4g} to {combination.high:.4g})"
        )
        if result.proposal is not None:
            loads = " and ".join(f"{load:.3g} N" for load in result.proposal.loads)
            text += f"; measure at {loads}: tau's interval falls to +-{100 * result.proposal.widths[0]:.0f} %"
        found.append(text + "; a curved surface changes A/P more than flat rough planes do")
    if result.degrees and result.probability < _UNLIKELY:
        found.append(
            f"chi-square {result.chi_square:.3g} of {result.degrees} degrees of freedom has probability "
            f"{result.probability:.1g}: surfaces, law or uncertainties are wrong, intervals too short"
        )
    for k, residual in enumerate(result.residuals):
        if abs(residual) > OUTLIER:
            found.append(
                f"row {k + 1} ({result.rows[k].load:.4g} N) is off by {residual:+.1f} standard uncertainties"
            )
    responses, measured = result.fitted.responses, np.array([row.u_mu for row in result.rows])
    bars = np.array([math.hypot(r.numerical, r.contact_edge) / COVERAGE for r in responses])
    if (wide := int(np.sum(bars > measured))) > 0:
        found.append(
            f"error bars of the model exceed the data's uncertainty in {wide} rows: take a finer grid"
        )
    if any(response.border > MAX_BORDER for response in responses):
        found.append("contact reaches the domain's border: mu of a larger domain differs")
    if (most := max(response.plastic for response in responses)) > 0:
        found.append(f"up to {100 * most:.0f} % of the contact is at the hardness: A/P changes little there")
    best = result.laws[0]
    linear = next(law for law in result.laws if law.name == "tau + beta f")
    if math.isfinite(linear.aicc) and linear.aicc - best.aicc > DECISIVE:
        found.append(
            f"the law {best.name} describes the data better (AICc lower by {linear.aicc - best.aicc:.1f})"
        )
    return [*found, *_limits(responses)]


def _limits(responses: Sequence[Response]) -> list[str]:
    """Warnings of the solves, one of each kind: texts that differ in their numbers alone are one."""
    kinds = {re.sub(r"[\d.]+", "", text): text for response in responses for text in response.warnings}
    return list(kinds.values())
