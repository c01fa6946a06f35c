"""Warnings of the limits of the model, and notes: texts with the number that was found."""

from __future__ import annotations

from enum import StrEnum
from typing import Any


class Limit(StrEnum):
    """The limits of the model."""

    PLASTICITY = "plasticity index"
    HARDNESS = "peak pressure"
    SHEAR = "shear strength"
    RMS_GRADIENT = "rms gradient"
    MAX_SLOPE = "maximum slope"
    HALF_SPACE = "half-space"
    BORDER = "border"
    CORRELATION = "correlation length"
    SHORT_CUT = "shortest wave"
    DATA = "points of data"
    RADIUS = "contact radius"
    ACTIVE_SET = "active set of tau"
    NEGLECTED = "neglected"
    INPUT = "implausible input"


class ModelWarning(str):
    """A warning: its text, with the ``limit`` that was exceeded, the ``number`` found and the ``allowed``
    one.
    """

    limit: Limit
    number: float
    allowed: float

    def __new__(cls, limit: Limit, number: float, allowed: float, text: str) -> ModelWarning:
        self = super().__new__(cls, text)
        self.limit, self.number, self.allowed = limit, number, allowed
        return self

    def __getnewargs__(self) -> tuple[Limit, float, float, str]:  # type: ignore[override]  # str's has text alone
        return self.limit, self.number, self.allowed, str(self)


class Notice(str):
    """A note of a surface or of the refinement, with the fields of a `ModelWarning` but without numbers."""

    limit = "note"
    number = None
    allowed = None


def plain_warning(text: str) -> dict[str, Any]:
    """Return a warning as plain values for JSON."""
    if isinstance(text, ModelWarning):
        return {"name": text.limit.value, "number": text.number, "limit": text.allowed, "text": str(text)}
    return {"name": Notice.limit, "number": None, "limit": None, "text": text}
