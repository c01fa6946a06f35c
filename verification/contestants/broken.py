"""Solvers that are wrong on purpose, each in one way, and all of them sure of themselves.

The suite's own test: every one of them must fail in each case whose description names its fault
(`verification.cases.solvers.contestants`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import Any
from unittest import mock

import numpy as np

from refimpl.grid import Array
from refimpl.kernels import normal_table
from refimpl.operators import kernel_tables
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.solvers.production import constants
from verification.contestants import own, referee, wrong_numbers
from verification.contestants.check import Fault
from verification.contestants.protocol import Answer, ContactProblem, Contestant
from verification.contestants.remembering import Forgetful, Remembering
from verification.contestants.wrong import (
    asked,
    cut_at_hardness,
    one_off,
    other_sign,
    padded,
    right,
    tau_along_x,
    tau_everywhere,
    tau_on,
    uncoupled_at_approach,
    unsigned,
    well_loaded,
    where_periodic,
    with_gap,
    without_tau,
)
from verification.contestants.wrong_numbers import WrongNumber


@dataclass(frozen=True)
class Wrong:
    """A solver with one fault; the solver always claims success."""

    solver: Callable[[ContactProblem], Array]
    abilities = own.solve.abilities

    def __call__(self, problem: ContactProblem) -> Answer:
        """What the faulty solver found, as if it were right."""
        return Answer(self.solver(problem), True)


@contextmanager
def patched(*patches: tuple[Any, str, Any]) -> Iterator[None]:
    """`refimpl` with a fault inside, while the context lasts; coefficients are tabulated anew."""
    with ExitStack() as stack:
        stack.enter_context(mock.patch.dict(kernel_tables._cache, clear=True))
        for owner, name, wrong in patches:
            stack.enter_context(mock.patch.object(owner, name, wrong))
        yield


def inside(*patches: tuple[Any, str, Any]) -> Callable[[ContactProblem], Array]:
    """Solves with a fault in the code."""

    def solver(problem: ContactProblem) -> Array:
        with patched(*patches):
            return right(problem)

    return solver


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


def from_first_contact(problem: ContactProblem) -> ContactProblem:
    """A periodic approach measured downwards from first contact, with the mean gap forgotten."""
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
    if not contact.any():
        return pressure
    beside = ~contact & (np.roll(contact, 1, axis=0) | np.roll(contact, -1, axis=1))
    pulled = np.where(beside, -1e-3 * pressure.max(), pressure)
    return np.asarray(pulled * (pressure.sum() / pulled.sum()))


def faint(problem: ContactProblem) -> Array:
    """A trillionth of the peak on all elements off the contact, as an interior-point method leaves it."""
    pressure = right(problem)
    return np.where(pressure > 0, pressure, 1e-12 * pressure.max())


def clipped(problem: ContactProblem) -> Array:
    """Pressures below a fixed 20 mPa count as none."""
    pressure = right(problem)
    return np.where(pressure < 0.02, 0.0, pressure)


def mean_pressure_added(problem: ContactProblem) -> Array:
    """Ten peaks of uniform pressure at a periodic approach: it displaces nothing, and stores no energy."""
    pressure = right(problem)
    return pressure + 10 * pressure.max() if problem.periodic and problem.approach is not None else pressure


def off_on_odd_grids(problem: ContactProblem) -> Array:
    """A tenth too much where M is odd, as a code tried on powers of two may have it."""
    pressure = right(problem)
    return 1.1 * pressure if problem.M % 2 else pressure


def corner_left_out(problem: ContactProblem) -> Array:
    """No pressure on the last element of the first row of a free square."""
    pressure = right(problem)
    if not problem.periodic:
        pressure[0, -1] = 0.0
    return pressure


def with_spacings(problem: ContactProblem, dx: float, dy: float) -> ContactProblem:
    """Return the gap on elements of other edges (m)."""
    return replace(problem, spacing=dx, spacing_y=None if dx == dy else dy)


def stretched(problem: ContactProblem) -> ContactProblem:
    """Return the gap and nominal area on a square, as a code with one number for its side may have it."""
    edge = problem.area**0.5
    return with_spacings(problem, edge / problem.shape[0], edge / problem.shape[1])


def _coarse_coefficients(rows: int, columns: int, dx: float, dy: float, *, known: Array | None) -> Array:
    """A point force at the centre of every element but the loaded one itself; ``known`` is made anew."""
    table = normal_table(rows, columns, dx, dy).copy()
    i, j = np.indices(table.shape)
    distance = np.hypot(i * dx, j * dy)
    return np.where(distance > 0, dx * dy / np.where(distance > 0, distance, 1.0), table)


def _single(function: Callable[..., Array]) -> Callable[..., Array]:
    return lambda *args: function(*args).astype(np.float32).astype(np.float64)


_IN_SINGLE_PRECISION = (
    (FFTInfluence, "_convolve", _single(FFTInfluence._convolve)),
    (PeriodicInfluence, "_filter", _single(PeriodicInfluence._filter)),
)
_POINT_FORCES = (kernel_tables, "_TABLES", {**kernel_tables._TABLES, "normal": _coarse_coefficients})
_THREE_STEPS = (constants, "CG_LIMIT", 3)

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
    Fault.MEAN_PLANES_LOST: lambda: Wrong(asked(from_first_contact)),
    Fault.MEAN_PRESSURE_LOST: lambda: Wrong(asked(mean_pressure_lost)),
    Fault.MEAN_PRESSURE_ADDED: lambda: Wrong(mean_pressure_added),
    Fault.NEAR_FIELD: lambda: Wrong(inside(_POINT_FORCES)),
    Fault.TENSION: lambda: Wrong(pulling),
    Fault.FAINT_PRESSURE: lambda: Wrong(faint),
    Fault.SPACING_KEPT: lambda: Wrong(Remembering("spacing")),
    Fault.MODULUS_KEPT: lambda: Wrong(Remembering("reduced_modulus")),
    Fault.C0_KEPT: lambda: Wrong(Remembering("shear_compliance")),
    Fault.DIRECTION_KEPT: lambda: Wrong(Remembering("sliding_direction")),
    Fault.BORDERS_KEPT: lambda: Wrong(Remembering("periodic")),
    Fault.BETA_KEPT: lambda: Wrong(Remembering("beta")),
    Fault.TAU_KEPT: lambda: Wrong(Remembering("tau")),
    Fault.APPROACH_FORGOTTEN: lambda: Wrong(Forgetful("approach")),
    Fault.FRICTION_FORGOTTEN: lambda: Wrong(Forgetful("coupling")),
    Fault.ABSOLUTE_THRESHOLD: lambda: Wrong(clipped),
    Fault.TAU_EVERYWHERE: lambda: Wrong(asked(tau_everywhere)),
    Fault.TAU_NOT_ON_ALL: lambda: Wrong(tau_on(well_loaded)),
    Fault.TAU_BESIDE: lambda: Wrong(where_periodic(tau_on(one_off))),
    Fault.TAU_ALONG_X: lambda: Wrong(where_periodic(tau_along_x)),
    Fault.SIGN_OF_C_LOST: lambda: Wrong(where_periodic(asked(unsigned))),
    Fault.UNCOUPLED_AT_APPROACH: lambda: Wrong(asked(uncoupled_at_approach)),
    Fault.ODD_GRIDS: lambda: Wrong(off_on_odd_grids),
    Fault.CORNER_LEFT_OUT: lambda: Wrong(corner_left_out),
    Fault.PADDING_SHORT: lambda: Wrong(padded(lambda M: 2 * M - 2)),
    Fault.PADDING_CAPPED: lambda: Wrong(padded(lambda M: min(2 * M, 256))),
    Fault.SHEAR_PADDING_CAPPED: lambda: Wrong(padded(lambda M: min(2 * M, 128), of_shear_alone=True)),
    Fault.EDGES_EXCHANGED: lambda: Wrong(asked(lambda p: with_spacings(p, *p.spacings[::-1]))),
    Fault.SQUARE_ELEMENTS: lambda: Wrong(asked(lambda p: with_spacings(p, *[p.element_area**0.5] * 2))),
    Fault.STRETCHED: lambda: Wrong(asked(stretched)),
    Fault.HARDNESS_IGNORED: lambda: Wrong(asked(lambda p: replace(p, hardness=None))),
    Fault.HARDNESS_CUT: lambda: Wrong(cut_at_hardness),
    Fault.HARDNESS_KEPT: lambda: Wrong(Remembering("hardness")),
    Fault.APPROACH_SIGN: lambda: WrongNumber("approach", wrong_numbers.other_sign),
    Fault.APPROACH_DATUM: lambda: WrongNumber("approach", wrong_numbers.other_datum),
    Fault.AREA_IN_ELEMENTS: lambda: WrongNumber("contact_area", wrong_numbers.in_elements),
    Fault.AREA_CORRECTED: lambda: WrongNumber("contact_area", wrong_numbers.corrected),
    Fault.DISPLACEMENT_OF_CONTACT: lambda: WrongNumber("mean_displacement", wrong_numbers.over_the_contact),
}
"""A fresh solver with each fault."""
