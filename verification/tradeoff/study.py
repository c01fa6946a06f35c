"""The study of one scene: every way on every grid, against a far finer reference."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

import refimpl as rf
from verification.provenance import provenance
from verification.tradeoff import prices
from verification.tradeoff.measure import QUANTITIES, Run, run
from verification.tradeoff.settings import settings

TOLERANCES = (1e-3, 1e-5, 1e-8)
_DENSE_PATIENCE = 60.0  # s: what a user would wait for the plain reference


def study(
    scene: rf.Scene,
    name: str,
    grids: Sequence[int],
    finest: int,
    repeats: int,
    progress: Callable[[str], None],
) -> dict[str, Any]:
    """The document of the study: reference, runs, Pareto fronts, price list, growth.

    ``finest`` is the reference's grid; its doubt is the change from half of it.
    """
    solved = [rf.solve(scene, M) for M in (finest // 2, finest)]
    coarse, reference = ({name: float(getattr(s, name)) for name in QUANTITIES} for s in solved)
    doubt = {name: abs(coarse[name] / reference[name] - 1) for name in QUANTITIES}
    runs: list[Run] = []
    for setting in settings(grids, TOLERANCES):
        progress(f"{setting.way} at {setting.M}")
        runs.append(run(scene, setting, repeats))
    return {
        "scene": name,
        "reference": {"M": finest, "numbers": reference, "doubt": doubt},
        "runs": [_row(r, reference) for r in runs],
        "front": {
            name: [
                {"way": r.setting.way, "M": r.setting.M, "seconds": r.seconds, "error": e}
                for r in prices.front(runs, reference, name)
                for e in [prices.errors(r, reference)[name]]
            ]
            for name in QUANTITIES
        },
        "prices": prices.price_list(runs, reference, doubt),
        "growth": prices.growth(runs),
        "dense up to": {"seconds": _DENSE_PATIENCE, "M": prices.affordable(runs, "dense", _DENSE_PATIENCE)},
        "provenance": provenance(),
    }


def _row(run: Run, reference: dict[str, float]) -> dict[str, Any]:
    return {
        **asdict(run.setting),
        "way": run.setting.way,
        "status": run.status,
        "seconds": run.seconds,
        "convolutions": run.convolutions,
        "distance from the limit": run.seconds / run.limit,
        "peak_bytes": run.peak_bytes,
        "errors": prices.errors(run, reference),
    }
