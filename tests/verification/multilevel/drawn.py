"""Ensembles whose sweeps solve nothing, but draw numbers of a known scatter."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from verification.multilevel.ensemble import QUANTITIES
from verification.sweep import engine
from verification.sweep.study import Study

TABLE = {"scene": "table1-rough", "vary": {"grid": [16, 32]}, "solve": {"tolerance": 1e-3}}


def spied(monkeypatch: pytest.MonkeyPatch, scatter: tuple[float, ...]) -> dict[str, float]:
    """Sweeps solve nothing, but draw: independent numbers of that scatter by grid (8, 16, ...).

    Returns the seconds of every run by its key.
    """
    seconds: dict[str, float] = {}

    def drawn(study: Study, *_: Any, **__: Any) -> engine.Sweep:
        rows, spent = [], []
        for run in study.runs():
            level = int(np.log2(run.inputs["grid"] / 8))
            seed = study.first_seed + 2 * int(
                run.coordinates["realisation"]
            )  # a key knows the code's version
            value = 100 + scatter[level] * np.random.default_rng([seed, level]).standard_normal()
            row = dict.fromkeys((*QUANTITIES, "contact_area_corrected"), value)
            rows.append(row | {"normal_force": 70.0, "status": "converged", "key": run.key})
            spent.append(seconds.setdefault(run.key, 4.0**level))
        return engine.Sweep(0, len(rows), {}, rows, spent, 0.0)

    monkeypatch.setattr(engine, "sweep", drawn)
    return seconds
