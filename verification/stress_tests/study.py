"""The study: all states of all axes, one after another, with the tables that the report shows."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import asdict
from typing import Any

from refimpl.operating_system import processor_time
from verification.exact import lawful_states
from verification.framework.case import jsonable
from verification.output.provenance import provenance
from verification.stress_tests import conditioning
from verification.stress_tests.axes import AXES, states
from verification.stress_tests.judge import judged
from verification.stress_tests.limits import LIMITS, limits_of
from verification.stress_tests.state import Extreme, Judged, Verdict

FORMAT = "rough-friction extremes, version 1"
Row = dict[str, Any]
"""One state as JSON: what `Extreme` and `Judged` hold, its id, digits and seconds of processor time."""


class OutOfTime(Exception):
    """A state did not end within its processor time."""


def run_state(unique: str, extreme: Extreme) -> Row:
    """Run one state within its time."""
    started = time.process_time()
    late = OutOfTime(f"no end within {extreme.seconds:g} s of processor time")
    with processor_time(extreme.seconds, late):
        found = judged(extreme.run)
    return {
        "id": unique, "axis": unique.split("/")[0],
        "series": extreme.series, "at": extreme.at, "x": extreme.x,
        **asdict(found), "verdict": found.verdict.value, "digits": found.digits,
        "kind": kind_of(unique, found),
        "seconds": round(time.process_time() - started, 3),
    }  # fmt: skip


def kind_of(unique: str, outcome: Judged) -> str | None:
    """Return what stands behind a state that is not solved; None where not exactly one limit says it.

    A limit by ids excuses what the solver reports, not a judge that failed.
    """
    found = limits_of(unique, outcome)
    by_rule = outcome.verdict is Verdict.UNJUDGED and any(limit.rule for limit in found)
    named = len(found) == 1 and (by_rule or outcome.verdict is Verdict.DETECTED)
    return found[0].kind.value if named else None


def unexplained(rows: Iterable[Row]) -> list[str]:
    """Return the ids of states that are neither right nor of a kind: wrong ones and crashes are always."""
    return [row["id"] for row in rows if row["verdict"] != Verdict.RIGHT and row["kind"] is None]


def run(names: Iterable[str] = (), tick: Callable[[str], None] = lambda _: None) -> list[Row]:
    """Return the rows of the named axes (all by default)."""
    rows = []
    for name in tuple(names) or AXES:
        for unique, extreme in states(name):
            rows.append(run_state(unique, extreme))
            tick(f"{rows[-1]['verdict']:<14} {unique}")
    return rows


def counts(rows: Iterable[Row]) -> dict[str, int]:
    """Return the number of states by verdict."""
    found = Counter(row["verdict"] for row in rows)
    return {verdict.value: found[verdict.value] for verdict in Verdict}


def summary(rows: Iterable[Row]) -> list[Row]:
    """Return the table of axes and series: range, verdicts, fewest and median digits of the right ones."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row["axis"], row["series"]), []).append(row)
    found = []
    for (axis, series), group in groups.items():
        digits = sorted(row["digits"] for row in group if row["verdict"] == Verdict.RIGHT)
        oracles = dict.fromkeys(row["oracle"] for row in group if row["oracle"] != "none")
        found.append(
            {
                "axis": axis, "series": series, "from": group[0]["at"], "to": group[-1]["at"],
                "states": len(group), **counts(group), "oracle": ", ".join(oracles),
                "fewest digits": digits[0] if digits else None,
                "median digits": digits[len(digits) // 2] if digits else None,
            }
        )  # fmt: skip
    return found


def document(rows: list[Row]) -> dict[str, Any]:
    """Return the result file: states, table, condition numbers, lawful states, limits."""
    plain = jsonable(
        {
            "format": FORMAT,
            "counts": counts(rows),
            "table": summary(rows),
            "limits": [limit._asdict() for limit in LIMITS],
            "not solved": Counter(row["kind"] for row in rows if row["kind"] is not None),
            "states": rows,
            "conditioning": conditioning.table(),
            "lawful states": [lawful_states.count(tau)._asdict() for tau in lawful_states.TAUS],
        }
    )
    assert isinstance(plain, dict)
    return {**plain, "provenance": provenance()}
