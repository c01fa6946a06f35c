"""Details behind a `Solution`: state, evidence and grids, for studies and for the code that judges it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import Any

from refimpl.accuracy.grid_features import GridFeatures
from refimpl.bounds.proven_bounds import Bounds, proven_bounds
from refimpl.grid import Array, Grid, Mask
from refimpl.half_space.influence_error import SlopeError
from refimpl.half_space.model_form import ModelForm, model_form
from refimpl.model.certificate import State
from refimpl.model.friction import FrictionLaw
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.model.state import Status
from refimpl.planning.plan import Plan
from refimpl.planning.term_effects import Effect
from refimpl.solution.evidence import Cost, Evidence
from refimpl.solution.model_warning import Notice


class _FromPart:
    """An attribute that is read, under its own name, from the part at a dotted path."""

    def __init__(self, path: str) -> None:
        self._path = path

    def __set_name__(self, owner: type, name: str) -> None:
        self._read = attrgetter(f"{self._path}.{name}")

    def __get__(self, details: Any, owner: type) -> Any:
        return self if details is None else self._read(details)


part: Any = _FromPart  # its instances stand for values of any type


class _Parts:
    """Attributes of `Details` that its evidence holds, as described there."""

    problem: Problem = part("evidence")
    plan: Plan = part("evidence")
    state: State = part("evidence")
    features: GridFeatures = part("evidence")
    neglected: Mapping[str, Effect] = part("evidence")
    slope_error: SlopeError = part("evidence")
    tolerance: float = part("evidence")
    slopes: Slopes = part("evidence.state")
    excluded: Mask = part("evidence.state")
    plastic: Mask = part("evidence.state")
    clearance: Array = part("evidence.state")
    grid: Grid = part("evidence.problem")
    friction: FrictionLaw = part("evidence.problem")


@dataclass(frozen=True, eq=False)
class Details(_Parts):
    """State, evidence and grids of a solve.

    evidence : state, features and effects on this grid, which numbers and arrays are read from
    cost : work of all grids
    grids : features of all grids of a refinement, coarse to fine; empty for a single grid
    shortfall : why a requested accuracy was not reached
    problem : the scene on its grid
    state : found
    features : what error bars look at on this grid, for studies of several grids
    neglected : effects of the neglected terms, from the solved contact
    slope_error : error of flat-surface influence coefficients at this contact's slopes, by Appendix A's table
    tolerance : what the certificate's residuals must meet
    excluded : elements that the rule for tau's active set leaves without adhesive shear
    plastic : elements at the hardness
    clearance : ``v - approach`` (m): the gap without the plastic indentation
    friction : the friction law
    """

    evidence: Evidence
    cost: Cost
    grids: tuple[GridFeatures, ...] = ()
    shortfall: Notice | None = None

    def __post_init__(self) -> None:
        self.evidence.freeze()

    @property
    def status(self) -> Status:
        """Status of the solve; a certificate that fails counts more than an accuracy that was not reached."""
        ended = self.evidence.status
        short = self.shortfall is not None and ended in (Status.CONVERGED, Status.CYCLED)
        return Status.ACCURACY_NOT_REACHED if short else ended

    @property
    def certified(self) -> bool:
        """True if the certificate holds, as it may where a requested accuracy was not reached."""
        return self.state.certificate.satisfies(self.tolerance)

    @property
    def sliding_direction(self) -> float:
        """The angle phi (rad)."""
        return self.problem.direction

    @property
    def separation(self) -> Array:
        """Height of the upper deformed surface over the lower one (m).

        On slopes Eq. (6) leaves it ``u (1 / (cos theta_x cos theta_y) - 1)`` below the gap.
        """
        lower, upper = self.evidence.surfaces
        return upper - lower

    @cached_property
    def bounds(self) -> Bounds:
        """Proven bounds at the state's slopes and active set of tau; computed when first used."""
        return proven_bounds(self.problem, self.state.pressure, self.state.traction, self.slopes)

    @cached_property
    def model_form(self) -> ModelForm:
        """Stated relative errors of the half-space in approach and N; computed when first used."""
        state = self.state
        moved = state.displacement_lower, state.displacement_upper
        return model_form(self.problem, state.pressure, state.traction, moved, state.approach)
