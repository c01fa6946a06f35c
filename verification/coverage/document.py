"""The study's result file: settings, summaries by number and class, and every verdict for the figure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from refimpl.accuracy.refinement import FIRST_GRIDS, GRID_SIZES
from verification.coverage.judge import coverages, reference_change, summary
from verification.coverage.scenes import CLASSES
from verification.coverage.store import FINEST, NUMBERS, TOLERANCE, GridSolve, refine, refinements
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
        refine(store, [seed], grids_of(seed))
    stored = _of_grids(store, {seed: grids_of(seed) for seed in seeds})
    return {
        "study": "accuracy= on random scenes",
        "seeds": [seeds[0], seeds[-1]],
        "tolerance": TOLERANCE,
        "solves": solves(stored.values()),
        "reference_check": reference_check(seeds, store),
        "accuracies": [_judged(stored, accuracy) for accuracy in accuracies],
        "provenance": provenance(),
    }


def _of_grids(store: Path, grids: Mapping[int, Sequence[int]]) -> dict[int, list[GridSolve]]:
    """The store's solves of these scenes on these grids."""
    return {
        seed: [one for one in found if one.M in grids[seed]]
        for seed, found in refinements(store).items()
        if seed in grids
    }


def reference_check(seeds: Sequence[int], store: Path) -> dict[str, object]:
    """References on a grid twice as fine, over their stated bounds; None where no scene is checked."""
    chosen = [seed for seed in seeds if seed in CHECK_SEEDS]
    refine(store, chosen, [CHECK])
    found = _of_grids(store, {seed: (*grids_of(seed), CHECK) for seed in chosen})
    shares = [reference_change(found[seed]) for seed in chosen]
    return {
        "grid": CHECK,
        "seeds": chosen,
        "over_bound": shares,
        "worst_over_bound": max(shares, default=None),
    }


def solves(stored: Iterable[Sequence[GridSolve]]) -> dict[str, float]:
    """Number and time (s) of solves, worst residual, and largest change of an answer by the initial guess."""
    found = [one for several in stored for one in several]
    return {
        "count": len(found),
        "seconds": sum(one.seconds for one in found),
        "worst_residual": max(one.worst for one in found),
        "worst_apart": max((one.apart for one in found if one.apart is not None), default=0.0),
        "not_converged": sum(one.status not in ("converged", "cycled") for one in found),
    }


def _judged(stored: Mapping[int, Sequence[GridSolve]], accuracy: float) -> dict[str, object]:
    found = coverages(stored, accuracy)
    of = {number: [one for one in found if one.number == number] for number in NUMBERS}
    columns: dict[str, dict[str, list[object]]] = {
        number: {name: [getattr(one, name) for one in part] for name in ("seed", "met", "cheapest")}
        | {
            "class": [one.kind for one in part],
            "grid": [one.grids[-1] for one in part],
            "grids": [list(one.grids) for one in part],
        }
        | {
            name: _four_digits(getattr(one, name) for one in part)
            for name in ("bar", "error", "reference_bound", "cost")
        }
        for number, part in of.items()
    }
    return {
        "accuracy": accuracy,
        "numbers": {number: summary(part) for number, part in of.items()},
        "classes": {
            kind: {number: summary(one for one in part if one.kind == kind) for number, part in of.items()}
            for kind in CLASSES
        },
        "verdicts": columns,
    }


def _four_digits(values: Iterable[float | None]) -> list[object]:
    """Relative bars and errors as recorded: an infinite one is None.

    >>> _four_digits([2 / 3, math.inf])
    [0.6667, None]
    """
    return [None if v is None or not math.isfinite(v) else float(f"{v:.4g}") for v in values]
