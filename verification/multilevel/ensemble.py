"""An ensemble solved to a target: pilot, allocation, more samples where they pay, until the error is met."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from refimpl.errors import InputError
from verification.multilevel.estimator import (
    Array,
    Estimate,
    cheapest_start,
    costs_by_start,
    demand,
    estimate,
)
from verification.sweep import engine
from verification.sweep.study import MAX_RUNS, Study

QUANTITIES = ("friction_coefficient", "contact_area")
PILOT = (16, 8, 4)  # samples of the terms at first; the last number serves all finer ones
TOLERANCE = 1e-5  # of each solve, where the study asks for none: far below any ensemble's scatter
_BLOCK = 10**7  # seeds between terms, so that no realisation serves two of them
_ROUNDS = 8


@dataclass(frozen=True)
class Ensemble:
    """Means on the finest grid; of every term its samples and the processor seconds of one.

    Grids that were found not to pay have none of both; ``dropped`` is what finding out took (s). ``plain`` is
    what as many solves on the finest grid as the standard error needs would cost (s), ``finest`` the values
    of the few that there were: their mean estimates the same without any coarser grid.
    """

    grids: tuple[int, ...]
    means: Mapping[str, Estimate]
    samples: tuple[int, ...]
    seconds: tuple[float, ...]
    plain: Mapping[str, float]
    finest: Mapping[str, tuple[float, ...]]
    met: bool
    failures: Mapping[str, str]
    dropped: float = 0.0

    @property
    def cost(self) -> float:
        """Processor seconds of all solves."""
        return float(np.dot(self.samples, self.seconds)) + self.dropped


def ensemble(
    study: Study,
    store: Path,
    target: float,
    *,
    workers: int = 2,
    scheduler: str | None = None,
    tick: Callable[[engine.Progress], None] = lambda _: None,
) -> Ensemble:
    """Mean mu (with friction) and A on the finest grid, each to the relative standard error ``target``.

    The study varies the grid alone, over two or more grids, each twice the one before. Runs are kept in the
    store, so an interrupted ensemble goes on. Where a run fails or does not converge there are no means but
    `Ensemble.failures`: without the hard surfaces they would be means of the easy ones.

    A pilot tells variances and costs, and every round of more samples tells them better; grids too coarse to
    pay by `costs_by_start` are dropped, down to plain sampling on the finest. Raises InputError, also for a
    target that is seen to take more than `MAX_RUNS` realisations, and what `engine.sweep` raises.
    """
    grids, names = _checked(study, target), _judged(study)
    if "tolerance" not in study.settings:
        study = replace(study, settings={**study.settings, "tolerance": TOLERANCE})
    sweep = partial(engine.sweep, store=store, workers=workers, scheduler=scheduler, tick=tick)
    numbers = [PILOT[min(term, len(PILOT) - 1)] for term in range(len(grids))]
    start, dropped = 0, 0.0
    for _ in range(_ROUNDS):
        terms = [
            _solved(study, names, sweep, term, grids[max(term - 1, start) : term + 1], number)
            for term, number in enumerate(numbers, start)
        ]
        found = _gathered(grids, names, terms, dropped, target)
        if found.met or found.failures:
            return found
        sizes = _sizes(found)
        if paying := _paying(terms, sizes):  # at any target: all costs go with its inverse square
            first = terms[paying].alone()
            dropped += sum(term.cost for term in terms[: paying + 1]) - first.cost
            terms, start = [first, *terms[paying + 1 :]], start + paying
        numbers = _numbers(terms, target, sizes)
    return found


@dataclass(frozen=True)
class _Term:
    """Samples and finer solves ``(N, quantities)``, seconds of one sample and of one finer solve."""

    samples: Array
    finer: Array
    seconds: float
    finer_seconds: float
    failures: Mapping[str, str]

    @property
    def cost(self) -> float:
        """Seconds of all samples."""
        return len(self.samples) * self.seconds

    def alone(self) -> _Term:
        """Its finer solves as the samples of a first term."""
        return replace(self, samples=self.finer, seconds=self.finer_seconds)


def _judged(study: Study) -> tuple[str, ...]:
    """Without friction mu has a mean of zero, which no error is a share of."""
    friction = study.scene["friction"]
    return QUANTITIES if friction["tau"] or friction["beta"] else ("contact_area",)


def _solved(
    study: Study,
    names: Sequence[str],
    sweep: Callable[[Study], engine.Sweep],
    term: int,
    grids: Sequence[int],
    number: int,
) -> _Term:
    """A term's samples on one grid, or from one to the next: the same realisations either way."""
    part = replace(
        study, realisations=number, first_seed=study.first_seed + term * _BLOCK, vary={"grid": tuple(grids)}
    )
    done = sweep(part)
    if failures := {**done.failures, **_unconverged(part, done)}:
        none = np.empty((0, len(names)))
        return _Term(none, none, np.nan, np.nan, failures)
    values = np.array([[row[name] for name in names] for row in done.rows], dtype=float)
    by_grid = values.reshape(number, len(grids), len(names))
    finer = by_grid[:, -1]
    samples = finer - by_grid[:, 0] if len(grids) > 1 else finer
    seconds = np.array(done.solve_seconds).reshape(number, len(grids)).mean(axis=0)
    return _Term(samples, finer, float(seconds.sum()), float(seconds[-1]), {})


