"""Table of faulty solvers: each has one fault, and claims success whatever it found.

Every one of them must fail in each case whose description names its fault
(`verification.cases.solvers.solver_suite`). The other faults that cases name were tried up to 43108c8b.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import Any
from unittest import mock

import numpy as np

from refimpl.grid import Array
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.solvers.production import constants
from verification.solver_suite import own, reference_solution
from verification.solver_suite.check import Fault
from verification.solver_suite.protocol import Answer, ContactProblem, Coupling, SolverUnderTest

Solver = Callable[[ContactProblem], Array]


@dataclass(frozen=True)
class Faulty:
    """A solver that always claims success; ``number`` gives a number beside the pressures, by its name."""

    solver: Solver
    number: tuple[str, Callable[[ContactProblem, Array], float]] | None = None
    abilities = own.solve.abilities

    def __call__(self, problem: ContactProblem) -> Answer:
        pressure = self.solver(problem)
        if self.number is None or not pressure.any():
            return Answer(pressure, True)
        name, of = self.number
        numbers: dict[str, Any] = {name: of(problem, pressure)}
        return Answer(pressure, True, **numbers)


def right(problem: ContactProblem) -> Array:
    """Return the pressures of our own solver, without its verdict."""
    return np.array(own.solve(problem).pressure, dtype=np.float64)


def asked(change: Callable[[ContactProblem], ContactProblem]) -> Solver:
    """Return a solver of another problem than the one posed."""
    return lambda problem: right(change(problem))


def periodic(problem: ContactProblem) -> ContactProblem:
    """Return the periodic problem whatever was asked: Tamaas 2.9.0 after `registerNonPeriodic` alone."""
    if problem.periodic:
        return problem
    approach = None if problem.approach is None else problem.approach - float(problem.gap.mean())
    return replace(problem, periodic=True, approach=approach)


def _coupled(change: Callable[[Coupling], Coupling]) -> Solver:
    def changed(problem: ContactProblem) -> ContactProblem:
        return problem if problem.coupling is None else replace(problem, coupling=change(problem.coupling))

    return asked(changed)


def _between_nodes(problem: ContactProblem) -> ContactProblem:
    """Return the heights half an element off along x: the mean of two neighbours."""
    gap = (problem.gap + np.roll(problem.gap, 1, axis=0)) / 2
    return replace(problem, gap=gap - gap.min())


def _mean_pressure_lost(problem: ContactProblem) -> ContactProblem:
    """Return the load as a mean pressure on (M - 1) x (M - 1) elements, as between nodes."""
    if problem.load is None:
        return problem
    return replace(problem, load=problem.load * (1 - 1 / problem.M) ** 2)


def _edges_exchanged(problem: ContactProblem) -> ContactProblem:
    dy, dx = problem.spacings
    return replace(problem, spacing=dx, spacing_y=None if dx == dy else dy)


def _pulling(problem: ContactProblem) -> Array:
    """Let the contact's neighbours pull with a thousandth of the peak; the load is made up for."""
    pressure = right(problem)
    contact = pressure > 0
    if not contact.any():
        return pressure
    beside = ~contact & (np.roll(contact, 1, axis=0) | np.roll(contact, -1, axis=1))
    pulled = np.where(beside, -1e-3 * pressure.max(), pressure)
    return np.asarray(pulled * (pressure.sum() / pulled.sum()))


def _modulus_kept() -> Solver:
    """Return a solver that keeps the modulus of its first problem of each size."""
    kept: dict[int, float] = {}
    return asked(lambda p: replace(p, reduced_modulus=kept.setdefault(p.M, p.reduced_modulus)))


def _approach_forgotten() -> Solver:
    """Return a solver that hands out again what it found for the same gap at another approach."""
    found: dict[tuple[object, ...], Array] = {}

    def solver(problem: ContactProblem) -> Array:
        others = (value for name, value in vars(problem).items() if name not in ("gap", "approach"))
        key = (problem.gap.tobytes(), *others)
        if key not in found:
            found[key] = right(problem)
        return found[key].copy()

    return solver


@contextmanager
def patched(*patches: tuple[Any, str, Any]) -> Iterator[None]:
    """Put faults into `refimpl` while the context lasts."""
    with ExitStack() as stack:
        for owner, name, wrong in patches:
            stack.enter_context(mock.patch.object(owner, name, wrong))
        yield


def _inside(*patches: tuple[Any, str, Any]) -> Solver:
    def solver(problem: ContactProblem) -> Array:
        with patched(*patches):
            return right(problem)

    return solver


def _single(owner: Any, name: str) -> tuple[Any, str, Any]:
    method = getattr(owner, name)
    return owner, name, lambda *args: method(*args).astype(np.float32).astype(np.float64)


_IN_SINGLE_PRECISION = _single(FFTInfluence, "_convolve"), _single(PeriodicInfluence, "_convolve")
_APPROACH_REVERSED = "approach", lambda problem, f: -reference_solution.approach_of(problem, f)

FAULTY: dict[Fault, Callable[[], SolverUnderTest]] = {
    Fault.SIGN_OF_C: lambda: Faulty(_coupled(lambda c: replace(c, shear_compliance=-c.shear_compliance))),
    Fault.TAU_MISSING: lambda: Faulty(_coupled(lambda c: replace(c, tau=0.0))),
    Fault.PERIODIC_FOR_APERIODIC: lambda: Faulty(asked(periodic)),
    Fault.APERIODIC_FOR_PERIODIC: lambda: Faulty(
        asked(lambda p: replace(p, periodic=False, approach=p.approach_from_touch))
    ),
    Fault.MODULUS_OFF: lambda: Faulty(asked(lambda p: replace(p, reduced_modulus=1.01 * p.reduced_modulus))),
    Fault.MODULUS_DOUBLED: lambda: Faulty(asked(lambda p: replace(p, reduced_modulus=2 * p.reduced_modulus))),
    Fault.MODULUS_KEPT: lambda: Faulty(_modulus_kept()),
    Fault.APPROACH_FORGOTTEN: lambda: Faulty(_approach_forgotten()),
    Fault.STUCK: lambda: Faulty(_inside((constants, "CG_LIMIT", 3))),
    Fault.SINGLE_PRECISION: lambda: Faulty(_inside(*_IN_SINGLE_PRECISION)),
    Fault.TRANSPOSED: lambda: Faulty(asked(lambda p: replace(p, gap=p.gap.T))),
    Fault.HALF_ELEMENT: lambda: Faulty(asked(_between_nodes)),
    Fault.EDGES_EXCHANGED: lambda: Faulty(asked(_edges_exchanged)),
    Fault.MEAN_PRESSURE_LOST: lambda: Faulty(asked(_mean_pressure_lost)),
    Fault.TENSION: lambda: Faulty(_pulling),
    Fault.ABSOLUTE_THRESHOLD: lambda: Faulty(lambda p: np.where((f := right(p)) < 0.02, 0.0, f)),  # 20 mPa
    Fault.HARDNESS_IGNORED: lambda: Faulty(asked(lambda p: replace(p, hardness=None))),
    Fault.APPROACH_SIGN: lambda: Faulty(right, _APPROACH_REVERSED),
}
"""A fresh solver with each fault."""
