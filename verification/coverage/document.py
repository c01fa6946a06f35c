"""The study's result file: settings, summaries by number and class, and every verdict for the figure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from refimpl.accuracy.refinement import FIRST_GRIDS, GRID_SIZES
from verification.coverage.judge import moved, summary, verdicts
from verification.coverage.scenes import CLASSES
from verification.coverage.store import FINEST, NUMBERS, TOLERANCE, Rung, climb, ladders
from verification.framework.provenance import provenance

GRIDS = (*FIRST_GRIDS, *(M for M in GRID_SIZES if FIRST_GRIDS[-1] < M <= FINEST))
"""Grids that may be requested: all of `refimpl.accuracy.refinement`."""
CHECK, CHECK_SEEDS = 2048, range(8, 14)
"""References are checked on one more grid for one scene of each class that is not periodic."""
REFERENCE, PERIODIC_REFERENCE = 1024, 512


def grids_of(seed: int) -> tuple[int, ...]:
    """A scene's grids, the last its reference: periodic scenes, ten times as dear, end at 512."""
    periodic = list(CLASSES)[seed % len(CLASSES)].startswith("periodic")
    reference = PERIODIC_REFERENCE if periodic else REFERENCE
    return (*(M for M in GRIDS if reference >= 2 * M), reference)


def document(accuracies: Sequence[float], seeds: Sequence[int], store: Path) -> dict[str, object]:
    """Solve what the store lacks and judge all of it."""
    for seed in seeds:
        climb(store, [seed], grids_of(seed))
    wanted = {seed: set(grids_of(seed)) for seed in seeds}
    stored = {
        seed: [rung for rung in rungs if rung.M in wanted[seed]]
        for seed, rungs in ladders(store).items()
        if seed in wanted
    }
    return {
        "study": "accuracy= on random scenes",
        "seeds": [seeds[0], seeds[-1]],
        "tolerance": TOLERANCE,
        "solves": solves(stored.values()),
        "reference_check": reference_check(seeds, store),
        "accuracies": [_judged(stored, accuracy) for accuracy in accuracies],
        "provenance": provenance(),
    }


def reference_check(seeds: Sequence[int], store: Path) -> dict[str, object]:
    """References on a grid twice as fine, over their stated bounds; None where no scene is checked."""
    chosen = [seed for seed in seeds if seed in CHECK_SEEDS]
    climb(store, chosen, [CHECK])
    found = ladders(store)
    wanted = {seed: {*grids_of(seed), CHECK} for seed in chosen}
    shares = [moved([rung for rung in found[seed] if rung.M in wanted[seed]]) for seed in chosen]
    return {
        "grid": CHECK,
        "seeds": chosen,
        "over_bound": shares,
        "worst_over_bound": max(shares, default=None),
    }


def solves(stored: Iterable[Sequence[Rung]]) -> dict[str, float]:
    """Number and time (s) of solves, worst residual, and largest change of an answer by the initial guess."""
    rungs = [rung for ladder in stored for rung in ladder]
    return {
        "count": len(rungs),
        "seconds": sum(rung.seconds for rung in rungs),
        "worst_residual": max(rung.worst for rung in rungs),
        "worst_apart": max((rung.apart for rung in rungs if rung.apart is not None), default=0.0),
        "not_converged": sum(rung.status not in ("converged", "cycled") for rung in rungs),
    }


def _judged(stored: Mapping[int, Sequence[Rung]], accuracy: float) -> dict[str, object]:
    found = verdicts(stored, accuracy)
    of = {number: [verdict for verdict in found if verdict.number == number] for number in NUMBERS}
    return {
        "accuracy": accuracy,
        "numbers": {number: summary(part) for number, part in of.items()},
        "classes": {
            kind: {number: summary(v for v in part if v.kind == kind) for number, part in of.items()}
            for kind in CLASSES
        },
        "verdicts": {
            number: {
                "seed": [v.seed for v in part],
                "class": [v.kind for v in part],
                "grid": [v.grids[-1] for v in part],
                "grids": [list(v.grids) for v in part],
                "met": [v.met for v in part],
                "bar": _four_digits(v.bar for v in part),
                "error": _four_digits(v.error for v in part),
                "reference_bound": _four_digits(v.reference_bound for v in part),
                "cheapest": [v.cheapest for v in part],
                "cost": _four_digits(v.cost for v in part),
            }
            for number, part in of.items()
        },
    }


def _four_digits(values: Iterable[float | None]) -> list[float | None]:
    """Relative bars and errors as recorded: an infinite one is None.

    >>> _four_digits([2 / 3, math.inf])
    [0.6667, None]
    """
    return [None if v is None or not math.isfinite(v) else float(f"{v:.4g}") for v in values]
