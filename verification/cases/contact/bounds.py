"""The bounds of `refimpl.bounds.proven_bounds` against solutions that are proven by ball arithmetic."""

from __future__ import annotations

import math
from functools import cache
from itertools import product

import numpy as np

import refimpl as rf
from refimpl.bounds.energy_norm import EnergyNorm
from refimpl.bounds.proven_bounds import Bounds, proven_bounds
from refimpl.grid import Array
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from verification.cases import Measured, case
from verification.enclosures.store import Enclosure, named, stored
from verification.exact.dense_influence import DenseInfluence
from verification.exact.textbook import normal_matrix
from verification.properties.states import compliances
from verification.scenes.cross_checks import pressed

SOURCE = "derivation in refimpl/bounds/proven_bounds.py; truth from ball arithmetic, verification/enclosures"
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)
PROVEN = "a bound that is exceeded once is none; the truth is enclosed to 1e-16"


def held(known: Enclosure) -> Slopes:
    """Return the slopes that the proof holds."""
    tan_x, tan_y = known.scene.tan_x, known.scene.tan_y
    return Slopes.flat(known.contact.shape) if tan_x is None or tan_y is None else Slopes(tan_x, tan_y)


@cache
def loose(name: str, tolerance: float) -> rf.Solution:
    """Stop the production solver early."""
    return named(name).scene.solve("fft", tolerance)


def bounds_of(known: Enclosure, problem: Problem, pressure: Array) -> Bounds:
    """Return the bounds of a pressure with the proof's slopes and active set of tau."""
    traction = problem.friction.traction(pressure, known.contact)
    return proven_bounds(problem, pressure, traction, held(known))


def energy_of(known: Enclosure, pressure: Array) -> float:
    """Return ``sum e (a e) dA`` of any pressure e (J), with the textbook's matrix where there is one."""
    grid, e = known.scene.scene.grid(known.scene.M), pressure.ravel()
    if known.scene.periodic:
        a = DenseInfluence(grid, known.scene.direction).normal_matrix
    else:
        a = normal_matrix(grid)
    return float(e @ a @ e) * compliances(known.scene.scene)[0] * grid.element_area


def same_support(known: Enclosure, found: rf.Solution) -> bool:
    """Return True if the solution's active set of tau is the proven one."""
    law = known.scene.friction
    if law.tau == 0:
        return True
    held_tau = found.traction - law.beta * found.pressure > 0.5 * law.tau
    return np.array_equal(held_tau, known.contact)


def rough_states() -> list[tuple[Enclosure, float, rf.Solution]]:
    """Return every enclosed scene at every loose tolerance."""
    return [(known, tol, loose(known.scene.name, tol)) for known in stored() for tol in TOLERANCES]


@case("bounds/energy", metric="at_most", tolerance=1.0, source=SOURCE, tolerance_reason=PROVEN)
def energy() -> Measured:
    """Bound on the error in the energy norm.

    Claim: (f - f*)' a (f - f*) is never above its bound, at tolerances from 1e-2 to 1e-8
    """
    ratios: dict[float, list[float]] = {tol: [] for tol in TOLERANCES}
    for known, tol, found in rough_states():
        bound = bounds_of(known, found.details.problem, found.pressure).energy
        ratios[tol].append(energy_of(known, found.pressure - known.pressure) / bound)
    sharp = [1 / math.sqrt(np.median(ratios[tol])) for tol in TOLERANCES]
    return Measured(
        value=max(max(values) for values in ratios.values()),
        note=f"the bound's norm is {min(sharp):.2f} to {max(sharp):.2f} times the true one (medians)",
    )


@case("bounds/gap", metric="at_most", tolerance=1.0, source=SOURCE, tolerance_reason=PROVEN)
def gap() -> Measured:
    """The certificate's own gap bounds the error.

    Claim: at flat slopes and exact load, (f - f*)' a (f - f*) is at most the complementarity gap
    """
    ratios = {}
    for name, tol in product(("smooth", "rough", "near-tie-misses", "near-tie-touches"), TOLERANCES):
        known, found = named(name), loose(name, tol)
        certified = found.certificate.gap * energy_of(known, found.pressure) / 2
        ratios[f"{name}, {tol:g}"] = energy_of(known, found.pressure - known.pressure) / certified
    return Measured(value=max(ratios.values()), data={"true error over gap": ratios})


