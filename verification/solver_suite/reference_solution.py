"""Computations by which the suite judges: displacements, residuals, and solutions by elimination.

None of it is shared with the solvers of `refimpl`. A half-space uses dense matrices of the textbook's corner
differences up to `LARGEST` elements a side, beyond convolution; periodic, the symbols of
`verification.exact.fourier`.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array, Grid, Mask
from verification.exact.fourier import symbol_at
from verification.exact.textbook import normal_matrix, normal_offsets, shear_matrix, shear_offsets
from verification.solver_suite.protocol import ContactProblem

LARGEST = 32


_AT_HARDNESS = 1 - 1e-12
"""Share of the hardness from which a pressure counts as at it: units that were changed and back round."""


def at_hardness(problem: ContactProblem) -> float:
    """Return the pressure (Pa) from which an element counts as at the hardness; infinite without one."""
    return np.inf if problem.hardness is None else problem.hardness * _AT_HARDNESS


class Residual(NamedTuple):
    """The three ways in which pressures can miss a problem, relative; see `residual`."""

    gap: float
    balance: float
    tension: float

    @property
    def worst(self) -> float:
        """The largest of them."""
        return max(self)


def is_large(problem: ContactProblem) -> bool:
    """Return True if a problem has too many elements for dense matrices."""
    return problem.gap.size > LARGEST**2


def _matrix(problem: ContactProblem, direction: float | None) -> Array:
    """Return ``I[1/rho]``, or ``I[s/rho^2]`` along a direction, between all elements (m)."""
    if is_large(problem):
        raise ValueError(f"{problem.gap.size} elements are too many for dense matrices")
    return problem.spacing * _unit_matrix(problem.shape, _edges(problem)[1], direction)


@lru_cache(maxsize=4)
def _unit_matrix(shape: tuple[int, int], aspect: float, direction: float | None) -> Array:
    grid = Grid(shape, (float(shape[0]), shape[1] * aspect))
    return normal_matrix(grid) if direction is None else shear_matrix(grid, direction)


def _edges(problem: ContactProblem) -> tuple[float, float]:
    return 1.0, problem.spacings[1] / problem.spacings[0]


def by_pressure(problem: ContactProblem, pressure: Array) -> Array:
    """Return the normal displacement ``a f`` (m) of both bodies by pressure alone."""
    if problem.periodic:
        return _filtered(pressure, symbol_at(*_waves(problem), problem.reduced_modulus))
    compliance = 1 / (np.pi * problem.reduced_modulus)
    if is_large(problem):
        offsets = normal_offsets(problem.shape, _edges(problem))
        return compliance * problem.spacing * _convolved(offsets, pressure)
    return compliance * np.asarray(_matrix(problem, None) @ pressure.ravel()).reshape(pressure.shape)


def _convolved(offsets: Array, field: Array) -> Array:
    return np.asarray(scipy.signal.fftconvolve(offsets, field, mode="valid"))  # a second to import


def displacement(problem: ContactProblem, pressure: Array) -> Array:
    """Return the normal displacement (m) by pressure and by the shear ``tau [f > 0] + beta f``."""
    normal, coupling = by_pressure(problem, pressure), problem.coupling
    if coupling is None:
        return normal
    shear = coupling.tau * (pressure > 0) + coupling.beta * pressure
    c0, direction = coupling.shear_compliance, coupling.sliding_direction
    if problem.periodic:
        E, slip = problem.reduced_modulus, np.pi * c0 * problem.reduced_modulus
        both = symbol_at(*_waves(problem), E, slip, direction)
        return normal + _filtered(shear, both - symbol_at(*_waves(problem), E))
    if is_large(problem):
        offsets = shear_offsets(problem.shape, direction, _edges(problem))
        moved = problem.spacing * _convolved(offsets, shear)
    else:
        moved = np.asarray(_matrix(problem, direction) @ shear.ravel()).reshape(shear.shape)
    return normal + c0 * moved


def symbols(problem: ContactProblem) -> tuple[Array, NDArray[np.complex128]]:
    """Return the symbols of ``a`` and of ``a + beta c`` of a periodic problem (m/Pa)."""
    waves, E, coupling = _waves(problem), problem.reduced_modulus, problem.coupling
    normal = symbol_at(*waves, E)
    if coupling is None:
        return normal.real, normal
    slip = np.pi * coupling.shear_compliance * E * coupling.beta
    return normal.real, symbol_at(*waves, E, slip, coupling.sliding_direction)


def _waves(problem: ContactProblem) -> tuple[Array, Array]:
    x, y = (
        np.asarray(2 * np.pi * np.fft.fftfreq(n, d), dtype=np.float64)
        for n, d in zip(problem.shape, problem.spacings, strict=True)
    )
    return x[:, None], y[None, :]


def _filtered(field: Array, symbol: NDArray[np.complex128]) -> Array:
    return np.asarray(np.fft.ifft2(np.fft.fft2(field) * symbol).real)


def energy(problem: ContactProblem, pressure: Array) -> float:
    """Return the elastic energy ``1/2 sum f (a f) dA`` (J). Raises ValueError beyond doubles."""
    with np.errstate(over="ignore", invalid="ignore"):
        stored = 0.5 * float(np.vdot(pressure, by_pressure(problem, pressure))) * problem.element_area
    if not np.isfinite(stored):
        raise ValueError("the pressures hold more elastic energy than a number can")
    return stored


def stores_no_energy(problem: ContactProblem) -> bool:
    """Return whether a load presses a flat periodic gap: the mean pressure, which deforms nothing."""
    return problem.periodic and problem.load is not None and not problem.gap.any()


def residual(problem: ContactProblem, pressure: Array) -> Residual:
    """Return the residuals of pressures (Pa) in the problem, recomputed from the pressures alone.

    gap : ``sum f (v - level) dA`` over the elastic energy; the level is ``min v`` under a load, else the
        approach, with penetration counted on the whole load; with a hardness that of both bounds
    balance : ``|N - P| / P``, or zero
    tension : largest negative pressure, or excess over the hardness, over the largest positive one

    Raises ValueError for pressures without any elastic energy, or without a finite one.
    """
    stored = energy(problem, pressure)
    v = displacement(problem, pressure) + problem.gap
    if not stored > 0 or not pressure.max() > 0:
        raise ValueError("the pressures hold no elastic energy")
    level, dA = float(v.min()), problem.element_area
    balance = 0.0
    if problem.load is not None:
        balance = abs(float(pressure.sum()) * dA / problem.load - 1)
    approach = problem.approach_from_touch
    if problem.hardness is not None:
        duality = _two_sided_gap(pressure, v, problem.hardness, approach)
    elif approach is None:
        duality = float(np.vdot(pressure, v - level))
    else:
        penetration = max(0.0, approach - level)
        duality = abs(float(np.vdot(pressure, v - approach))) + penetration * float(np.abs(pressure).sum())
    beyond = -float(pressure.min())
    if problem.hardness is not None:
        beyond = max(beyond, float(pressure.max()) - problem.hardness)
    return Residual(duality * dA / stored, balance, max(0.0, beyond) / float(pressure.max()))


def _two_sided_gap(f: Array, v: Array, hardness: float, approach: float | None) -> float:
    """Return ``sum [f (v - d)+ + (H - f)(d - v)+]`` (Pa m), d the approach or f's mean of v.

    It is the most that ``sum (f - g)(v - d)`` reaches for pressures g between the bounds, so at the load of
    the solution it bounds the squared error in the energy norm, whatever d is (see `misfit`).
    """
    at_hardness = f >= hardness * _AT_HARDNESS
    if approach is None:
        between = (f > 0) & ~at_hardness
        if between.any():
            approach = float(np.vdot(f[between], v[between]) / f[between].sum())
        else:
            ends = [v[at_hardness].max(initial=-np.inf), v[~at_hardness].min(initial=np.inf)]
            approach = float(np.mean([end for end in ends if np.isfinite(end)]))
    room = np.where(at_hardness, 0.0, hardness - f)
    return float(np.sum(f * np.maximum(v - approach, 0) + room * np.maximum(approach - v, 0)))


def misfit(problem: ContactProblem, found: Array, exact: Array) -> float:
    """Return ``(f - f*) a (f - f*)`` over ``1/2 f* a f*``: relative error in the energy norm, squared.

    It is at most the relative complementarity gap of ``f``, by the skewness of c for any coupling at fixed
    tau: with ``e = f - f*``, ``e' a e = e' (v - v*) <= f' (v - min v)``. (The periodic mean stores no energy;
    it is the load balance's affair.) Raises ValueError where ``f*`` holds no energy, or no finite one.
    """
    stored = energy(problem, exact)
    if not stored > 0:
        raise ValueError("the pressures to compare with hold no elastic energy")
    return energy(problem, found - exact) / stored


def approach_of(problem: ContactProblem, pressure: Array) -> float:
    """Return the approach (m) as the problem counts it: mean of v over f. ValueError without load."""
    if not pressure.sum() > 0:
        raise ValueError("the pressures carry no load: no approach")
    v = displacement(problem, pressure) + problem.gap
    touch = float(np.vdot(pressure, v) / pressure.sum())
    return touch - (float(problem.gap.mean()) if problem.periodic else 0.0)


def _flexibility(problem: ContactProblem) -> Array:
    """Return displacements (m/Pa) of all elements by all, also with beta. ValueError for tau."""
    c, (n, m) = problem.coupling, problem.shape
    if c is not None and c.tau != 0:
        raise ValueError("elimination is for problems without tau")
    if problem.periodic:
        origin = np.zeros((n, m))
        origin[0, 0] = 1.0
        i, j = (axis.ravel() for axis in np.indices((n, m)))
        response = displacement(problem, origin)
        return np.asarray(response[(i[:, None] - i) % n, (j[:, None] - j) % m])
    normal = _matrix(problem, None) / (np.pi * problem.reduced_modulus)
    if c is None:
        return normal
    return normal + c.beta * c.shear_compliance * _matrix(problem, c.sliding_direction)


def _on(problem: ContactProblem, matrix: Array, contact: Mask) -> tuple[Array, float]:
    """Return pressures (all elements) and approach from first contact on a set, by Gauss' elimination."""
    k, gap = np.flatnonzero(contact), problem.gap.ravel()
    block, approach, f = matrix[np.ix_(k, k)], problem.approach_from_touch, np.zeros(gap.size)
    if approach is not None:
        f[k] = np.linalg.solve(block, approach - gap[k])
        return f, approach
    # unknowns are scaled to one: pressures by the mean one, the approach by what that displaces
    assert problem.load is not None
    mean = problem.load / problem.element_area / len(k)
    length = float(np.abs(block).max()) * mean
    one = np.ones((len(k), 1))
    bordered = np.block([[block * (mean / length), -one], [one.T, np.zeros((1, 1))]])
    solved = np.linalg.solve(bordered, np.append(-gap[k] / length, len(k)))
    f[k] = solved[:-1] * mean
    return f, float(solved[-1]) * length


def eliminated(problem: ContactProblem) -> Array:
    """Return the solution (Pa) by block principal pivoting, for small problems without tau.

    From all elements in contact, or all that overlap, drops those in tension and adds those that penetrate.
    Raises RuntimeError where that does not end within 100 rounds.
    """
    matrix, gap, prescribed = _flexibility(problem), problem.gap.ravel(), problem.approach_from_touch
    contact = gap < (np.inf if prescribed is None else prescribed)
    for _ in range(100):
        f, approach = _on(problem, matrix, contact)
        v = matrix @ f + gap
        slack = 1e-13 * max(float(np.abs(v).max()), abs(approach))
        wrong_in, wrong_out = contact & (f < 0), ~contact & (v < approach - slack)
        if not wrong_in.any() and not wrong_out.any():
            return f.reshape(problem.gap.shape)
        # tension first: a set that is too large only loses elements, one by its worst penetration gains
        contact = contact & ~wrong_in if wrong_in.any() else contact | wrong_out
    raise RuntimeError("no contact set found in 100 rounds")
