"""The validation report: one HTML page that needs nothing else, from result files alone."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from reports import contestant, drawing, figures
from reports.chapters import CHAPTERS, exhibits_of, subjects_of, unplaced
from reports.comparison import compared
from reports.evidence import Evidence, gathered
from reports.exhibit import address, as_csv
from reports.results import Case, CaseDataError, ResultFileError, by, worst
from reports.summary import groups
from reports.traceability import traced

_OTHER_SHAPE = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
"""Exceptions of drawing where data are not of the shape that a figure needs."""


def render(
    results: object,
    committed: Mapping[str, Mapping[str, Any]] | None = None,
    against: object | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> str:
    """The page of a run, with committed result files by name, and what changed against an older run.

    ``progress`` is called with every case and figure before drawing.
    Raises ResultFileError (a ValueError) for anything but result files.
    """
    evidence = gathered(results, committed or {})

    def case_pictures(case: Case) -> list[Mapping[str, Any]]:
        progress(case["id"])
        try:
            return pictures(case, evidence)
        except _OTHER_SHAPE as broken:
            raise CaseDataError(f"data of case {case['id']!r}: {broken}", case["origin"]) from broken

    def one_picture(figure: drawing.Figure, data: Mapping[str, Any]) -> Mapping[str, Any]:
        progress(figure.caption)
        try:
            return picture(figure, data)
        except _OTHER_SHAPE as broken:
            raise ResultFileError(f"data of the figure {figure.caption!r}: {broken}") from broken

    environment = Environment(
        loader=PackageLoader("reports"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(number=number, anchor=anchor)
    return environment.get_template("report.html").render(
        run=evidence.run,
        evidence=evidence,
        provenance=evidence.run["provenance"],
        paper=traced(evidence.cases, evidence.errata),
        claims=[(claim, group, worst(group)) for claim, group in by(list(evidence.cases), "claim").items()],
        chapters=[(c, subjects_of(c, evidence), exhibits_of(c, evidence)) for c in CHAPTERS],
        unplaced=unplaced(evidence),
        leading=leading(evidence),
        solver=evidence.solver,
        groups=groups(evidence),
        changes=None if against is None else compared(against, results),
        judgement=judgement,
        facts=facts,
        rerun=lambda case: rerun(case, evidence),
        pictures=case_pictures,
        picture=one_picture,
        cell=cell,
    )


def number(value: float | None, digits: int = 4) -> str:
    """A number for a table; what was not measured is "n/a", never 0.

    >>> number(None), number(0.25), number(171.0512, 6)
    ('n/a', '0.25', '171.051')
    """
    return "n/a" if value is None else f"{value:.{digits}g}"


def anchor(case_id: str) -> str:
    """The fragment that links to a case; different ids have different ones.

    >>> anchor("hertz/peak-order"), anchor("a.b")
    ('case-hertz.peak-order', 'case-a_2e_b')
    """
    kept = (c if c.isalnum() or c == "-" else "." if c == "/" else f"_{ord(c):x}_" for c in case_id)
    return "case-" + "".join(kept)


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


def rerun(case: Case, evidence: Evidence) -> str:
    """The command that runs this case alone, with the solver that it was run with."""
    if evidence.solver is not None and case["origin"] is None:
        return contestant.rerun(evidence.run["provenance"]["command"], case["id"])
    tier = " --tier full" if case["tier"] == "full" else ""
    return f"rough-friction verify{tier} --only {shlex.quote(case['id'])}"


def cell(value: Any) -> str:
    """A table's cell: numbers to four digits, whole numbers and texts as they are.

    >>> cell(0.123456), cell(512), cell(True), cell(None)
    ('0.1235', '512', 'yes', 'n/a')
    """
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number(value) if isinstance(value, float | None) else str(value)


def picture(figure: drawing.Figure, data: Mapping[str, Any]) -> Mapping[str, Any]:
    """A figure and its data as addresses, None where the data are missing, and the caption."""
    svg = drawing.svg(figure, data)
    return {
        "caption": figure.caption,
        "address": None if svg is None else address(svg, "image/svg+xml"),
        "csv": None if svg is None else address(as_csv(figure, data), "text/csv"),
    }


def pictures(case: Case, evidence: Evidence) -> list[Mapping[str, Any]]:
    """The case's figures; none where its long twin, which has the same ones with less scatter, passed."""
    twin = f"{case['id']}-full"
    if any(other["id"] == twin and other["status"] == "pass" for other in evidence.cases):
        return []
    return [picture(f, case["data"]) for f in figures.figures_of(case["id"], case["data"])]


LEADING = (
    ("reproduction/fig8-exponential-full", "reproduction/fig8-exponential"),
    ("fem3d/error-map", "appendix-figures/fig12", "appendix-fem/map"),
    ("hertz/peak-order",),
)
"""Cases whose first figure opens the report, each with its stand-ins."""


def leading(evidence: Evidence) -> list[tuple[Case, Mapping[str, Any]]]:
    """The figures of the first page, with their cases; none where another's solver was run: they are ours."""
    if evidence.solver is not None:
        return []
    cases = {case["id"]: case for case in evidence.cases}
    found = []
    for ids in LEADING:
        for case in (cases[id] for id in ids if id in cases):
            drawn = [picture(f, case["data"]) for f in figures.figures_of(case["id"], case["data"])[:1]]
            if drawn and drawn[0]["address"]:
                found.append((case, drawn[0]))
                break
    return found
