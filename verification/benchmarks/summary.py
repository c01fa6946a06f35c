"""From rounds to a table: medians with their spread, ratios within rounds, and counted operations."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Sequence
from typing import Any

from verification.benchmarks.codes import OWN
from verification.benchmarks.rounds import TARGET, Turns, error

JUDGED = ("gap", "balance", "penetration", "tension", "area", "peak", "converged", "operations")


def spread(values: Iterable[float]) -> dict[str, float]:
    """Median, least and largest.

    >>> spread([3.0, 1.0, 2.0])
    {'median': 2.0, 'least': 1.0, 'most': 3.0}
    """
    known = list(values)
    return {"median": statistics.median(known), "least": min(known), "most": max(known)}


def row(turns: Turns) -> dict[str, object]:
    """One code on one problem."""
    head: dict[str, object] = {
        "code": turns.code,
        "kind": turns.kind,
        "M": turns.M,
        "tolerance": turns.tolerance,
        "failure": turns.failure,
    }
    if not turns.rounds:
        return head
    last = turns.rounds[-1]
    numbers: dict[str, object] = {
        "seconds": spread(found["seconds"] for found in turns.rounds),
        "processor seconds": spread(found["processor seconds"] for found in turns.rounds),
        "peak memory": spread(found["peak memory"] for found in turns.rounds),
        "memory of the solve": spread(
            found["peak memory"] - found["memory before"] for found in turns.rounds
        ),
        "times one convolution": spread(
            found["seconds"] / found["convolution seconds"] for found in turns.rounds
        ),
        "meets the target": all(error(found) <= TARGET for found in turns.rounds),
    }
    logs = last["operations"].get("n log2 n")
    if logs is not None:
        points = math.prod(last["padded box"])
        numbers["convolution equivalents"] = logs / (points * math.log2(points))
    return head | numbers | {name: last[name] for name in JUDGED} | {"padded box": last["padded box"]}


def ratios(turns: Sequence[Turns]) -> dict[str, object]:
    """Seconds of every code over ours on one problem, round by round; and the least of the peers': by the
    recommended set-ups, and by any.

    Processor seconds beside: they hear less of what else the machine does.
    """
    by_code = {one.code: one.rounds for one in turns if one.rounds}
    own = by_code.pop(OWN, None)
    if own is None:
        return {}
    found: dict[str, object] = {}
    medians: dict[str, float] = {}
    for code, rounds in by_code.items():
        pairs = list(zip(rounds, own, strict=False))
        found[code] = {
            clock: spread(theirs[clock] / ours[clock] for theirs, ours in pairs)
            for clock in ("seconds", "processor seconds")
        }
        if not code.startswith(OWN):
            medians[code] = spread(theirs["seconds"] / ours["seconds"] for theirs, ours in pairs)["median"]
    recommended = {code: ratio for code, ratio in medians.items() if "+" not in code}
    for name, of in (("fastest peer", recommended), ("fastest set-up of a peer", medians)):
        if of:
            fastest = min(of, key=lambda code: of[code])
            found[name] = {"code": fastest, "seconds over ours": of[fastest]}
    return found


def lines(rows: Sequence[Any], ratios: Sequence[Any]) -> list[list[str]]:
    """The run as rows of text: problem, code, seconds, over ours, gap, convolutions, megabytes."""
    over = {(r["kind"], r["M"], code): r[code] for r in ratios for code in r if isinstance(r[code], dict)}
    text = [["problem", "code", "seconds", "over ours", "gap", "convolutions", "peak memory"]]
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
