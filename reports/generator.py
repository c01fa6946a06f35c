"""The validation report: one HTML page that needs nothing else, from a result file alone."""

from __future__ import annotations

import base64
import shlex
from collections.abc import Mapping
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from reports import drawing, figures
from reports.results import Case, by, by_subject, check, worst


def render(results: object) -> str:
    """The page. Raises ResultFileError (a ValueError) for anything but a result file."""
    checked = check(results)
    environment = Environment(
        loader=PackageLoader("reports"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(number=number, anchor=anchor)
    cases: list[Case] = checked["cases"]
    return environment.get_template("report.html").render(
        results=checked,
        counts=checked["counts"],
        provenance=checked["provenance"],
        claims=[(claim, group, worst(group)) for claim, group in by(cases, "claim").items()],
        subjects=by_subject(cases),
        judgement=judgement,
        facts=facts,
        rerun=rerun,
        pictures=pictures,
    )


def number(value: float | None, digits: int = 4) -> str:
    """A number for a table; what was not measured is "n/a", never 0.

    >>> number(None), number(0.25), number(171.0512, 6)
    ('n/a', '0.25', '171.051')
    """
    return "n/a" if value is None else f"{value:.{digits}g}"


def anchor(case_id: str) -> str:
    """The fragment that links to a case."""
    return "case-" + "".join(c if c.isalnum() else "-" for c in case_id)


def judgement(case: Case) -> str:
    """Error against tolerance, as the verdict was found."""
    if case["error"] is None:
        return "not judged"
    sign = "≥" if case["metric"] == "at_least" else "≤"
    sign = sign if case["status"] == "pass" else {"≥": "<", "≤": ">"}[sign]
    return f"{number(case['error'], 3)} {sign} {number(case['tolerance'], 3)}"


def facts(data: Mapping[str, Any], most: int = 12) -> list[tuple[str, str]]:
    """The single numbers and texts that a case recorded, and its small tables of them, ready to print.

    >>> facts({"worst": 1e-15, "by grid": {"64": 0.1, "128": 0.05}, "series": [1, 2, 3]})
    [('worst', '1e-15'), ('by grid', '64: 0.1, 128: 0.05')]
    """
    found = []
    for name, value in data.items():
        if isinstance(value, Mapping) and 0 < len(value) <= most and all(map(_single, value.values())):
            found.append((name, ", ".join(f"{key}: {_text(entry)}" for key, entry in value.items())))
        elif _single(value):
            found.append((name, _text(value)))
    return found


def _single(value: object) -> bool:
    return value is None or isinstance(value, str | int | float)


def _text(value: Any) -> str:
    return str(value) if isinstance(value, str | bool) else number(value)


def rerun(case: Case) -> str:
    """The command that runs this case alone."""
    tier = " --tier full" if case["tier"] == "full" else ""
    return f"rough-friction verify{tier} --only {shlex.quote(case['id'])}"


def pictures(case: Case) -> list[Mapping[str, Any]]:
    """The case's figures as data addresses with captions; an `address` is None where the data are missing."""
    found: list[Mapping[str, Any]] = []
    for figure in figures.figures_of(case["id"], case["data"]):
        svg = drawing.svg(figure, case["data"])
        encoded = None if svg is None else base64.b64encode(svg.encode()).decode()
        address = None if encoded is None else f"data:image/svg+xml;base64,{encoded}"
        found.append({"caption": figure.caption, "address": address})
    return found
