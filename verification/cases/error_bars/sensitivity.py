"""Derivatives against finite differences and finer grids; input uncertainty against drawn inputs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import stats
from scipy.stats import qmc

import refimpl as rf
from refimpl.model.friction import is_frictionless
from refimpl.scene.parameters import differentiable_parameters, with_parameter
from refimpl.sensitivities.budget import budget
from refimpl.sensitivities.difference_quotients import NUMBERS
from refimpl.sensitivities.sensitivity import Sensitivity
from verification.cases import Measured, case
from verification.coverage.scenes import random_scene

MU = NUMBERS[0]
SEEDS = range(3000, 3008)  # one scene of each class; none that anything was fitted to
M, TIGHT, STEP = 48, 1e-11, 1e-5
STUDIED, COARSE, FINE = range(4100, 4140), 96, 384  # no scene of these was solved before the bars were set
SMALL = -0.04, -0.025, -0.01, 0.0, 0.01, 0.025, 0.04
TOLERANCES = {
    "load": 0.04,
    "friction.tau": 0.10,
    "friction.beta": 0.05,
    "lower.material.E": 0.05,
    "upper.surface[0].radius": 0.03,
}
DRAWS, DRAWN_M = 64, 192


def _unit(number: str, scene: rf.Scene, found: Sensitivity, parameter: str) -> float:
    """Return what makes a derivative one of logarithms; of Q, which may vanish, over the load."""
    whole = scene.load if number == "binormal_force" else found.found[number]
    return found.parameters[parameter] / whole


def _by_number(off: Sequence[tuple[str, float]]) -> dict[str, list[float]]:
    """Return the differences by number, of those that have any."""
    return {number: [d for of, d in off if of == number] for number in dict(off)}


def _at_the_edge(solution: rf.Solution, number: str, excess: float) -> float:
    """Return a solution's number; mu without tau on an ``excess`` (m^2), whose change is the area's."""
    if number != MU:
        return float(getattr(solution, number))
    return solution.friction_coefficient - solution.details.features.dmu_dA * excess


def _differences(seed: int) -> tuple[list[tuple[str, float]], int]:
    """Return the number and difference of smooth derivatives from central ones of full solves.

    Differences are in per cents for one per cent of the parameter, Q's over the load. The second number
    counts the parameters that changed the contact.
    """
    scene = random_scene(seed).scene
    solution = rf.solve(scene, M, tolerance=TIGHT)
    found, excess = rf.sensitivity(scene, solution), solution.details.features.excess
    compared: list[tuple[str, float]] = []
    skipped = 0
    for name, value in differentiable_parameters(scene).items():
        low, high = (
            rf.solve(with_parameter(scene, name, value * (1 + s)), M, tolerance=TIGHT) for s in (-STEP, STEP)
        )
        if not (
            np.array_equal(low.contact, high.contact)
            and np.array_equal(low.details.excluded, high.details.excluded)
        ):
            skipped += 1
            continue
        for number in NUMBERS:
            without_friction = number == MU and is_frictionless(scene.friction)
            if number == "contact_area_corrected" or without_friction:
                continue
            above, below = (_at_the_edge(one, number, excess) for one in (high, low))
            difference = (above - below) / (2 * STEP * value)
            if number == MU:  # the set stays, and tau's share of its growth is not seen
                difference += found.edge_growth[name]
            unit = _unit(number, scene, found, name)
            compared.append((number, abs(found.derivatives[number][name] * unit - difference * unit)))
    return compared, skipped


@case("sensitivity/finite-differences", metric="at_most", tolerance=1e-4, tier="full")
def finite_differences() -> Measured:
    """Derivatives against finite differences.

    Claim: f_max, Q, and mu but for tau on what the area grows by, change with every parameter as central
    differences of full solves say
    Source: solves to 1e-11 on one grid, parameters moved by 1e-5 where that leaves the contact set as it is
    Tolerance: per cents for one per cent: a quotient of solves to 1e-11 and steps of 1e-5 errs by 1e-6 of a
    number that is a hundred times its change, GMRES by 1e-6 of answers up to ten
    """
    found = [_differences(seed) for seed in SEEDS]
    compared = [one for part, _ in found for one in part]
    skipped = sum(count for _, count in found)
    worst = {number: max(off) for number, off in _by_number(compared).items()}
    note = f"{len(compared)} derivatives of {len(SEEDS)} scenes; {skipped} parameters moved the contact set"
    enough = len(compared) >= 10 * skipped
    return Measured(max(worst.values()) if enough else float("inf"), data={"worst": worst}, note=note)


def _fine_derivatives(scene: rf.Scene, name: str, value: float) -> dict[str, tuple[float, float]]:
    """Return derivatives on the fine grid and standard errors: parabolas through small steps."""
    solutions = [rf.solve(with_parameter(scene, name, value * (1 + step)), FINE) for step in SMALL]
    found = {}
    for number in NUMBERS:
        values = [getattr(solution, number) for solution in solutions]
        slope, covariance = np.polyfit(SMALL, values, 2, cov=True)
        found[number] = float(slope[1]) / value, float(np.sqrt(covariance[1, 1])) / value
    return found


def _covered(seed: int) -> list[tuple[str, bool, float, float]]:
    """Return number, whether the bar covers, error and bar (per cents for one per cent) of derivatives.

    By the load, tau, a modulus, and a height or radius. Two standard errors of the fine derivative are added.
    """
    scene = random_scene(seed).scene
    values = differentiable_parameters(scene)
    sizes = [name for name in values if name.endswith((".rms", ".radius"))]
    names = [name for name in ("load", "friction.tau", "lower.material.E", *sizes[:1]) if name in values]
    found = rf.sensitivity(scene, rf.solve(scene, COARSE), names)
    compared = []
    for name in names:
        fine = _fine_derivatives(scene, name, values[name])
        for number in (number for number in NUMBERS if found.found[number] != 0):
            unit = abs(_unit(number, scene, found, name))
            error = abs(found.derivatives[number][name] - fine[number][0])
            bar = found.scatter[number][name]
            compared.append((number, error <= bar + 2 * fine[number][1], error * unit, bar * unit))
    return compared


@case("sensitivity/finer-grids", metric="at_least", tolerance=0.91, tier="full")
def finer_grids() -> Measured:
    """Bars of derivatives on {COARSE} x {COARSE} beside small steps on {FINE} x {FINE}.

    Claim: bars of the derivatives of mu, A (corrected), f_max and Q by the load, tau, a modulus and a height
    or radius hold
    Source: parabolas through solves at up to 4 % either way; Q over the load
    Tolerance: 0.95 less two standard deviations (0.04) of 120 derivatives, taken as independent
    """
    compared = [one for seed in STUDIED for one in _covered(seed)]
    shares, medians = {}, {}
    for number in NUMBERS:
        own = [one[1:] for one in compared if one[0] == number]
        shares[number] = float(np.mean([holds for holds, _, _ in own]))
        medians[number] = [float(np.median([one[k] for one in own])) for k in (1, 2)]
    note = "; ".join(f"{number}: error {e:.2g}, bar {b:.2g}" for number, (e, b) in medians.items())
    data = {"covered": shares, "median of error and bar": medians}
    return Measured(min(shares.values()), data=data, note=f"{len(compared)} derivatives; medians of {note}")


@case("sensitivity/drawn-inputs", metric="at_most", tolerance=0.1, tier="full")
def drawn_inputs() -> Measured:
    """Input uncertainty against drawn inputs.

    Claim: the budget's input part of mu, A, f_max and Q is the 95 % half-width of solves with drawn inputs
    Source: {DRAWS} solves of a rough ball with normal inputs (Sobol points) as wide as the tolerances
    Tolerance: relative, on 192 x 192: so many Sobol points are good to 0.02, A counts elements, and Q bends
    within the inputs' 5 %; on half that grid by more, which the note states and nothing bounds
    """
    ratio, half = _budget_over_draws(DRAWN_M), _budget_over_draws(DRAWN_M // 2)
    said = "; ".join(
        f"on {M} x {M} " + ", ".join(f"{number} {value:.3f}" for number, value in found.items())
        for M, found in ((DRAWN_M, ratio), (DRAWN_M // 2, half))
    )
    data = {"ratio": ratio, "on half the grid": half}
    return Measured(max(abs(r - 1) for r in ratio.values()), data=data, note=f"budget over draws: {said}")


def _budget_over_draws(M: int) -> dict[str, float]:
    """Return each number's input part over the half-width of solves with drawn inputs, all on one grid."""
    scene = rf.read_scene("table1-rough")
    linear = budget(scene, rf.solve(scene, M), TOLERANCES)
    points = qmc.Sobol(len(TOLERANCES), rng=np.random.default_rng(2001)).random(DRAWS)
    drawn: dict[str, list[float]] = {number: [] for number in NUMBERS}
    for shares in stats.norm.ppf(points) / stats.norm.ppf(0.975):
        one = scene
        for share, (name, tolerance) in zip(shares, TOLERANCES.items(), strict=True):
            one = with_parameter(one, name, differentiable_parameters(scene)[name] * (1 + share * tolerance))
        solution = rf.solve(one, M)
        for number in NUMBERS:
            drawn[number].append(getattr(solution, number))
    width = stats.norm.ppf(0.975)
    return {
        number: linear.numbers[number].input / (width * float(np.std(values)))
        for number, values in drawn.items()
    }
