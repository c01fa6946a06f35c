"""Runs a selection of cases and forms the result file that reports are made from."""

from __future__ import annotations

import importlib
import importlib.util
import time
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, is_dataclass

from verification.case import Result, Status, Tier, jsonable
from verification.files import Progress
from verification.provenance import provenance
from verification.registry import CASES_PACKAGE, load, select
from verification.workers import run_all

FORMAT = "rough-friction results, version 1"
ERRATA_MODULES = ("appendix_a.errata", "verification.errata")


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
        """The result file (SPEC 3): the cases, and errata and provenance beside them."""
        return {
            "format": FORMAT,
            "tier": self.tier.value,
            "only": list(self.only),
            "counts": self.counts,
            "seconds": round(self.seconds, 3),
            "cases": [asdict(r) for r in self.results],
            "errata": errata(self.tier),
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
    progress = Progress(len(chosen))
    results = run_all(chosen, jobs, lambda r: progress.tick(f"{r.status:<11} {r.id}"))
    progress.close()
    return Run(tier, globs, tuple(results), time.perf_counter() - start)


def errata(tier: Tier) -> list[dict[str, object]]:
    """Entries of the modules' `ERRATA` (dataclasses or mappings), where these modules exist.

    A field that is a function measures evidence, which can take minutes: it is called in the full tier only.
    """
    entries: list[dict[str, object]] = []
    for name in ERRATA_MODULES:
        if importlib.util.find_spec(name) is not None:
            entries += [_fields(entry, tier) for entry in importlib.import_module(name).ERRATA]
    return entries


def _fields(entry: object, tier: Tier) -> dict[str, object]:
    fields = vars(entry) if is_dataclass(entry) else entry
    if not isinstance(fields, Mapping):
        raise TypeError(f"an erratum is a dataclass or a mapping, not a {type(entry).__name__}")
    return {str(key): jsonable(_measured(value, tier)) for key, value in fields.items()}


def _measured(value: object, tier: Tier) -> object:
    if not callable(value):
        return value
    return value() if tier is Tier.FULL else "measured in the full tier"
