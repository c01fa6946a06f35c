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
    """Declare ``id`` (quick) and ``id-full``; the function gets the tier, each may have a ``tolerance``."""
    by_tier = tolerance if isinstance(tolerance, Mapping) else dict.fromkeys(TIERS, tolerance)
    ids = {id: "quick", f"{id}-full": "full"}
    return family("tier, tolerance", {i: (tier, by_tier[tier]) for i, tier in ids.items()}, **declared)
