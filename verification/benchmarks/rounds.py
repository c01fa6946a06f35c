"""Turns: every code solves in a process of its own, A B C A B C, at the loosest tolerance that will do."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from verification.benchmarks.codes import OWN

TARGET = 1e-8  # relative gap, recomputed, that everybody has to meet
CERTIFIED = 1e-8  # tolerance at which our own solver starts: its default, so never looser
LOOSE = 1e-7  # where a peer's search starts: adapters derive their tolerances from bounds, on the safe side
_LONG = 20.0  # s; above it a tolerance that does is not loosened further
_TRIES = 8
_GROWTH = 8.0  # seconds from one grid to the twice finer one: four times the elements, and more iterations
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

Found = dict[str, Any]
"""Result of one solve, as `timed.timed_solve` returns it."""


class Failed(Exception):
    """A solve that gave nothing to judge: it raised, or took longer than allowed."""


@dataclass
class Turns:
    """One code on one problem: the tolerance it was given and what each round found."""

    code: str
    kind: str
    M: int
    tolerance: float
    rounds: list[Found] = field(default_factory=list)
    failure: str = ""

    def solve(self, tolerance: float, threads: int, limit: float) -> Found:
        """Solve in a fresh process, within ``limit`` seconds. Raises `Failed` with the last line said."""
        asked = [self.code, self.kind, str(self.M), repr(tolerance)]
        command = [sys.executable, "-m", "verification.benchmarks.timed", *asked]
        environment = {**os.environ, **dict.fromkeys(THREADS, str(threads))}
        try:
            done = subprocess.run(
                command, env=environment, capture_output=True, encoding="utf-8", timeout=limit
            )
        except subprocess.TimeoutExpired:
            raise Failed(f"took longer than {limit:g} s") from None
        if done.returncode != 0:
            raise Failed((done.stderr.strip() or "no word").splitlines()[-1])
        return dict(json.loads(done.stdout.splitlines()[-1]))


def error(found: Mapping[str, Any]) -> float:
    """Return the residual for the target: recomputed gap, with coupling the certificate's worst one."""
    return float(found["gap"] if found["residual"] is None else found["residual"])


def tuned_turns(name: str, kind: str, M: int, last: Turns | None, threads: int, limit: float) -> Turns:
    """Return the code with a tolerance that meets the target; or why it takes no part on this grid.

    ``last`` are its turns on the next coarser grid: a peer's search goes on from their tolerance.
    """
    ours = name.startswith(OWN)
    turns = Turns(name, kind, M, CERTIFIED if ours else (last.tolerance if last else LOOSE))
    if last is not None:
        if last.failure:
            turns.failure = f"not run after {last.M} x {last.M}: {last.failure}"
            return turns
        expected = _GROWTH ** math.log2(M / last.M) * min(found["seconds"] for found in last.rounds)
        if expected > limit:
            turns.failure = f"not run: {expected:.0f} s expected"
            return turns
    try:
        turns.tolerance, _ = tuned(
            lambda tolerance: turns.solve(tolerance, threads, limit), turns.tolerance, loosen=not ours
        )
    except Failed as failure:
        turns.failure = str(failure)
    return turns


def tuned(solve: Callable[[float], Found], start: float, *, loosen: bool) -> tuple[float, Found]:
    """Return the loosest tolerance, within a factor of two, whose error meets the target, and what it found.

    Without ``loosen`` the start is the loosest allowed. Raises `Failed` when no tolerance tried will do.
    """
    best: tuple[float, Found] | None = None
    too_loose, tolerance = math.inf, start
    for _ in range(_TRIES):
        found = solve(tolerance)
        excess = error(found) / TARGET
        if excess <= 1:
            best = tolerance, found
            if not loosen or found["seconds"] > _LONG or too_loose <= 2 * tolerance:
                return best
            if math.isinf(too_loose):
                tolerance *= min(10.0, max(2.0, 1 / max(excess, 0.1)))
                continue
        else:
            too_loose = tolerance
            if best is None:
                tolerance *= max(0.1, min(0.5, 1 / excess))
                continue
            if too_loose <= 2 * best[0]:
                return best
        tolerance = math.sqrt(best[0] * too_loose)
    if best is None:
        raise Failed(f"relative gap {TARGET * excess:.1e} at tolerance {tolerance:.1e}: {_TRIES} tries")
    return best


def in_turns(turns: Sequence[Turns], rounds: int, solve: Callable[[Turns], Found]) -> None:
    """Fill the rounds: one solve of each code, then the next of each. A failure ends a code's part."""
    for _ in range(rounds):
        for one in turns:
            if one.failure:
                continue
            try:
                one.rounds.append(solve(one))
            except Failed as failure:
                one.failure = str(failure)
