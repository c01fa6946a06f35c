"""The active set of tau: which elements carry adhesive shear, one rule and one loop for all solvers.

``r = tau + beta f`` switches tau on where contact begins. Tau moves the surfaces beside it, so elements with
tau need not be the elements in contact. The rule has three steps.

1. *Gradual state.* Tau acts in full on the contact, and on a share of each element beside it: the share falls
   from 1 to 0 as the clearance grows from 0 to ``reach``. Shares follow displacements continuously, and less
   steeply than pressures resist them, so this state does not depend on the path to it. An element that tau
   lifts off ends outside the contact, with a share of tau. Elements in contact carry all of tau.
2. *Final state.* The active set A is the contact of the gradual state, and the problem is solved with tau on
   A. If elements of A are not in contact, A loses them, and the problem is solved again. A only shrinks, so
   the rule ends, and no cycle exists.
3. *Once more.* Elements that are in contact in the final state and not in A carry no adhesive shear: they are
   ``excluded``. If tau on them as well may leave the contact as it is (`promising`), the problem is solved
   with tau on all of it. If that is the contact again, the law holds everywhere; if not, the state with tau
   on A is final.

The set is a property of the grid, the same for every solver, window and start, but for elements whose
pressure or clearance is too small to decide. Excluded elements leave mu open by tau on them over the load,
the part ``active set`` of its error bar. Without any the law holds everywhere; other sets may obey it too,
with a mu that differs by up to 2e-3 of its value on 128 x 128 elements, in one random scene of ten.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from refimpl.grid import Array, Mask
from refimpl.model.elasticity import Influence
from refimpl.model.friction import FrictionLaw
from refimpl.model.problem import Problem
from refimpl.model.state import Status

_REACH = 2.0  # over the gap change by tau on single elements; with 1 slow convergence on 2048 x 2048, with 4
#               a third more excluded elements (150 random scenes, 256 x 256)
_LEAST_RATIO = 0.01  # least shear compliance in the reach, over the normal one: else tau moves only slopes
_LEAST_REACH = 1e-200  # m; a clearance over it is a double
_MOST_EXCLUDED = 0.5  # share of the contact; reached where tau is two to three times p_max
_LIFT_MARGIN = 1.4  # over the first-order estimate of the pressure that tau on excluded elements takes away
_LEAST_EXCLUDED = 0.02  # least pressure of an excluded element, over stiffness times reach; with both,
#                         19 of 61 states of 230 random scenes (128 x 128) are tried, and 7 of them succeed
_ACTIVE_SETS = 200  # limit of the loop
_MOST_STAGNATED = 3  # solves in a row that do not converge: their contact sets are not the rule's

Clearance = Callable[[], Array]
ContactTest = Callable[[Mask], bool]


@dataclass(frozen=True, eq=False)
class FixedSet:
    """Tau on given elements: traction r and shear offset ``r - slope f`` (Pa), whatever the state."""

    elements: Mask
    is_fixed = True

    def traction(self, law: FrictionLaw, pressure: Array, clearance: Clearance) -> Array:
        return law.traction(pressure, self.elements)

    def shear_offset(self, law: FrictionLaw, pressure: Array, clearance: Clearance) -> Array:
        return law.shear_offset(pressure, self.elements)


@dataclass(frozen=True)
class GradualSet:
    """All of tau on the contact, and a share of it up to a clearance of ``reach`` (m).

    >>> from refimpl.model.friction import Friction
    >>> law = Friction(tau=2.0)
    >>> GradualSet(reach=1e-9).traction(law, np.array([5.0, 0.0, 0.0]), lambda: np.array([0.0, 5e-10, 2e-9]))
    array([2., 1., 0.])
    """

    reach: float
    is_fixed = False

    def traction(self, law: FrictionLaw, pressure: Array, clearance: Clearance) -> Array:
        return law.slope * pressure + self.shear_offset(law, pressure, clearance)

    def shear_offset(self, law: FrictionLaw, pressure: Array, clearance: Clearance) -> Array:
        share = np.clip(1 - clearance() / self.reach, 0.0, 1.0)
        share[pressure > 0] = 1.0
        return share * law.shear_offset(pressure, share > 0)


ActiveSet = FixedSet | GradualSet
"""Elements under tau; ``is_fixed`` if shares do not depend on ``clearance()``, ``v - approach`` (m)."""


def first_set(problem: Problem) -> ActiveSet:
    """Return the gradual set of a problem; every element where the law's jump is too small to move any."""
    law, elasticity = problem.friction, problem.elasticity
    ratio = max(abs(elasticity.coupling_ratio), _LEAST_RATIO)
    reach = _REACH * ratio * law.jump * elasticity.element_compliance(problem.grid)
    if reach < _LEAST_REACH:
        return FixedSet(np.ones(problem.gap.shape, dtype=bool))
    return GradualSet(reach)


