"""Run every invariant against a solver."""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import HealthCheck, Phase, example, given, settings
from hypothesis import seed as seeded

from verification.properties import equivariance, mechanics, states  # noqa: F401  # they declare invariants
from verification.properties.registry import INVARIANTS, Invariant, Solver
from verification.properties.samples import Sample


def check_solver(
    solver: Solver, *, examples: int = 20, only: Iterable[str] = (), seed: int | None = None
) -> None:
    """Raise AssertionError, with the shrunk sample, at the first invariant that ``solver`` breaks.

    ``only`` names invariants (all when empty). Samples are the same in every run, and others with every
    ``seed``. Raises KeyError for an unknown name.
    """
    chosen = [INVARIANTS[name] for name in only] or list(INVARIANTS.values())
    for invariant in chosen:
        search(invariant, solver, examples, seed)


def search(invariant: Invariant, solver: Solver, examples: int, seed: int | None = None) -> int:
    """Try past counterexamples and ``examples`` samples; how many held. Raises AssertionError as above."""
    held = 0
    # the phase that explains takes longer than finding and shrinking
    phases = tuple(phase for phase in settings().phases if phase is not Phase.explain)

    @settings(
        max_examples=examples,
        deadline=None,
        derandomize=seed is None,
        database=None,
        report_multiple_bugs=False,
        phases=phases,
        suppress_health_check=list(HealthCheck),
    )
    @given(invariant.samples)
    def holds(sample: Sample) -> None:
        nonlocal held
        invariant.check(solver, sample)
        held += 1

    for sample in invariant.found:
        holds = example(sample)(holds)
    if seed is not None:
        holds = seeded(seed)(holds)
    holds()
    return held
