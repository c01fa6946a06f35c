"""The study: all states of all axes, one after another, resumable, with the tables that the report shows."""

from __future__ import annotations

import signal
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

import verification.extremes.axes  # noqa: F401  # registers the axes
from reports.result_files import read_result
from verification.extremes import conditioning, precision, uniqueness
from verification.extremes.limits import LIMITS
from verification.extremes.state import Extreme, Verdict, axes, states
from verification.framework.case import jsonable
from verification.framework.files import write_result
from verification.framework.provenance import provenance

FORMAT = "rough-friction extremes, version 1"
SAVED_EVERY = 20  # states: what a kill may cost
Row = dict[str, Any]
"""One state as JSON: what `Extreme` and `Judged` hold, its id, digits and seconds of processor time."""


class OutOfTime(Exception):
    """A state did not end within its processor time."""


@contextmanager
def processor_time(seconds: float) -> Iterator[None]:
    """Raise OutOfTime inside the block when it has used that much (POSIX, main thread only)."""

    def expired(*_: object) -> None:
        raise OutOfTime(f"no end within {seconds:g} s of processor time")

    before = signal.signal(signal.SIGPROF, expired)
    signal.setitimer(signal.ITIMER_PROF, seconds, 1.0)  # again, should a callback swallow the first
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def judged(extreme: Extreme) -> Row:
    """Run one state within its time."""
    started = time.process_time()
    with processor_time(extreme.seconds):
        found = extreme.run()
    head = {
        "id": extreme.id,
        "axis": extreme.axis,
        "series": extreme.series,
        "at": extreme.at,
        "x": extreme.x,
    }
    body = asdict(found) | {"verdict": found.verdict.value, "digits": found.digits}
    return head | body | {"seconds": round(time.process_time() - started, 3)}


def run(names: Iterable[str] = (), kept: Mapping[str, Row] | None = None) -> Iterator[Row]:
    """Rows of the named axes (all by default), those of ``kept`` as they are."""
    for name in tuple(names) or axes():
        for extreme in states(name):
            yield (kept or {}).get(extreme.id) or judged(extreme)


def summary(rows: Iterable[Row]) -> list[Row]:
    """The table axis x series: range, verdicts, fewest and median digits of the right ones."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row["axis"], row["series"]), []).append(row)
    found = []
    for (axis, series), group in groups.items():
        digits = sorted(row["digits"] for row in group if row["verdict"] == Verdict.RIGHT)
        counts = Counter(row["verdict"] for row in group)
        found.append(
            {
                "axis": axis,
                "series": series,
                "from": group[0]["at"],
                "to": group[-1]["at"],
                "states": len(group),
                **{verdict.value: counts[verdict.value] for verdict in Verdict},
                "fewest digits": digits[0] if digits else None,
                "median digits": digits[len(digits) // 2] if digits else None,
                "oracle": ", ".join(
                    dict.fromkeys(r["oracle"] for r in group if r["oracle"] not in ("none", "refused"))
                ),
            }
        )
    return found


def document(rows: list[Row], *, complete: bool) -> dict[str, Any]:
    """The result file: states, table, heat map of precision, condition numbers, lawful states, limits."""
    counts = Counter(row["verdict"] for row in rows)
    found: dict[str, Any] = {
        "format": FORMAT,
        "complete": complete,
        "counts": {verdict.value: counts[verdict.value] for verdict in Verdict},
        "table": summary(rows),
        "limits": [asdict(limit) for limit in LIMITS],
        "states": rows,
    }
    if complete:
        found["precision"] = precision.table()
        found["conditioning"] = conditioning.table()
        found["lawful states"] = [uniqueness.count(tau)._asdict() for tau in uniqueness.TAUS]
    plain = jsonable(found)
    assert isinstance(plain, dict)
    return {**plain, "provenance": provenance()}


def kept_rows(path: Path) -> dict[str, Row]:
    """States of an unfinished file of the same commit; anything else is begun anew."""
    try:
        before = read_result(path)
        same = before["format"] == FORMAT and before["provenance"]["commit"] == provenance()["commit"]
        return {row["id"]: row for row in before["states"]} if same and not before["complete"] else {}
    except (FileNotFoundError, ValueError, KeyError, TypeError):
        return {}


def study(
    path: Path, names: Iterable[str] = (), tick: Callable[[str], None] = lambda _: None
) -> dict[str, Any]:
    """Run, saving as it goes; go on with an unfinished file of this commit."""
    rows: list[Row] = []
    for row in run(names, kept_rows(path)):
        rows.append(row)
        tick(f"{row['verdict']:<14} {row['id']}")
        if len(rows) % SAVED_EVERY == 0:
            write_result(document(rows, complete=False), path)
    found = document(rows, complete=True)
    write_result(found, path)
    return found


def total(names: Iterable[str] = ()) -> int:
    """Number of states."""
    return sum(1 for name in tuple(names) or axes() for _ in states(name))
