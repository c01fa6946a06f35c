"""A solved and certified problem on one grid, with what its own solution leaves open of its numbers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from refimpl.accuracy.first_contact import HERTZ_EXPONENTS
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.iteration_error import AREAS, Uncertainty, active_set_parts, iteration_parts, merged
from refimpl.model.certificate import State
from refimpl.model.problem import Problem
from refimpl.model.state import SolverResult, Status
from refimpl.planning.plan import Plan
from refimpl.planning.term_effects import Effect, effects_in, neglected_parts
from refimpl.scene.scene import Scene
from refimpl.solution.cost import Cost
from refimpl.solution.unseen import unseen_parts


@dataclass(frozen=True, eq=False)
class Solved:
    """A solved and certified problem on one grid, before it becomes a `Solution`.

    ``scene`` says what lies beyond the domain and between points of data, if it is known.
    """

    problem: Problem
    plan: Plan
    result: SolverResult
    state: State
    tolerance: float
    cost: Cost
    scene: Scene | None = None

    @property
    def status(self) -> Status:
        """The loops' status; a loop that ended well still fails on a certificate that does not hold."""
        ended_well = self.result.status in (Status.CONVERGED, Status.CYCLED)
        if ended_well and not self.state.certificate.satisfies(self.tolerance):
            return Status.STAGNATED
        return self.result.status

    @cached_property
    def neglected(self) -> dict[str, Effect]:
        """Effects of the neglected terms, from the solved contact."""
        return effects_in(self.plan.neglected, self.problem, self.state.pressure, self.plan.contact)

    @cached_property
    def features(self) -> GridFeatures:
        """Features that error bars depend on, on this grid."""
        return GridFeatures.of(self.problem, self.state, self.own_parts)

    @property
    def own_parts(self) -> Uncertainty:
        """Parts of the uncertainty that this grid's own solution leaves: iteration, active set, neglected
        terms."""
        problem, state = self.problem, self.state
        forces, total = state.forces, float(state.pressure.sum())
        moved = (
            {"approach": state.approach}
            if problem.load is not None
            else {"normal_force": HERTZ_EXPONENTS["normal_force"] * forces.normal}
        )
        return merged(
            iteration_parts(problem, state),
            active_set_parts(problem, state),
            unseen_parts(problem, state, self.scene),
            neglected_parts(
                self.neglected,
                float(state.traction.sum()) / total if total else 0.0,
                problem.nominal_load(forces.normal),
                dict.fromkeys(AREAS, state.contact_area)
                | {"plastic_area": state.plastic_area}
                | {"max_pressure": 0.0 if state.plastic_area else state.max_pressure}
                | moved,
            ),
        )
