"""Random faults of a solver: an effect on an operator, input or answer, under a condition; one per seed.

Generator and seeds were committed before the covering design was: the campaign measures what nobody aimed at.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from refimpl.grid import Array
from verification.contestants.compact import Compact, with_hooks
from verification.contestants.protocol import ContactProblem, Coupling

SEEDS = range(240)
"""Seeds of the campaign."""
COUNTED = 1e-3
"""Error, relative to the peak pressure, of 100 claims at 1e-8: faults below are not counted."""
When = Callable[[ContactProblem], bool]


@dataclass(frozen=True)
class RandomFault:
    """Fault of one seed: a description, and a factory of solvers that have it."""

    seed: int
    effect: str
    condition: str
    when: When
    fresh: Callable[[], Compact]


def _conditions(random: np.random.Generator) -> tuple[str, When]:
    n, sector = int(random.choice([20, 40, 80, 120])), int(random.integers(8))
    length, modulus = 10 ** random.uniform(-8, 2), 10 ** random.uniform(4, 11)
    beta = float(random.uniform(0.1, 1.2))
    table: list[tuple[str, When]] = [
        ("always", lambda p: True),
        ("periodic", lambda p: p.periodic),
        ("free", lambda p: not p.periodic),
        ("at an approach", lambda p: p.load is None),
        ("under a load", lambda p: p.load is not None),
        ("even elements", lambda p: p.M % 2 == 0),
        ("odd elements", lambda p: p.M % 2 == 1),
        (f"more than {n} elements", lambda p: n < p.M),
        (f"at most {n} elements", lambda p: n >= p.M),
        ("powers of two", lambda p: p.M & (p.M - 1) == 0),
        (f"spacing below {length:.1e} m", lambda p: p.spacing < length),
        (f"modulus below {modulus:.1e} Pa", lambda p: p.reduced_modulus < modulus),
        ("rectangles", lambda p: p.shape[0] != p.shape[1]),
        ("oblong elements", lambda p: p.spacings[0] != p.spacings[1]),
        ("sliding", lambda p: p.coupling is not None),
        (f"sector {sector}", lambda p: p.coupling is not None and _sector(p.coupling) == sector),
        (f"beta above {beta:.2f}", lambda p: p.coupling is not None and p.coupling.beta > beta),
        ("tau", lambda p: p.coupling is not None and p.coupling.tau > 0),
        ("negative c0", lambda p: p.coupling is not None and p.coupling.shear_compliance < 0),
        ("sliding and periodic", lambda p: p.coupling is not None and p.periodic),
        ("sliding, periodic, even", lambda p: p.coupling is not None and p.periodic and p.M % 2 == 0),
        (f"periodic, above {n} elements", lambda p: p.periodic and n < p.M),
        ("free at an approach", lambda p: not p.periodic and p.load is None),
    ]
    return table[int(random.integers(len(table)))]


def _sector(coupling: Coupling) -> int:
    return int((coupling.sliding_direction % (2 * np.pi)) // (np.pi / 4)) % 8


def _coupled(
    change: Callable[[Coupling], Coupling],
) -> Callable[[ContactProblem, ContactProblem], ContactProblem]:
    def pose(_: ContactProblem, problem: ContactProblem) -> ContactProblem:
        return problem if problem.coupling is None else replace(problem, coupling=change(problem.coupling))

    return pose


def _effects(random: np.random.Generator) -> tuple[str, dict[str, Any]]:
    s = 1 + float(random.choice([-1, 1])) * 10 ** random.uniform(-2, -0.3)
    row, drop, floor = int(random.integers(1, 12)), 10 ** random.uniform(-4, -1), 10 ** random.uniform(-2, 7)
    limit, kept = int(random.choice([10, 30, 60, 100])), int(random.integers(5))
    top, weak = float(random.uniform(0.2, 1.2)), 10 ** random.uniform(-14, -9)

    def scaled(name: str) -> Callable[[ContactProblem, ContactProblem], ContactProblem]:
        return lambda _, p: p if getattr(p, name) is None else replace(p, **{name: s * getattr(p, name)})

    def one_wave(_: ContactProblem, hat: Any) -> Any:
        out = hat.copy()
        i, j = row % hat.shape[0], row // 2 % hat.shape[1]
        out[i, j] *= 2
        out[-i % hat.shape[0], -j % hat.shape[1]] = np.conj(out[i, j])
        return out

    def high_waves(_: ContactProblem, hat: Any) -> Any:
        x, y = (np.abs(np.fft.fftfreq(n)) for n in hat.shape)
        return np.where(np.maximum(x[:, None], y[None, :]) > 0.5 - drop, s * hat, hat)

    def border(_: ContactProblem, f: Array) -> Array:
        out = f.copy()
        out[-1] = 0
        return out

    keys: list[Callable[[ContactProblem], tuple[object, ...]]] = [
        lambda p: (p.shape, p.reduced_modulus, p.periodic, p.coupling),
        lambda p: (p.shape, p.spacings, p.periodic, p.coupling),
        lambda p: (p.shape, p.spacings, p.reduced_modulus, p.coupling),
        lambda p: (p.shape, p.spacings, p.reduced_modulus, p.periodic, p.coupling is None),
        lambda p: (max(p.shape), p.spacings, p.reduced_modulus, p.periodic, p.coupling),
    ]
    names = ["spacing", "modulus", "borders", "friction", "rectangle"]
    table: list[tuple[str, dict[str, Any]]] = [
        (f"modulus times {s:.3f}", {"pose": scaled("reduced_modulus")}),
        (f"load times {s:.3f}", {"pose": scaled("load")}),
        (f"approach times {s:.3f}", {"pose": scaled("approach")}),
        (f"normal influence times {s:.3f}", {"normal": lambda p, h: s * h}),
        (f"shear influence times {s:.3f}", {"shear": lambda p, h: s * h}),
        ("shear influence reversed", {"shear": lambda p, h: -h}),
        ("shear influence transposed", {"shear": lambda p, h: h.T if h.shape[0] == h.shape[1] else h}),
        (f"a wave {row} doubled", {"normal": one_wave}),
        (f"highest waves times {s:.3f}", {"normal": high_waves}),
        (f"highest waves of shear times {s:.3f}", {"shear": high_waves}),
        (f"beta times {s:.3f}", {"pose": _coupled(lambda c: replace(c, beta=s * c.beta))}),
        (f"beta capped at {top:.2f}", {"pose": _coupled(lambda c: replace(c, beta=min(c.beta, top)))}),
        ("tau lost", {"pose": _coupled(lambda c: replace(c, tau=0.0))}),
        (
            f"c0 below {weak:.1e} taken for none",
            {
                "pose": _coupled(
                    lambda c: replace(
                        c, shear_compliance=c.shear_compliance * (abs(c.shear_compliance) >= weak)
                    )
                )
            },
        ),
        (
            "c0 without its sign",
            {"pose": _coupled(lambda c: replace(c, shear_compliance=abs(c.shear_compliance)))},
        ),
        (
            "direction reflected in x",
            {"pose": _coupled(lambda c: replace(c, sliding_direction=-c.sliding_direction))},
        ),
        (
            "direction by its arc tangent",
            {
                "pose": _coupled(
                    lambda c: replace(c, sliding_direction=float(np.arctan(np.tan(c.sliding_direction))))
                )
            },
        ),
        (
            f"pressures below {drop:.1e} of the peak dropped",
            {"pressure": lambda p, f: np.where(f < drop * f.max(), 0, f)},
        ),
        (f"pressures below {floor:.1e} Pa dropped", {"pressure": lambda p, f: np.where(f < floor, 0, f)}),
        ("last row without pressure", {"pressure": border}),
        ("pressures one element off", {"pressure": lambda p, f: np.roll(f, 1, axis=int(row % 2))}),
        (f"{limit} iterations at most", {"limit": lambda p, n: limit}),
        (f"operators kept without {names[kept]}", {"key": keys[kept]}),
        ("shear traction on the whole grid", {"traction": lambda p, r: np.where(r > 0, r, p.coupling.tau)}),
    ]
    return table[int(random.integers(len(table)))]


def random_fault(seed: int) -> RandomFault:
    """Return the fault of a seed; the same on every machine.

    >>> random_fault(3).effect == random_fault(3).effect
    True
    """
    random = np.random.default_rng([43, seed])
    effect, hooks = _effects(random)
    condition, when = _conditions(random)
    if "key" in hooks:  # a memory spans problems: it has no condition
        return RandomFault(seed, effect, "always", lambda p: True, partial(with_hooks, **hooks))
    limited = {name: _only(when, hook) for name, hook in hooks.items()}
    return RandomFault(seed, effect, condition, when, partial(with_hooks, **limited))


def _only(when: When, hook: Callable[..., Any]) -> Callable[..., Any]:
    return lambda p, item: hook(p, item) if when(p) else item
