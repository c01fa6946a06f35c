"""What a scene requires: the terms that enter, the terms left out, and the memory it will take."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from refimpl.errors import InputError
from refimpl.problem import Terms
from refimpl.scene import Scene

Method = Literal["dense", "fft", "paper"]
METHODS: tuple[Method, ...] = ("dense", "fft", "paper")

# Bytes per element at the peak, measured on the shipped scenes with slopes and shear coupling: FFT
# work arrays, two kernel tables and their transforms; or five dense matrices of Eq. (7).
_FFT_BYTES = 520
_DENSE_MATRICES = 5


@dataclass(frozen=True)
class Term:
    """One piece of physics: whether it is modelled, and why."""

    name: str
    included: bool
    reason: str


@dataclass(frozen=True)
class Plan:
    """What is modelled on an ``M x M`` grid, what is left out and why, and the memory estimate (bytes)."""

    method: Method
    M: int
    terms: tuple[Term, ...]
    memory: int

    def includes(self, name: str) -> bool:
        """Whether the named term is modelled."""
        return next(term.included for term in self.terms if term.name == name)

    @property
    def switches(self) -> Terms:
        """The terms as the solvers' switches."""
        return Terms(
            coupled=self.includes("shear coupling"),
            oblique=self.includes("obliqueness"),
            slope_correction=self.includes("slope correction"),
        )


def make_plan(
    scene: Scene, M: int, method: Method, *, oblique: bool | None, slope_correction: bool
) -> Plan:
    """Decide the terms from the scene alone and check that the grid fits into memory.

    Raises `InputError` for an unknown method and for a grid whose estimate exceeds the free memory.
    """
    if method not in METHODS:
        raise InputError("method", method, f"one of {', '.join(METHODS)}")
    if slope_correction and oblique is False:
        raise InputError("oblique", oblique, "true or unset: the slope correction needs the slopes")
    if method == "paper" and scene.periodic:
        raise InputError("method", method, "dense or fft for a periodic scene")
    memory = 8 * _DENSE_MATRICES * M**4 if method == "dense" else _FFT_BYTES * M**2
    free = free_memory()
    if memory > free:
        raise InputError(
            "grid", M, f"a grid whose estimated {memory / 1e9:.3g} GB fit into the free {free / 1e9:.3g} GB"
        )
    terms = (
        _coupling(scene, slope_correction),
        _obliqueness(oblique),
        Term("slope correction", slope_correction, "asked for" if slope_correction else "not asked for"),
        Term("tau support", scene.friction.tau > 0, "tau > 0" if scene.friction.tau > 0 else "tau is zero"),
    )
    return Plan(method, M, terms, memory)


def _coupling(scene: Scene, slope_correction: bool) -> Term:
    name = "shear coupling"
    if scene.materials.shear_compliance == 0:
        return Term(name, False, "lower and upper shear compliances cancel exactly")
    if scene.friction.is_zero and not slope_correction:
        return Term(name, False, "no friction")
    return Term(name, True, "shear compliances of the bodies differ")


def _obliqueness(oblique: bool | None) -> Term:
    if oblique is None:
        return Term("obliqueness", True, "slopes of the deformed surface enter Eqs (2), (3) and (6)")
    return Term("obliqueness", oblique, "forced in" if oblique else "forced out: cosines 1, sines 0")


def free_memory() -> int:
    """Memory that an allocation may take now (bytes), from the kernel's own estimate where there is one."""
    meminfo = Path("/proc/meminfo")
    if meminfo.exists():
        for line in meminfo.read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
