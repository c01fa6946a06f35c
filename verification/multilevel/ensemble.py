"""An ensemble solved to a target: pilot, allocation, more samples where they pay, until the error is met."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from refimpl.errors import InputError
from verification.multilevel.estimator import Array, Estimate, allocation, estimate
from verification.sweep import engine
from verification.sweep.study import Study

QUANTITIES = ("friction_coefficient", "contact_area")
PILOT = (16, 8, 4)  # samples of the terms at first; the last number serves all finer ones
TOLERANCE = 1e-5  # of each solve, where the study asks for none: far below any ensemble's scatter
_BLOCK = 10**7  # seeds between terms, so that no realisation serves two of them
_ROUNDS = 8


@dataclass(frozen=True)
class Ensemble:
    """Means on the finest grid; of every term its samples and the processor seconds of one.

    ``plain`` is what as many solves on the finest grid as the standard error needs would cost (s), ``finest``
    the values of the few that there were: their mean estimates the same without any coarser grid.
    """

    grids: tuple[int, ...]
    means: Mapping[str, Estimate]
    samples: tuple[int, ...]
    seconds: tuple[float, ...]
    plain: Mapping[str, float]
    finest: Mapping[str, tuple[float, ...]]
    met: bool
    failures: Mapping[str, str]

    @property
    def cost(self) -> float:
        """Processor seconds of all solves."""
        return float(np.dot(self.samples, self.seconds))


def ensemble(
    study: Study,
    store: Path,
    target: float,
    *,
    workers: int = 2,
    scheduler: str | None = None,
    tick: Callable[[engine.Progress], None] = lambda _: None,
) -> Ensemble:
    """Mean mu and A on the study's finest grid, each to the relative standard error ``target``.

    The study varies the grid alone, over two or more grids, each twice the one before. Runs are kept in the
    store, so an interrupted ensemble goes on. Where a run fails or does not converge there are no means but
    `Ensemble.failures`: without the hard surfaces they would be means of the easy ones. Raises InputError,
    and what `engine.sweep` raises.
    """
    grids = _checked(study, target)
    if "tolerance" not in study.settings:
        study = replace(study, settings={**study.settings, "tolerance": TOLERANCE})
    numbers = np.array([PILOT[min(term, len(PILOT) - 1)] for term in range(len(grids))])
    for _ in range(_ROUNDS):
        terms = [
            _solved(study, store, grids, term, int(n), workers, scheduler, tick)
            for term, n in enumerate(numbers)
        ]
        found = _gathered(grids, terms, target)
        if found.met or found.failures:
            return found
        variances = np.array([term.samples.var(axis=0, ddof=1) for term in terms])
        goal = 0.97 * target * np.array([abs(found.means[name].mean) for name in QUANTITIES])
        numbers = np.maximum(numbers, allocation(variances, np.array(found.seconds), goal))
    return found


@dataclass(frozen=True)
class _Term:
    """Samples and finer solves ``(N, quantities)``, seconds of one sample and of one finer solve."""

    samples: Array
    finer: Array
    seconds: float
    finer_seconds: float
    failures: Mapping[str, str]


def _solved(
    study: Study,
    store: Path,
    grids: Sequence[int],
    term: int,
    number: int,
    workers: int,
    scheduler: str | None,
    tick: Callable[[engine.Progress], None],
) -> _Term:
    pair = grids[max(term - 1, 0) : term + 1]
    part = replace(
        study, realisations=number, first_seed=study.first_seed + term * _BLOCK, vary={"grid": tuple(pair)}
    )
    done = engine.sweep(part, store, workers=workers, scheduler=scheduler, tick=tick)
    if failures := {**done.failures, **_unconverged(part, done)}:
        none = np.empty((0, len(QUANTITIES)))
        return _Term(none, none, np.nan, np.nan, failures)
    values = np.array([[row[name] for name in QUANTITIES] for row in done.rows], dtype=float)
    by_grid = values.reshape(number, len(pair), len(QUANTITIES))
    samples = by_grid[:, -1] - by_grid[:, 0] if term else by_grid[:, 0]
    seconds = np.array(done.solve_seconds).reshape(number, len(pair)).mean(axis=0)
    return _Term(samples, by_grid[:, -1], float(seconds.sum()), float(seconds[-1]), {})


def _unconverged(part: Study, done: engine.Sweep) -> dict[str, str]:
    """How many runs of a term are no solutions, under the key of the first; nothing where there is none."""
    if not done.unconverged:
        return {}
    first = done.unconverged[0]
    seed = part.first_seed + 2 * first["realisation"]
    number = f"{len(done.unconverged)} of {len(done.rows)} runs did not converge"
    which = f"seeds {seed} and {seed + 1} on {first['grid']} elements a side, {first['status']}"
    return {first["key"]: f"{number}; the first: {which}, residual {first['residual']:.2g}"}


def _gathered(grids: Sequence[int], terms: Sequence[_Term], target: float) -> Ensemble:
    failures = {key: text for term in terms for key, text in term.failures.items()}
    if failures:
        return Ensemble(tuple(grids), {}, (), (), {}, {}, False, failures)
    means = {name: estimate([term.samples[:, k] for term in terms]) for k, name in enumerate(QUANTITIES)}
    plain = {
        # the scatter of one realisation hardly depends on the grid, and the coarsest knows it best
        name: terms[-1].finer_seconds
        * float(terms[0].samples[:, k].var(ddof=1))
        / means[name].standard_error ** 2
        for k, name in enumerate(QUANTITIES)
    }
    return Ensemble(
        grids=tuple(grids),
        means=means,
        samples=tuple(len(term.samples) for term in terms),
        seconds=tuple(term.seconds for term in terms),
        plain=plain,
        finest={name: tuple(terms[-1].finer[:, k].tolist()) for k, name in enumerate(QUANTITIES)},
        met=all(e.standard_error <= target * abs(e.mean) for e in means.values()),
        failures={},
    )


def _checked(study: Study, target: float) -> list[int]:
    grids = [int(M) for M in study.vary["grid"]]
    if set(study.vary) != {"grid"}:
        extra = ", ".join(sorted(set(study.vary) - {"grid"}))
        raise InputError("vary", extra, "the grid alone, for an ensemble to a target error")
    if len(grids) < 2 or any(fine != 2 * coarse for coarse, fine in pairwise(grids)):
        raise InputError("vary.grid", grids, "two grids or more, each twice the one before")
    if not 0 < target < 1:
        raise InputError("--target-error", target, "a share between 0 and 1, or a percentage like 0.5%")
    if not study.is_rough:
        raise InputError(
            "--target-error", target, "none: no surface of the scene is Gaussian, nothing scatters"
        )
    return grids
