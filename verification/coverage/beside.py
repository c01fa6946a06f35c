"""Bars that no accuracy is asked of: approach and Q where a climb ends, and all numbers at an approach.

A bar of Q is judged over the load: Q itself is nothing but rounding where a scene is its own mirror image.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from refimpl.accuracy.refinement import FIRST_GRIDS, size_of, uncertainty
from refimpl.model.friction import is_frictionless
from verification.coverage.judge import Held, Verdict, bounded, ratio_of, reference_of
from verification.coverage.scenes import random_scene
from verification.coverage.store import NUMBERS, Rung

BESIDE = ("approach", "binormal_force")
AT_APPROACH = ("normal_force", "friction_coefficient", "contact_area", "max_pressure", "binormal_force")
GRIDS = (64, 128, 256)  # on which bars at an approach are judged


@dataclass(frozen=True, kw_only=True)
class Bar(Held):
    """One number of one scene on a grid; all three lengths are over the value, of Q over the load."""

    seed: int
    kind: str
    number: str
    grid: int


def where_climbs_end(ladders: Mapping[int, Sequence[Rung]], verdicts: Sequence[Verdict]) -> list[Bar]:
    """Approach and Q on the grids of verdicts on mu, and of those on A where mu has none."""
    ends = {v.seed: v for v in verdicts if v.number == "contact_area"}
    ends |= {v.seed: v for v in verdicts if v.number == "friction_coefficient"}
    return [_bar(ladders[seed], end.grids, number) for seed, end in sorted(ends.items()) for number in BESIDE]


def at_approach(ladders: Mapping[int, Sequence[Rung]]) -> list[Bar]:
    """All numbers on all `GRIDS`, each after the opening's."""
    return [
        _bar(rungs, tuple(dict.fromkeys((*FIRST_GRIDS, M))), number)
        for seed, rungs in ladders.items()
        for number in AT_APPROACH
        for M in GRIDS
        if number != "friction_coefficient" or not is_frictionless(random_scene(seed).scene.friction)
    ]


def _bar(rungs: Sequence[Rung], grids: Sequence[int], number: str) -> Bar:
    at = {rung.M: rung.result for rung in rungs}
    results = [at[M] for M in grids]
    fine = results[-1]
    reference, bound = _reference(rungs, number)
    value = fine.numbers[number]
    unit = fine.numbers["normal_force"] if number == "binormal_force" else abs(value)
    return Bar(
        seed=rungs[0].seed,
        kind=random_scene(rungs[0].seed).kind,
        number=number,
        grid=size_of(fine),
        bar=sum(uncertainty(results)[number].values()) / unit,
        error=abs(value - reference) / unit,
        reference_bound=bound / unit,
    )


def _reference(rungs: Sequence[Rung], number: str) -> tuple[float, float]:
    """As of climbs; else the finest grid's and its change. Approaches count from where surfaces touch."""
    if number in NUMBERS:
        return reference_of(rungs, number)
    before, finest = (
        rung.result.numbers[number] + (rung.result.first_contact.height if number == "approach" else 0.0)
        for rung in rungs[-2:]
    )
    return finest, abs(finest - before)


def summary(found: Sequence[Bar]) -> dict[str, float | int | None]:
    """Shares and medians of bars of one number."""
    if not found:
        return {"scenes": 0}
    return {
        "scenes": len(found),
        "covered": sum(bar.covered for bar in found) / len(found),
        "covered_at_worst": sum(bar.covered_at_worst for bar in found) / len(found),
        "median_bar_over_error": bounded(np.median([ratio_of(bar.bar, bar.error) for bar in found])),
        "median_bar": bounded(np.median([bar.bar for bar in found])),
    }
