"""The evidence for a solved problem on one grid: certificate, features, error parts, neglected effects."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from refimpl.accuracy.first_contact import HERTZ_EXPONENTS
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.iteration_error import (
    Uncertainty,
    active_set_parts,
    iteration_parts,
    merged,
    reported_numbers,
)
from refimpl.grid import Array, read_only
from refimpl.half_space.influence_error import SlopeError, constant_along_an_axis, slope_error
from refimpl.model.certificate import State
from refimpl.model.problem import Problem
from refimpl.model.state import Status
from refimpl.planning.plan import Plan
from refimpl.planning.term_effects import Effect, effects_in, neglected_parts
from refimpl.scene.scene import Scene
from refimpl.solution.domain_error import unseen_parts


@dataclass(frozen=True)
class Cost:
    """Work done: seconds, operator applications by kind, their ``n log2 n`` sum, iterations by loop."""

    seconds: float
    applications: Mapping[str, int]
    point_logs: float
    iterations: Mapping[str, int]


def total_cost(costs: Iterable[Cost]) -> Cost:
    """Return the cost of several solves together."""
    every, applications, iterations = list(costs), Counter[str](), Counter[str]()
    for cost in every:
        applications.update(cost.applications)
        iterations.update(cost.iterations)
    seconds, point_logs = sum(cost.seconds for cost in every), sum(cost.point_logs for cost in every)
    return Cost(seconds, dict(applications), point_logs, dict(iterations))


@dataclass(frozen=True, eq=False)
class Evidence:
    """Everything that the numbers of a solve on one grid are judged by.

    scene : with what lies beyond the domain and between points of data
    problem, plan, state : posed, modelled and found
    tolerance : what the certificate's residuals must meet
    cost : work done
    """

    scene: Scene
    problem: Problem
    plan: Plan
    state: State
    tolerance: float
    cost: Cost

    @property
    def status(self) -> Status:
        """The loops' status; a loop that ended well still fails on a certificate that does not hold."""
        ended_well = self.state.status in (Status.CONVERGED, Status.CYCLED)
        if ended_well and not self.state.certificate.satisfies(self.tolerance):
            return Status.STAGNATED
        return self.state.status

    def freeze(self) -> None:
        """Make the arrays read-only, without copies: what is computed from them later is what it was."""
        self.state.freeze()
        for array in (self.problem.gap, self.problem.mean_surface):
            read_only(array)

    @cached_property
    def numbers(self) -> dict[str, float]:
        """Reported numbers that need no features (SI)."""
        return reported_numbers(self.problem, self.state)

    @cached_property
    def surfaces(self) -> tuple[Array, Array]:
        """Deformed heights of the lower and the upper surface (m)."""
        lower, upper = self.problem.heights
        lower -= self.state.displacement_lower
        upper += self.state.displacement_upper
        upper -= self.state.approach
        return read_only(lower), read_only(upper)

    @cached_property
    def slope_error(self) -> SlopeError:
        """Error of flat-surface influence coefficients at this contact's slopes, by Appendix A's table."""
        problem, state = self.problem, self.state
        plane = constant_along_an_axis(problem.gap, problem.mean_surface)
        return slope_error(state.slopes, state.pressure, problem.pair, plane=plane)

    @cached_property
    def neglected(self) -> dict[str, Effect]:
        """Effects of the neglected terms, from the solved contact."""
        plan, state = self.plan, self.state
        return effects_in(plan.neglected, self.problem, state.pressure, state.clearance, plan.contact)

    @cached_property
    def features(self) -> GridFeatures:
        """Features that error bars depend on, on this grid."""
        return GridFeatures.of(self.problem, self.state, self.own_parts)

    @property
    def own_parts(self) -> Uncertainty:
        """Parts of the uncertainty by this grid's own solution: iteration, active set, neglected terms."""
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
                {"contact_area": state.contact_area}
                | {"plastic_area": state.plastic_area}
                | {"max_pressure": 0.0 if state.plastic_area else state.max_pressure}
                | moved,
            ),
        )
