"""Alternating contact edges under tau: mu of a law that turns tau on with pressure, instead of at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.model.forces import friction_coefficient, resultants
from refimpl.operators.influence import window_influence
from refimpl.operators.preconditioner import SpectralPreconditioner, extended
from refimpl.solvers.production.level import LevelSolver
from refimpl.solvers.tau_active_set import FixedSet
from verification.cases import Measured, family
from verification.coverage.scenes import random_scene

NINE = [*((seed, 64) for seed in (2015, 2031, 2047, 2054, 2118, 2121, 2134, 2164)), (2071, 128)]
"""Seed and elements per side. Eight of the eleven scenes that cycle at 64 x 64, with the longest error bars;
states of the last one's cycle are too close to each other to be its error bar."""
ONSET = 1e-4
"""Of p_max: the pressure at which all of tau is on. A tenth of it moves mu of single elements by up to 0.3
error bars, and none beyond its bar."""
UPDATES = 60  # limit of updates of the shares
TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class SharesOfTau:
    """A friction law whose elements each carry their own share of tau: ``r = share tau + beta f``.

    jump, slope : tau (Pa) and beta
    share : 0 to 1, in the grid's shape; it stands for an active set, and does not depend on the pressure
    """

    jump: float
    slope: float
    share: Array
    is_linear = True

    def traction(self, pressure: Array, active: Mask) -> Array:
        """Return ``share tau + beta f`` (Pa)."""
        return self.shear_offset(pressure, active) + self.slope * pressure

    def shear_offset(self, pressure: Array, active: Mask) -> Array:
        """Return ``share tau`` (Pa)."""
        return self.jump * self.share


def in_shares(solution: rf.Solution) -> tuple[float, float]:
    """Return mu where elements carry ``tau min(1, f / (ONSET p_max))``, and how much it still moves.

    Shares of tau approach those that their pressures ask for, each by a step length of its own: half as long
    after a step back, a little longer otherwise. Mean and standard deviation of the last half of the updates.
    """
    solved = _solver(solution)
    onset = ONSET * solution.max_pressure
    pressure, share = solution.pressure, (solution.contact & ~solution.details.excluded).astype(np.float64)
    length, last = np.full(share.shape, 0.5), np.zeros(share.shape)
    found = []
    for _ in range(UPDATES):
        solver = solved(pressure, share)
        pressure = solver.cg.pressure
        found.append(_mu(solver))
        change = np.clip(pressure / onset, 0.0, 1.0) - share
        length = np.where(change * last < 0, 0.5 * length, np.minimum(1.1 * length, 1.0))
        share, last = share + length * change, change
    late = found[UPDATES // 2 :]
    return float(np.mean(late)), float(np.std(late))


def _mu(solver: LevelSolver) -> float:
    """Return the friction coefficient of a solver's present state, Eq. (4)."""
    problem, lagged = solver.problem, solver.lagged
    forces = resultants(solver.cg.pressure, lagged.traction, lagged.slopes, problem.grid.element_area)
    return friction_coefficient(forces.friction, problem.nominal_load(forces.normal))


def _solver(solution: rf.Solution) -> Callable[[Array, Array], LevelSolver]:
    """Return the production solver from a pressure, with shares of tau; RuntimeError if unconverged."""
    problem, tau = solution.details.problem, solution.details.friction.jump
    operator = window_influence(problem.grid, problem.direction)
    spectral = SpectralPreconditioner(operator, problem.elasticity.symbol(operator.symbol))
    precondition = extended(spectral, solution.contact)

    def solved(pressure: Array, share: Array) -> LevelSolver:
        law = SharesOfTau(tau, solution.details.friction.slope, share)
        solver = LevelSolver(replace(problem, friction=law), operator, precondition, pressure)
        if not solver.solve(TOLERANCE, FixedSet(share > 0)):
            raise RuntimeError(f"residual {solver.residual:.1e} with fixed shares of tau")
        return solver

    return solved


@family(
    "scenes, least, tier, title",
    {
        "accuracy/tau-shares": (
            NINE, len(NINE), "quick",
            "Alternating contact edges under tau: mu of a law without a jump, nine scenes"),
        "accuracy/tau-shares-128": (  # one in twenty error bars of 95 % may miss
            [(seed, 128) for seed in range(2000, 2200)], 20, "full",
            "Alternating contact edges under tau at 128 x 128: mu of a law without a jump"),
    },
    metric="at_most", tolerance=1.0,
)  # fmt: skip
def apart(scenes: Sequence[tuple[int, int]], least: int) -> Measured:
    """Return the largest difference of mu over the error bar of tau's active set, of the scenes that cycle.

    Claim: if tau comes on between no pressure and a ten-thousandth of p_max, no active set cycles and no
    element is excluded: mu is that of our rule within the error bar that it gives to tau's active set
    Source: Eq. (8); its jump is the limit of such laws
    Tolerance: the error bar itself. It contains all of tau on the contacts that the rule excludes; laws
    without a jump leave them a share of tau

    The bar is exact where an excluded element carries all of tau and the contact stays the same: the one of
    seed 2015 on 128 does, and is at 0.99997 of its bar; the other 3e-5 is what that tau moves pressures by.
    Scenes are given by seed and elements per side. Raises RuntimeError where fewer than ``least`` cycle.
    """
    shares = {}
    for seed, M in scenes:
        solution = rf.solve(random_scene(seed).scene, M, tolerance=TOLERANCE)
        if solution.status is rf.Status.CYCLED:
            mu, moves_by = in_shares(solution)
            off = abs(mu - solution.friction_coefficient) + moves_by
            bar = solution.uncertainty["friction_coefficient"]["active set"] or 0.0
            shares[f"{seed}: {solution.details.excluded.sum()} excluded"] = off / bar
    note = f"{len(shares)} scenes that cycle, of {len(scenes)}"
    if len(shares) < least:
        raise RuntimeError(f"{note}: too few to judge by")
    return Measured(max(shares.values()), data={"difference / bar": shares}, note=note)
