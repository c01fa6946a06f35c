"""The study of one scene: every way on every grid, against a far finer reference."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

import refimpl as rf
from verification.framework.provenance import provenance
from verification.tradeoff import prices
from verification.tradeoff.measure import QUANTITIES, Run, run
from verification.tradeoff.settings import inapplicable, settings

TOLERANCES = (1e-3, 1e-5, 1e-8)
IS_ZERO = "it is zero here, and of zero there is no relative error"
_DENSE_PATIENCE = 60.0  # s: what a user would wait for the plain reference


def study(
    scene: rf.Scene,
    name: str,
    grids: Sequence[int],
    finest: int,
    repeats: int,
    progress: Callable[[str], None],
) -> dict[str, Any]:
    """The document of the study: reference, runs, Pareto fronts, cost-accuracy table, growth.

    ``finest`` is the reference's grid; its doubt is the change from half of it. Ways that do not apply to the
    scene and numbers that are zero, of which there is no relative error, are "left out", with the reason;
    so are those that find no solution at all, under "failed". Raises ArithmeticError for a reference that is
    not settled: there is nothing to judge by.
    """
    solved = [_settled(scene, M) for M in (finest // 2, finest)]
    coarse, numbers = ({name: float(getattr(s, name)) for name in QUANTITIES} for s in solved)
    reference = {name: number for name, number in numbers.items() if number}
    doubt = prices.relative(coarse, reference)
    left_out = inapplicable(scene)
    runs: list[Run] = []
    failed: dict[str, str] = {}
    for setting in settings(grids, TOLERANCES, left_out):
        at = f"{setting.way} at {setting.M}"
        progress(at)
        try:
            runs.append(run(scene, setting, repeats))
        except ArithmeticError as none:
            if type(none) is not ArithmeticError:  # the solvers' own word; a division by zero is a bug
                raise
            failed[at] = str(none)
    return {
        "scene": name,
        "left out": left_out | {name: IS_ZERO for name in numbers if name not in reference},
        "failed": failed,
        "reference": {"M": finest, "numbers": reference, "doubt": doubt},
        "runs": [_row(r, reference) for r in runs],
        "front": {
            name: [
                {"way": r.setting.way, "M": r.setting.M, "seconds": r.seconds, "error": e}
                for r in prices.front(runs, reference, name)
                for e in [prices.relative(r.numbers, reference)[name]]
            ]
            for name in reference
        },
        "prices": prices.price_list(runs, reference, doubt),
        "growth": prices.growth(runs),
        "dense up to": {"seconds": _DENSE_PATIENCE, "M": prices.affordable(runs, "dense", _DENSE_PATIENCE)},
        "provenance": provenance(),
    }


def _settled(scene: rf.Scene, M: int) -> rf.Solution:
    solution = rf.solve(scene, M)
    if not solution.converged:
        raise ArithmeticError(f"the reference on {M} elements a side ends in '{solution.status.value}'")
    return solution


def _row(run: Run, reference: dict[str, float]) -> dict[str, Any]:
    return {
        **asdict(run.setting),
        "way": run.setting.way,
        "status": run.status,
        "seconds": run.seconds,
        "convolutions": run.convolutions,
        "distance from the limit": run.seconds / run.limit,
        "peak_bytes": run.peak_bytes,
        "errors": prices.relative(run.numbers, reference),
    }
