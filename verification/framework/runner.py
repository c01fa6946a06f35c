"""Runs a selection of cases and forms the result file that reports are made from."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass

from verification.framework.case import Result, Status, Tier
from verification.framework.registry import CASES_PACKAGE, load, select
from verification.framework.workers import run_all
from verification.output.files import Progress
from verification.output.provenance import provenance

FORMAT = "rough-friction results, version 1"
ERRATUM = ("equation", "printed", "corrected", "measure", "printed_error", "corrected_error")


@dataclass(frozen=True)
class Run:
    """Results in the order of the registry, and the run's wall time in seconds."""

    tier: Tier
    only: tuple[str, ...]
    results: tuple[Result, ...]
    seconds: float

    @property
    def counts(self) -> dict[str, int]:
        """Number of results per status, zeros included."""
        found = Counter(r.status for r in self.results)
        return {status.value: found[status.value] for status in Status}

    @property
    def exit_status(self) -> int:
        """0 when something passed and nothing failed or broke, else 1; an unavailable case is neither."""
        bad = self.counts[Status.FAIL] + self.counts[Status.ERROR]
        return 0 if not bad and self.counts[Status.PASS] else 1

    def document(self) -> dict[str, object]:
        """Return the result file: the cases, and errata and provenance beside them."""
        return {
            "format": FORMAT,
            "tier": self.tier.value,
            "only": list(self.only),
            "counts": self.counts,
            "seconds": round(self.seconds, 3),
            "cases": [asdict(r) for r in self.results],
            "errata": errata(self.results),
            "provenance": provenance(),
        }


def run(
    tier: Tier | str = Tier.QUICK,
    *,
    only: Iterable[str] = (),
    jobs: int = 2,
    package: str = CASES_PACKAGE,
) -> Run:
    """Run the cases of a tier whose ids match `only` (globs; all when empty) in `jobs` worker processes.

    Raises LookupError when the selection is empty, ValueError for an unknown tier or fewer than one worker.
    """
    tier, globs, start = Tier(tier), tuple(only), time.perf_counter()
    chosen = select(load(package), tier, globs)
    with Progress(len(chosen)) as progress:
        results = run_all(chosen, jobs, lambda r: progress.tick(f"{r.status:<11} {r.id}"))
    return Run(tier, globs, tuple(results), time.perf_counter() - start)


def errata(results: Iterable[Result]) -> list[dict[str, object]]:
    """Return the errata with evidence: a case is about one when its data has all of ERRATUM."""
    about = [r for r in results if set(ERRATUM) <= set(r.data)]
    return [{"case": r.id, "status": r.status, **{name: r.data[name] for name in ERRATUM}} for r in about]
