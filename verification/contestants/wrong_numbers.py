"""Numbers that are wrong beside right pressures: see `verification.contestants.broken`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from refimpl.grid import Array
from verification.contestants import own, referee
from verification.contestants.protocol import Answer, ContactProblem
from verification.contestants.wrong import right

Number = Callable[[ContactProblem, Array], float]


@dataclass(frozen=True)
class WrongNumber:
    """Right pressures, with the number of this name as the function gives it."""

    name: str
    number: Number
    abilities = own.solve.abilities

    def __call__(self, problem: ContactProblem) -> Answer:
        """Return the answer, as if it were right; without the number where nothing is in contact."""
        pressure = right(problem)
        numbers: dict[str, Any] = {self.name: self.number(problem, pressure)} if pressure.any() else {}
        return Answer(pressure, True, **numbers)


def other_sign(problem: ContactProblem, f: Array) -> float:
    """The approach, negative where surfaces come together from first contact."""
    return -referee.approach_of(problem, f)


def other_datum(problem: ContactProblem, f: Array) -> float:
    """The approach from the mean planes on a free half-space, from first contact where periodic."""
    mean = float(problem.gap.mean())
    return referee.approach_of(problem, f) + (mean if problem.periodic else -mean)


def in_elements(problem: ContactProblem, f: Array) -> float:
    """Number of elements in contact."""
    return float(np.count_nonzero(f > 0))


def corrected(problem: ContactProblem, f: Array) -> float:
    """Area less a share of the faces between contact and no contact (Yastrebov et al. 2017)."""
    on = np.pad(f > 0, 1)
    faces = np.count_nonzero(on[1:] != on[:-1]) + np.count_nonzero(on[:, 1:] != on[:, :-1])
    cut = (np.pi - 1 + np.log(2)) / 24 * faces
    return float(np.count_nonzero(on) - cut) * problem.element_area


def over_the_contact(problem: ContactProblem, f: Array) -> float:
    """Mean of u over the contact in the place of the domain."""
    return float(referee.displacement(problem, f)[f > 0].mean())
