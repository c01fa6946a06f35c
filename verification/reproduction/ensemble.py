"""Ensembles of a shipped study: run, and averaged, with intervals."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from scipy.stats import t as student

from verification.sweep.engine import sweep
from verification.sweep.run import CERTIFIED, Row
from verification.sweep.study import Study
from verification.sweep.study_file import read_study

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """Mean over ``n`` independent realisations, the half width of its 95 % interval (Student's t), and the
    relative scatter of one realisation (standard deviation over mean).
    """

    mean: float
    half_width: float
    scatter: float
    n: int


def estimate(values: Sequence[float]) -> Estimate:
    """Estimate a mean; raises ValueError for fewer than two values or one that is not finite.

    >>> e = estimate([1.0, 2.0, 3.0])
    >>> e.mean, round(e.half_width, 3), e.scatter
    (2.0, 2.484, 0.5)
    """
    v = np.asarray(values, dtype=float)
    if len(v) < 2 or not np.all(np.isfinite(v)):
        raise ValueError("an interval needs at least two finite values")
    deviation = float(v.std(ddof=1))
    half = float(student.ppf((1 + CONFIDENCE) / 2, len(v) - 1)) * deviation / np.sqrt(len(v))
    mean = float(v.mean())
    return Estimate(mean, float(half), deviation / abs(mean) if mean else np.inf, len(v))


QUICK_MESH = 128
QUICK: Mapping[str, tuple[int, Mapping[str, Iterable[float]]]] = {
    "table3": (6, {}),
    "beta0": (6, {}),
    "fig8": (3, {"lower_rms": (0.0, 0.252e-6, 0.504e-6, 1.008e-6, 1.680e-6)}),
    "fig9": (1, {"sliding_direction": (0.0, np.pi / 2), "sliding_offset": [k * 50e-6 for k in range(8)]}),
    "fig10": (1, {"lower_rms": (0.504e-6, 1.680e-6), "sliding_direction": np.radians(range(0, 360, 60))}),
    "slide": (1, {"sliding_offset": [k * 100e-6 for k in range(16)]}),
}
"""The quick tier's part of each shipped study: realisations, and values on some axes."""


@cache
def rows_at(tier: str, name: str) -> tuple[Row, ...]:
    """Return all rows of a shipped study; in the quick tier those on `QUICK_MESH` elements a side."""
    if tier == "full":
        return rows(read_study(name))
    study, (realisations, vary) = read_study(name), QUICK[name]
    part = {"grid": (QUICK_MESH,)} | {axis: tuple(map(float, values)) for axis, values in vary.items()}
    return rows(replace(study, realisations=realisations, vary={**study.vary, **part}))


def rows(study: Study) -> tuple[Row, ...]:
    """Return all rows of a study, solved here. RuntimeError where one failed or is not certified."""
    with tempfile.TemporaryDirectory() as folder:
        done = sweep(study, Path(folder) / "rows.sqlite", workers=0)
    uncertified = [row["key"] for row in done.rows if row["status"] not in CERTIFIED]
    if done.failures or uncertified:
        first = next(iter(done.failures.values()), uncertified[:1])
        raise RuntimeError(f"{len(done.failures)} runs failed, {len(uncertified)} uncertified: {first}")
    return tuple(done.rows)


def column(found: Iterable[Row], quantity: str, **where: float) -> list[float]:
    """Return the values of a quantity in rows at given coordinates, in order; LookupError for none."""
    chosen = [row[quantity] for row in found if all(row[k] == v for k, v in where.items())]
    if not chosen:
        raise LookupError(f"no run has {where}")
    return chosen
