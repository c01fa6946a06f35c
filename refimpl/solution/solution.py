"""What a solve returns: the numbers, the arrays, how well it converged and what it cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from refimpl.grid import Array, Grid
from refimpl.model.certificate import Certificate
from refimpl.model.friction import Mask
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.model.state import Status
from refimpl.planning.plan import Plan
from refimpl.planning.term_effects import Effect
from refimpl.scene.scene import Friction
from refimpl.solution.bounds import Bounds, proven_bounds
from refimpl.solution.influence_error import SlopeError
from refimpl.solution.limits import Caution, plain_warning
from refimpl.solution.remark import Remark


@dataclass(frozen=True)
class Cost:
    """Work done: seconds, operator applications by kind, their ``n log2 n`` sum, iterations by loop."""

    seconds: float
    applications: Mapping[str, int]
    point_logs: float
    iterations: Mapping[str, int]


@dataclass(frozen=True, eq=False)
class Solution:
    """A solved scene. Forces in N, lengths in m, areas in m^2, pressures in Pa, arrays ``(M, M)``.

    ``approach`` counts from first touch, or from the mean planes when periodic. ``pressure`` is the local
    ``f`` and ``traction`` the local ``r`` of Eq. (1). ``surface_lower`` and ``surface_upper`` are the
    deformed heights; ``separation`` is the gap left between them, and ``clearance`` what Eq. (6) asks to be
    zero in contact, ``u / (cos theta_x cos theta_y) + h - approach``. ``uncertainty`` maps each reported
    number to its parts, absolute, in the number's unit. ``slope_error`` quotes what Appendix A's table says
    of flat-surface influence coefficients at this contact's slopes. ``problem`` is what was solved: the scene
    on its grid. ``left_out`` holds, for each term that the plan left out as small, its effect as the found
    contact has it; ``warnings`` are texts with ``limit``, ``number`` and ``allowed``: those of
    `refimpl.solution.limits`, and remarks without numbers.
    """

    status: Status
    approach: float
    normal_force: float
    friction_force: float
    binormal_force: float
    friction_coefficient: float
    contact_area: float
    contact_area_corrected: float
    max_pressure: float
    pressure: Array
    traction: Array
    slopes: Slopes
    surface_lower: Array
    surface_upper: Array
    separation: Array
    clearance: Array
    withheld: Mask
    slope_error: SlopeError
    grid: Grid
    friction: Friction
    sliding_direction: float
    certificate: Certificate
    tolerance: float
    uncertainty: Mapping[str, Mapping[str, float]]
    plan: Plan
    left_out: Mapping[str, Effect]
    problem: Problem
    warnings: tuple[Caution | Remark, ...]
    cost: Cost

    @property
    def contact(self) -> Mask:
        """Elements with ``f > 0``."""
        return self.pressure > 0

    @cached_property
    def theta_x(self) -> Array:
        """Slope angle along the sliding direction, positive uphill (rad)."""
        return np.arctan(self.slopes.tan_x)

    @cached_property
    def theta_y(self) -> Array:
        """Slope angle along the direction 90 degrees anticlockwise of sliding (rad)."""
        return np.arctan(self.slopes.tan_y)

    @property
    def converged(self) -> bool:
        """Whether the loops ended well and the certificate holds; a settled cycle of tau is certified too."""
        return self.status in (Status.CONVERGED, Status.CYCLED)

    @property
    def certified(self) -> bool:
        """Whether the certificate holds; so it may where an accuracy asked for was not reached."""
        return self.certificate.meets(self.tolerance)

    @cached_property
    def bounds(self) -> Bounds:
        """Proven bounds at the state's slopes and support of tau; computed when first asked for."""
        return proven_bounds(self.problem, self.pressure, self.traction, self.slopes)

    def summary(self) -> dict[str, Any]:
        """Everything but the arrays, as plain values for JSON."""
        numbers = {name: getattr(self, name) for name in REPORTED}
        return {
            "status": self.status.value,
            **numbers,
            "grid": self.grid.M,
            "side": self.grid.side,
            "tolerance": self.tolerance,
            "certificate": asdict(self.certificate),
            "uncertainty": {name: dict(parts) for name, parts in self.uncertainty.items()},
            "slope_error": asdict(self.slope_error),
            "plan": [
                {
                    "term": term.name,
                    "included": term.included,
                    "reason": term.reason,
                    "effect": asdict(term.effect),
                }
                for term in self.plan.terms
            ],
            "left_out": {name: asdict(effect) for name, effect in self.left_out.items()},
            "method": self.plan.method,
            "warnings": [plain_warning(text) for text in self.warnings],
            "cost": {
                "seconds": self.cost.seconds,
                "applications": dict(self.cost.applications),
                "iterations": dict(self.cost.iterations),
            },
        }


REPORTED = (
    "friction_coefficient",
    "contact_area",
    "contact_area_corrected",
    "max_pressure",
    "approach",
    "normal_force",
    "friction_force",
    "binormal_force",
)
