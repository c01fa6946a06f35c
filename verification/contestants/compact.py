"""A compact solver with a seam for every fault: constrained conjugate gradients on tables or symbols.

Independent of `refimpl.solvers`, so that a fault in one of its hooks is a fault in an operator,
not in a problem posed otherwise. Method: Polonsky and Keer 1999; displacement by shear lags behind and is
brought up to date.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from verification.contestants.protocol import Abilities, Answer, ContactProblem
from verification.properties.textbook import normal_offsets, shear_offsets

Complex = NDArray[np.complex128]
CLOSER = 0.1
"""Residual that is sought, over that required: a periodic mean is off by more than its energy shows."""
MOST = 2000
"""Most iterations."""
ROUNDS = 120
"""Most updates of the displacement by shear."""


def _unchanged(problem: ContactProblem, item: Any) -> Any:
    return item


@dataclass(frozen=True)
class Hooks:
    """Places for a fault; by default there is none.

    pose : changes the problem before anything is computed
    normal, shear : change the transform of the influence (m/Pa, shape of the padded grid)
    traction : changes the shear traction (Pa)
    pressure : changes the answer (Pa)
    limit : most iterations, from the problem
    key : identity of the operators that are kept; None computes them anew
    """

    pose: Callable[[ContactProblem, ContactProblem], ContactProblem] = _unchanged
    normal: Callable[[ContactProblem, Complex], Complex] = _unchanged
    shear: Callable[[ContactProblem, Complex], Complex] = _unchanged
    traction: Callable[[ContactProblem, Array], Array] = _unchanged
    pressure: Callable[[ContactProblem, Array], Array] = _unchanged
    limit: Callable[[ContactProblem, int], int] = _unchanged
    key: Callable[[ContactProblem], Hashable] | None = None


def transforms(problem: ContactProblem) -> tuple[Complex, Complex]:
    """Transforms of displacement by unit pressure and by unit shear along the sliding direction (m/Pa)."""
    E, edges, coupling = problem.reduced_modulus, problem.spacings, problem.coupling
    c0, direction = (coupling.shear_compliance, coupling.sliding_direction) if coupling else (0.0, 0.0)
    if problem.periodic:
        freq = [2 * np.pi * np.fft.fftfreq(n, d) for n, d in zip(problem.shape, edges, strict=True)]
        qx, qy = freq[0][:, None], freq[1][None, :]
        q = np.hypot(qx, qy)
        q[0, 0] = np.inf
        odd = [np.where(np.arange(n) * 2 == n, 0.0, f) for n, f in zip(problem.shape, freq, strict=True)]
        along = np.cos(direction) * odd[0][:, None] + np.sin(direction) * odd[1][None, :]
        return (2 / (E * q)).astype(complex), -2j * np.pi * c0 * along / q**2
    unit = 1.0, edges[1] / edges[0]
    size = [2 * n for n in problem.shape]
    tables = [edges[0] / (np.pi * E) * normal_offsets(problem.shape, unit)]
    tables.append(edges[0] * c0 * shear_offsets(problem.shape, direction, unit) if c0 else 0 * tables[0])
    circles = []
    for table in tables:
        circle = np.zeros(size)
        circle[: table.shape[0], : table.shape[1]] = table
        shifts = tuple(1 - n for n in problem.shape)
        circles.append(np.fft.fft2(np.roll(circle, shifts, axis=(0, 1))))
    return circles[0], circles[1]


class Solved(NamedTuple):
    """Pressures (Pa), whether the residual was reached, and the iterations."""

    pressure: Array
    converged: bool
    iterations: int


def shear_traction(problem: ContactProblem, f: Array) -> Array:
    """Shear traction (Pa) of pressures: ``tau [f > 0] + beta f``."""
    c = problem.coupling
    return np.zeros_like(f) if c is None else c.tau * (f > 0) + c.beta * f


def _same(one: ContactProblem, other: ContactProblem) -> bool:
    mine, theirs = vars(one), vars(other)
    return one is other or all(np.array_equal(mine[name], theirs[name]) for name in mine)


@dataclass
class Compact:
    """The solver; without hooks it is right, with them it claims success whatever it found."""

    hooks: Hooks = field(default_factory=Hooks)
    sure: bool = False
    abilities: Abilities = field(
        default_factory=lambda: Abilities(coupling=True, rectangle=True, oblong_elements=True)
    )

    def __post_init__(self) -> None:
        self._kept: dict[Hashable, tuple[Complex, Complex]] = {}

    def __call__(self, problem: ContactProblem) -> Answer:
        """Return the pressures (Pa), claimed to be right where ``sure`` or where the residual is reached."""
        found = self.solved(problem)
        return Answer(found.pressure, self.sure or found.converged)

    def solved(self, problem: ContactProblem) -> Solved:
        """Return the pressures (Pa) with how the iteration ended."""
        posed = self.hooks.pose(problem, problem)
        normal, shear = self.operators(posed)

        def apply(hat: Complex, field_: Array) -> Array:
            return np.asarray(np.fft.ifft2(hat * np.fft.fft2(field_, hat.shape)).real)[
                : len(field_), : field_.shape[1]
            ]

        limit = self.hooks.limit(posed, MOST)
        f, moved, left, ok = _start(posed), np.zeros(posed.shape), limit, False
        for _ in range(ROUNDS if posed.coupling is not None else 1):
            f, used, ok = _frictionless(posed, lambda p: apply(normal, p), posed.gap + moved, f, left)
            left -= used
            if posed.coupling is None or left <= 0:
                break
            change = apply(shear, self.hooks.traction(posed, shear_traction(posed, f))) - moved
            moved = moved + _relaxation(posed) * change
            if _settled(f, change, apply(normal, f), CLOSER * posed.tolerance):
                break
        else:
            ok = posed.coupling is None and ok
        return Solved(self.hooks.pressure(problem, f), ok, limit - left)

    def changes_nothing(self, problem: ContactProblem, right: Solved) -> bool:
        """Return whether no hook changes anything of a problem with this solution, nor then the answer.

        Operators that are kept are made, as they would be by the solution.
        """
        posed = self.hooks.pose(problem, problem)
        made, f = self.operators(posed), right.pressure
        if not _same(posed, problem) or self.hooks.limit(problem, MOST) < right.iterations:
            return False
        shear = shear_traction(problem, f)
        return (
            all(np.array_equal(one, other) for one, other in zip(made, transforms(problem), strict=True))
            and np.array_equal(self.hooks.pressure(problem, f), f)
            and (problem.coupling is None or np.array_equal(self.hooks.traction(problem, shear), shear))
        )

    def operators(self, problem: ContactProblem) -> tuple[Complex, Complex]:
        """Return both transforms, kept ones where there is a key."""
        key = self.hooks.key(problem) if self.hooks.key else None
        if key is None or key not in self._kept:
            normal, shear = transforms(problem)
            made = self.hooks.normal(problem, normal), self.hooks.shear(problem, shear)
            if key is None:
                return made
            self._kept[key] = made
        kept = self._kept[key]
        right = problem.shape if problem.periodic else tuple(2 * n for n in problem.shape)
        return kept if kept[0].shape == right else transforms(problem)


def _relaxation(problem: ContactProblem) -> float:
    """Share of a change of the displacement by shear that is taken.

    On one contact set the changes are multiplied by ``i m`` with ``m <= beta pi |c0| E*``, since c is skew;
    with the share w by ``1 - w + i w m``, least for ``w = 1 / (1 + m^2)``.
    """
    c = problem.coupling
    slip = 0.0 if c is None else c.beta * np.pi * c.shear_compliance * problem.reduced_modulus
    return 1 / (1 + slip**2)


def _settled(f: Array, change: Array, u: Array, tolerance: float) -> bool:
    """Whether the last change of the displacement by shear does no work that counts."""
    moved = float(np.abs(change - np.average(change, weights=f)).max() * f.sum()) if f.sum() > 0 else 0.0
    return moved <= tolerance * float(np.vdot(f, u)) / 2


def _start(problem: ContactProblem) -> Array:
    if problem.load is not None:
        return np.full(problem.shape, problem.load / problem.area)
    over = np.maximum(0.0, (problem.approach_from_touch or 0.0) - problem.gap)
    return over * problem.reduced_modulus / sum(problem.lengths)


def _frictionless(
    problem: ContactProblem, displaced: Callable[[Array], Array], gap: Array, f: Array, limit: int
) -> tuple[Array, int, bool]:
    """Pressures over a gap from a guess; how many displacements that took, and whether they met."""
    level, total = problem.approach_from_touch, (problem.load or 0.0) / problem.element_area
    f, t, delta, old = f.copy(), np.zeros(f.shape), 0.0, 1.0
    for step in range(1, max(2, limit)):
        u = displaced(f)
        v, on, energy = u + gap, f > 0, float(np.vdot(f, u)) / 2
        touch = level if level is not None else float(v[on].mean())
        g = v - touch
        least = float(g.min())
        work = abs(float(np.vdot(f, g))) + max(0.0, -least) * float(f.sum())
        if level is not None and not on.any() and least >= 0:
            return f, step, True
        if energy > 0 and work <= CLOSER * problem.tolerance * energy:
            return f, step, True
        square = float(np.vdot(g[on], g[on]))
        t = np.where(on, g + delta * (square / old) * t, 0.0)
        r = displaced(t)
        r = r - (r[on].mean() if level is None and on.any() else 0.0)
        curvature = float(np.vdot(r, t))
        if level is not None and (not on.any() or curvature <= 0):
            alpha = problem.reduced_modulus / sum(problem.lengths)
        elif curvature <= 0:
            return f, step, work <= 1e-12 * max(energy, 1e-300)
        else:
            alpha = float(np.vdot(g, t)) / curvature
        f = np.maximum(np.where(on, f - alpha * t, 0.0), 0.0)
        late = (f == 0) & (g < 0)
        f[late] -= alpha * g[late]
        delta, old = (0.0 if late.any() else 1.0), square or 1.0
        if level is None:
            f *= total / f.sum()
    return f, limit, False


def with_hooks(**hooks: Any) -> Compact:
    """A compact solver with a fault, that claims success."""
    return Compact(replace(Hooks(), **hooks), sure=True)


solve = Compact()
"""The right one."""
