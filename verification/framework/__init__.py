"""Verification cases: their declaration, the measurement they return, and the verdict on a claim."""

from verification.framework.case import Measured, Unavailable
from verification.framework.registry import case, family
from verification.framework.verdict import Verdict, judged

__all__ = ["Measured", "Unavailable", "Verdict", "case", "family", "judged"]
