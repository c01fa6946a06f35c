"""One claim, two cases: on fewer and smaller realisations in the quick tier, in full in the full tier."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from verification.framework.case import Measured
from verification.framework.registry import family

TIERS = ("quick", "full")
Function = Callable[[str], Measured]


def in_both_tiers(
    id: str, *, tolerance: float | Mapping[str, float], **declared: str
) -> Callable[[Function], Function]:
    """Declare ``id`` in the quick tier and ``id-full`` in the full one; the function gets the tier.

    ``tolerance`` is one number, or one for each tier.
    """
    by_tier = tolerance if isinstance(tolerance, Mapping) else dict.fromkeys(TIERS, tolerance)
    ids = {id: "quick", f"{id}-full": "full"}
    return family("tier, tolerance", {i: (tier, by_tier[tier]) for i, tier in ids.items()}, **declared)
