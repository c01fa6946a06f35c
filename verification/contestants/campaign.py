"""The campaign of random faults against the covering design: ``python -m verification.contestants.campaign``.

A fault stops at the first case that it fails. A problem outside its condition gets the right answer, so that
only the others are solved. Problems that the compact solver does not solve when right are not counted.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

import numpy as np

from verification.contestants import compact, referee
from verification.contestants.design import posed, rows
from verification.contestants.protocol import ContactProblem
from verification.contestants.random_faults import COUNTED, SEEDS, RandomFault, error, random_fault

CLAIM = 1e-8


@cache
def problems() -> list[tuple[str, ContactProblem]]:
    """Slugs and problems of the design, small ones first."""
    found = [
        (f"design-{name}-{number:02}", posed(row, number, CLAIM))
        for name, design in rows().items()
        for number, row in enumerate(design, start=1)
    ]
    return sorted(found, key=lambda item: item[1].gap.size)


@cache
def _right(slug: str) -> bool:
    problem = dict(problems())[slug]
    answer = compact.solve(problem)
    return bool(answer.converged) and _judged(problem, np.asarray(answer.pressure)) <= CLAIM


def _judged(problem: ContactProblem, pressure: np.ndarray) -> float:
    try:
        return referee.residual(problem, pressure).worst
    except ValueError:
        return float("inf")


def caught(fault: RandomFault) -> str | None:
    """Slug of the first case of the design that a fault fails, or None."""
    solver = fault.fresh()
    for slug, problem in problems():
        if not fault.when(problem):
            continue
        residual = _judged(problem, np.asarray(solver(problem).pressure))
        if not residual <= 1.01 * CLAIM and _right(slug):
            return slug
    return None


def campaign(seeds: Iterable[int] = SEEDS) -> Iterator[dict[str, object]]:
    """Return, one by one, the faults with error and the case that catches each."""
    for seed in seeds:
        fault = random_fault(seed)
        head = {"seed": seed, "effect": fault.effect, "condition": fault.condition}
        yield head | {"error": error(fault), "caught": caught(fault)}


def summary(found: list[dict[str, object]]) -> str:
    """Counts, and the survivors."""
    counted = [f for f in found if float(str(f["error"])) > COUNTED]
    missed = [f for f in counted if f["caught"] is None]
    lines = [f"{len(found)} faults, {len(counted)} above 100 claims, {len(counted) - len(missed)} caught"]
    lines += [f"  {f['seed']}: {f['effect']}, {f['condition']}: error {f['error']:.2g}" for f in missed]
    return "\n".join(lines)


def main() -> int:
    """Run, with a line a fault on stderr; returns the exit status."""
    parser = argparse.ArgumentParser(description="random faults against the covering design")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--seeds", type=int, default=len(SEEDS), help="only the first so many")
    options, found = parser.parse_args(), []
    for result in campaign(list(SEEDS)[: options.seeds]):
        found.append(result)
        print(result, file=sys.stderr, flush=True)
    if options.json:
        options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(summary(found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
