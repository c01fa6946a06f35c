"""Where tau's support cycles: what a law says that turns tau on with pressure, instead of at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.friction import Mask
from refimpl.operators.fft import Counter
from refimpl.solvers.production.coarse_grids import Start
from refimpl.solvers.production.level import LevelSolver
from refimpl.solvers.production.nested_solver import begun
from verification.coverage.scenes import random_scene
from verification.framework.case import Measured
from verification.framework.registry import case

SCENES = range(2000, 2200)
AT_64 = (2015, 2031, 2047, 2054, 2118, 2121, 2134, 2164)
"""Those of the eleven scenes that cycle at 64 x 64 whose bars are the longest."""
APART = 2071
"""The scene whose cycle's own states, at 128 x 128, are too close to each other to be its bar."""
ONSET = 1e-4
"""Of f_max: the pressure at which all of tau is on. A tenth of it moves mu of single elements by up to 0.3
bars, and none beyond its bar."""
UPDATES = 60  # of the shares
TOLERANCE = 1e-9
SOURCE = "Eq. (8); its jump is the limit of such laws"
CLAIM = (
    "if tau comes on between no pressure and a ten-thousandth of f_max, no support cycles and no element is "
    "withheld: mu is that of our rule within the bar that it gives to tau's support"
)
REASON = (
    "the bar itself. It holds all of tau on the contacts from which it is withheld; laws without a jump "
    "leave them a share of it"
)


def in_shares(solution: rf.Solution) -> tuple[float, float]:
    """mu where elements bear ``tau min(1, f / (ONSET f_max))``, and how much it still moves.

    Shares of tau go towards those that their pressures ask for, each by a length of its own: half as far
    where it turned, a little further where it did not. The mean and the standard deviation of the last half.
    """
    solver = _solver(solution)
    onset = ONSET * solution.max_pressure
    share: Array = ((solution.pressure > 0) & ~solution.withheld)[solver.window.slices].astype(float)
    length, last = np.full(share.shape, 0.5), np.zeros(share.shape)
    found = []
    for _ in range(UPDATES):
        if not solver.settle(TOLERANCE, cast(Mask, share)):
            raise RuntimeError(f"residual {solver.residual:.1e} with shares of tau held")
        found.append(solver.visited().friction_coefficient)
        change = np.clip(solver.cg.pressure / onset, 0.0, 1.0) - share
        length = np.where(change * last < 0, 0.5 * length, np.minimum(1.1 * length, 1.0))
        share, last = share + length * change, change
    late = found[UPDATES // 2 :]
    return float(np.mean(late)), float(np.std(late))


def _solver(solution: rf.Solution) -> LevelSolver:
    """The production solver's CG on the solution's own grid, from the solution."""
    displacement = solution.clearance + solution.approach - solution.problem.gap
    return begun(solution.problem, Start(solution.pressure, displacement, None), Counter())


def apart(scenes: Sequence[tuple[int, int]], least: int) -> Measured:
    """The largest difference of mu over the bar that tau's support has, of the scenes that cycle.

    Scenes are told by their seed and elements per side. Raises RuntimeError where fewer than ``least`` do.
    """
    found: dict[str, list[float]] = {
        "scene": [], "elements per side": [], "withheld": [],
        "mu": [], "mu in shares": [], "moves by": [], "bar": [],
    }  # fmt: skip
    for seed, M in scenes:
        solution = rf.solve(random_scene(seed).scene, M, tolerance=TOLERANCE)
        if solution.status is not rf.Status.CYCLED:
            continue
        numbers = (
            float(seed),
            float(M),
            float(solution.withheld.sum()),
            solution.friction_coefficient,
            *in_shares(solution),
            solution.uncertainty["friction_coefficient"]["tau support"],
        )
        for column, number in zip(found.values(), numbers, strict=True):
            column.append(number)
    if len(found["scene"]) < least:
        raise RuntimeError(f"{len(found['scene'])} of {len(scenes)} scenes cycle: too few to judge by")
    off = np.abs(np.subtract(found["mu in shares"], found["mu"])) + found["moves by"]
    names = [f"{s:.0f}: {n:.0f} withheld" for s, n in zip(found["scene"], found["withheld"], strict=True)]
    shares = dict(zip(names, (off / found["bar"]).tolist(), strict=True))
    return Measured(
        max(shares.values()),
        data={**found, "difference / bar": shares},
        note=f"{len(shares)} scenes that cycle, of {len(scenes)}",
    )


@case(
    "accuracy/tau-shares",
    title="Where tau's support cycles: mu of a law without a jump, nine scenes",
    claim=CLAIM,
    source=SOURCE,
    metric="at_most",
    tolerance=1.0,
    tolerance_reason=REASON,
    tags=("tau", "uncertainty"),
)
def nine_scenes() -> Measured:
    scenes = [*((seed, 64) for seed in AT_64), (APART, 128)]
    return apart(scenes, least=len(scenes))


@case(
    "accuracy/tau-shares-128",
    title="Where tau's support cycles at 128 x 128: mu of a law without a jump",
    claim=CLAIM,
    source=SOURCE,
    metric="at_most",
    tolerance=1.0,
    tolerance_reason=REASON,
    tier="full",
    tags=("tau", "uncertainty"),
)
def bars_at_128() -> Measured:
    return apart([(seed, 128) for seed in SCENES], least=20)  # of a bar of 95 % one in twenty may miss
