"""Covering arrays: every combination of levels of any few dimensions occurs in some row."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

TRIES = 30
"""Completions of a row among which the best is taken."""
Combination = tuple[int, ...]
"""Dimension, level, dimension, level, ..."""


def covering(
    dimensions: Mapping[str, Sequence[Any]], seed: int, *, strength: int = 2, tries: int = TRIES
) -> list[dict[str, Any]]:
    """Rows of a covering array, by a greedy search among random completions.

    >>> rows = covering({"a": (1, 2), "b": (3, 4), "c": (5, 6)}, seed=0)
    >>> len({(row["a"], row["c"]) for row in rows})
    4
    """
    names, random = list(dimensions), np.random.default_rng(seed)
    sizes = [len(dimensions[name]) for name in names]
    wanted = {
        tuple(itertools.chain(*zip(chosen, levels, strict=True)))
        for chosen in itertools.combinations(range(len(names)), strength)
        for levels in itertools.product(*(range(sizes[k]) for k in chosen))
    }
    rows = []
    while wanted:
        left, best, most = sorted(wanted), [0] * len(names), -1
        for _ in range(tries):
            fixed = left[random.integers(len(left))]
            row = [int(random.integers(size)) for size in sizes]
            for k, level in zip(fixed[::2], fixed[1::2], strict=True):
                row[k] = level
            for k in random.permutation([k for k in range(len(names)) if k not in fixed[::2]]):
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
        rows.append({name: dimensions[name][level] for name, level in zip(names, best, strict=True)})
    return rows


def _combinations(row: Sequence[int], strength: int) -> Iterator[Combination]:
    for chosen in itertools.combinations(range(len(row)), strength):
        yield tuple(itertools.chain(*((k, row[k]) for k in chosen)))


def _with(row: Sequence[int], k: int, strength: int) -> Iterator[Combination]:
    """Those of a row's combinations that hold dimension ``k``."""
    others = [other for other in range(len(row)) if other != k]
    for chosen in itertools.combinations(others, strength - 1):
        yield tuple(itertools.chain(*((each, row[each]) for each in sorted((k, *chosen)))))
