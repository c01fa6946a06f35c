"""Error of a random fault: against the right pressures, on random problems of every kind that it may meet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from refimpl.grid import Array
from verification.contestants import own, referee
from verification.contestants.compact import Compact, Solved
from verification.contestants.compact import solve as right
from verification.contestants.design import posed
from verification.contestants.protocol import ContactProblem
from verification.contestants.random_faults import RandomFault

CLAIM = 1e-8
"""Claim of the campaign's solvers."""
PROBES = 72
"""Random problems; a third of them squares without friction, a third that slide, a third rectangles."""
ENOUGH = 1e-2
"""Error from which no more probes are solved: what is reported is a lower bound."""
MET = 30
"""Most probes that a fault is tried on, small ones first."""
REMEMBERED = 32**2
"""Most elements of a pair of problems for a memory."""
AGREED = 1e-4
"""Most that the two right solvers may differ, relative to the peak; other probes are dropped."""
SIZES = (8, 9, 13, 16, 21, 24, 32, 37, 45, 64, 90, 121, 128, 150)


class Error(NamedTuple):
    """Largest errors of a fault's pressures over the probes.

    peak : largest error over the right peak
    claims : squared error in the energy norm over the claim, that of a periodic mean pressure added
    """

    peak: float
    claims: float


@dataclass(frozen=True, eq=False)
class Probe:
    """A problem with its right pressures (Pa), and with the compact solver's solution."""

    problem: ContactProblem
    exact: Array
    ours: Solved

    def error(self, found: Array) -> Error:
        """Errors of pressures (Pa)."""
        carried = float(self.exact.sum())
        claims = referee.misfit(self.problem, found, self.exact)
        if self.problem.periodic:
            claims += (float(found.sum()) / carried - 1) ** 2
        return Error(float(np.abs(found - self.exact).max() / self.exact.max()), claims / CLAIM)


def _row(number: int) -> dict[str, Any]:
    """Levels of a probe, drawn from ranges instead of the design's values."""
    random, kind = np.random.default_rng([44, number]), number % 3

    def one_of(*levels: Any) -> Any:
        return levels[random.integers(len(levels))]

    row = {
        "elements": one_of(*SIZES),
        "edge": 10 ** random.uniform(-9, 3),
        "modulus": 10 ** random.uniform(3, 13),
        "control": one_of("load", "approach"),
        "borders": one_of("free", "periodic"),
        "contact": one_of("light", "half", "most"),
        "slope": 10 ** random.uniform(-4, 0),
        "surface": one_of("smooth", "harsh"),
    }
    if kind == 0:
        return row
    row |= {
        "sector": int(random.integers(8)),
        "beta": random.uniform(0.05, 1.5),
        "tau": one_of(0.0, 0.02, 0.1),
        "coupling": one_of(-1, 1) * random.uniform(0.05, 0.6),
    }
    return row | {"shape": one_of("wide", "deep", "oblong elements", "both")} if kind == 2 else row


@cache
def probes() -> tuple[Probe, ...]:
    """Return the probes on which both right solvers agree, small ones first."""
    made = (_probe(posed(_row(number), number, CLAIM)) for number in range(PROBES))
    return tuple(sorted(filter(None, made), key=lambda probe: probe.problem.gap.size))


def _probe(problem: ContactProblem) -> Probe | None:
    theirs, ours = own.solve(replace(problem, tolerance=1e-2 * CLAIM)), right.solved(problem)
    exact = np.asarray(theirs.pressure)
    far = float(np.abs(exact - ours.pressure).max())
    agreed = ours.converged and theirs.converged and float(exact.max()) > 0 and far < AGREED * exact.max()
    return Probe(problem, exact, ours) if agreed else None


def error(fault: RandomFault) -> Error:
    """Return the largest errors over the probes that meet the fault's condition; 0 without any.

    A memory is probed in pairs: a problem, then one of the same shape with twice the spacing, a third of the
    modulus, the other borders or another direction.
    """
    worst = Error(0.0, 0.0)
    for found in _errors(fault):
        worst = Error(max(worst.peak, found.peak), max(worst.claims, found.claims))
        if worst.peak > ENOUGH:
            break
    return worst


def _errors(fault: RandomFault) -> Iterator[Error]:
    if fault.fresh().hooks.key is not None:
        for first, second in _pairs():
            solver = fault.fresh()
            solver.operators(first)
            yield _error(solver, second)
    else:
        met = [probe for probe in probes() if fault.when(probe.problem)]
        yield from (_error(fault.fresh(), probe) for probe in met[:MET])


def _error(solver: Compact, probe: Probe) -> Error:
    if solver.changes_nothing(probe.problem, probe.ours):
        return Error(0.0, 0.0)
    return probe.error(solver.solved(probe.problem).pressure)


@cache
def _pairs() -> tuple[tuple[ContactProblem, Probe], ...]:
    small = [probe.problem for probe in probes() if probe.problem.gap.size <= REMEMBERED]
    made = [(first, _probe(second)) for first in small for second in _turned(first)]
    return tuple((first, second) for first, second in made if second is not None)


def _turned(problem: ContactProblem) -> list[ContactProblem]:
    c = problem.coupling
    load = problem.load or 1e-3 * problem.reduced_modulus * problem.area
    plain = replace(problem, load=load, approach=None)
    others = [
        replace(plain, spacing=2 * plain.spacing, spacing_y=2 * plain.spacings[1]),
        replace(plain, reduced_modulus=plain.reduced_modulus / 3),
        replace(plain, periodic=not plain.periodic),
    ]
    if c is not None:
        others.append(replace(plain, coupling=replace(c, sliding_direction=c.sliding_direction + 2)))
    return others
