"""A covering design of contact problems: every pair of levels of any two dimensions occurs in some problem.

Judged by the linear residual, recomputed by `verification.contestants.referee`: no answer has to be known.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from verification.contestants import referee
from verification.contestants.gaps import waves
from verification.contestants.protocol import ContactProblem, Coupling

Row = Mapping[str, Any]

PLAIN: dict[str, tuple[Any, ...]] = {
    "elements": (9, 16, 31, 32, 45, 64, 125, 176),
    "edge": (1e-9, 1e-7, 1e-5, 1e-3, 1.0, 1e3),
    "modulus": (1e3, 1e6, 2e9, 2e11, 1e15),
    "control": ("load", "approach"),
    "borders": ("free", "periodic"),
    "contact": ("light", "half", "most", "full"),
    "slope": (1e-4, 1e-2, 1.0),
    "surface": ("smooth", "harsh"),
}
"""Squares without friction. ``edge`` in m, ``modulus`` in Pa; ``slope`` scales heights over the side."""
SLIDING = PLAIN | {
    "sector": tuple(range(8)),
    "beta": (0.05, 0.4, 1.0, 1.6),
    "tau": (0.0, 0.01, 0.1),
    "coupling": (-0.6, -0.2, 0.1, 0.45),
}
"""Squares that slide. ``sector``: eighth of the circle; ``tau`` over the peak; ``coupling``: pi c0 E*."""
OBLONG = SLIDING | {
    "elements": (12, 21, 32, 63, 128),
    "edge": (1e-8, 1e-5, 1.0),
    "modulus": (1e4, 2e11),
    "shape": ("wide", "deep", "oblong elements", "both"),
    "sector": (0, 3, 5, 6),
}
"""Rectangles, elements whose edges differ, and both; with friction."""
PRESSURES = {"light": 0.01, "half": 0.1, "most": 0.5, "full": 4.0}
"""Mean pressure over E* times the slope."""
DEPTHS = {"light": 0.2, "half": 0.5, "most": 0.8, "full": 0.95}
"""Approach from first contact over the mean gap if periodic; free, with `BEYOND` where contact is full."""
SHARES = {"light": 0.01, "half": 0.2, "most": 0.6, "full": 1.0}
"""Elements in contact over all, where pressures are chosen."""
PEAK = 0.1
"""Chosen peak pressure over E* times the slope."""
MARGIN = 0.2
"""Clearance beside a chosen contact, over the range of its displacement: no element is in doubt."""
BEYOND = 2.0
"""Approach over the largest gap."""


def covering(dimensions: Mapping[str, Sequence[Any]], seed: int) -> list[dict[str, Any]]:
    """Rows of a covering array of strength 2, by a greedy search among random completions.

    >>> rows = covering({"a": (1, 2), "b": (3, 4), "c": (5, 6)}, seed=0)
    >>> len({(row["a"], row["c"]) for row in rows})
    4
    """
    names, random = list(dimensions), np.random.default_rng(seed)
    sizes = [len(dimensions[name]) for name in names]
    pairs = {
        (i, a, j, b)
        for i, j in itertools.combinations(range(len(names)), 2)
        for a, b in itertools.product(range(sizes[i]), range(sizes[j]))
    }
    rows = []
    while pairs:
        left, best, most = sorted(pairs), [0] * len(names), -1
        for _ in range(30):
            i, a, j, b = left[random.integers(len(left))]
            row = [int(random.integers(size)) for size in sizes]
            row[i], row[j] = a, b
            for k in random.permutation([k for k in range(len(names)) if k not in (i, j)]):
                gains = []
                for level in range(sizes[k]):
                    row[k] = level
                    gains.append(
                        sum(_pair(row, k, other) in pairs for other in range(len(row)) if other != k)
                    )
                ties = np.flatnonzero(np.array(gains) == max(gains))
                row[k] = int(random.choice(ties))
            gain = sum(_pair(row, i, j) in pairs for i, j in itertools.combinations(range(len(row)), 2))
            if gain > most:
                best, most = row, gain
        pairs -= {_pair(best, i, j) for i, j in itertools.combinations(range(len(best)), 2)}
        rows.append({name: dimensions[name][level] for name, level in zip(names, best, strict=True)})
    return rows


def _pair(row: Sequence[int], i: int, j: int) -> tuple[int, int, int, int]:
    i, j = min(i, j), max(i, j)
    return i, row[i], j, row[j]


@cache
def rows() -> dict[str, tuple[dict[str, Any], ...]]:
    """Rows of the three designs, by name; small grids first within each."""
    made = {"plain": covering(PLAIN, 1), "sliding": covering(SLIDING, 2), "oblong": covering(OBLONG, 3)}
    return {name: tuple(sorted(found, key=lambda row: int(row["elements"]))) for name, found in made.items()}


def posed(row: Row, seed: int, tolerance: float) -> ContactProblem:
    """Return the problem of a row; ``seed`` draws its surface and the direction within its sector."""
    random, n = np.random.default_rng([45, seed]), int(row["elements"])
    shape = row.get("shape", "")
    across = {"wide": (n, max(3, n // 2)), "deep": (max(3, n // 2), n), "both": (n, max(3, 2 * n // 3))}
    nx, ny = across.get(shape, (n, n))
    dx, dy = float(row["edge"]), float(row["edge"]) * (1.6 if shape in ("both", "oblong elements") else 1.0)
    side, E, g = n * dx, float(row["modulus"]), float(row["slope"])
    if row["surface"] == "smooth":
        heights = waves(n, seed, shortest=3)[:nx, :ny]
    else:
        heights = random.standard_normal((nx, ny)) * min(1.0, 8 / n)
    gap = 0.05 * g * side * (heights.max() - heights)
    periodic, mean = row["borders"] == "periodic", float(gap.mean())
    pressure = PRESSURES[row["contact"]] * E * g
    load = approach = None
    if row["control"] == "load":
        load = pressure * nx * dx * ny * dy
    elif periodic:
        approach = (DEPTHS[row["contact"]] - 1) * mean
    else:
        approach = BEYOND * float(gap.max()) if row["contact"] == "full" else DEPTHS[row["contact"]] * mean
    coupling = None
    if "beta" in row:
        direction = (row["sector"] + random.uniform(0.15, 0.85)) * np.pi / 4
        compliance = row["coupling"] / (np.pi * E)
        coupling = Coupling(row["tau"] * PEAK * E * g, row["beta"], compliance, float(direction))
    dy_ = None if dx == dy else dy
    found = ContactProblem(gap - gap.min(), dx, E, load, approach, periodic, tolerance, coupling, dy_)
    return manufactured(found, row, random) if row.get("tau") else found


def manufactured(problem: ContactProblem, row: Row, random: np.random.Generator) -> ContactProblem:
    """Return the problem over a gap that chosen pressures close: with tau another gap may have no solution.

    The lowest elements of the gap touch, with pressures from 0.3 of the peak up; the others are well apart.
    """
    most = 0.9 if problem.periodic and problem.load is None else 1.0  # at full contact the mean is free
    share = max(1, round(min(most, SHARES[row["contact"]]) * problem.gap.size))
    contact = problem.gap <= np.partition(problem.gap.ravel(), share - 1)[share - 1]
    peak = PEAK * problem.reduced_modulus * float(row["slope"])
    pressure = np.where(contact, peak * random.uniform(0.3, 1.0, contact.shape), 0.0)
    u = referee.displacement(problem, pressure)
    level = float(u[contact].max())
    gap = level - u + np.where(contact, 0.0, MARGIN * float(np.ptp(u)) + float(u.max()) - level)
    touch = level - float(gap.min())
    gap -= gap.min()
    if problem.load is not None:
        return replace(problem, gap=gap, load=float(pressure.sum()) * problem.element_area)
    approach = touch - (float(gap.mean()) if problem.periodic else 0.0)
    return replace(problem, gap=gap, approach=approach)
