"""The paper's own scheme: section 5 and the flow chart of Fig. 3, step by step.

Three nested iterations. The first finds the contact for an assumed approach, inverting [a] by a
periodic FFT, excluding pressures that are not positive, and removing the periodicity error by
residual correction against the true aperiodic operator. The second adjusts the approach until N
balances P. The third refines the grid, starting from cubic interpolation.

What the paper leaves open is settled like this. The periodic FFT inverts [a] on the whole square,
but displacements are known only in contact; keeping those and taking the displacements outside
from the pressures found so far is one step ``f += B (u - a f)`` on the contact, with ``B`` the
periodic inverse, which is the residual correction as well. As ``B`` restricted to the contact
exceeds the inverse that is sought, full steps may diverge; each step gets its exact length. Elements
excluded too early are taken back when they break inequality (6b). The approach moves by the secant rule.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy

from refimpl.grid import Array, Mask, inner, resampled
from refimpl.model.certificate import State, certify
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.model.state import SolverResult, Status
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.kernel_tables import unit_table
from refimpl.solvers.tau_active_set import ActiveSet, ContactTest, first_set, iterate

PAPER_TOLERANCE = 1e-4  # |(P - N) / P|, section 5
_PRESSURE_SHARE = 0.1  # |df| / |f| may be this share of the load tolerance: 1e-5, section 5
_STEPS, _PASSES, _APPROACHES = 2000, 60, 60
_BUDGET = 20_000  # steps and passes on one grid, of which the shipped scenes take 630 at most (128 x 128)


@dataclass(eq=False)
class Trace:
    """Counts and residuals of the scheme on one grid of a shape; ``coarser`` are the grids before it.

    ``approaches`` counts iteration two, ``passes`` iteration one, and the steps are those within it.
    ``periodicity_before`` and ``periodicity_after`` are the relative residuals ``|u - a f| / |u|`` of
    Eq. (7) on the contact against the true operator, once the periodic iteration has converged and
    once the residual correction has; ``periodic_pressure`` (Pa) is what the former left. All three
    belong to the last approach.
    """

    shape: tuple[int, int]
    approaches: int = 0
    passes: int = 0
    periodic_steps: int = 0
    correction_steps: int = 0
    periodicity_before: float = math.nan
    periodicity_after: float = math.nan
    periodic_pressure: Array | None = None
    coarser: tuple[Trace, ...] = ()


def solve_paper(problem: Problem, tolerance: float, counter: Counter) -> tuple[State, Trace]:
    """Return the certified state and the finest grid's trace, to a tolerance of the load."""
    pressure: Array | None = None
    approach = problem.approach
    traces: list[Trace] = []
    *coarse, finest = _refinements(problem)
    for level in coarse:  # (3) iteration three: from coarse to fine
        scheme = _Scheme(level, tolerance, counter, pressure)
        approach = scheme.balance(approach, first_set(level))
        pressure = _interpolated(scheme.pressure)
        traces.append(scheme.trace)
    scheme = _Scheme(finest, tolerance, counter, pressure, approach)
    scheme.trace.coarser = tuple(traces)
    state = certify(finest, scheme.operator, **vars(scheme.result()))
    return state, scheme.trace


