"""The configurations that solve one scene: method, grid, tolerance, and neglected terms."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass
from typing import Literal

import refimpl as rf

Way = Literal["fft", "paper", "dense", "qp"]
OTHERS: tuple[Way, ...] = ("paper", "dense", "qp")
LARGEST = {"fft": 2048, "paper": 256, "dense": 64, "qp": 128}
"""Elements a side beyond which a method takes minutes on one core."""


@dataclass(frozen=True)
class Setting:
    """One way: ``nested`` grids or the finest alone; ``oblique`` slopes and ``coupled`` shear, or not.

    ``single`` has the solver's convolutions in single precision; the certificate stays in double.
    "qp" is L-BFGS-B on the energy at the scene's approach, which it is told; without slopes and coupling.
    """

    method: Way
    M: int
    tolerance: float
    nested: bool = True
    oblique: bool | None = None
    coupled: bool | None = None
    single: bool = False

    @property
    def way(self) -> str:
        """The setting without its grid, as a legend says it."""
        parts: list[str] = [self.method]
        if self.method == "fft":
            parts.append(f"{self.tolerance:.0e}")
        if not self.nested:
            parts.append("one grid")
        if self.oblique is False:
            parts.append("flat")
        if self.coupled is False:
            parts.append("uncoupled")
        if self.single:
            parts.append("single")
        return ", ".join(parts)


APERIODIC = {
    "paper": "the paper's scheme is of free half-spaces",
    "qp": "the energy that it minimises is of free half-spaces",
    "single": "only convolutions on free half-spaces have a single precision",
}


def inapplicable(scene: rf.Scene) -> dict[str, str]:
    """The ways, by method or "single", that such a scene cannot be solved in, and why."""
    return dict(APERIODIC) if scene.periodic else {}


def settings(
    grids: Sequence[int], tolerances: Sequence[float], without: Container[str] = ()
) -> list[Setting]:
    """Every way that is compared: production at each tolerance, then one thing changed at a time.

    ``without`` are those that do not apply, see `inapplicable`.
    """
    middle = tolerances[len(tolerances) // 2]
    ways: list[Setting] = []
    for M in grids:
        ways += [Setting("fft", M, tolerance) for tolerance in tolerances]
        ways += [Setting("fft", M, tolerance, single=True) for tolerance in tolerances[-2:]]
        ways.append(Setting("fft", M, middle, nested=False))
        ways.append(Setting("fft", M, middle, oblique=False))
        ways.append(Setting("fft", M, middle, coupled=False))
        ways.append(Setting("fft", M, middle, oblique=False, coupled=False))
        ways += [Setting(other, M, middle) for other in OTHERS if LARGEST[other] >= M]
    return [way for way in ways if way.method not in without and not (way.single and "single" in without)]
