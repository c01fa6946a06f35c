"""Dimensions of the covering designs, with their levels; a row of a design has one level of each.

``plain``, ``sliding`` and ``oblong`` pose all pairs of levels, ``triples`` all triples where faults multiply.
``large`` goes to 512 elements, ``tiny`` down to one; ``capped`` has a hardness, ``memory`` changes one
dimension from a problem to the next.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

PLAIN: dict[str, tuple[Any, ...]] = {
    "elements": (9, 16, 31, 32, 45, 64, 125, 176),
    "edge": (1e-9, 1e-7, 1e-5, 1e-3, 1.0, 1e3),
    "modulus": (1e3, 1e6, 2e9, 2e11, 1e15),
    "control": ("load", "approach"),
    "borders": ("free", "periodic"),
    "contact": ("light", "half", "most", "full"),
    "slope": (1e-4, 1e-2, 1.0),
    "surface": ("smooth", "harsh"),
}
"""Squares without friction. ``edge`` in m, ``modulus`` in Pa; ``slope`` scales heights over the side."""
SLIDING = PLAIN | {
    "sector": tuple(range(8)),
    "beta": (0.05, 0.4, 1.0, 1.6),
    "tau": (0.0, 0.01, 0.1),
    "coupling": (-0.6, -0.2, 0.1, 0.45),
}
"""Squares that slide. ``sector``: eighth of the circle; ``tau`` over the peak; ``coupling``: pi c0 E*."""
OBLONG = SLIDING | {
    "elements": (12, 21, 32, 63, 128),
    "edge": (1e-8, 1e-5, 1.0),
    "modulus": (1e4, 2e11),
    "shape": ("wide", "deep", "oblong elements", "both"),
    "sector": (0, 3, 5, 6),
}
"""Rectangles, elements whose edges differ, and both; with friction."""
PRESSURES = {"light": 0.01, "half": 0.1, "most": 0.5, "full": 4.0}
"""Mean pressure over E* times the slope."""
DEPTHS = {"light": 0.2, "half": 0.5, "most": 0.8, "full": 0.95}
"""Approach from first contact over the mean gap if periodic; free, with `BEYOND` where contact is full."""
SHARES = {"light": 0.01, "half": 0.2, "most": 0.6, "full": 1.0}
"""Elements in contact over all, where pressures are chosen."""
PEAK = 0.1
"""Chosen peak pressure over E* times the slope."""
MARGIN = 0.2
"""Clearance beside a chosen contact, over the range of its displacement: no element is in doubt."""
BEYOND = 2.0
"""Approach over the largest gap."""

CAPS = (1.5, 4.0, 20.0)
"""Hardness over the mean pressure of `PRESSURES`."""
TRIPLES: dict[str, tuple[Any, ...]] = {
    "elements": (8, 11, 16),
    "borders": ("free", "periodic"),
    "control": ("load", "approach"),
    "sector": tuple(range(8)),
    "beta": (0.1, 1.3),
    "tau": (0.0, 0.1),
    "coupling": (-0.5, 0.3),
    "shape": ("square", "wide", "oblong elements"),
}
"""Small grids that slide, for slow solvers as well: all triples of levels."""
LARGE: dict[str, tuple[Any, ...]] = {
    "elements": (199, 256, 347, 512),
    "borders": ("free", "periodic"),
    "control": ("load", "approach"),
    "contact": ("light", "half", "most"),
    "surface": ("smooth", "harsh"),
}
LARGE_SLIDING: dict[str, tuple[Any, ...]] = {
    "elements": (199, 256, 347, 512),
    "borders": ("free", "periodic"),
    "control": ("load", "approach"),
    "contact": ("light", "half"),
    "sector": (1, 4, 6),
    "beta": (0.2, 1.2),
    "tau": (0.0, 0.1),
    "coupling": (-0.4, 0.3),
}
TINY: dict[str, tuple[Any, ...]] = {
    "elements": (1, 2, 3, 5),
    "borders": ("free", "periodic"),
    "control": ("load", "approach"),
    "surface": ("flat", "harsh"),
    "shape": ("square", "row"),
    "beta": (0.0, 0.6),
    "edge": (1e-6, 1.0),
    "modulus": (1e5, 1e11),
}
CAPPED: dict[str, tuple[Any, ...]] = {
    "elements": (9, 16, 31, 64, 125),
    "borders": ("free", "periodic"),
    "control": ("load", "approach"),
    "contact": ("light", "half", "most"),
    "cap": CAPS,
    "beta": (0.0, 0.8),
    "coupling": (-0.4, 0.3),
    "sector": (0, 3, 6),
}
CHANGED = (
    *("edge", "modulus", "borders", "control", "load", "surface"),
    *("elements", "edges", "sector", "beta", "tau", "coupling"),
)
MEMORY: dict[str, tuple[Any, ...]] = {
    "changed": CHANGED,
    "borders": ("free", "periodic"),
    "control": ("load", "approach"),
    "tau": (0.0, 0.05),
    "coupling": (-0.4, 0.3),
}
"""A problem, another one that differs in ``changed``, and the first again. Each has a size of its own: what
is kept from one is not met in another."""
FIXED: dict[str, Any] = {
    "edge": 1e-6,
    "modulus": 1e11,
    "contact": "half",
    "slope": 1e-2,
    "surface": "smooth",
    "sector": 1,
    "beta": 0.5,
}
"""Levels of what a later design does not vary."""


class Design(NamedTuple):
    """Dimensions with a covering array's strength, seed and tries, and levels that are not varied."""

    dimensions: dict[str, tuple[Any, ...]]
    seed: int
    strength: int = 2
    tries: int = 30
    fixed: Mapping[str, Any] = MappingProxyType({})


_DRY = {name: level for name, level in FIXED.items() if name not in ("sector", "beta")}
DESIGNS: dict[str, Design] = {
    "plain": Design(PLAIN, 1),
    "sliding": Design(SLIDING, 2),
    "oblong": Design(OBLONG, 3),
    "triples": Design(TRIPLES, 4, strength=3, tries=1, fixed=FIXED),
    "large": Design(LARGE, 5, fixed=_DRY),
    "large-sliding": Design(LARGE_SLIDING, 6, fixed=FIXED),
    "tiny": Design(TINY, 7, fixed=FIXED | {"contact": "half", "tau": 0.0, "coupling": 0.3}),
    "capped": Design(CAPPED, 8, fixed=FIXED | {"tau": 0.0}),
    "memory": Design(MEMORY, 9, fixed=FIXED),
}
VARIED = ("plain", "sliding", "oblong", "triples", "capped", "memory")
"""Designs of which ``--thorough`` poses further arrays; ``tiny`` has few others, ``large`` costs too much."""
FURTHER_ARRAYS = (2, 3)
FURTHER: dict[str, Design] = {
    f"{name}-{number}": DESIGNS[name]._replace(seed=100 * number + DESIGNS[name].seed)
    for number in FURTHER_ARRAYS
    for name in VARIED
}
"""Arrays of the same levels from other seeds: their rows meet triples of levels that the first ones miss."""
