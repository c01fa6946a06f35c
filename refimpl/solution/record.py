"""A solution's arrays, status and warnings, each read from its details."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from refimpl.grid import Array, Grid, Mask, read_only
from refimpl.model.certificate import Certificate
from refimpl.model.slopes import Slopes
from refimpl.model.state import Status
from refimpl.planning.plan import Plan
from refimpl.solution.details import Details, part
from refimpl.solution.evidence import Cost
from refimpl.solution.limits import model_warnings
from refimpl.solution.model_warning import Limit, ModelWarning, Notice
from refimpl.solution.plausibility import notes
from refimpl.solution.quantities import Numbers


class _Fields(Numbers):
    """Attributes of a `Solution` that its details hold under the same name."""

    pressure: Array = part("details.state")
    traction: Array = part("details.state")
    slopes: Slopes = part("details.state")
    certificate: Certificate = part("details.state")
    surfaces: tuple[Array, Array] = part("details.evidence")
    grid: Grid = part("details.problem")
    status: Status = part("details")
    plan: Plan = part("details")
    cost: Cost = part("details")


_ORDER = {Limit.INPUT: 0, Notice.limit: 2}


@dataclass(frozen=True, eq=False, repr=False)
class Record(_Fields):
    """A `Solution` without its texts: what follows from its details. Arrays are read-only.

    Error bars, warnings and whatever else no solve needs are computed when first read, and in a pickle.
    """

    details: Details

    def __getstate__(self) -> dict[str, Any]:
        _ = self.uncertainty, self.warnings
        return vars(self)

    @cached_property
    def warnings(self) -> tuple[ModelWarning | Notice, ...]:
        """Warnings of implausible inputs, often the cause of others; of the model's limits; then notes."""
        evidence, shortfall = self.details.evidence, self.details.shortfall
        found = (*((shortfall,) if shortfall else ()), *model_warnings(evidence), *notes(evidence))
        return tuple(sorted(found, key=lambda text: _ORDER.get(text.limit, 1)))

    @cached_property
    def gap(self) -> Array:
        """Deformed gap by Eq. (6) (m)."""
        return read_only(self.details.state.gap)

    @cached_property
    def plastic_indentation(self) -> Array:
        """Depth w_p by which the softer body has yielded (m)."""
        indentation = self.details.state.indentation
        return read_only(self.grid.zeros if indentation is None else indentation)

    @property
    def contact(self) -> Mask:
        """Elements with ``f > 0``."""
        return self.pressure > 0

    @property
    def converged(self) -> bool:
        """True if the loops ended well and the certificate holds, with an alternating edge or without."""
        return self.status in (Status.CONVERGED, Status.CYCLED)
