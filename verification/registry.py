"""The documented name of `verification.framework.registry` for authors of cases."""

from verification.framework.registry import case, find, load, select

__all__ = ["case", "find", "load", "select"]
