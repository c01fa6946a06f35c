"""Faults of friction, and what all faults are made of: see `verification.contestants.broken`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.signal import fftconvolve

from refimpl.grid import Array, Mask
from verification.contestants import own, referee
from verification.contestants.protocol import ContactProblem
from verification.properties.textbook import normal_offsets, shear_offsets

Solver = Callable[[ContactProblem], Array]
Change = Callable[[ContactProblem], ContactProblem]

ROUNDS = 20
"""Most times that a wrong active set of tau is brought up to date."""
FEW_ROUNDS = 5
"""Times that displacements from afar, a hundredth of all, are brought up to date."""


def right(problem: ContactProblem) -> Array:
    """The pressures of our own solver, without its verdict."""
    return np.array(own.solve(problem).pressure, dtype=np.float64)


def asked(change: Change) -> Solver:
    """Solves another problem than it was asked."""
    return lambda problem: right(change(problem))


def where_periodic(wrong: Solver) -> Solver:
    """Wrong only in periodic problems."""
    return lambda problem: (wrong if problem.periodic else right)(problem)


def with_gap(problem: ContactProblem, gap: Array) -> ContactProblem:
    """The problem with another gap, shifted to first contact."""
    return replace(problem, gap=gap - gap.min())


def other_sign(problem: ContactProblem) -> ContactProblem:
    """c as upper minus lower."""
    if problem.coupling is None:
        return problem
    c = problem.coupling
    return replace(problem, coupling=replace(c, shear_compliance=-c.shear_compliance))


def unsigned(problem: ContactProblem) -> ContactProblem:
    """c as if the lower body were always the more compliant one."""
    if problem.coupling is None:
        return problem
    c = problem.coupling
    return replace(problem, coupling=replace(c, shear_compliance=abs(c.shear_compliance)))


def uncoupled_at_approach(problem: ContactProblem) -> ContactProblem:
    """Friction forgotten where the approach is prescribed."""
    return problem if problem.approach is None else replace(problem, coupling=None)


def without_tau(problem: ContactProblem) -> ContactProblem:
    """Friction by beta alone."""
    if problem.coupling is None:
        return problem
    return replace(problem, coupling=replace(problem.coupling, tau=0.0))


def cut_at_hardness(problem: ContactProblem) -> Array:
    """Elastic pressures cut at the hardness; under a load scaled so that what is left bears it."""
    pressure = right(replace(problem, hardness=None))
    if problem.hardness is None:
        return pressure
    factors = np.geomspace(1.0, 1e6, 2000) if problem.load is not None else np.ones(1)
    for factor in factors:
        cut = np.minimum(factor * pressure, problem.hardness)
        if problem.load is None or cut.sum() * problem.element_area >= problem.load:
            break
    return np.asarray(cut)


def lifted(problem: ContactProblem, moved: Array) -> ContactProblem:
    """Bodies with false displacements (m) of a solver added to the gap."""
    gap = problem.gap + moved
    # an approach from first contact counts from what is touched first now; one from the mean planes does not
    if problem.approach is not None and not problem.periodic:
        problem = replace(problem, approach=problem.approach - float(gap.min()))
    return with_gap(problem, gap)


def sheared(problem: ContactProblem, where: Mask) -> ContactProblem:
    """The problem without tau over a gap that tau on some elements has moved beforehand."""
    assert problem.coupling is not None
    alone = replace(problem, coupling=replace(problem.coupling, beta=0.0))
    one = where.astype(np.float64)
    moved = referee.displacement(alone, one) - referee.by_pressure(problem, one)
    return lifted(without_tau(problem), moved)


def tau_everywhere(problem: ContactProblem) -> ContactProblem:
    """Shear tau on the whole square: its displacement is known beforehand, and belongs to the gap."""
    return problem if problem.coupling is None else sheared(problem, np.ones(problem.gap.shape, bool))


def tau_on(support: Callable[[Array], Mask]) -> Solver:
    """Shear tau on elements that depend on the pressures, by repetition until they stay the same."""

    def solver(problem: ContactProblem) -> Array:
        pressure = right(problem)
        if problem.coupling is None or problem.coupling.tau == 0:
            return pressure
        for _ in range(ROUNDS):
            before = support(pressure)
            pressure = right(sheared(problem, before))
            if np.array_equal(support(pressure), before):
                break
        return pressure

    return solver


def well_loaded(pressure: Array) -> Mask:
    """Elements above a hundredth of the peak."""
    return np.asarray(pressure > 0.01 * pressure.max())


def one_off(pressure: Array) -> Mask:
    """The contact, moved by one element along x."""
    return np.roll(pressure > 0, 1, axis=0)


def tau_along_x(problem: ContactProblem) -> Array:
    """tau along x whatever the sliding direction; beta along that."""
    if problem.coupling is None:
        return right(problem)
    along_x = replace(problem.coupling, sliding_direction=0.0)
    pressure = right(problem)
    for _ in range(ROUNDS):
        moved = sheared(replace(problem, coupling=along_x), pressure > 0)
        before, pressure = pressure, right(replace(moved, coupling=without_tau(problem).coupling))
        if np.array_equal(before > 0, pressure > 0):
            break
    return pressure


def padded(points: Callable[[int], int], *, of_shear_alone: bool = False) -> Solver:
    """Convolutions on circles of so many points for ``M`` elements: too few alias the farthest offsets."""

    def solver(problem: ContactProblem) -> Array:
        pressure = right(problem)
        enough = all(points(n) >= 2 * n - 1 for n in problem.shape)
        if problem.periodic or enough or (of_shear_alone and problem.coupling is None):
            return pressure
        for _ in range(FEW_ROUNDS):
            moved = aliased(problem, pressure, points)
            falsely = sum(moved[1:] if of_shear_alone else moved)
            pressure = right(lifted(problem, np.asarray(falsely)))
        return pressure

    return solver


def aliased(problem: ContactProblem, pressure: Array, points: Callable[[int], int]) -> list[Array]:
    """Error of the displacement (m) by circles that are too short: by pressure, then by shear if any."""
    shape, edges, coupling = problem.shape, problem.spacings, problem.coupling
    taken = [(np.arange(1 - n, n) + points(n) // 2) % points(n) - points(n) // 2 + n - 1 for n in shape]
    tables = [normal_offsets(shape, edges) / (np.pi * problem.reduced_modulus)]
    tractions = [pressure]
    if coupling is not None:
        tables.append(shear_offsets(shape, coupling.sliding_direction, edges) * coupling.shear_compliance)
        tractions.append(coupling.tau * (pressure > 0) + coupling.beta * pressure)
    return [
        fftconvolve(table[np.ix_(*taken)] - table, traction, mode="valid")
        for table, traction in zip(tables, tractions, strict=True)
    ]
