"""What a solver hands back before certification: the state, how its loops ended, and what they visited."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

from refimpl.grid import Array
from refimpl.model.friction import Mask
from refimpl.model.slopes import Slopes


class Status(Enum):
    """How a solve ended.

    CONVERGED: the certificate meets the tolerance. STAGNATED: it stopped improving above it.
    ITERATION_LIMIT: a loop's limit came first. CYCLED: the support of tau cycled and was settled by
    the rule of `refimpl.model.friction`; the certificate holds for the settled traction. NO_CONTACT: the
    approach leaves the surfaces apart.
    """

    CONVERGED = "converged"
    STAGNATED = "stagnated"
    ITERATION_LIMIT = "iteration limit"
    CYCLED = "cycled"
    NO_CONTACT = "no contact"


class Visited(NamedTuple):
    """Summary of one state of a cycle: friction coefficient and contact area (m^2)."""

    friction_coefficient: float
    contact_area: float


@dataclass(frozen=True, eq=False)
class Outcome:
    """A solver's state: ``pressure``, ``traction`` (Pa) and ``slopes``, shapes ``(M, M)``.

    ``withheld`` marks the elements that tau's rule denied; ``visited`` holds the states of all
    cycles; ``iterations`` counts per loop.
    """

    pressure: Array
    traction: Array
    slopes: Slopes
    status: Status
    withheld: Mask
    visited: tuple[Visited, ...]
    iterations: dict[str, int] = field(default_factory=dict)
