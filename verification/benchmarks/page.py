"""The table of docs/costs.md, from the record of runs: ``python -m verification.benchmarks --page``.

The newest run on one thread counts in which ours and ASPHER took part with all their set-ups. A cell is the
range over the rounds, of memory the ratio of medians.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from verification.benchmarks.codes import ALONE, OWN, SHEARED, SLOPED

GRIDS = (128, 256, 512, 1024, 2048)
PEER, QUICKEST = "aspher", "aspher+options"
EVERY = frozenset({OWN, ALONE, PEER, QUICKEST, SHEARED, SLOPED})

Ratios = Mapping[str, Any]
Rows = Mapping[str, Any]
Spread = Mapping[str, float]
"""Median, and where it is known the least and the most."""
Number = Callable[[Ratios, Rows], Spread]


def over(code: str, by: str = OWN) -> Number:
    """Return a code's seconds over this code's, or its solver's: the range of the rounds."""
    return lambda ratios, rows: dict((ratios[code] if by == OWN else ratios[code][by])["seconds"])


def memory(ratios: Ratios, rows: Rows) -> Spread:
    """Return ASPHER's memory of a solve, as a ratio to this code."""
    theirs, ours = (rows[code]["memory of the solve"]["median"] for code in (PEER, OWN))
    return {"median": theirs / ours}


TABLE: dict[str, Number] = {
    "time: ASPHER (quickest options) over our solver": over(QUICKEST, by=ALONE),
    "time: ASPHER over ours with error bars": over(PEER),
    "memory: ASPHER over ours": memory,
    "our time: with friction over without": over(SHEARED),
    "our time: with friction and slopes over without": over(SLOPED),
}


def newest(
    runs: Sequence[Mapping[str, Any]], codes: frozenset[str] = EVERY
) -> dict[tuple[str, int], tuple[Ratios, Rows]]:
    """Return ratios and rows by surface and grid, of the last run on one thread with all codes."""
    found: dict[tuple[str, int], tuple[Ratios, Rows]] = {}
    for run in runs:
        if run["conditions"]["threads"] == 1 and {row["code"] for row in run["rows"]} >= codes:
            for ratios in run["ratios"]:
                at = ratios["kind"], ratios["M"]
                rows = {row["code"]: row for row in run["rows"] if (row["kind"], row["M"]) == at}
                found[at] = ratios, rows
    return found


def table(runs: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    """Return the rows of the table, each with its label and a cell per grid: smooth / rough."""
    found = newest(runs)

    def cell(number: Number, kind: str, M: int) -> str:
        return shown(number(*found[kind, M]) if (kind, M) in found else None)

    return [
        [label, *(" / ".join(cell(number, kind, M) for kind in ("smooth", "rough")) for M in GRIDS)]
        for label, number in TABLE.items()
    ]


def shown(number: Spread | None) -> str:
    """Return the range of a number.

    >>> shown({"median": 3.1, "least": 2.96, "most": 12.4}), shown({"median": 12.2}), shown(None)
    ('3.0-12', '12', '-')
    """
    if number is None:
        return "-"
    ends = number.get("least", number["median"]), number.get("most", number["median"])
    return "-".join(dict.fromkeys(f"{end:.1f}" if end < 9.95 else f"{end:.0f}" for end in ends))


def lines(runs: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the table in Markdown, and one line for each run of the record: where and how it was made."""
    text = [f"| | {' | '.join(map(str, GRIDS))} |", "|---" * (1 + len(GRIDS)) + "|"]
    text += [f"| {' | '.join(row)} |" for row in table(runs)]
    for run in runs:
        machine, asked = run["provenance"]["machine"], run["conditions"]
        sizes = ", ".join(map(str, sorted({row["M"] for row in run["rows"]})))
        load = f"{asked['load average']['before'][0]:.1f} to {asked['load average']['after'][0]:.1f}"
        text.append(
            f"{run['provenance']['date'][:10]}: {machine['processor']}, {machine['cores']} cores, threads "
            f"{asked['threads']}, {asked['rounds']} rounds at {sizes}, load {load}"
        )
    return text