class TauSolver(Protocol):
    """Interface of a solver, as the loop needs it: states with tau on a given active set."""

    @property
    def operator(self) -> Influence:
        """Influence between the elements."""

    @property
    def pressure(self) -> Array:
        """Present pressure (Pa)."""

    @property
    def stagnated(self) -> bool:
        """Return whether the last solve did not converge."""

    @property
    def exhausted(self) -> bool:
        """Return whether no further solve is worthwhile: slopes diverged, or the solver's budget is spent."""

    @property
    def window_too_small(self) -> bool:
        """Return whether the contact meets the edge of the solver's window."""

    @property
    def contact(self) -> Mask:
        """Elements with positive present pressure."""

    def solve(self, tolerance: float, active: ActiveSet, enough: ContactTest | None = None) -> bool:
        """Solve with tau on ``active``; return whether the residual meets the tolerance.

        The solver may stop as soon as its contact set is decided and passes ``enough``.
        """

    def copy(self) -> Any:
        """Return the solver as it is, to `restore`."""

    def restore(self, copied: Any) -> None:
        """Go back to a copy; work is counted on."""


class TauResult(NamedTuple):
    """End of the rule.

    settled : the active set is part of the contact, and of most of it
    excluded : elements in contact that the rule leaves without adhesive shear
    solves : how many states were solved
    """

    settled: bool
    excluded: Mask
    solves: int

    def status(self, ended: Status = Status.CONVERGED) -> Status:
        """Return the status of a solver whose own loops ended with ``ended``."""
        if ended is Status.CONVERGED and not self.settled:
            return Status.ITERATION_LIMIT
        if ended is Status.CONVERGED and self.excluded.any():
            return Status.CYCLED
        return ended


def iterate(solver: TauSolver, problem: Problem, tolerance: float) -> TauResult:
    """Solve by the rule; states before the last may end early. The solver is left at the last state."""
    first = first_set(problem)
    if isinstance(first, FixedSet):
        solver.solve(tolerance, first)
        return TauResult(True, np.zeros(solver.contact.shape, dtype=bool), 1)
    terms = problem.terms
    moves = terms.coupled or terms.oblique or terms.slope_correction  # else the final state is this one
    solver.solve(tolerance, first, (lambda contact: True) if moves else None)
    active, solves, settled = solver.contact, 1, False
    stagnated = int(solver.stagnated)
    while not (settled or solver.window_too_small or solver.exhausted):
        if solves == _ACTIVE_SETS or stagnated == _MOST_STAGNATED:
            break
        solver.solve(tolerance, FixedSet(active), _loses(active))
        solves += 1
        stagnated = stagnated + 1 if solver.stagnated else 0
        remaining = active & solver.contact
        settled = bool(np.array_equal(remaining, active))
        active = remaining
    if settled and _holds_once_more(solver, problem, tolerance, active, first.reach):
        active, solves = solver.contact, solves + 1
    excluded = solver.contact & ~active
    return TauResult(settled and not _loses_most(excluded, solver.contact), excluded, solves)


def promising(problem: Problem, operator: Influence, pressure: Array, excluded: Mask, reach: float) -> bool:
    """Return whether tau on the excluded elements as well may leave the contact as it is.

    That tau opens a gap, and to close it takes pressure: every element must have more than that. Excluded
    elements must also have a least pressure, for what tau does to the slopes.
    """
    stiffness = 1 / problem.elasticity.element_compliance(problem.grid)
    held = problem.friction.shear_offset(pressure, excluded)
    needed = _LIFT_MARGIN * stiffness * problem.elasticity.gap_by_shear(operator.shear(held))
    needed[excluded] = np.maximum(needed[excluded], _LEAST_EXCLUDED * stiffness * reach)
    return not np.any((pressure > 0) & (pressure <= needed))


def _holds_once_more(
    solver: TauSolver, problem: Problem, tolerance: float, active: Mask, reach: float
) -> bool:
    """Try tau on all of the contact; return whether that obeys the law, and restore the solver if not."""
    whole = solver.contact
    excluded = whole & ~active
    if not (
        excluded.any()
        and (
            _loses_most(excluded, whole)
            or promising(problem, solver.operator, solver.pressure, excluded, reach)
        )
    ):
        return False
    before = solver.copy()
    found = solver.solve(tolerance, FixedSet(whole), lambda contact: not np.array_equal(contact, whole))
    if found and np.array_equal(solver.contact, whole):
        return True
    solver.restore(before)
    return False


def _loses_most(excluded: Mask, contact: Mask) -> bool:
    return bool(np.count_nonzero(excluded) > _MOST_EXCLUDED * np.count_nonzero(contact))


def _loses(active: Mask) -> ContactTest:
    return lambda contact: bool(np.any(active > contact))
