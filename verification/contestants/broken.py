"""Solvers that are wrong on purpose, each in one way, and all of them sure of themselves.

The suite's own test: every one of them must fail in each case whose description names its fault
(`verification.contestants.self_test`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import Any
from unittest import mock

import numpy as np

from refimpl import level_solver
from refimpl.grid import Array
from refimpl.kernels import normal_table
from refimpl.operators import tables
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from verification.contestants import own, referee
from verification.contestants.check import Fault
from verification.contestants.protocol import Answer, ContactProblem, Contestant

Change = Callable[[ContactProblem], ContactProblem]


@dataclass(frozen=True)
class Wrong:
    """A contestant with one fault; it claims success whatever happens inside."""

    solver: Callable[[ContactProblem], Array]
    abilities = own.solve.abilities

    def __call__(self, problem: ContactProblem) -> Answer:
        """What the faulty solver found, as if it were right."""
        return Answer(self.solver(problem), True)


def right(problem: ContactProblem) -> Array:
    """The pressures of our own solver, without its verdict."""
    return np.asarray(own.solve(problem).pressure, dtype=np.float64)


def asked(change: Change) -> Callable[[ContactProblem], Array]:
    """Solves another problem than it was asked."""
    return lambda problem: right(change(problem))


def with_gap(problem: ContactProblem, gap: Array) -> ContactProblem:
    """The problem with another gap, shifted to first touch."""
    return replace(problem, gap=gap - gap.min())


@contextmanager
def patched(*patches: tuple[Any, str, Any]) -> Iterator[None]:
    """`refimpl` with a fault inside, while the context lasts; coefficients are tabulated anew."""
    with ExitStack() as stack:
        stack.enter_context(mock.patch.dict(tables._cache, clear=True))
        for owner, name, wrong in patches:
            stack.enter_context(mock.patch.object(owner, name, wrong))
        yield


def inside(*patches: tuple[Any, str, Any]) -> Callable[[ContactProblem], Array]:
    """Solves with a fault in the code."""

    def solver(problem: ContactProblem) -> Array:
        with patched(*patches):
            return right(problem)

    return solver


def other_sign(problem: ContactProblem) -> ContactProblem:
    """c as upper minus lower."""
    if problem.coupling is None:
        return problem
    c = problem.coupling
    return replace(problem, coupling=replace(c, shear_compliance=-c.shear_compliance))


def without_tau(problem: ContactProblem) -> ContactProblem:
    """Friction by beta alone."""
    if problem.coupling is None:
        return problem
    return replace(problem, coupling=replace(problem.coupling, tau=0.0))


def tau_everywhere(problem: ContactProblem) -> ContactProblem:
    """Shear tau on the whole square: its displacement is known beforehand, and belongs to the gap."""
    if problem.coupling is None:
        return problem
    one = np.ones_like(problem.gap)
    sheared = replace(problem, coupling=replace(problem.coupling, beta=0.0))
    moved = referee.displacement(sheared, one) - referee.by_pressure(problem, one)
    return with_gap(without_tau(problem), problem.gap + moved)


def periodic(problem: ContactProblem) -> ContactProblem:
    """The periodic problem whatever was asked: what Tamaas 2.9.0 does after `registerNonPeriodic` alone."""
    if problem.periodic:
        return problem
    approach = None if problem.approach is None else problem.approach - float(problem.gap.mean())
    return replace(problem, periodic=True, approach=approach)


def aperiodic(problem: ContactProblem) -> ContactProblem:
    """A free half-space whatever was asked."""
    return replace(problem, periodic=False, approach=problem.approach_from_touch)


def between_nodes(problem: ContactProblem) -> ContactProblem:
    """Heights half an element off along x: the mean of two neighbours."""
    return with_gap(problem, (problem.gap + np.roll(problem.gap, 1, axis=0)) / 2)


def from_first_touch(problem: ContactProblem) -> ContactProblem:
    """A periodic approach measured downwards from first touch, with the mean gap forgotten."""
    if not problem.periodic or problem.approach is None:
        return problem
    return replace(problem, approach=abs(problem.approach) - float(problem.gap.mean()))


def mean_displacement_lost(problem: ContactProblem) -> Array:
    """The kernel's zero frequency set to zero in a free half-space: displacements lack their mean."""
    pressure = right(problem)
    if problem.periodic or problem.approach is None:
        return pressure
    mean = float(referee.by_pressure(problem, pressure).mean())
    return right(replace(problem, approach=problem.approach + mean))


