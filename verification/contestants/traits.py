"""Traits of a problem of the covering designs: the levels of its row, and what follows from them.

Names are the design's dimensions. Numbers are compared with thresholds; texts and truths are equal or not.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping
from functools import cache
from typing import Any

from verification.contestants.design import HEIGHT, Row, further_rows, in_turn, rows, shape_of
from verification.contestants.dimensions import FURTHER, PRESSURES
from verification.contestants.iterations import ITERATIONS

Trait = float | str | bool | None
"""Value of a dimension; None where the problem has the dimension and no condition is to name it."""
OF_SLIDING = ("c0", "direction")
PARTS = ("edges", "modulus", "borders", *OF_SLIDING)
"""Parts of a problem that its operators depend on, beside its shape."""


def row_of(slug: str) -> Row | None:
    """Return the row of a problem of the designs by its slug; or None."""
    head, _, number = slug.rpartition("-")
    design = head.removeprefix("design-")
    if not head.startswith("design-"):
        return None
    found = _rows(design in FURTHER).get(design)
    return None if found is None else found[int(number) - 1]


def _rows(further: bool) -> Mapping[str, tuple[Row, ...]]:
    """Rows of the designs in the order of the suite, of the further ones too where asked for."""
    return rows() | (further_rows() if further else {})


def levels(slug: str) -> dict[str, Trait] | None:
    """Return the traits of a problem by its slug; or None for a case of no design.

    >>> levels("design-plain-01")["parity"]
    'odd'

    A dimension that a problem does not have, such as beta without friction, is no trait.
    """
    row = row_of(slug)
    if row is None:
        return None
    further = slug.removeprefix("design-").rpartition("-")[0] in FURTHER
    n, g, E = int(row["elements"]), float(row["slope"]), float(row["modulus"])
    wide, deep = shape_of(row)
    traits: dict[str, Trait] = {
        "elements": float(n),
        "parity": "even" if n % 2 == 0 else "odd",
        "power of two": n & (n - 1) == 0,
        "edge": float(row["edge"]),
        "modulus": E,
        "control": row["control"],
        "borders": row["borders"],
        "contact": row["contact"],
        "slope": g,
        "surface": row["surface"],
        "heights": HEIGHT * g * n * float(row["edge"]),
        "pressure": PRESSURES[row["contact"]] * E * g,
        "pressure over E*": PRESSURES[row["contact"]] * g,
        "beyond the gap": row["contact"] == "full"
        and row["control"] == "approach"
        and row["borders"] == "free",
        "rectangle": wide != deep,
        "oblong elements": row.get("shape") in ("both", "oblong elements"),
        "sliding": _slides(row),
        "hardness": "cap" in row,
        "shape met before": slug not in _first_of_their_shapes(further),
    }
    if (iterations := ITERATIONS.get(slug)) is not None:
        traits["iterations"] = float(iterations)
    if "changed" in row:
        traits["changed"] = str(row["changed"])
    for part in PARTS[: None if _slides(row) else -len(OF_SLIDING)]:
        traits[f"changed {part}"] = part in _changed_parts(further)[slug] or None
    return traits | (_of_sliding(row) if _slides(row) else {})


@cache
def _first_of_their_shapes(further: bool) -> frozenset[str]:
    """Slugs of the problems before which none of their shape and borders is posed; of no problems in turn."""
    first: dict[tuple[tuple[int, int], str], str] = {}
    for design, found in _rows(further).items():
        for number, row in enumerate(found, start=1):
            first.setdefault((shape_of(row), row["borders"]), f"design-{design}-{number:02}")
    return frozenset(slug for slug in first.values() if "-memory-" not in slug)


@cache
def _changed_parts(further: bool) -> dict[str, frozenset[str]]:
    """By slug: the parts in which alone a problem differs from an earlier one of its shape.

    A memory that forgets such a part hands the operators of the earlier problem out again.
    """
    met: dict[tuple[Hashable, ...], set[Hashable]] = {}
    changed: dict[str, frozenset[str]] = {}
    for design, found in _rows(further).items():
        for number, base in enumerate(found, start=1):
            slug = f"design-{design}-{number:02}"
            for parts in (_parts(row, slug) for row in in_turn(base)):
                others = {name: met.setdefault((name, *_without(name, parts)), set()) for name in PARTS}
                new = {name for name in PARTS if others[name] - {parts[name]}}
                changed[slug] = changed.get(slug, frozenset()) | new
                for name in PARTS:
                    others[name].add(parts[name])
    return changed


def _parts(row: Row, slug: str) -> dict[str, Hashable]:
    """Shape and `PARTS` of a row; each problem has a direction of its own, drawn within its sector."""
    slides, oblong = _slides(row), row.get("shape") in ("both", "oblong elements")
    return {
        "shape": shape_of(row),
        "edges": (row["edge"], oblong),
        "modulus": row["modulus"],
        "borders": row["borders"],
        "c0": row["coupling"] / row["modulus"] if slides else 0.0,
        "direction": (slug, row["sector"]) if slides else None,
    }


def _without(name: str, parts: Mapping[str, Hashable]) -> tuple[Hashable, ...]:
    return tuple(value for part, value in parts.items() if part != name)


def _slides(row: Row) -> bool:
    return any(each.get("beta") or each.get("tau") for each in in_turn(row))


def _of_sliding(row: Row) -> dict[str, Trait]:
    angle = (int(row["sector"]) + 0.5) * math.pi / 4
    coupling: Any = row["coupling"]
    return {
        "sector": f"{row['sector']}",
        "cos of the direction": "negative" if math.cos(angle) < 0 else "positive",
        "sin of the direction": "negative" if math.sin(angle) < 0 else "positive",
        "beta": float(row["beta"]),
        "tau": float(row["tau"]),
        "coupling": abs(float(coupling)),
        "sign of c0": "positive" if coupling > 0 else "negative",
        "c0": abs(float(coupling)) / (math.pi * float(row["modulus"])),
    }
