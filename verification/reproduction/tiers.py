"""One claim, two cases: on fewer and smaller realisations in the quick tier, in full in the full tier."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import wraps

from verification.framework.case import Measured
from verification.framework.registry import case

TIERS = ("quick", "full")
Function = Callable[[str], Measured]


def in_both_tiers(
    id: str,
    *,
    title: str,
    claim: str,
    source: str,
    metric: str,
    tolerance: float | Mapping[str, float],
    tolerance_reason: str,
    tags: Iterable[str],
) -> Callable[[Function], Function]:
    """Declare ``id`` in the quick tier and ``id-full`` in the full one; the function gets the tier.

    ``tolerance`` is one number, or one for each tier.
    """

    def declare(function: Function) -> Function:
        for tier in TIERS:

            @wraps(function)  # takes over the module, where the runner's workers look for the case
            def run(tier: str = tier) -> Measured:
                return function(tier)

            case(
                id if tier == "quick" else f"{id}-full",
                title=title,
                claim=claim,
                source=source,
                metric=metric,
                tolerance=tolerance[tier] if isinstance(tolerance, Mapping) else tolerance,
                tolerance_reason=tolerance_reason,
                tier=tier,
                tags=("reproduction", *tags),
            )(run)
        return function

    return declare
