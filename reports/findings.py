"""Sentences with numbers from cases: ``{case | key | format}`` in a text becomes the case's number.

A key is "value", "error", or a name in the case's data; ``#`` goes one step into a list or table ("margin#2",
"numbers#mu") or takes "max", the largest magnitude of a list.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from reports.results import Case

MISSING = "n/a"
LIMIT = 2.0  # per cent: the paper's "less than 2%"
_FIELD = re.compile(r"\{([^|{}]+)\|([^|{}]+)\|([^|{}]*)\}")
READINGS = ("self", "in line", "across")  # ends of the names of the readings of "less than 2%"


def by_claim(cases: Iterable[Case]) -> dict[str, Case]:
    """Return the cases by id without "-full": the long case where it passed, else the quick one."""

    def preference(case: Case) -> int:
        long = str(case["id"]).endswith("-full")
        return 0 if long and case["status"] != "pass" else 1 + long

    return {str(case["id"]).removesuffix("-full"): case for case in sorted(cases, key=preference)}


def filled(text: str, cases: Mapping[str, Case]) -> str:
    """Return the text with its numbers; ``n/a`` where the case or the number is missing.

    >>> filled("{a/1 | value | .1%}, {a/1 | x#1 | d}", {"a/1": {"value": 0.0123, "data": {"x": [1, 2]}}})
    '1.2%, 2'
    """

    def put(match: re.Match[str]) -> str:
        case, key, form = (part.strip() for part in match.groups())
        if key == "note" and case in cases:
            return note(cases[case])
        found = number(cases[case], key) if case in cases else None
        if found is None:
            return MISSING
        return f"{round(found):d}" if form == "d" else format(found, form)

    return _FIELD.sub(put, text)


def note(case: Case) -> str:
    """Return the first statement of a case's note.

    >>> note({"data": {}, "note": "1 (of 2; 3) by Eq. (1); more. And more"})
    '1 (of 2; 3) by Eq. (1)'
    """
    return re.split(r"(?:;|(?<!Eq)(?<!Eqs)(?<!Fig)\.) (?![^(]*\))", case["note"])[0]


def fields(text: str) -> list[tuple[str, str]]:
    """Return the cases and keys that a text names."""
    return [(case.strip(), key.strip()) for case, key, _ in _FIELD.findall(text)]


def number(case: Case, key: str) -> float | None:
    """Return the number of a case under a key; None where it is missing or no number."""
    if key in ("value", "error"):
        found: Any = case[key]
    elif key in ("#below 2", "#readings"):
        found = _readings(case["data"], below=key == "#below 2")
    else:
        found = _step_by_step(case["data"], key.split("#"))
    return float(found) if isinstance(found, int | float) and not isinstance(found, bool) else None


def _step_by_step(data: Any, steps: list[str]) -> Any:
    for step in steps:
        if isinstance(data, Mapping):
            data = data.get(step)
        elif isinstance(data, list) and step == "max":
            sizes = [abs(v) for v in data if isinstance(v, int | float)]
            data = max(sizes) if sizes else None
        elif isinstance(data, list) and step.isdigit() and int(step) < len(data):
            data = data[int(step)]
        else:
            return None
    return data


def _readings(data: Mapping[str, Any], *, below: bool) -> int | None:
    """Return the number of readings of "less than 2%", or share that holds (per cent)."""
    rows = [row for name, row in data.items() if name.endswith(READINGS) and isinstance(row, list)]
    sizes = [v for row in rows for v in row if isinstance(v, int | float)]
    return sum(abs(v) < LIMIT for v in sizes) if below else len(sizes)
