"""The documented name of `verification.framework.case` for authors of cases."""

from verification.framework.case import Measured, Metric, Tier, Unavailable

__all__ = ["Measured", "Metric", "Tier", "Unavailable"]