@case("bounds/any-state", metric="at_most", tolerance=1.0, source=SOURCE, tolerance_reason=PROVEN)
def any_state() -> Measured:
    """Bounds for states that are far from feasible.

    Claim: noise on the pressure, negative pressures, penetration and a wrong load do not break the bound
    """
    random, ratios = np.random.default_rng(5), []
    for known in stored():
        problem, shape = loose(known.scene.name, 1e-8).details.problem, known.contact.shape
        for size in (1.0, 0.1, 1e-3, 1e-6):
            noise = random.standard_normal(shape) * (random.random(shape) < 0.5)
            pressure = known.pressure + size * float(known.pressure.max()) * noise
            bound = bounds_of(known, problem, pressure).energy
            ratios.append(energy_of(known, pressure - known.pressure) / bound)
    return Measured(value=max(ratios), data={"true over bound": ratios})


@case("bounds/numbers", metric="at_most", tolerance=1.0)
def numbers() -> Measured:
    """Bounds on pressure, approach, forces and friction.

    Claim: no number of a loosely solved scene is farther from its proven value than its bound
    Source: {SOURCE}
    Tolerance: {PROVEN}; differences below 1e-15 of a number are the double's own and neglected
    """
    worst: dict[str, float] = {}
    compared = 0
    for known, _, found in rough_states():
        if known.scene.oblique or not same_support(known, found):
            continue  # its own slopes, or active set of tau: another frozen problem than the proven one
        compared += 1
        bounds = bounds_of(known, found.details.problem, found.pressure)
        miss = {"pressure": float(np.abs(found.pressure - known.pressure).max())}
        mean = float(found.details.problem.gap.mean()) if known.scene.periodic else 0.0
        for name, exact in known.numbers.items():
            value = getattr(found, name) + (mean if name == "approach" else 0.0)
            miss[name] = max(0.0, abs(value - exact.mid) - exact.radius - 1e-15 * abs(exact.mid))
        for name, error in miss.items():
            if error > 0:
                worst[name] = max(worst.get(name, 0.0), error / getattr(bounds, name))
    return Measured(
        value=max(worst.values()) if compared >= len(rough_states()) / 2 else math.inf,
        data={"true over bound": worst, "states compared": compared},
    )


@case("bounds/contact-sets", metric="equal", tolerance=0.0, source=SOURCE)
def contact_sets() -> Measured:
    """Elements proven in or out of contact.

    Claim: none is listed wrongly, and at 1e-8 all are listed but the near ties
    Tolerance: one element on the wrong list refutes the proof
    """
    wrong = 0
    for known, tol, found in rough_states():
        bounds = bounds_of(known, found.details.problem, found.pressure)
        wrong += int(np.count_nonzero(bounds.in_contact & ~known.contact))
        wrong += int(np.count_nonzero(bounds.out_of_contact & known.contact))
        low, high = bounds.contact_area
        area = float(known.contact.sum()) * found.grid.element_area
        wrong += not low * (1 - 1e-15) <= area <= high * (1 + 1e-15)
        if tol == TOLERANCES[-1]:
            undecided = int((~bounds.in_contact & ~bounds.out_of_contact).sum())
            wrong += undecided != known.scene.name.startswith("near-tie")
    return Measured(value=float(wrong), reference=0.0, unit="elements")


@case("bounds/least-eigenvalue", metric="at_most", tolerance=1.0)
def least_eigenvalue() -> Measured:
    """Least eigenvalue of the flexibility.

    Claim: the symbol's smallest value is below every grid's smallest eigenvalue, and within 0.5 % at M = 16
    Source: refimpl/bounds/energy_norm.py; numpy.linalg.eigvalsh
    Tolerance: a lower bound that is exceeded once is none; eigvalsh errs by 1e-15
    """
    ratios = []
    for M in (1, 2, 3, 5, 8, 12, 16):
        problem = rf.solve(pressed(rms=None), M, tolerance=0.5, oblique=False).details.problem
        matrix = problem.pair.normal_compliance * normal_matrix(problem.grid)
        floor = EnergyNorm(problem, np.ones((M, M))).floor
        ratios.append(floor / float(np.linalg.eigvalsh(matrix)[0]))
    return Measured(value=max(ratios) if ratios[-1] > 0.995 else math.inf, data={"bound": ratios})


@case("bounds/production", metric="at_most", tolerance=1e-6, source=SOURCE)
def production() -> Measured:
    """Bounds of a production solve.

    Claim: at the default tolerance the bound proves mu to 1e-6 and the contact set of Table 1's rough scene
    Tolerance: a hundredth of what the paper prints of mu; the bound is linear in residuals of 1e-8
    """
    found = rf.solve(rf.read_scene("table1-rough"), 64)
    bounds = found.details.bounds
    low, high = bounds.contact_area
    undecided = round((high - low) / found.grid.element_area)
    value = bounds.friction_coefficient if undecided == 0 else math.inf
    return Measured(value, note=bounds.unproven)
