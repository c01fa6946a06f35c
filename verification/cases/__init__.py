"""The verification cases by subject; a module of cases imports from here what it declares them with."""

from verification.framework.case import Measured, Unavailable
from verification.framework.certified import certified
from verification.framework.registry import case, family
from verification.framework.verdict import Verdict, judged, percents

__all__ = ["Measured", "Unavailable", "Verdict", "case", "certified", "family", "judged", "percents"]
