"""Faults of strangers that once passed the whole suite, each rebuilt in several variants.

A fault stands in the compact solver, which claims success. ``dimensions`` are the traits of which the short
list must name one: a group for each condition of the fault.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from refimpl.grid import Array
from verification.contestants.compact import Compact, Complex, with_hooks
from verification.contestants.protocol import ContactProblem, Coupling

When = Callable[[ContactProblem], bool]
OF_LENGTH = ("edge", "heights")
OF_C0 = ("c0", "modulus", "coupling")
OF_PRESSURE = ("pressure", "modulus", "slope", "contact", "pressure over E*")


class TableFault(NamedTuple):
    """A fault: its hole in the table, a factory of solvers, and the dimensions to be named."""

    hole: str
    fresh: Callable[[], Compact]
    dimensions: tuple[tuple[str, ...], ...]

    @property
    def largest(self) -> float:
        """Most elements a side of the problems that the fault is put to."""
        return math.inf if self.hole == _LARGE else _SMALL


def _friction(change: Callable[[Coupling], Coupling], when: When = lambda p: True) -> Callable[[], Compact]:
    def pose(_: ContactProblem, p: ContactProblem) -> ContactProblem:
        return p if p.coupling is None or not when(p) else replace(p, coupling=change(p.coupling))

    return partial(with_hooks, pose=pose)


def _pressures(change: Callable[[ContactProblem, Array], Array]) -> Callable[[], Compact]:
    return partial(with_hooks, pressure=change)


def _limit(most: int) -> TableFault:
    return TableFault("iterations", partial(with_hooks, limit=lambda p, n: most), (("iterations",),))


def _small_c0(least: float) -> Callable[[Coupling], Coupling]:
    return lambda c: replace(c, shear_compliance=c.shear_compliance * (abs(c.shear_compliance) >= least))


def _dropped(floor: float) -> Callable[[ContactProblem, Array], Array]:
    return lambda p, f: np.where(f < floor, 0.0, f)


def _floored(least: float) -> Callable[[ContactProblem, ContactProblem], ContactProblem]:
    def pose(_: ContactProblem, p: ContactProblem) -> ContactProblem:
        dx, dy = (max(edge, least) for edge in p.spacings)
        return replace(p, spacing=dx, spacing_y=None if dx == dy else dy)

    return pose


def _squared_by_isclose(_: ContactProblem, p: ContactProblem) -> ContactProblem:
    """Edges that `numpy.isclose` calls equal, as all below 1e-8 m are: taken for a square's."""
    return replace(p, spacing_y=None) if np.isclose(*p.spacings) else p


def _loose(resolved: float) -> Callable[[ContactProblem, ContactProblem], ContactProblem]:
    """Stop at an absolute step (m): what the gap's range leaves of the tolerance."""

    def pose(_: ContactProblem, p: ContactProblem) -> ContactProblem:
        height = float(np.ptp(p.gap))
        return replace(p, tolerance=min(0.5, max(p.tolerance, resolved / height if height else 0.0)))

    return pose


def _direction(change: Callable[[float], float]) -> Callable[[Coupling], Coupling]:
    return lambda c: replace(c, sliding_direction=change(c.sliding_direction))


def _both_negative(p: ContactProblem) -> bool:
    angle = p.coupling.sliding_direction if p.coupling else 0.0
    return not p.periodic and math.cos(angle) < 0 and math.sin(angle) < 0


