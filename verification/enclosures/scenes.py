"""The scenes: whole problems in exact binary numbers, each for one part of the model.

Heights are multiples of 2^-40 m (2^-60 m in a near tie), so that any code forms gaps without rounding.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.planning.plan import Method

SIDE = 2.0**-10
QUANTUM = 2.0**-40  # m
STEEL, COPPER, POLYMER = rf.Material(200e9, 0.30), rf.Material(118e9, 0.30), rf.Material(2.5e9, 0.38)
SLIDING = rf.Friction(tau=0.8e6, beta=0.15)
NONE = rf.Friction()


@dataclass(frozen=True, eq=False)
class EnclosedScene:
    """Heights of the lower surface (m) below a flat upper one, materials, friction, load (N) or approach (m).

    ``tan_x``, ``tan_y`` are the slopes held in the proof, or None for ``oblique=False``.
    """

    name: str
    stresses: str
    heights: Array
    lower: rf.Material = COPPER
    upper: rf.Material = STEEL
    friction: rf.Friction = NONE
    load: float = 1.0
    approach: float | None = None
    direction: float = 0.0
    periodic: bool = False
    tan_x: Array | None = None
    tan_y: Array | None = None

    @property
    def M(self) -> int:
        """Elements a side."""
        return len(self.heights)

    @property
    def oblique(self) -> bool:
        """True if slopes enter."""
        return self.tan_x is not None

    @property
    def scene(self) -> rf.Scene:
        """The scene as `refimpl.solve` takes it."""
        return rf.Scene(
            upper=rf.Body(self.upper, rf.Flat()),
            lower=rf.Body(self.lower, self.heights),
            friction=self.friction,
            load=self.load,
            side=SIDE,
            sliding_direction=self.direction,
            periodic=self.periodic,
        )

    def solve(self, method: Method = "fft", tolerance: float = 1e-12) -> rf.Solution:
        """Return the scene solved, with the terms that the proof has."""
        terms: Any = {"approach": self.approach, "oblique": self.oblique}
        return rf.solve(self.scene, self.M, method=method, tolerance=tolerance, **terms)


def surface(M: int, seed: int, rms: float, radius: float | None = None) -> Array:
    """Return white heights of this rms (m) on a bump of this radius (m), in multiples of `QUANTUM`."""
    z = rms * np.random.default_rng(seed).standard_normal((M, M))
    if radius is not None:
        x = ((np.arange(M) + 0.5) / M - 0.5) * SIDE
        z -= (x[:, None] ** 2 + x[None, :] ** 2) / (2 * radius)
    return np.asarray(np.rint(z / QUANTUM) * QUANTUM)


def scenes() -> tuple[EnclosedScene, ...]:
    """Return all but the near ties and the oblique one, which start from a proven or a solved scene."""
    return (
        EnclosedScene("smooth", "a smooth bump without friction", surface(9, 0, 0.0, 0.2), load=12.0),
        EnclosedScene("rough", "a rough bump on identical metal", surface(12, 1, 0.1e-6, 0.3),
                      upper=COPPER, load=6.0),
        EnclosedScene("friction", "dissimilar bodies sliding askew, tau and beta", surface(8, 2, 0.3e-6, 0.1),
                      lower=POLYMER, friction=SLIDING, load=2.0, direction=0.7),
        EnclosedScene("other-sign", "coupling of the other sign, sliding backwards, a nearly incompressible "
                      "and a cellular body", surface(7, 3, 0.2e-6, 0.1), lower=rf.Material(70e9, 0.49),
                      upper=rf.Material(3e9, -0.2), friction=rf.Friction(0.2e6, 0.4),
                      load=2.0, direction=2.5),
        EnclosedScene("approach", "prescribed approach, coupled", surface(9, 4, 0.3e-6, 0.1),
                      lower=POLYMER, friction=SLIDING, approach=2.0**-20, direction=1.0),
        EnclosedScene("periodic", "periodic rough plane with friction", surface(8, 5, 0.15e-6),
                      lower=POLYMER, friction=SLIDING, load=1.0, direction=0.3, periodic=True),
        EnclosedScene("single", "one element in contact", surface(5, 6, 2e-6), load=2.0**-10),
        EnclosedScene("full", "every element in contact", surface(6, 7, 2e-9),
                      lower=POLYMER, friction=SLIDING, load=4.0),
        EnclosedScene("largest", "dissimilar, rough, with friction, on 144 elements",
                      surface(12, 8, 0.2e-6, 0.2), lower=POLYMER, friction=rf.Friction(0.2e6, 0.3),
                      load=1.0, direction=-1.2),
    )  # fmt: skip


def oblique_scene() -> EnclosedScene:
    """Return a steep rough bump; held are the slopes that the dense reference ends with."""
    start = EnclosedScene(
        "oblique", "slopes of some 0.05 in Eqs (2), (3) and (6), with tau and beta",
        surface(7, 9, 2e-6, 0.02), lower=POLYMER, friction=SLIDING, load=20.0, direction=0.4,
    )  # fmt: skip
    solution = rf.solve(start.scene, start.M, method="dense", tolerance=1e-12)
    return replace(start, tan_x=solution.slopes.tan_x, tan_y=solution.slopes.tan_y)


def near_tie(base: EnclosedScene, name: str, element: tuple[int, int], rise: float) -> EnclosedScene:
    """Return ``base`` with one element raised by about ``rise`` (m): it just does, or not, touch."""
    quantum = 2.0**-60
    heights = base.heights.copy()
    heights[element] += np.rint(rise / quantum) * quantum
    return replace(base, name=name, stresses=f"an element that just {name[9:]}", heights=heights)