def _refinements(problem: Problem) -> list[Problem]:
    """Return the problem on M/4, M/2 and M elements per side, as far as they divide (128, 256, 512)."""
    levels = [problem]
    while len(levels) < 3 and all(n % 2 == 0 and n >= 32 for n in levels[0].grid.shape):
        n, m = levels[0].grid.shape
        grid = problem.grid.refined((n // 2, m // 2))
        gap, mean_surface = (resampled(z, grid.shape) for z in (levels[0].gap, levels[0].mean_surface))
        levels.insert(0, replace(problem, grid=grid, gap=gap, mean_surface=mean_surface))
    return levels


def _interpolated(coarse: Array) -> Array:
    """Return the cubic interpolation to the twice finer element centres; negative overshoot is cut off."""
    at = ((np.arange(2 * n) + 0.5) / 2 - 0.5 for n in coarse.shape)
    fine: Array = scipy.ndimage.map_coordinates(
        coarse, np.meshgrid(*at, indexing="ij"), order=3, mode="nearest"
    )
    return np.maximum(fine, 0.0)


class _Scheme:
    """Iterations one and two on one grid; a `TauSolver`."""

    stagnated = window_too_small = False  # it has no window, and its budget alone ends it early

    def __init__(
        self,
        problem: Problem,
        tolerance: float,
        counter: Counter,
        pressure: Array | None,
        approach: float | None = None,
    ) -> None:
        self.problem = problem
        self.tolerance = tolerance
        self.trace = Trace(problem.grid.shape)
        self.operator = FFTInfluence(problem.grid, problem.direction, counter=counter)
        self.pressure = np.zeros(problem.gap.shape) if pressure is None else pressure
        self.traction = np.zeros(problem.gap.shape)
        self.slopes = Slopes.flat(problem.gap.shape)
        self._shear = self._clearance = np.zeros(problem.gap.shape)
        self.settled = True
        self._approach = approach
        # (1) [a] by the moving-grid argument: one row of it, translated; here on the FFT's circle
        (n, m), dx = problem.grid.shape, problem.grid.spacings[0]
        circle = [np.minimum(np.arange(count), count - np.arange(count)) for count in (n, m)]
        row = unit_table("normal", (1 + n // 2, 1 + m // 2), problem.grid.aspect)[np.ix_(*circle)] * dx
        self._periodic_hat: Array = problem.elasticity.symbol(scipy.fft.rfft2(row).real)

    def result(self) -> SolverResult:
        ended = iterate(self, self.problem, self.tolerance)
        every = (*self.trace.coarser, self.trace)
        counts = {
            "periodic": sum(t.periodic_steps for t in every),
            "correction": sum(t.correction_steps for t in every),
            "passes": sum(t.passes for t in every),
            "approaches": sum(t.approaches for t in every),
        }
        return SolverResult(
            pressure=self.pressure,
            traction=self.traction,
            slopes=self.slopes,
            status=ended.status() if self.settled else Status.ITERATION_LIMIT,
            excluded=ended.excluded,
            iterations=counts | {"active sets": ended.solves},
        )

    @property
    def exhausted(self) -> bool:
        """True if more was done on this grid than any state that settles takes: limits of loops multiply."""
        trace = self.trace
        return trace.periodic_steps + trace.correction_steps + trace.passes >= _BUDGET

    @property
    def contact(self) -> Mask:
        return self.pressure > 0

    def copy(self) -> _Scheme:
        return copy(self)

    def restore(self, copied: _Scheme) -> None:
        """Go back to a copy; the trace goes on."""
        vars(self).update(vars(copied))

    def solve(self, tolerance: float, active: ActiveSet, enough: ContactTest | None = None) -> bool:
        self._approach = self.balance(self._approach, active)
        self.traction = active.traction(self.problem.friction, self.pressure, self._last_clearance)
        return self.settled

    def balance(self, approach: float | None, active: ActiveSet) -> float:
        """Find the approach (m) at which N = P, by secants within a bracket: iteration two, (2)."""
        if self.problem.approach is not None:
            self.normal_force(self.problem.approach, active)
            return self.problem.approach
        assert self.problem.load is not None
        load = self.problem.load
        approach = approach or 0.05 * float(self.problem.gap.max()) or self.problem.grid.element_size
        low, high, last = 0.0, math.inf, None
        for _ in range(_APPROACHES):
            if self.exhausted:
                break
            normal = self.normal_force(approach, active)
            if abs(load - normal) <= self.tolerance * load:
                return approach
            low, high = (approach, high) if normal < load else (low, approach)
            step = approach * max(0.25, min(4.0, (load / max(normal, 1e-12 * load)) ** (2 / 3)))
            if last is not None and normal != last[1]:
                step = approach + (load - normal) * (approach - last[0]) / (normal - last[1])
            if not low < step < high:
                step = 0.5 * (low + high) if math.isfinite(high) else 2 * approach
            last, approach = (approach, normal), step
        self.settled = False
        return approach

    def normal_force(self, approach: float, active: ActiveSet) -> float:
        """Find the contact at an assumed approach, and return N of Eq. (2): iteration one, (1)."""
        self.trace.approaches += 1
        self.settled, problem = True, self.problem  # independent of the approaches before
        inside: Mask = problem.gap < approach  # (1a) contact lies within kinematic interference
        if self.pressure.any():
            inside &= self.pressure > 0
        before = self.pressure
        for first in (True, *(_PASSES - 1) * (False,)):
            self.trace.passes += 1
            shear, held = self._update(approach, active)
            u = self.slopes.cosine_product * (approach - problem.gap) - shear  # Eqs (6a), (7)
            if first:  # later passes only mend: the periodic contact would throw returned elements out again
                inside = self._iterate(u, inside, on_circle=True)
                self.trace.periodicity_before = self._residual(u, inside)
                self.trace.periodic_pressure = self.pressure
            inside = self._iterate(u, inside, on_circle=False)
            self.trace.periodicity_after = self._residual(u, inside)
            # (1d) inequality (6b): what penetrates comes back
            returning = ~inside & (self._apply(self.pressure) < u)
            inside = inside | returning
            change = float(np.abs(self.pressure - before).max()) / max(float(self.pressure.max()), 1e-300)
            before = self.pressure
            done = not returning.any() and change <= _PRESSURE_SHARE * self.tolerance
            if done or self.exhausted:
                self.settled &= done
                break
        else:
            self.settled = False
        weights, offset = problem.load_weights(self.slopes, held)
        return inner(weights, self.pressure) * problem.grid.element_area - offset

    def _update(self, approach: float, active: ActiveSet) -> tuple[Array, Array]:
        """Update the slopes; return all displacements but ``a f`` (m), and the shear offset (Pa)."""
        law, normal = self.problem.friction, self._apply(self.pressure)
        v = self.slopes.per_cosine_product(normal + self._shear) + self.problem.gap
        self._clearance = v - approach
        traction = active.traction(law, self.pressure, self._last_clearance)
        lower, upper = self.problem.displacements(self.operator, self.pressure, traction, self.slopes)
        self.slopes = self.problem.slopes(lower, upper)
        self._shear = lower + upper - normal
        return self._shear, active.shear_offset(law, self.pressure, self._last_clearance)

    def _last_clearance(self) -> Array:
        return self._clearance

    def _iterate(self, u: Array, inside: Mask, *, on_circle: bool) -> Mask:
        """Run (1b) periodic inversion or (1c) residual correction, with (1b') exclusion."""
        flexibility = partial(self._on_circle, np.multiply) if on_circle else self._apply
        pressure = self.pressure * inside
        answer = flexibility(pressure)
        for _ in range(_STEPS):
            residual = (u - answer) * inside
            step = self._on_circle(np.divide, residual) * inside
            moved = flexibility(step)
            curvature = inner(step, moved)
            if curvature <= 0:
                break
            length = inner(step, residual) / curvature
            found = pressure + length * step
            excluded = inside & (found <= 0)
            inside = inside & ~excluded
            found *= inside
            answer = flexibility(found) if excluded.any() else answer + length * moved
            change = float(np.linalg.norm(found - pressure))
            pressure = found
            self.trace.periodic_steps += on_circle
            self.trace.correction_steps += not on_circle
            done = change <= _PRESSURE_SHARE * self.tolerance * float(np.linalg.norm(found))
            if done or self.exhausted:
                self.settled &= done
                break
        else:
            self.settled = False
        self.pressure = pressure
        return inside

    def _residual(self, u: Array, inside: Mask) -> float:
        norm = float(np.linalg.norm(u * inside))
        return float(np.linalg.norm((u - self._apply(self.pressure)) * inside)) / norm if norm > 0 else 0.0

    def _apply(self, pressure: Array) -> Array:
        return self.problem.elasticity.normal(self.operator, pressure)

    def _on_circle(self, by: np.ufunc, values: Array) -> Array:
        """Return the periodic product (`np.multiply`) or its inverse (`np.divide`)."""
        self.operator.counter.add("periodic", values.size)
        return np.asarray(scipy.fft.irfft2(by(scipy.fft.rfft2(values), self._periodic_hat), s=values.shape))
