"""Diagnosis of a faulty solver: a short list of the dimensions where problems of the covering designs fail.

The traits of a problem are the levels of its row, and what follows from them. Names are the design's
dimensions. Numbers are compared with thresholds; texts and truths are equal or not.
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Hashable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from verification.framework.case import Result
from verification.solver_suite.design import HEIGHT, Row, further_rows, in_turn, rows, shape_of
from verification.solver_suite.dimensions import FURTHER, PRESSURES

ITERATIONS = {
    f"design-{design}-{number:02}": count
    for design, counts in json.loads(
        Path(__file__).with_name("iterations.json").read_text(encoding="utf-8")
    ).items()
    for number, count in enumerate(counts, start=1)
}
"""By slug: iterations of constrained conjugate gradients to a tenth of 1e-8, with 2000 as their limit.

Counted once, at commit 43108c8b, by its `verification.solver_suite.compact`; in the order of the rows. Large
grids and problems with a hardness are not counted.
"""

Trait = float | str | bool | None
"""Value of a dimension; None where the problem has the dimension and no condition is to name it."""
OF_SLIDING = ("c0", "direction")
PARTS = ("edges", "modulus", "borders", *OF_SLIDING)
"""Parts of a problem that its operators depend on, beside its shape."""


@cache
def _rows(further: bool) -> Mapping[str, Row]:
    """Rows by slug in the order of the suite, those of the further designs too where asked for."""
    designs = rows() | (further_rows() if further else {})
    return {
        f"design-{design}-{number:02}": row
        for design, found in designs.items()
        for number, row in enumerate(found, start=1)
    }


def levels(slug: str) -> dict[str, Trait] | None:
    """Return the traits of a problem by its slug; or None for a case of no design.

    >>> levels("design-plain-01")["parity"]
    'odd'

    A dimension that a problem does not have, such as beta without friction, is no trait.
    """
    further = slug.removeprefix("design-").rpartition("-")[0] in FURTHER
    row = _rows(further).get(slug)
    if row is None:
        return None
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
    if not _slides(row):
        return traits
    angle, coupling = (int(row["sector"]) + 0.5) * math.pi / 4, float(row["coupling"])
    return traits | {
        "sector": f"{row['sector']}",
        "cos of the direction": "negative" if math.cos(angle) < 0 else "positive",
        "sin of the direction": "negative" if math.sin(angle) < 0 else "positive",
        "beta": float(row["beta"]),
        "tau": float(row["tau"]),
        "coupling": abs(coupling),
        "sign of c0": "positive" if coupling > 0 else "negative",
        "c0": abs(coupling) / (math.pi * E),
    }


@cache
def _first_of_their_shapes(further: bool) -> frozenset[str]:
    """Slugs of the problems before which none of their shape and borders is posed; of no problems in turn."""
    first: dict[tuple[tuple[int, int], str], str] = {}
    for slug, row in _rows(further).items():
        first.setdefault((shape_of(row), row["borders"]), slug)
    return frozenset(slug for slug in first.values() if "-memory-" not in slug)


@cache
def _changed_parts(further: bool) -> dict[str, frozenset[str]]:
    """By slug: the parts in which alone a problem differs from an earlier one of its shape.

    A memory that forgets such a part hands the operators of the earlier problem out again.
    """
    met: dict[tuple[Hashable, ...], set[Hashable]] = {}
    changed: dict[str, frozenset[str]] = {}
    for slug, base in _rows(further).items():
        for parts in (_parts(row, slug) for row in in_turn(base)):
            others = {
                name: met.setdefault((name, *(parts[part] for part in parts if part != name)), set())
                for name in PARTS
            }
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


def _slides(row: Row) -> bool:
    return any(each.get("beta") or each.get("tau") for each in in_turn(row))


LISTED = 3
PAIR = 0.04
"""Score that a pair of conditions loses to a single one."""
DOUBTS = 2
"""Problems that are taken to speak against each condition: a failure outside it and a pass within it.