def mean_pressure_lost(problem: ContactProblem) -> ContactProblem:
    """The load as a mean pressure on (M - 1) x (M - 1) elements, as between nodes."""
    if problem.load is None:
        return problem
    return replace(problem, load=problem.load * (1 - 1 / problem.M) ** 2)


def pulling(problem: ContactProblem) -> Array:
    """The contact's neighbours pull with a thousandth of the peak; the load is made up for."""
    pressure = right(problem)
    contact = pressure > 0
    beside = ~contact & (np.roll(contact, 1, axis=0) | np.roll(contact, -1, axis=1))
    pulled = np.where(beside, -1e-3 * pressure.max(), pressure)
    return np.asarray(pulled * (pressure.sum() / pulled.sum()))


def clipped(problem: ContactProblem) -> Array:
    """Pressures below a fixed 20 mPa count as none."""
    pressure = right(problem)
    return np.where(pressure < 0.02, 0.0, pressure)


def off_on_odd_grids(problem: ContactProblem) -> Array:
    """A tenth too much without coupling where M is odd, as a code tried on powers of two may have it."""
    pressure = right(problem)
    return 1.1 * pressure if problem.M % 2 and problem.coupling is None else pressure


class Remembering:
    """Keeps the spacing of the first problem of each size."""

    def __init__(self) -> None:
        self._spacing: dict[int, float] = {}

    def __call__(self, problem: ContactProblem) -> Array:
        """Solve on the remembered grid."""
        kept = self._spacing.setdefault(problem.M, problem.spacing)
        return right(replace(problem, spacing=kept))


def _coarse_coefficients(rows: int, columns: int, edge: float, *, known: Array | None) -> Array:
    """A point force at the centre of every element but the loaded one itself; ``known`` is made anew."""
    table = normal_table(rows, columns, edge).copy()
    i, j = np.indices(table.shape)
    distance = np.hypot(i, j) * edge
    return np.where(distance > 0, edge**2 / np.where(distance > 0, distance, 1.0), table)


def _single(function: Callable[..., Array]) -> Callable[..., Array]:
    return lambda *args: function(*args).astype(np.float32).astype(np.float64)


_IN_SINGLE_PRECISION = (
    (FFTInfluence, "_convolve", _single(FFTInfluence._convolve)),
    (PeriodicInfluence, "_filter", _single(PeriodicInfluence._filter)),
)
_POINT_FORCES = (tables, "_TABLES", {**tables._TABLES, "normal": _coarse_coefficients})
_THREE_STEPS = (level_solver, "_CG_LIMIT", 3)

BROKEN: dict[Fault, Callable[[], Contestant]] = {
    Fault.SIGN_OF_C: lambda: Wrong(asked(other_sign)),
    Fault.PERIODIC_FOR_APERIODIC: lambda: Wrong(asked(periodic)),
    Fault.APERIODIC_FOR_PERIODIC: lambda: Wrong(asked(aperiodic)),
    Fault.MODULUS_OFF: lambda: Wrong(asked(lambda p: replace(p, reduced_modulus=1.01 * p.reduced_modulus))),
    Fault.MODULUS_DOUBLED: lambda: Wrong(asked(lambda p: replace(p, reduced_modulus=2 * p.reduced_modulus))),
    Fault.STUCK: lambda: Wrong(inside(_THREE_STEPS)),
    Fault.TRANSPOSED: lambda: Wrong(asked(lambda p: replace(p, gap=p.gap.T))),
    Fault.HALF_ELEMENT: lambda: Wrong(asked(between_nodes)),
    Fault.SINGLE_PRECISION: lambda: Wrong(inside(*_IN_SINGLE_PRECISION)),
    Fault.TAU_MISSING: lambda: Wrong(asked(without_tau)),
    Fault.MEAN_DISPLACEMENT_LOST: lambda: Wrong(mean_displacement_lost),
    Fault.MEAN_PLANES_LOST: lambda: Wrong(asked(from_first_touch)),
    Fault.MEAN_PRESSURE_LOST: lambda: Wrong(asked(mean_pressure_lost)),
    Fault.NEAR_FIELD: lambda: Wrong(inside(_POINT_FORCES)),
    Fault.TENSION: lambda: Wrong(pulling),
    Fault.STATE_KEPT: lambda: Wrong(Remembering()),
    Fault.ABSOLUTE_THRESHOLD: lambda: Wrong(clipped),
    Fault.TAU_EVERYWHERE: lambda: Wrong(asked(tau_everywhere)),
    Fault.ODD_GRIDS: lambda: Wrong(off_on_odd_grids),
}
"""A fresh solver with each fault."""
