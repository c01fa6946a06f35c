"""Numbers that a solver may return beside its pressures, judged by what these pressures give.

With e the error of the pressures f, ``sum e (a e) dA <= claim E``: E is their elastic energy (J), the claim
the residual that the solver reports (`reference_solution.misfit`). A mean of displacements with weights w,
whose sum is 1, then errs by at most ``sqrt(w a w) sqrt(e a e) = sqrt(2 claim E E_w) / N`` (Cauchy and
Schwarz): N is the load (N), and E_w the energy of the same load distributed as w is. Shear adds at most the
share ``beta pi |c0| E*`` of that. The solver's number and the recomputed one may both err so much.

- approach: a mean over the contact, by pressure or by area. Where it is prescribed, it is the given one.
- contact area: a whole number of elements; a half is left for rounding.
- mean displacement: the mean of u over the domain; zero where periodic.
"""

from __future__ import annotations

import math

import numpy as np

from refimpl.grid import Array, Mask
from verification.solver_suite import reference_solution
from verification.solver_suite.protocol import NUMBERS, Answer, ContactProblem

ROUNDING = 1e-9
"""Allowed at least, of what the mean pressure displaces: sums of 1e5 terms that cancel lose 1e-11."""
HALF_AN_ELEMENT = 0.5


def wrong(problem: ContactProblem, answer: Answer) -> list[str]:
    """Return a sentence on each number of the answer that is not that of its pressures."""
    pressure, sentences = np.asarray(answer.pressure, dtype=np.float64), []
    for name in NUMBERS:
        found = getattr(answer, name)
        if found is None or (judged := JUDGES[name](problem, pressure)) is None:
            continue
        right, allowed, unit = judged
        if not abs(found - right) <= allowed:
            given = f"its pressures give {right:.9g} +- {allowed:.1g} {unit}"
            sentences.append(f"{name.replace('_', ' ')} {found:.9g} {unit}: {given}")
    return sentences


Number = tuple[float, float, str]
"""The right number, the largest error that is allowed, and the unit of both."""


def contact_area(problem: ContactProblem, f: Array) -> Number:
    """Return the area of the elements with a pressure (m^2)."""
    dA = problem.element_area
    return np.count_nonzero(f > 0) * dA, HALF_AN_ELEMENT * dA, "m^2"


def approach(problem: ContactProblem, f: Array) -> Number | None:
    """Return the approach as the problem counts it (m); None without load, or left open by a hardness."""
    if problem.approach is None and f.sum() <= 0:
        return None
    contact = f > 0
    right = problem.approach
    if right is None:
        between = contact & (f < reference_solution.at_hardness(problem))
        if not between.any():
            return None
        v = reference_solution.displacement(problem, f) + problem.gap
        right = float(np.average(v[between], weights=f[between]))
        right -= float(problem.gap.mean()) if problem.periodic else 0.0
    if not contact.any():
        return right, ROUNDING * abs(right), "m"
    return right, max(_error_of_mean(problem, f, f), _error_of_mean(problem, f, contact)), "m"


def mean_displacement(problem: ContactProblem, f: Array) -> Number:
    """Return the mean of u over the domain (m), by pressure and shear."""
    if problem.periodic:
        return 0.0, _rounding(problem, f), "m"
    right = float(reference_solution.displacement(problem, f).mean())
    return right, _error_of_mean(problem, f, np.ones(f.shape)), "m"


JUDGES = {"approach": approach, "contact_area": contact_area, "mean_displacement": mean_displacement}


def _error_of_mean(problem: ContactProblem, f: Array, weights: Array | Mask) -> float:
    """Return the largest difference (m) of two means of displacements with these weights, by the claim."""
    total = float(f.sum())
    if not total > 0:
        return _rounding(problem, f)
    spread = np.asarray(weights, dtype=np.float64) * (total / float(weights.sum()))
    E, E_w = reference_solution.energy(problem, f), reference_solution.energy(problem, spread)
    coupling, by_shear = problem.coupling, 0.0
    if coupling is not None:
        by_shear = coupling.beta * math.pi * abs(coupling.shear_compliance) * problem.reduced_modulus
    one = math.sqrt(2 * problem.tolerance * max(0.0, E * E_w)) / (total * problem.element_area)
    return 2 * (1 + by_shear) * one + _rounding(problem, f)


def _rounding(problem: ContactProblem, f: Array) -> float:
    load = float(np.abs(f).sum()) * problem.element_area
    return ROUNDING * load / (problem.reduced_modulus * max(problem.lengths))
