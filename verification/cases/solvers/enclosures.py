"""Both solvers against scenes whose contact set and solution are proven by ball arithmetic."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

import refimpl as rf
from refimpl.planning.plan import Method
from verification.cases import Measured, case
from verification.enclosures.proof import prove
from verification.enclosures.store import Enclosure, enclosed, named, relative, stored

SOURCE = "ball arithmetic (python-flint) on Love's and Cerruti's coefficients: verification/enclosures"
METHODS: tuple[Method, ...] = ("dense", "fft")
ASKED = "solvers have the tolerance 1e-12; the error of a force or of the approach is of second order"


@cache
def solution(name: str, method: Method) -> rf.Solution:
    """Return the stored scene's solution; solved once for all cases here."""
    return named(name).scene.solve(method)


def approach(found: rf.Solution) -> float:
    """Return the approach from first contact (m); a periodic solution's counts from the mean planes."""
    mean = float(found.details.problem.gap.mean()) if found.grid.periodic else 0.0
    return found.approach + mean


def by_scene(error: Callable[[Enclosure, rf.Solution], float]) -> dict[str, list[float]]:
    """Return the errors of both solvers, scene by scene."""
    return {
        known.scene.name: [error(known, solution(known.scene.name, method)) for method in METHODS]
        for known in stored()
    }


def measured(errors: dict[str, list[float]]) -> Measured:
    """Return the largest error, with the series."""
    dense, fft = (list(column) for column in zip(*errors.values(), strict=True))
    value = max(dense + fft)
    return Measured(value=value, data={"scene": list(errors), "dense": dense, "fft": fft})


@case("golden/contact-sets", metric="equal", tolerance=0.0, source=SOURCE)
def contact_sets() -> Measured:
    """Proven contact sets.

    Claim: both solvers find the contact set that is proven, element by element, in near ties too
    Tolerance: margins are proven, 1e-10 of the approach at least; solvers have the tolerance 1e-12
    """
    found = measured(by_scene(lambda g, s: float(np.count_nonzero(s.contact != g.contact))))
    return replace(found, reference=0.0, unit="elements")


def pressure_error(known: Enclosure, found: rf.Solution) -> float:
    """Return the largest distance from the proven pressure, over the peak."""
    miss = float(np.abs(found.pressure - known.pressure).max()) + known.radius
    return miss / float(known.pressure.max())


@case("golden/pressure", metric="at_most", tolerance=1e-11, source=SOURCE)
def pressure() -> Measured:
    """Proven pressures.

    Claim: every element's pressure is its proven value, to 1e-11 of the peak with either solver
    Tolerance: residuals of 1e-12 are required, conditioning may cost a digit; 6e-13 was measured
    """
    return measured(by_scene(pressure_error))


@case("golden/dense-pressure", metric="at_most", tolerance=2e-14, source=SOURCE)
def dense_pressure() -> Measured:
    """Proven pressures, dense reference.

    Claim: the plain reference reaches the proven pressures to rounding
    Tolerance: condition numbers below 100 times the rounding unit; 1.4e-15 was measured
    """
    dense = {name: pair[0] for name, pair in by_scene(pressure_error).items()}
    return Measured(value=max(dense.values()), data={"dense": dense})


@case("golden/approach", metric="at_most", tolerance=1e-12, source=SOURCE, tolerance_reason=ASKED)
def approaches() -> Measured:
    """Proven approaches.

    Claim: the approach is its proven value, to 1e-12
    """
    return measured(
        by_scene(lambda g, s: relative(approach(s), g.numbers["approach"], g.numbers["approach"].mid))
    )


@case("golden/forces", metric="at_most", tolerance=1e-12, source=SOURCE, tolerance_reason=ASKED)
def forces() -> Measured:
    """Proven forces.

    Claim: N, F, Q and mu are their proven values, to 1e-12 of the load
    """

    def error(known: Enclosure, found: rf.Solution) -> float:
        load = known.numbers["normal_force"].mid
        return max(
            relative(getattr(found, name), exact, 1.0 if name == "friction_coefficient" else load)
            for name, exact in known.numbers.items()
            if name != "approach"
        )

    return measured(by_scene(error))


@case("golden/proven-anew", metric="equal", tolerance=0.0, source=SOURCE)
def proven_anew() -> Measured:
    """The golden files are what the proof gives.

    Claim: proving stored scenes again gives balls that meet the stored ones, number by number
    Tolerance: two enclosures of one number have it in common
    """
    apart = {}
    for name in ("friction", "periodic", "oblique", "near-tie-touches"):
        known = named(name)
        proof = prove(known.scene, known.contact)
        pairs = [(enclosed(ball), known.numbers[key]) for key, ball in proof.forces.items()]
        pairs.append((enclosed(proof.approach), known.numbers["approach"]))
        fresh = np.array([float(ball) for ball in proof.pressures])
        away = np.abs(fresh - known.pressure[known.contact]) > 2 * known.radius
        apart[name] = sum(not one.meets(other) for one, other in pairs) + np.count_nonzero(away)
    return Measured(value=float(sum(apart.values())), reference=0.0, unit="numbers", data={"apart": apart})
