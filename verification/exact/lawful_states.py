"""Lawful states counted by brute force: every contact set of a tiny grid is tried, without a contact solver.

A contact set S is lawful when the pressure that solves the linear equations on it, with tau acting on S and
nowhere else, is positive on S and leaves no penetration outside. Slopes are neglected. With tau = 0 there is
exactly one (`verification.stress_tests.positive_definite`); with tau there may be none, one or several.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import refimpl as rf
from refimpl.grid import Array
from refimpl.planning.plan import Method
from verification.exact.textbook import normal_matrix, shear_matrix
from verification.scenes.cross_checks import POLYMER, STEEL

SOLVERS: tuple[Method, ...] = ("fft", "dense")
M = 3
TAUS = (0.0, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
"""Over the mean pressure."""
SCENES = 40
MEAN_PRESSURE = 2e6
SIDE = 1e-3


class Count(NamedTuple):
    """At one tau: how many scenes have no, one, several lawful states, and what the solvers said of each."""

    tau: float
    none: int
    one: int
    several: int
    most: int
    statuses: dict[str, dict[str, int]]
    wrong: int


def scene(seed: int, tau: float, *, soft_below: bool = True) -> rf.Scene:
    """Return a flat on random heights, tau over the mean pressure given."""
    rng = np.random.default_rng(seed)
    z = 10.0 ** rng.uniform(-8, -6) * rng.standard_normal((M, M))
    upper, lower = (STEEL, POLYMER) if soft_below else (POLYMER, STEEL)
    return rf.Scene(
        upper=rf.Body(upper, rf.Flat()),
        lower=rf.Body(lower, z),
        friction=rf.Friction(tau * MEAN_PRESSURE, 0.1),
        load=MEAN_PRESSURE * SIDE**2,
        side=SIDE,
        sliding_direction=float(rng.uniform(0, 2 * np.pi)),
    )


def lawful_states(scene: rf.Scene) -> list[NDArray[np.bool_]]:
    """Return all lawful contact sets, each as ``(M, M)``."""
    grid, pair = scene.grid(M), scene.materials
    a = pair.normal_compliance * normal_matrix(grid)
    c = pair.shear_compliance * shear_matrix(grid, scene.sliding_direction)
    lower, upper = scene.heights(grid)
    h = (upper - lower - (upper - lower).min()).ravel()
    target = scene.load / grid.element_area
    found = []
    for code in range(1, 2 ** (M * M)):
        inside = np.array([bool(code >> k & 1) for k in range(M * M)])
        if _is_lawful(a + scene.friction.beta * c, scene.friction.tau * (c @ inside), h, target, inside):
            found.append(inside.reshape(M, M))
    return found


def _is_lawful(G: Array, shear: Array, h: Array, target: float, inside: NDArray[np.bool_]) -> bool:
    """Return whether the bordered equations on a set give pressures and gaps of the right sign."""
    index = np.flatnonzero(inside)
    n = len(index)
    bordered = np.zeros((n + 1, n + 1))
    scale = np.abs(G).max()
    bordered[:n, :n], bordered[:n, n], bordered[n, :n] = G[np.ix_(index, index)] / scale, -1.0, 1.0
    solved = np.linalg.solve(bordered, np.append(-(h + shear)[index], target * scale))
    f, approach = solved[:n] / scale, solved[n]
    gap = G[:, index] @ f + shear + h - approach
    return bool(f.min() > 0 and gap[~inside].min(initial=0.0) >= -1e-12 * abs(approach))


def count(tau: float, scenes: int = SCENES) -> Count:
    """Count the lawful states of seeded scenes at one tau, and whether the solvers' good states are among
    them."""
    numbers, wrong = list[int](), 0
    statuses: dict[str, dict[str, int]] = {method: {} for method in SOLVERS}
    for seed in range(scenes):
        this = scene(seed, tau, soft_below=seed % 2 == 0)
        lawful = lawful_states(this)
        numbers.append(len(lawful))
        for method in SOLVERS:
            solution = rf.solve(this, M, method=method, oblique=False, tolerance=1e-10)
            told = solution.status.value
            statuses[method][told] = statuses[method].get(told, 0) + 1
            among = any(np.array_equal(solution.contact, state) for state in lawful)
            wrong += solution.status is rf.Status.CONVERGED and not among
    several = [n for n in numbers if n > 1]
    return Count(tau, numbers.count(0), numbers.count(1), len(several), max(numbers), statuses, wrong)
