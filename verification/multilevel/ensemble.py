"""An ensemble solved to a target: pilot, allocation, more samples where they pay, until the error is met.

Only the finest grid's numbers are meant as they are. On coarser ones any that go with them will do. Whole
elements make areas too large by a share of the perimeter, and that is corrected to what the finest grid's
elements would make of it, with tau on that area in mu: a third less scatter on 64 elements a side, and a
third to a quarter less between grids (measured, table1-rough).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from refimpl.errors import InputError
from refimpl.scene.scene_file import scene_from_dict
from verification.multilevel.estimator import (
    Array,
    Estimate,
    costs_by_start,
    demand,
    estimate,
    variances,
)
from verification.sweep import engine
from verification.sweep.run import Row
from verification.sweep.study import MAX_RUNS, Study

QUANTITIES = ("friction_coefficient", "contact_area")
PILOT = (8, 8, 4, 2)  # samples of the terms at first; the last number serves all finer ones
FEWEST = 32  # least samples of the first term: a few that scatter little would otherwise be the last
_KNOWN = 3.0  # standard errors that a mean must be from zero before targets are shares of it
TOLERANCE = 1e-5  # default tolerance of each solve: far below any ensemble's scatter
_BLOCK = 10**7  # seeds between terms, so that no realisation serves two of them
_ROUNDS = 8


@dataclass(frozen=True)
class Ensemble:
    """Means on the finest grid; of every term its samples and the processor seconds of one.

    Grids that were found not to pay have none of both; ``dropped`` is what finding out took (s). ``plain`` is
    what as many solves on the finest grid as the standard error needs would cost (s), by how a realisation
    scatters on the grids kept: none where nothing does. ``finest`` are the values of the few such solves that
    there were, whose mean estimates the same without any coarser grid, and ``finest_seconds`` one's cost.
    """

    grids: tuple[int, ...]
    means: Mapping[str, Estimate]
    samples: tuple[int, ...]
    seconds: tuple[float, ...]
    plain: Mapping[str, float | None]
    finest: Mapping[str, tuple[float, ...]]
    met: bool
    failures: Mapping[str, str]
    dropped: float = 0.0
    finest_seconds: float | None = None

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
    pay by `costs_by_start` are dropped, down to plain sampling on the finest. Costs are processor seconds, so
    that another run of the same seeds may take a few realisations more or less, and differ within its error.
    Raises InputError, also for a target that is seen to take more than `MAX_RUNS` realisations, and what
    `engine.sweep` raises.
    """
    grids, names = _checked(study, target), _judged(study)
    if "tolerance" not in study.settings:
        study = replace(study, settings={**study.settings, "tolerance": TOLERANCE})
    sweep = partial(engine.sweep, store=store, workers=workers, scheduler=scheduler, tick=tick)
    numbers = [PILOT[min(term, len(PILOT) - 1)] for term in range(len(grids))]
    start, dropped = 0, 0.0
    for _ in range(_ROUNDS):
        terms = [
            _solved(study, names, sweep, term, grids[max(term - 1, start) : term + 1], number, grids[-1])
            for term, number in enumerate(numbers, start)
        ]
        found = _gathered(grids, names, terms, dropped, target)
        if found.failures or (found.met and len(terms[0].samples) >= FEWEST):
            return found
        sizes = _sizes(found, terms)
        if paying := _paying(terms, sizes):  # at any target: all costs go with its inverse square
            first = terms[paying].alone()
            dropped += sum(term.cost for term in terms[: paying + 1]) - first.cost
            terms, start = [first, *terms[paying + 1 :]], start + paying
        numbers = _numbers(terms, target, sizes)
    return found


@dataclass(frozen=True)
class _Term:
    """Samples and finer solves ``(N, quantities)``, what an element in contact is worth on the finest grid
    ``(quantities,)``, seconds of one sample and of one finer solve.
    """

    samples: Array
    finer: Array
    element: Array
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
    finest: int,
) -> _Term:
    """A term's samples on one grid, or from one to the next: the same realisations either way."""
    part = replace(
        study, realisations=number, first_seed=study.first_seed + term * _BLOCK, vary={"grid": tuple(grids)}
    )
    done = sweep(part)
    if failures := {**done.failures, **_unconverged(part, done)}:
        none = np.empty((0, len(names)))
        return _Term(none, none, none, np.nan, np.nan, failures)
    tau = study.scene["friction"]["tau"]
    shares = [1 - grid / finest for grid in grids] * number
    rows = zip(done.rows, shares, strict=True)
    values = np.array([_values(row, names, tau, share) for row, share in rows])
    by_grid = values.reshape(number, len(grids), len(names))
    finer = by_grid[:, -1]
    samples = finer - by_grid[:, 0] if len(grids) > 1 else finer
    seconds = np.array(done.solve_seconds).reshape(number, len(grids)).mean(axis=0)
    worth = {"contact_area": scene_from_dict(study.scene, Path()).grid(finest).element_area}
    worth["friction_coefficient"] = tau * worth["contact_area"] / float(done.rows[0]["normal_force"])
    element = np.array([worth[name] for name in names])
    return _Term(samples, finer, element, float(seconds.sum()), float(seconds[-1]), {})