def _nyquist(p: ContactProblem, hat: Complex, *, axes: tuple[int, ...] = (0, 1)) -> Complex:
    """Keep the odd symbol of shear on the highest wave of an even axis, where it belongs to no real field.

    As of a real transform: one half of the waves is stored, the other one follows as its conjugate.
    """
    if not p.periodic or p.coupling is None:
        return hat
    q = [2 * np.pi * np.fft.fftfreq(n, d) for n, d in zip(p.shape, p.spacings, strict=True)]
    qx, qy = np.meshgrid(*q, indexing="ij")
    angle, out = p.coupling.sliding_direction, hat.copy()
    square = np.where(qx**2 + qy**2 > 0, qx**2 + qy**2, np.inf)
    along = math.cos(angle) * qx + math.sin(angle) * qy
    symbol = -2j * np.pi * p.coupling.shear_compliance * along / square
    for axis in axes:
        n, half = p.shape[axis], np.arange(1, (p.shape[1 - axis] + 1) // 2)
        if n % 2 == 0:
            kept, made = (np.moveaxis(each, axis, 0)[n // 2] for each in (symbol, out))
            made[half], made[-half] = kept[half], np.conj(kept[half])
    return out


def _off_above(most: int, factor: float) -> Callable[[ContactProblem, Complex], Complex]:
    return lambda p, hat: factor * hat if most < p.M else hat


def _capped_at_modulus(p: ContactProblem, f: Array) -> Array:
    return np.minimum(f, p.reduced_modulus)


def _within_the_gap(_: ContactProblem, p: ContactProblem) -> ContactProblem:
    """An approach ends at the largest gap."""
    top = float(p.gap.max())
    beyond = p.approach is not None and not p.periodic and p.approach > top > 0
    return replace(p, approach=top) if beyond else p


def _one_element_free(p: ContactProblem, f: Array) -> Array:
    """The element with the largest gap never touches."""
    return np.where((p.gap == p.gap.max()) & (f > 0) & (p.gap.size > 4), 0.0, f)


def _no_single(p: ContactProblem, f: Array) -> Array:
    """A grid of one element is taken for nothing to solve."""
    return np.zeros_like(f) if p.gap.size == 1 else f


def _no_flat(p: ContactProblem, f: Array) -> Array:
    """A gap without range is divided by: only the mean pressure is returned."""
    return np.full_like(f, f.mean()) if np.ptp(p.gap) == 0 else f


def _tau_of_half(p: ContactProblem, r: Array) -> Array:
    """An element whose pressure is below half the peak has no tau."""
    assert p.coupling is not None
    tau = p.coupling.tau
    return np.where((r > 0) & (r - tau < 0.5 * (r.max() - tau)), r - tau, r) if tau else r


def _key(*names: str) -> Callable[[], Compact]:
    """Operators kept by these parts of a problem alone."""
    parts: dict[str, Callable[[ContactProblem], Any]] = {
        "shape": lambda p: p.shape,
        "spacings": lambda p: p.spacings,
        "modulus": lambda p: p.reduced_modulus,
        "borders": lambda p: p.periodic,
        "c0": lambda p: p.coupling and p.coupling.shear_compliance,
        "direction": lambda p: p.coupling and p.coupling.sliding_direction,
    }
    return partial(with_hooks, key=lambda p: tuple(parts[name](p) for name in names))


def _borders_kept() -> Compact:
    """The borders of the first problem of each shape are kept, and its approach is counted by them."""
    kept: dict[tuple[int, int], bool] = {}

    def pose(_: ContactProblem, p: ContactProblem) -> ContactProblem:
        return replace(p, periodic=kept.setdefault(p.shape, p.periodic))

    return with_hooks(pose=pose)


_UNITS, _DIRECTION, _FRICTION = "absolute units", "directions", "range of beta and tau"
_CACHE, _NYQUIST, _FULL, _LARGE = "operators by a short key", "Nyquist rows", "full contact", "large grids"
_COS, _SIN = ("cos of the direction", "sector"), ("sin of the direction", "sector")
_TAU, _N = ("tau",), ("elements",)
_SMALL = 64


def _pose(hook: Callable[[ContactProblem, ContactProblem], ContactProblem]) -> Callable[[], Compact]:
    return partial(with_hooks, pose=hook)


TABLE: dict[str, TableFault] = {
    "30 iterations": _limit(30),
    "60 iterations": _limit(60),
    "100 iterations": _limit(100),
    "200 iterations": _limit(200),
    "c0 below 1e-11 taken for none": TableFault(_UNITS, _friction(_small_c0(1e-11)), (OF_C0,)),
    "c0 below 1e-13 taken for none": TableFault(_UNITS, _friction(_small_c0(1e-13)), (OF_C0,)),
    "pressures below 1 kPa dropped": TableFault(_UNITS, _pressures(_dropped(1e3)), (OF_PRESSURE,)),
    "pressures below 1 Pa dropped": TableFault(_UNITS, _pressures(_dropped(1.0)), (OF_PRESSURE,)),
    "spacing at least 1 um": TableFault(_UNITS, _pose(_floored(1e-6)), (OF_LENGTH,)),
    "spacing at least 10 nm": TableFault(_UNITS, _pose(_floored(1e-8)), (OF_LENGTH,)),
    "spacings compared by isclose": TableFault(
        _UNITS, _pose(_squared_by_isclose), (OF_LENGTH, ("oblong elements",))
    ),
    "stop at 1 pm": TableFault(_UNITS, _pose(_loose(1e-12)), (OF_LENGTH,)),
    "stop at 1 nm": TableFault(_UNITS, _pose(_loose(1e-9)), (OF_LENGTH,)),
    "sine from the root": TableFault(
        _DIRECTION, _friction(_direction(lambda a: math.acos(math.cos(a)))), (_SIN,)
    ),
    "cosine from the root": TableFault(
        _DIRECTION, _friction(_direction(lambda a: math.asin(math.sin(a)))), (_COS,)
    ),
    "both shear components negative, free": TableFault(
        _DIRECTION,
        _friction(lambda c: replace(c, shear_compliance=-c.shear_compliance), _both_negative),
        ((*_COS, *_SIN), ("borders",)),
    ),
    "beta at most 1": TableFault(
        _FRICTION, _friction(lambda c: replace(c, beta=min(c.beta, 1.0))), (("beta",),)
    ),
    "beta at most 0.8": TableFault(
        _FRICTION, _friction(lambda c: replace(c, beta=min(c.beta, 0.8))), (("beta",),)
    ),
    "tau lost": TableFault(_FRICTION, _friction(lambda c: replace(c, tau=0.0)), (_TAU,)),
    "tau lost above 32 elements": TableFault(
        _FRICTION, _friction(lambda c: replace(c, tau=0.0), lambda p: p.M > 32), (_TAU, _N)
    ),
    "tau on the whole grid": TableFault(
        _FRICTION, partial(with_hooks, traction=lambda p, r: np.where(r > 0, r, p.coupling.tau)), (_TAU,)
    ),
    "tau on well loaded elements only": TableFault(
        _FRICTION, partial(with_hooks, traction=_tau_of_half), (_TAU,)
    ),
    "key without spacing": TableFault(
        _CACHE, _key("shape", "modulus", "borders", "c0", "direction"), (("changed",),)
    ),
    "key without borders": TableFault(_CACHE, _borders_kept, (("changed",),)),
    "key without modulus": TableFault(
        _CACHE, _key("shape", "spacings", "borders", "c0", "direction"), (("changed",),)
    ),
    "key without direction": TableFault(
        _CACHE, _key("shape", "spacings", "borders", "modulus", "c0"), (("changed",),)
    ),
    "key of the shape alone": TableFault(_CACHE, _key("shape"), (("changed", "shape met before"),)),
    "Nyquist of shear, both axes": TableFault(
        _NYQUIST, partial(with_hooks, shear=_nyquist), (("parity", "power of two"), ("borders",))
    ),
    "Nyquist of shear along y": TableFault(
        _NYQUIST,
        partial(with_hooks, shear=partial(_nyquist, axes=(1,))),
        (("parity", "power of two"), ("borders",)),
    ),
    "pressures at most E*": TableFault(_FULL, _pressures(_capped_at_modulus), (OF_PRESSURE,)),
    "approach at most the gap": TableFault(_FULL, _pose(_within_the_gap), (("beyond the gap", "contact"),)),
    "an element that never touches": TableFault(
        _FULL, _pressures(_one_element_free), (("contact", "pressure over E*"),)
    ),
    "one element not solved": TableFault(_FULL, _pressures(_no_single), (_N,)),
    "flat gap has the mean pressure": TableFault(_FULL, _pressures(_no_flat), (("surface",),)),
    "1 % off above 100 elements": TableFault(
        _LARGE, partial(with_hooks, normal=_off_above(100, 1.01)), (_N,)
    ),
    "1 % off above 160 elements": TableFault(
        _LARGE, partial(with_hooks, normal=_off_above(160, 1.01)), (_N,)
    ),
    "tolerance 1e-4 above 160 elements": TableFault(
        _LARGE, _pose(lambda _, p: replace(p, tolerance=1e-4) if p.M > 160 else p), (_N,)
    ),
}
"""Faults by name."""
