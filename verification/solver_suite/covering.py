"""Covering arrays: every combination of levels of any few dimensions occurs in some row.

Found once: ``python -m verification.solver_suite.covering`` writes `FILE` anew.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from verification.solver_suite.dimensions import DESIGNS, FURTHER, Design

FILE = Path(__file__).with_name("covering.json")
"""By design its rows, each a text of the numbers of its levels, to the base 36."""
Combination = tuple[int, ...]
"""Dimension, level, dimension, level, ..."""


def stored(name: str, design: Design) -> list[dict[str, object]]:
    """Return the rows of the covering array of a design, from `FILE`."""
    levels = design.dimensions.values()
    return [
        dict(zip(design.dimensions, (of[int(k, 36)] for k, of in zip(row, levels, strict=True)), strict=True))
        for row in json.loads(FILE.read_text(encoding="utf-8"))[name]
    ]


def covering(sizes: Sequence[int], seed: int, *, strength: int, tries: int) -> list[list[int]]:
    """Return a covering array of dimensions with so many levels, by greedy search among completions.

    Of ``tries`` random completions of a row the best is taken.

    >>> rows = covering((2, 2, 2), seed=0, strength=2, tries=1)
    >>> len({(row[0], row[2]) for row in rows})
    4
    """
    random = np.random.default_rng(seed)
    wanted = {
        tuple(itertools.chain(*zip(chosen, levels, strict=True)))
        for chosen in itertools.combinations(range(len(sizes)), strength)
        for levels in itertools.product(*(range(sizes[k]) for k in chosen))
    }
    rows = []
    while wanted:
        left, best, most = sorted(wanted), [0] * len(sizes), -1
        for _ in range(tries):
            fixed = left[random.integers(len(left))]
            row = [int(random.integers(size)) for size in sizes]
            for k, level in zip(fixed[::2], fixed[1::2], strict=True):
                row[k] = level
            for k in random.permutation([k for k in range(len(sizes)) if k not in fixed[::2]]):
                gains = []
                for level in range(sizes[k]):
                    row[k] = level
                    gains.append(sum(each in wanted for each in _with(row, int(k), strength)))
                ties = np.flatnonzero(np.array(gains) == max(gains))
                row[k] = int(random.choice(ties))
            gain = sum(each in wanted for each in _combinations(row, strength))
            if gain > most:
                best, most = row, gain
        wanted -= {*_combinations(best, strength)}
        rows.append(best)
    return rows


def _combinations(row: Sequence[int], strength: int) -> Iterator[Combination]:
    for chosen in itertools.combinations(range(len(row)), strength):
        yield tuple(itertools.chain(*((k, row[k]) for k in chosen)))


def _with(row: Sequence[int], k: int, strength: int) -> Iterator[Combination]:
    """Yield those of a row's combinations that hold dimension ``k``."""
    others = [other for other in range(len(row)) if other != k]
    for chosen in itertools.combinations(others, strength - 1):
        yield tuple(itertools.chain(*((each, row[each]) for each in sorted((k, *chosen)))))


def text(name: str) -> list[str]:
    """Return the rows of a design as `FILE` has them, from a search."""
    dimensions, seed, strength, tries, _ = (DESIGNS | FURTHER)[name]
    found = covering([len(levels) for levels in dimensions.values()], seed, strength=strength, tries=tries)
    return ["".join(np.base_repr(level, 36) for level in row) for row in found]


if __name__ == "__main__":
    rows = {name: text(name) for name in DESIGNS | FURTHER}
    FILE.write_text(json.dumps(rows, indent=0) + "\n", encoding="utf-8")