def _values(row: Row, names: Sequence[str], tau: float, share: float) -> list[float]:
    """A row's numbers, with a share of the perimeter's correction in the area, and tau (Pa) on that area."""
    corrected = share * (float(row["contact_area_corrected"]) - float(row["contact_area"]))
    shift = {"contact_area": corrected, "friction_coefficient": tau * corrected / float(row["normal_force"])}
    return [float(row[name]) + shift[name] for name in names]


def _scatter(terms: Sequence[_Term]) -> Array:
    """A realisation's variance ``(quantities,)``, pooled over all grids: few samples on each."""
    differ = [np.ptp(term.finer, axis=0) > 0 for term in terms]  # the variance of equal numbers may round up
    variances = [term.finer.var(axis=0, ddof=1) * seen for term, seen in zip(terms, differ, strict=True)]
    return np.asarray(np.average(variances, axis=0, weights=[len(term.finer) - 1 for term in terms]))


def _unseen(terms: Sequence[_Term]) -> Array:
    """What a sample unlike all others may make of it: a realisation's scatter, or one element in contact."""
    return np.maximum(_scatter(terms), terms[0].element ** 2)


def _variances(terms: Sequence[_Term]) -> Array:
    """Of all terms' samples, ``(terms, quantities)``."""
    return np.transpose(
        [variances([term.samples[:, k] for term in terms], unseen) for k, unseen in enumerate(_unseen(terms))]
    )


def _sizes(found: Ensemble, terms: Sequence[_Term]) -> Array:
    """What the target is a share of, by quantity, a little smaller: scatter is seen to be larger later.

    It is a share of the mean; while that may as well be zero, of the mean on the finest grid alone.
    """
    means = zip(found.means.values(), terms[-1].finer.mean(axis=0), strict=True)
    known = [abs(e.mean if abs(e.mean) > _KNOWN * e.standard_error else alone) for e, alone in means]
    return 0.97 * np.array(known)


def _paying(terms: Sequence[_Term], sizes: Array) -> int:
    """The term to start from. A realisation's scatter is pooled over all grids: a coarse one that resolves
    nothing has more of it, which makes plain sampling look dearer than it is.
    """
    alone, pairs = (np.array([getattr(term, s) for term in terms]) for s in ("finer_seconds", "seconds"))
    return int(np.argmin(costs_by_start(_scatter(terms), _variances(terms), alone, pairs, sizes)))


def _numbers(terms: Sequence[_Term], target: float, sizes: Array) -> list[int]:
    """Samples that the terms should have, no fewer than they do; of the first, which bears most of the error,
    `FEWEST`. Raises InputError for too many.
    """
    at_one = demand(_variances(terms), np.array([term.seconds for term in terms]), sizes)
    least = float(np.sqrt(at_one.sum() / MAX_RUNS))
    if target < least:
        number = (least / target) * (least / target) * MAX_RUNS  # infinite where no double holds it
        reach = f"{1.05 * least:.2g} or more" if 1.05 * least < 1 else "none"  # two digits that are no less
        why = f"it takes {number:.2g} realisations by the pilot's estimate, at most {MAX_RUNS} are allowed"
        raise InputError("--target-error", target, f"{reach}: {why}")
    numbers = np.ceil(at_one / target**2 - 1e-9).astype(int)
    numbers[0] = max(numbers[0], FEWEST)
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
    scatter, unseen = _scatter(terms), _unseen(terms)
    means = {
        name: estimate([term.samples[:, k] for term in terms], unseen[k]) for k, name in enumerate(names)
    }
    plain = {
        name: terms[-1].finer_seconds * variance / means[name].standard_error ** 2 if variance else None
        for name, variance in zip(names, scatter.tolist(), strict=True)
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
        finest_seconds=terms[-1].finer_seconds,
    )


def _checked(study: Study, target: float) -> list[int]:
    grids = [int(M) for M in study.vary.get("grid", ())]
    if set(study.vary) != {"grid"}:
        extra = ", ".join(sorted(set(study.vary) - {"grid"}))
        raise InputError("vary", extra, "the grid alone, for an ensemble to a target error")
    if len(grids) < 2 or any(fine != 2 * coarse for coarse, fine in pairwise(grids)):
        raise InputError("vary.grid", grids, "two grids or more, each twice the one before")
    if not 0 < target < 1:
        raise InputError("--target-error", target, "a share between 0 and 1, or a percentage like 0.5%")
    if study.realisations != 1:
        raise InputError(
            "realisations", study.realisations, "none beside --target-error, which finds how many"
        )
    if study.first_seed + len(grids) * _BLOCK + 2 * MAX_RUNS >= 2**63:
        raise InputError("first_seed", study.first_seed, "seeds that leave room for all terms, below 9e18")
    if not study.is_rough:
        raise InputError(
            "--target-error", target, "none: no surface of the scene is random, nothing scatters"
        )
    return grids
