"""Error of a random fault: against the right pressures, on random problems of every kind that it may meet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import islice
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
MET = 16
"""Most probes that a fault is tried on, small ones first."""
REMEMBERED = 12
"""Probes that a memory is tried on, with others of their shapes."""
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
def probe(number: int) -> Probe | None:
    """Return a probe, or None where the two right solvers do not agree on it."""
    return _probe(posed(_row(number), number, CLAIM))


@cache
def _by_size() -> tuple[int, ...]:
    return tuple(sorted(range(PROBES), key=lambda number: int(_row(number)["elements"])))


def probes() -> Iterator[Probe]:
    """Return the probes one by one, small ones first."""
    yield from filter(None, map(probe, _by_size()))


def _probe(problem: ContactProblem) -> Probe | None:
    theirs, ours = own.solve(replace(problem, tolerance=1e-2 * CLAIM)), right.solved(problem)
    exact = np.asarray(theirs.pressure)
    far = float(np.abs(exact - ours.pressure).max())
    agreed = theirs.converged and ours.converged and float(exact.max()) > 0 and far < AGREED * exact.max()
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
    if fault.fresh().hooks.key is None:
        for probe in islice((probe for probe in probes() if fault.when(probe.problem)), MET):
            yield _error(fault.fresh(), probe)
        return
    for first in islice((probe.problem for probe in probes()), REMEMBERED):
        for number, problem in enumerate(_turned(first)):
            if (second := _second(first.gap.tobytes(), number, problem)) is not None:
                solver = fault.fresh()
                solver.operators(first)
                yield _error(solver, second)


def _error(solver: Compact, probe: Probe) -> Error:
    if solver.changes_nothing(probe.problem, probe.ours):
        return Error(0.0, 0.0)
    return probe.error(solver.solved(probe.problem).pressure)


_seconds: dict[tuple[bytes, int], Probe | None] = {}


def _second(first: bytes, number: int, problem: ContactProblem) -> Probe | None:
    if (first, number) not in _seconds:
        _seconds[first, number] = _probe(problem)
    return _seconds[first, number]


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
