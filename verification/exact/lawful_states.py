"""Lawful states by brute force or integer programming: over all contact sets, without a contact solver.

A contact set S is lawful when the pressure that solves the linear equations on it, with tau acting on S and
nowhere else, is positive on S and leaves no penetration outside; slopes are neglected. With tau = 0 there is
exactly one (`positive_definite`); with tau there may be none, one or several.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, LinearConstraint, milp

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
_INFEASIBLE = 2  # status of `scipy.optimize.milp`


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
    a, c, h, target = _equations(scene, M)
    found = []
    for code in range(1, 2 ** (M * M)):
        inside = np.array([bool(code >> k & 1) for k in range(M * M)])
        if _is_lawful(a + scene.friction.beta * c, scene.friction.tau * (c @ inside), h, target, inside):
            found.append(inside.reshape(M, M))
    return found


def none_is_lawful(scene: rf.Scene, elements: int) -> bool:
    """Return whether integer programming proves that no contact set is lawful; False where it is not decided.

    Shares f of the load on elements, contact s of 0 or 1, and the approach d obey sum f = 1, 0 <= f <= s and
    0 <= G f + tau c s + h - d <= room (1 - s); no gap of a state exceeds twice its largest displacement, the
    room. The program's tolerance of 1e-6 makes its set larger: what it proves empty is empty.
    """
    a, c, h, target = _equations(scene, elements)
    n, G = len(h), (a + scene.friction.beta * c) * target
    length = np.abs(G).max()
    G, shear, h = G / length, scene.friction.tau * c / length, h / length
    room = 2 * float((np.abs(G).max(axis=1) + np.abs(shear).sum(axis=1) + h).max())
    one, unit, contact = np.ones((n, 1)), np.eye(n), np.arange(2 * n + 1) // n == 1
    constraints = [
        LinearConstraint(np.hstack([G, shear, -one]), -h, np.inf),
        LinearConstraint(np.hstack([G, shear + room * unit, -one]), -np.inf, room - h),
        LinearConstraint(np.hstack([unit, -unit, 0 * one]), -np.inf, 0.0),
        LinearConstraint(np.arange(2 * n + 1)[None] < n, 1.0, 1.0),
    ]
    least, most = np.zeros(2 * n + 1), np.ones(2 * n + 1)
    least[-1], most[-1] = -room, room
    found = milp(
        np.zeros(2 * n + 1),
        constraints=constraints,
        integrality=contact,
        bounds=Bounds(least, most),
        options={"time_limit": 120.0},
    )
    return bool(found.status == _INFEASIBLE)


def _equations(scene: rf.Scene, elements: int) -> tuple[Array, Array, Array, float]:
    """Return the matrices of a and c, the gap from first contact, and the sum of pressures."""
    grid, pair = scene.grid(elements), scene.materials
    a = pair.normal_compliance * normal_matrix(grid)
    c = pair.shear_compliance * shear_matrix(grid, scene.sliding_direction)
    lower, upper = scene.heights(grid)
    gap = (upper - lower).ravel()
    return a, c, gap - gap.min(), scene.load / grid.element_area


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
    """Count lawful states of seeded scenes at one tau, and whether good states are among them."""
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
