"""Run every invariant against a solver."""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import HealthCheck, example, given, settings

from verification.properties import equivariance, mechanics, states  # noqa: F401  # they declare invariants
from verification.properties.registry import INVARIANTS, Invariant, Solver
from verification.properties.samples import Sample


def check_solver(solver: Solver, *, examples: int = 20, only: Iterable[str] = ()) -> None:
    """Raise AssertionError, with the shrunk sample, at the first invariant that ``solver`` breaks.

    ``only`` names invariants (all when empty); samples are the same in every run. Raises KeyError for an
    unknown name.
    """
    chosen = [INVARIANTS[name] for name in only] or list(INVARIANTS.values())
    for invariant in chosen:
        _search(invariant, solver, examples)


def _search(invariant: Invariant, solver: Solver, examples: int) -> None:
    @settings(
        max_examples=examples,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(invariant.samples)
    def holds(sample: Sample) -> None:
        invariant.check(solver, sample)

    for sample in invariant.found:
        holds = example(sample)(holds)
    holds()