What one or two problems show may be chance; what ten show is little changed (Laplace's rule of succession).
"""
SHARE = 0.1
"""Score of a condition that explains all failures, those among problems without its dimension too."""


class Condition(NamedTuple):
    """Condition on one dimension: ``name``, the words that follow it, and the problems that meet it."""

    name: str
    words: str
    met: NDArray[np.bool_]

    def __str__(self) -> str:
        return f"{self.name} {self.words}".strip()


def short_list(failed: Mapping[str, bool], most: int = LISTED) -> list[str]:
    """Return conditions under which problems fail, best first, from slugs and whether each failed.

    Candidates are conditions on one dimension, or on two. Their score is ``2 n / (f + s + 2) + 0.1 n / F``:
    n failures meet the condition, of s problems that meet it, of f failures among the problems that have the
    dimension, and of F in all. The first term is the F measure with two `DOUBTS`: a fault that fails
    elsewhere too, by another way, is named by its dimension all the same. The second term prefers conditions
    that explain more of the failures.

    >>> from verification.solver_suite.design import rows
    >>> slugs = [f"design-plain-{n:02}" for n in range(1, 49)]
    >>> short_list({slug: levels(slug)["borders"] == "periodic" for slug in slugs})[0]
    'borders = periodic'
    """
    traits = {slug: found for slug in failed if (found := levels(slug)) is not None}
    fails = np.array([failed[slug] for slug in traits], dtype=np.float64)
    if not fails.any():
        return []
    if fails.all():
        return ["everywhere"]
    conditions, has = _conditions(list(traits.values()))
    met = np.array([each.met for each in conditions], dtype=np.float64)
    known = np.array([has[each.name] for each in conditions], dtype=np.float64)
    hits, covered, failures = (met * fails) @ met.T, met @ met.T, (known * fails) @ known.T
    score = 2 * hits / (failures + covered + DOUBTS) + SHARE * hits / fails.sum()
    score -= PAIR * ~np.eye(len(conditions), dtype=bool)
    return _best(conditions, score, most)


def _best(conditions: list[Condition], score: NDArray[np.float64], most: int) -> list[str]:
    """The best conditions on different dimensions; a pair behind a single one of its two says no more."""
    rows, columns = np.triu_indices(len(conditions))
    order = np.argsort(-score[rows, columns], kind="stable")
    listed: dict[frozenset[str], str] = {}
    for i, j in zip(rows[order], columns[order], strict=True):
        one, other = conditions[i], conditions[j]
        names = frozenset((one.name, other.name))
        follows = not (one.met & ~other.met).any() or not (other.met & ~one.met).any()
        if any(names >= known for known in listed) or (i != j and (len(names) == 1 or follows)):
            continue
        listed[names] = str(one) if i == j else f"{one} and {other}"
        if len(listed) == most:
            break
    return list(listed.values())


def _conditions(traits: list[dict[str, Trait]]) -> tuple[list[Condition], dict[str, NDArray[np.bool_]]]:
    """All conditions that some problems meet and others do not; and which problems have each dimension."""
    names = list(dict.fromkeys(itertools.chain(*traits)))
    has = {name: np.array([name in each for each in traits]) for name in names}
    found = [each for name in names for each in _of(name, [one.get(name) for one in traits])]
    return [each for each in found if each.met.any()], has


def _of(name: str, values: list[Trait | None]) -> Iterator[Condition]:
    numbers = np.array([value if isinstance(value, float) else np.nan for value in values])
    for low, high in itertools.pairwise(sorted({*numbers[~np.isnan(numbers)]})):
        yield Condition(name, f"above {low:.3g}", numbers > low)
        yield Condition(name, f"below {high:.3g}", numbers < high)
    for value in dict.fromkeys(value for value in values if isinstance(value, str | bool)):
        words = f"= {value}" if isinstance(value, str) else "" if value else "not"
        yield Condition(name, words, np.array([v == value for v in values]))


def of_results(results: Iterable[Result]) -> list[str]:
    """Return the short list of a run: problems of the designs that failed or broke, among those judged."""
    judged = [r for r in results if r.status != "unavailable"]
    return short_list({r.id.partition("/")[2]: r.status != "pass" for r in judged})
