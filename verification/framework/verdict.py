"""The sentence that a case about the paper ends with: the verdict on its claim, and what decides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import StrEnum

from verification.framework.case import Measured


class Verdict(StrEnum):
    """On the paper's claim. A case passes when its verdict stands, whichever it is."""

    CONFIRMED = "confirmed"
    CONDITIONAL = "confirmed with conditions"
    REFUTED = "not confirmed"
    CONSTRUCTION = "by construction"


def judged(
    verdict: Verdict,
    sentence: str,
    value: float,
    *,
    data: Mapping[str, object],
    reference: float | None = None,
    unit: str = "",
) -> Measured:
    """Return a measurement with its verdict in ``data["verdict"]``, and the sentence as its note."""
    return Measured(
        value=value,
        reference=reference,
        unit=unit,
        data={"verdict": verdict.value, **data},
        note=sentence,
    )


def percents(shares: Sequence[float], digits: int = 1) -> str:
    """Return shares in per cent, for a sentence.

    >>> percents([0.123, 0.5], 0)
    '12%, 50%'
    """
    return ", ".join(f"{share:.{digits}%}" for share in shares)
