"""From rounds to a table: medians with their spread, ratios within rounds, and counted operations."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Sequence
from typing import Any

from verification.benchmarks.codes import ALONE, OWN
from verification.benchmarks.rounds import TARGET, Found, Turns, error

TIMED = ("seconds", "processor seconds", "seconds again", "peak memory")  # again: in the same process
JUDGED = ("gap", "balance", "penetration", "tension", "area", "peak", "converged", "operations", "padded box")


def spread(values: Iterable[float]) -> dict[str, float]:
    """Return the median, least and largest.

    >>> spread([3.0, 1.0, 2.0])
    {'median': 2.0, 'least': 1.0, 'most': 3.0}
    """
    known = list(values)
    return {"median": statistics.median(known), "least": min(known), "most": max(known)}


def row(turns: Turns) -> dict[str, object]:
    """Time one code on one problem."""
    head: dict[str, object] = {
        name: getattr(turns, name) for name in ("code", "kind", "M", "tolerance", "failure")
    }
    if not turns.rounds:
        return head
    last = turns.rounds[-1]
    series: dict[str, list[float]] = {
        name: [found[name] for found in turns.rounds if found[name] is not None] for name in TIMED
    }
    series["memory of the solve"] = [found["peak memory"] - found["memory before"] for found in turns.rounds]
    numbers: dict[str, object] = {name: spread(values) for name, values in series.items() if values}
    numbers["meets the target"] = all(error(found) <= TARGET for found in turns.rounds)
    logs = last["operations"].get("n log2 n")
    if logs is not None:
        points = math.prod(last["padded box"])
        numbers["convolution equivalents"] = logs / (points * math.log2(points))
    return head | numbers | {name: last[name] for name in JUDGED}


def ratios(turns: Sequence[Turns]) -> dict[str, object]:
    """Return each code's seconds over this code's on a problem, by rounds; under `ALONE` over its solver's.

    Processor seconds beside: they hear less of what else the machine does.
    """
    by_code = {one.code: one.rounds for one in turns if one.rounds}
    own, alone = by_code.pop(OWN, None), by_code.get(ALONE, [])
    if own is None:
        return {}
    return {
        code: {clock: _over(rounds, own, clock) for clock in ("seconds", "processor seconds")}
        | ({ALONE: {"seconds": _over(rounds, alone, "seconds")}} if alone else {})
        for code, rounds in by_code.items()
    }


def _over(theirs: Sequence[Found], ours: Sequence[Found], clock: str) -> dict[str, float]:
    return spread(one[clock] / other[clock] for one, other in zip(theirs, ours, strict=False))


def lines(rows: Sequence[Any], ratios: Sequence[Any]) -> list[list[str]]:
    """Return the run as rows of text: problem, code, seconds, ratio, gap, convolutions, megabytes."""
    over = {(r["kind"], r["M"], code): r[code] for r in ratios for code in r if isinstance(r[code], dict)}
    text = [["problem", "code", "seconds", "ratio to this code", "gap", "convolutions", "peak memory"]]
    for entry in rows:
        head = [f"{entry['kind']} {entry['M']}", entry["code"]]
        if "seconds" not in entry:
            text.append([*head, *[""] * 4, entry["failure"]])
            continue
        ratio = over.get((entry["kind"], entry["M"], entry["code"]))
        equivalents = entry.get("convolution equivalents")
        text.append(
            [
                *head,
                f"{entry['seconds']['median']:.3g}",
                "" if ratio is None else f"{ratio['seconds']['median']:.3g}",
                f"{entry['gap']:.1e}",
                "" if equivalents is None else f"{equivalents:.1f}",
                f"{entry['peak memory']['median'] / 1e6:.0f} MB",
            ]
        )
    return text
