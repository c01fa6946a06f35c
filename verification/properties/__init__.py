"""Properties that every solver of this model has, as a library: samples, invariants, and `check_solver`."""

from verification.properties.check import check_solver
from verification.properties.registry import INVARIANTS, Invariant, Solver
from verification.properties.samples import Sample, samples

__all__ = ["INVARIANTS", "Invariant", "Sample", "Solver", "check_solver", "samples"]
