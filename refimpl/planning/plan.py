"""What a scene requires: the terms that enter, the terms left out with what they would change, the memory."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Literal

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.model.problem import Terms
from refimpl.planning.expected_contact import Outlook, expected
from refimpl.planning.resolution import Resolution, resolution
from refimpl.planning.terms import Forced, Term, affordable, choose
from refimpl.scene.discretise import Posing
from refimpl.scene.scene import Scene

Method = Literal["dense", "fft", "paper"]
METHODS: tuple[Method, ...] = ("dense", "fft", "paper")

_KEYWORDS = {"shear coupling": "coupled", "obliqueness": "oblique", "shear tilt": "tilted"}
DECISION_GRID = 256  # where terms are decided for all grids of a refinement

# Bytes per element at the peak, measured on the shipped scenes with slopes and shear coupling: FFT
# work arrays, two kernel tables and their transforms; or dense matrices of Eq. (7), 5.2 of them without and
# 7.2 with the slope correction, which has a kernel more (40 and 56 elements a side).
_FFT_BYTES = 520
_DENSE_MATRICES, _DENSE_MATRICES_CORRECTED = 6, 8


@dataclass(frozen=True)
class Plan:
    """What is modelled on an ``M x M`` grid, what is left out and why, and the memory estimate (bytes).

    ``demand`` is the relative accuracy that terms are held against, and ``budget`` what those left out may
    add up to; ``decided_on`` is the grid whose heights decided; ``outlook`` the contact to expect there;
    ``resolution`` what roughness asks of the grid, if there is any.
    """

    method: Method
    M: int
    terms: tuple[Term, ...]
    memory: int
    demand: float
    budget: float
    forced: Forced
    decided_on: int
    outlook: Outlook
    resolution: Resolution | None

    def term(self, name: str) -> Term:
        """The named term."""
        return next(term for term in self.terms if term.name == name)

    def includes(self, name: str) -> bool:
        """Whether the named term is modelled."""
        return self.term(name).included

    @property
    def left_out(self) -> tuple[str, ...]:
        """Names of the terms that would change something and were left out for being small."""
        return tuple(term.name for term in self.terms if term.small)

    @property
    def switches(self) -> Terms:
        """The terms as the solvers' switches."""
        return Terms(
            coupled=self.includes("shear coupling"),
            oblique=self.includes("obliqueness"),
            slope_correction=self.includes("slope correction"),
            tilted=self.includes("shear tilt"),
        )

    def on(self, scene: Scene, M: int) -> Plan:
        """The same terms on another grid, checked against the free memory."""
        asked = resolution(scene, M, self.demand)
        memory = memory_of(self.method, M, corrected=self.forced.slope_correction)
        return replace(self, M=M, memory=memory, resolution=asked)

    def put_back(self, scene: Scene, name: str) -> Plan:
        """The plan with a term that turned out to matter."""
        forced = replace(self.forced, **{_KEYWORDS[name]: True})
        terms = choose(scene, self.outlook, forced, self.budget)
        put_back = tuple(
            replace(term, reason="put back: the contact found says that it matters")
            if term.name == name
            else term
            for term in terms
        )
        return replace(self, terms=put_back, forced=forced)


def make_plan(
    scene: Scene,
    M: int,
    method: Method,
    *,
    oblique: bool | None = None,
    slope_correction: bool = False,
    coupled: bool | None = None,
    tilted: bool | None = None,
    demand: float = 1e-8,
    approach: float | None = None,
    decide_on: int | None = None,
    of_mu: bool = False,
    posing: Posing | None = None,
) -> Plan:
    """Decide the terms from the scene alone and check that the grid fits into memory.

    ``True`` and ``False`` force a term in or out, ``None`` leaves it to its estimate against ``demand``,
    the relative accuracy asked of mu and A (``of_mu``: of mu above all), by the heights on ``decide_on``
    elements a side (M by default), which ``posing`` samples, if it is given, and keeps.

    Raises `InputError` for an unknown method, for a grid whose estimate exceeds the free memory, and for
    terms that exclude each other.
    """
    if method not in METHODS:
        raise InputError("method", method, f"one of {', '.join(METHODS)}")
    forced = Forced(coupled, oblique, tilted, slope_correction)
    forced.check()
    if method == "paper" and scene.periodic:
        raise InputError("method", method, "dense or fft for a periodic scene")
    memory = memory_of(method, M, corrected=slope_correction)
    decide_on = decide_on or M
    posing = posing or Posing(scene, approach)
    outlook = expected(posing.whole(Grid(scene.side, decide_on)))
    budget = affordable(scene, outlook, demand)
    return Plan(
        method=method,
        M=M,
        terms=choose(scene, outlook, forced, budget, of_mu=of_mu),
        memory=memory,
        demand=demand,
        budget=budget,
        forced=forced,
        decided_on=decide_on,
        outlook=outlook,
        resolution=resolution(scene, M, demand),
    )


def memory_of(method: Method, M: int, *, corrected: bool = False) -> int:
    """Estimated bytes at the peak of a solve; raises `InputError` when they exceed the free memory."""
    matrices = _DENSE_MATRICES_CORRECTED if corrected else _DENSE_MATRICES
    memory = 8 * matrices * M**4 if method == "dense" else _FFT_BYTES * M**2
    free = free_memory()
    if memory > free:
        raise InputError(
            "grid", M, f"a grid whose estimated {memory / 1e9:.3g} GB fit into the free {free / 1e9:.3g} GB"
        )
    return memory


def free_memory() -> int:
    """Memory that an allocation may take now (bytes), from the kernel's own estimate where there is one."""
    with suppress(OSError), open("/proc/meminfo", encoding="ascii") as lines:
        for line in lines:
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
