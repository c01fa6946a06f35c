"""Table 2 again: processor time of the paper's scheme, the production solver and the general minimisers.

Every method solves the same contact at the approach that the load requires; the paper's scheme and the
production solver are also timed under the load, approach and all, which is what their users wait for. Methods
take turns (A B C A B C), so that a slow spell of the machine meets all of them. A time comes with the
pressure's distance from a state certified to 1e-12: a fast wrong answer would show.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import TypeVar

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.framework.files import Progress
from verification.variational.energy import Energy, certified, frictionless, table2_scene
from verification.variational.minimisers import MINIMISERS, Minimum

Result = TypeVar("Result")

PAPER_GRIDS = (100, 128, 256, 512)
SMALLER_GRIDS = (48, 64, 80)  # for the growth of what does not get far
UNDER_LOAD = ("paper, load", "production, load")
AT_APPROACH = ("paper", "production")
_SHORTEST = 0.2  # s of processor time; what takes less is repeated and averaged
_LONG = 20.0  # s; what takes longer has one round, so that the whole table takes minutes
_CUBIC, _QUASILINEAR = 3.3, 1.3  # growth in unknowns expected before it is measured, to keep to the budget

PRINTED = {
    "M": [100, 128, 256, 512],
    "initial points": {"paper": [9801, 14697, 59171, 23715], "variational": [9717, None, 65310, None]},
    "final points": {"paper": [1821, 4371, 17383, 68951], "variational": [1711, None, 16517, None]},
    "hours": {"paper": [0.07, 0.42, 7.21, 50.4], "variational": [1.0, None, 96.0, None]},
}
"""Table 2 as printed; days as hours. [37], the variational column, is Tian and Bhushan 1996."""


@dataclass(frozen=True)
class Row:
    """One method on one grid: points before and after, seconds per solve by round, how well, how much work.

    ``pressure_error`` is the largest difference from the reference over its peak; ``gap`` the certificate's.
    """

    method: str
    M: int
    initial: int
    final: int
    pressure_error: float
    gap: float
    operations: Mapping[str, float]
    cpu: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)

    @property
    def seconds(self) -> float:
        """Processor time per solve, the least of the rounds: other work on the machine only adds."""
        return min(self.cpu)


@dataclass(frozen=True, eq=False)
class Contact:
    """The scene on one grid with its certified state, ready for every method."""

    scene: rf.Scene
    M: int
    reference: rf.Solution

    @classmethod
    def of(cls, scene: rf.Scene, M: int) -> Contact:
        """Solve for the reference, which also fills the kernels' tables that all methods share.

        Raises RuntimeError when the reference is not certified to 1e-10.
        """
        reference = rf.solve(scene, grid=M, oblique=False, tolerance=1e-12)
        if not reference.certificate.satisfies(1e-10):
            raise RuntimeError(f"no reference at M = {M}: {reference.certificate}")
        return cls(scene, M, reference)

    def run(self, method: str) -> tuple[Array, dict[str, float]]:
        """Pressure (Pa) and operation counts of a method, from nothing but the scene (and the approach)."""
        if method in MINIMISERS:
            energy = Energy(frictionless(self.scene, self.M, self.reference.approach))
            found: Minimum = MINIMISERS[method](energy)
            return energy.pressure(found.x), dict(found.operations)
        name, _, load = method.partition(", ")
        solution = rf.solve(
            self.scene,
            grid=self.M,
            method="paper" if name == "paper" else "fft",
            oblique=False,
            approach=None if load else self.reference.approach,
        )
        counts = {f"{key} products": value for key, value in solution.cost.applications.items()}
        return solution.pressure, counts | {"n log2 n": solution.cost.point_logs}

    def judged(self, method: str, pressure: Array, operations: Mapping[str, float]) -> Row:
        """The row of a method's answer, without times."""
        problem = frictionless(self.scene, self.M, self.reference.approach)
        peak = float(self.reference.pressure.max())
        return Row(
            method=method,
            M=self.M,
            initial=int(np.count_nonzero(problem.gap < self.reference.approach)),
            final=int(np.count_nonzero(pressure)),
            pressure_error=float(np.abs(pressure - self.reference.pressure).max()) / peak,
            gap=certified(problem, pressure).certificate.gap,
            operations=operations,
        )


def timed(call: Callable[[], Result]) -> tuple[Result, float, float]:
    """Result, processor and wall seconds of a call; the mean of as many as fill a fifth of a second."""
    cpu, wall, calls = time.process_time(), time.perf_counter(), 0
    while calls == 0 or time.process_time() - cpu < _SHORTEST:
        result = call()
        calls += 1
    return result, (time.process_time() - cpu) / calls, (time.perf_counter() - wall) / calls


def measure(grids: Sequence[int], methods: Sequence[str], rounds: int, budget: float) -> list[Row]:
    """Rows of all methods on all grids (ascending), as far as each gets.

    A grid is left out when the method's last time, grown to it, exceeds ``budget`` (processor s a solve).
    """
    scene = table2_scene()
    rows: list[Row] = []
    last: dict[str, Row] = {}
    progress = Progress(len(grids))
    for M in grids:
        contact = Contact.of(scene, M)
        feasible = [m for m in methods if m not in last or predicted(last[m], M) <= budget]
        here: dict[str, Row] = {}
        for _ in range(rounds):
            for method in feasible:
                if method in here and here[method].seconds > _LONG:
                    continue
                answer, cpu, wall = timed(partial(contact.run, method))
                row = here.setdefault(method, contact.judged(method, *answer))
                row.cpu.append(cpu)
                row.wall.append(wall)
        rows += here.values()
        last |= here
        progress.tick(f"{M} x {M}")
    progress.close()
    return rows


def predicted(row: Row, M: int) -> float:
    """Seconds a method will take on ``M x M`` elements, from a row of a smaller grid."""
    matrix = "flops at least" in row.operations
    exponent = _CUBIC if matrix else _QUASILINEAR
    return float(row.seconds * (M / row.M) ** (2 * exponent))


def growth(M: Sequence[int], cost: Sequence[float]) -> float:
    """Exponent of a cost in the number of elements ``M^2``, fitted to all grids.

    >>> round(growth([10, 20, 40], [3.0, 48.0, 768.0]), 12)
    2.0
    """
    return float(np.polyfit(2 * np.log(M), np.log(cost), 1)[0])


def table(rows: Sequence[Row]) -> dict[str, object]:
    """Rows, growth exponents (from 64 x 64 on), and ratios of processor time to the paper's scheme."""
    by_method: dict[str, list[Row]] = {}
    for row in rows:
        by_method.setdefault(row.method, []).append(row)
    paper = {row.M: row.seconds for row in by_method["paper"]}
    return {
        "rows": [asdict(row) for row in rows],
        "growth": {
            name: growth([r.M for r in run], [r.seconds for r in run])
            for name, run in ((name, [r for r in run if r.M >= 64]) for name, run in by_method.items())
            if len(run) >= 3
        },
        "ratio to paper": {
            name: {str(r.M): r.seconds / paper[r.M] for r in run} for name, run in by_method.items()
        },
        "printed": PRINTED | {"growth": printed_growth()},
    }


def printed_growth() -> dict[str, float]:
    """Growth exponents of Table 2's own hours in its number of elements."""
    hours = PRINTED["hours"]
    assert isinstance(hours, dict)
    exponents = {}
    for name, column in hours.items():
        pairs = [(M, h) for M, h in zip(PAPER_GRIDS, column, strict=True) if h is not None]
        exponents[name] = growth([M for M, _ in pairs], [h for _, h in pairs])
    return exponents
