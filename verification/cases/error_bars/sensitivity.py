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
from refimpl.sensitivities.sensitivity import NUMBERS, Sensitivity
from verification.cases import Measured, case
from verification.coverage.scenes import random_scene

SEEDS = range(3000, 3008)  # one scene of each class; none that anything was fitted to
M, TIGHT, STEP = 48, 1e-11, 1e-5
STUDIED, COARSE, FINE = range(3000, 3032), 128, 512
TOLERANCES = {
    "load": 0.04,
    "friction.tau": 0.10,
    "friction.beta": 0.05,
    "lower.material.E": 0.05,
    "upper.surface[0].radius": 0.03,
}
DRAWS, DRAWN_M = 64, 192


def _unit(number: str, scene: rf.Scene, found: Sensitivity, parameter: str) -> float:
    """What a derivative is multiplied by to be one of logarithms; of Q, which may vanish, over the load."""
    whole = scene.load if number == "binormal_force" else found.found[number]
    return found.parameters[parameter] / whole


def _by_number(off: Sequence[tuple[str, float]]) -> dict[str, list[float]]:
    """Differences by number, of those that have any."""
    return {number: [d for of, d in off if of == number] for number in dict(off)}


def _differences(seed: int) -> tuple[list[tuple[str, float]], int]:
    """Number and difference of each smooth derivative of a scene from central differences of full solves.

    Differences are in per cents for one per cent of the parameter, Q's over the load. The second number
    counts the parameters that changed the contact.
    """
    scene = random_scene(seed).scene
    found = rf.sensitivity(scene, rf.solve(scene, M, tolerance=TIGHT))
    compared: list[tuple[str, float]] = []
    skipped = 0
    for name, value in differentiable_parameters(scene).items():
        low, high = (
            rf.solve(with_parameter(scene, name, value * (1 + s)), M, tolerance=TIGHT) for s in (-STEP, STEP)
        )
        if not (np.array_equal(low.contact, high.contact) and np.array_equal(low.excluded, high.excluded)):
            skipped += 1
            continue
        for number in NUMBERS:
            without_friction = number == "friction_coefficient" and is_frictionless(scene.friction)
            if number == "contact_area" or without_friction:
                continue
            difference = (getattr(high, number) - getattr(low, number)) / (2 * STEP * value)
            if number == "friction_coefficient":  # the set stays, and tau's share of its growth is not seen
                difference += scene.friction.tau / scene.load * found.derivatives["contact_area"][name]
            unit = _unit(number, scene, found, name)
            compared.append((number, abs(found.derivatives[number][name] * unit - difference * unit)))
    return compared, skipped


@case("sensitivity/finite-differences", metric="at_most", tolerance=1e-4)
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


@case("sensitivity/finer-grids", metric="at_most", tolerance=0.01, tier="full")
def finer_grids() -> Measured:
    """Derivatives on 128 x 128 beside those on 512 x 512.

    Claim: what one per cent of a parameter changes mu, A, f_max and Q by is known to 0.01 per cent, in the
    median over random scenes and their parameters
    Source: the same derivatives on 512 x 512; Q over the load
    Tolerance: required of a budget: a hundredth of an input's tolerance
    """
    compared: list[tuple[str, float]] = []
    for seed in STUDIED:
        scene = random_scene(seed).scene
        both = [rf.sensitivity(scene, rf.solve(scene, grid)) for grid in (COARSE, FINE)]
        for number in (number for number in NUMBERS if both[-1].found[number] != 0):
            for name in both[-1].derivatives[number]:
                low, high = (one.derivatives[number][name] * _unit(number, scene, one, name) for one in both)
                compared.append((number, abs(low - high)))
    medians = {number: float(np.median(off)) for number, off in _by_number(compared).items()}
    return Measured(max(medians.values()), data={"median": medians})


@case("sensitivity/drawn-inputs", metric="at_most", tolerance=0.1)
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
    """Each number's input part over the half-width of solves with drawn inputs, all on one grid."""
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
