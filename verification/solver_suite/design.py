"""Problems of covering designs, judged by the residual of `reference_solution`: no answer is needed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from refimpl.grid import Array
from verification.solver_suite import reference_solution
from verification.solver_suite.covering import stored
from verification.solver_suite.dimensions import (
    BEYOND,
    CHANGED,
    DEPTHS,
    DESIGNS,
    FURTHER,
    MARGIN,
    PEAK,
    PRESSURES,
    SHARES,
    Design,
)
from verification.solver_suite.gaps import waves
from verification.solver_suite.protocol import ContactProblem, Coupling

Row = Mapping[str, Any]
HEIGHT = 0.05
"""Heights over the side times the slope."""
FARTHER = 40
"""Elements that a memory's other size has more."""


@cache
def rows() -> dict[str, tuple[dict[str, Any], ...]]:
    """Return the rows of the designs, by name; small grids first within each."""
    return _rows_of(DESIGNS, _own_sizes())


@cache
def further_rows() -> dict[str, tuple[dict[str, Any], ...]]:
    """Return the rows of the further designs that ``--thorough`` poses."""
    return _rows_of(FURTHER, _own_sizes()[len(rows()["memory"]) :])


def seed_of(design: str, number: int) -> int:
    """Return the seed of the surface of a design's problem; those of further designs have others.

    >>> seed_of("plain", 7), seed_of("plain-2", 7)
    (7, 2007)
    """
    array = design.rpartition("-")[2]
    return number + (1000 * int(array) if array.isdigit() else 0)


def _rows_of(designs: Mapping[str, Design], sizes: Sequence[int]) -> dict[str, tuple[dict[str, Any], ...]]:
    """Return the rows by name; each problem of a memory has the next one of the sizes."""
    made, next_size = {}, iter(sizes)
    for name, design in designs.items():
        found = [{**design.fixed, **row} for row in stored(name, design)]
        if name == "tiny":
            found = [_bounded(row) for row in found]
        if "changed" in design.dimensions:
            found = [row | {"elements": next(next_size)} for row in found]
        made[name] = tuple(sorted(found, key=lambda row: int(row["elements"])))
    return made


def _bounded(row: dict[str, Any]) -> dict[str, Any]:
    """Return no approach: a flat periodic gap has none, its pressures are given by the load alone."""
    flat = row["surface"] == "flat" or row["elements"] == 1
    return row | {"control": "load"} if flat and row["borders"] == "periodic" else row


def _own_sizes() -> list[int]:
    taken = {n for design in DESIGNS.values() for n in design.dimensions.get("elements", ())}
    return [n for n in range(10, 200) if n not in taken]


def shape_of(row: Row) -> tuple[int, int]:
    """Return the elements along x and y of the problem of a row."""
    n = int(row["elements"])
    across = {"wide": (n, max(3, n // 2)), "deep": (max(3, n // 2), n), "both": (n, max(3, 2 * n // 3))}
    return (across | {"row": (n, 1)}).get(row.get("shape", ""), (n, n))


def posed(row: Row, seed: int, tolerance: float) -> ContactProblem:
    """Return the problem of a row; ``seed`` draws its surface and the direction within its sector."""
    random, n = np.random.default_rng([45, seed]), int(row["elements"])
    nx, ny = shape_of(row)
    oblong = row.get("shape") in ("both", "oblong elements")
    dx, dy = float(row["edge"]), float(row["edge"]) * (1.6 if oblong else 1.0)
    side, E, g = n * dx, float(row["modulus"]), float(row["slope"])
    heights = _heights(row, seed, random)
    gap = HEIGHT * g * side * (heights.max() - heights)
    periodic, mean = row["borders"] == "periodic", float(gap.mean())
    pressure = PRESSURES[row["contact"]] * E * g
    load = approach = None
    if row["control"] == "load":
        load = pressure * nx * dx * ny * dy
    elif periodic:
        approach = (DEPTHS[row["contact"]] - 1) * mean
    elif row["contact"] == "full":
        approach = BEYOND * float(gap.max())
    else:
        approach = DEPTHS[row["contact"]] * (mean or HEIGHT * g * side)
    coupling = None
    if row.get("beta") or row.get("tau"):
        direction = (row["sector"] + random.uniform(0.15, 0.85)) * np.pi / 4
        compliance = row["coupling"] / (np.pi * E)
        coupling = Coupling(row["tau"] * PEAK * E * g, row["beta"], compliance, float(direction))
    dy_ = None if dx == dy else dy
    hardness = row["cap"] * pressure if "cap" in row else None
    found = ContactProblem(
        gap - gap.min(), dx, E, load, approach, periodic, tolerance, coupling, dy_, hardness
    )
    return manufactured(found, row, random) if row.get("tau") else found


def _heights(row: Row, seed: int, random: np.random.Generator) -> Array:
    n, (nx, ny) = int(row["elements"]), shape_of(row)
    if row["surface"] == "flat":
        return np.zeros((nx, ny))
    if row["surface"] == "smooth":
        return waves(n, seed, shortest=3)[:nx, :ny]
    return np.asarray(random.standard_normal((nx, ny)) * min(1.0, 8 / n))


def in_turn(row: Row) -> tuple[Row, ...]:
    """Return the rows that are posed in turn: of a memory the row, the changed one, and the row again."""
    if "changed" not in row:
        return (row,)
    # the modulus is changed at the same c0, the coupling at the same modulus
    others: dict[str, Any] = {
        "edge": {"edge": 3 * row["edge"]},
        "modulus": {"modulus": row["modulus"] / 3, "coupling": row["coupling"] / 3},
        "borders": {"borders": "free" if row["borders"] == "periodic" else "periodic"},
        "control": {"control": "load" if row["control"] == "approach" else "approach"},
        "load": {"contact": "most"},
        "surface": {"surface": "harsh"},
        "elements": {"elements": row["elements"] + FARTHER},
        "edges": {"shape": "oblong elements"},
        "sector": {"sector": (row["sector"] + 5) % 8},
        "beta": {"beta": 2.2 * row["beta"]},
        "tau": {"tau": 0.0 if row["tau"] else 0.1},
        "coupling": {"coupling": -0.7 * row["coupling"]},
    }
    assert set(others) == set(CHANGED)
    return row, {**row, **others[row["changed"]]}, row


def manufactured(problem: ContactProblem, row: Row, random: np.random.Generator) -> ContactProblem:
    """Return the problem over a gap that chosen pressures close: with tau another gap may have no solution.

    The lowest elements of the gap touch, with pressures from 0.3 of the peak up; the others are well apart.
    """
    most = 0.9 if problem.periodic and problem.load is None else 1.0  # at full contact the mean is free
    share = max(1, round(min(most, SHARES[row["contact"]]) * problem.gap.size))
    contact = problem.gap <= np.partition(problem.gap.ravel(), share - 1)[share - 1]
    peak = PEAK * problem.reduced_modulus * float(row["slope"])
    pressure = np.where(contact, peak * random.uniform(0.3, 1.0, contact.shape), 0.0)
    u = reference_solution.displacement(problem, pressure)
    level = float(u[contact].max())
    gap = level - u + np.where(contact, 0.0, MARGIN * float(np.ptp(u)) + float(u.max()) - level)
    touch = level - float(gap.min())
    gap -= gap.min()
    if problem.load is not None:
        return replace(problem, gap=gap, load=float(pressure.sum()) * problem.element_area)
    approach = touch - (float(gap.mean()) if problem.periodic else 0.0)
    return replace(problem, gap=gap, approach=approach)