def _sizes(found: Ensemble) -> Array:
    """What the target is a share of, by quantity, a little smaller: scatter is seen to be larger later."""
    return 0.97 * np.array([abs(mean.mean) for mean in found.means.values()])


def _paying(terms: Sequence[_Term], sizes: Array) -> int:
    """The term to start from. A realisation's scatter is pooled over all grids, few samples on each: a coarse
    grid that resolves nothing has more of it, which makes plain sampling look dearer than it is.
    """
    scatter = np.average(
        [term.finer.var(axis=0, ddof=1) for term in terms],
        axis=0,
        weights=[len(term.finer) - 1 for term in terms],
    )
    corrections = np.array([term.samples.var(axis=0, ddof=1) for term in terms])
    alone, pairs = (np.array([getattr(term, s) for term in terms]) for s in ("finer_seconds", "seconds"))
    return cheapest_start(costs_by_start(scatter, corrections, alone, pairs, sizes))


def _numbers(terms: Sequence[_Term], target: float, sizes: Array) -> list[int]:
    """Samples that the terms should have, no fewer than they do. Raises InputError for too many."""
    variances = np.array([term.samples.var(axis=0, ddof=1) for term in terms])
    at_one = demand(variances, np.array([term.seconds for term in terms]), sizes)
    least = float(np.sqrt(at_one.sum() / MAX_RUNS))
    if target < least:
        number = (least / target) * (least / target) * MAX_RUNS  # infinite where no double holds it
        reach = f"{1.05 * least:.2g} or more"  # two digits that are no less
        why = f"it takes {number:.2g} realisations by the pilot's estimate, at most {MAX_RUNS} are allowed"
        raise InputError("--target-error", target, f"{reach}: {why}")
    numbers = np.ceil(at_one / target**2 - 1e-9).astype(int)
    return [max(len(term.samples), int(number)) for term, number in zip(terms, numbers, strict=True)]


def _unconverged(part: Study, done: engine.Sweep) -> dict[str, str]:
    """How many runs of a term are no solutions, under the key of the first; nothing where there is none."""
    if not done.unconverged:
        return {}
    first = done.unconverged[0]
    seed = part.first_seed + 2 * first["realisation"]
    number = f"{len(done.unconverged)} of {len(done.rows)} runs did not converge"
    which = f"seeds {seed} and {seed + 1} on {first['grid']} elements a side, {first['status']}"
    return {first["key"]: f"{number}; the first: {which}, residual {first['residual']:.2g}"}


def _gathered(
    grids: Sequence[int], names: Sequence[str], terms: Sequence[_Term], dropped: float, target: float
) -> Ensemble:
    failures = {key: text for term in terms for key, text in term.failures.items()}
    if failures:
        return Ensemble(tuple(grids), {}, (), (), {}, {}, False, failures)
    means = {name: estimate([term.samples[:, k] for term in terms]) for k, name in enumerate(names)}
    plain = {
        # the scatter of one realisation hardly depends on a grid that pays, and the coarsest knows it best
        name: terms[-1].finer_seconds
        * float(terms[0].samples[:, k].var(ddof=1))
        / means[name].standard_error ** 2
        for k, name in enumerate(names)
    }
    none = (0,) * (len(grids) - len(terms))
    return Ensemble(
        grids=tuple(grids),
        means=means,
        samples=none + tuple(len(term.samples) for term in terms),
        seconds=none + tuple(term.seconds for term in terms),
        plain=plain,
        finest={name: tuple(terms[-1].finer[:, k].tolist()) for k, name in enumerate(names)},
        met=all(e.standard_error <= target * abs(e.mean) for e in means.values()),
        failures={},
        dropped=dropped,
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
