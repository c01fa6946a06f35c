"""The report: one HTML page that needs nothing else, from result files alone."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from reports import agreement
from reports.catalogue import figures_of
from reports.chapters import all_chapters, exhibits_of, subjects_of
from reports.claims import judged, of_the_conversion, shown, statements
from reports.drawing import Figure
from reports.evidence import Evidence, gathered, groups, revisions_of
from reports.evidence import rerun as rerun_with
from reports.exhibit import Album
from reports.findings import by_claim
from reports.front_page import AGREEMENT, front_page
from reports.results import Case, CaseDataError, compared, shaped, shown_status
from reports.text import cell, decimals, interval, judgement, number, quoted, symbols


def render(
    results: object,
    committed: Mapping[str, Mapping[str, Any]] | None = None,
    against: object | None = None,
    progress: Callable[[str], None] = lambda _: None,
    departures: Sequence[str] = (),
) -> str:
    """Return the page of a run, with committed result files by name, and what changed against an older run.

    ``progress`` is called with every case and figure before drawing. The first page has the ``departures``.
    Raises ResultFileError (a ValueError) for anything but result files.
    """
    evidence = gathered(results, committed or {})
    album = Album()

    def case_pictures(case: Case) -> list[Mapping[str, Any] | None]:
        progress(case["id"])
        with shaped(f"data of case {case['id']!r}", lambda text: CaseDataError(text, case["origin"])):
            return [album.add(figure, case["data"], case["title"]) for figure in figures_of(case["id"])]

    def one_picture(figure: Figure, data: Mapping[str, Any]) -> Mapping[str, Any] | None:
        progress(figure.caption)
        with shaped(f"data of the figure {figure.caption!r}"):
            return album.add(figure, data)

    environment = Environment(
        loader=PackageLoader("reports"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(number=number, anchor=anchor, symbols=symbols, quoted=quoted, label=label)
    environment.filters.update(status=shown_status)
    template = environment.get_template("solver.html" if evidence.solver is not None else "report.html")
    with shaped("a study"):  # its file is checked by being shown
        own = {"statements": {}} if evidence.solver is not None else _own(evidence, one_picture)
        page = template.render(
            run=evidence.run,
            evidence=evidence,
            provenance=evidence.run["provenance"],
            departures=departures,
            revisions=revisions_of(evidence),
            solver=evidence.solver,
            changes=None if against is None else compared(against, results),
            judgement=judgement,
            interval=interval,
            decimals=decimals,
            facts=facts,
            again=again(evidence),
            rerun=lambda case: rerun(case, evidence),
            pictures=case_pictures,
            picture=one_picture,
            cell=cell,
            groups=groups(evidence),
            **own,
        )
    return page.replace("/* figures */", album.styles)


def _own(evidence: Evidence, picture: Any) -> dict[str, Any]:
    claims = judged(evidence.cases, evidence.errata)
    numbers = agreement.numbers(by_claim(evidence.cases))
    return {
        "front": front_page(evidence, claims, numbers),
        "claims": claims,
        "statements": statements(claims),
        "of_the_conversion": of_the_conversion(),
        "numbers": numbers,
        "scatter": picture(AGREEMENT, agreement.series(agreement.compared(numbers))) if numbers else None,
        "parts": shown(claims, numbers, evidence.cases),
        "chapters": [
            (chapter, subjects, exhibits)
            for chapter in all_chapters(evidence)
            for subjects, exhibits in [(subjects_of(chapter, evidence), exhibits_of(chapter, evidence))]
            if subjects or exhibits or chapter.body
        ],
    }


def anchor(case_id: str) -> str:
    """Return the fragment that links to a case; different ids have different ones.

    >>> anchor("hertz/peak-order"), anchor("a.b")
    ('case-hertz.peak-order', 'case-a_2e_b')
    """
    kept = (c if c.isalnum() or c == "-" else "." if c == "/" else f"_{ord(c):x}_" for c in case_id)
    return "case-" + "".join(kept)


def label(text: str) -> str:
    """Return a fragment of letters, digits and hyphens.

    >>> label("Fig. 6(a)")
    'fig-6-a'
    """
    return "-".join("".join(c if c.isalnum() else " " for c in text.lower()).split())


def facts(data: Mapping[str, Any], most: int = 12) -> list[tuple[str, str]]:
    """Return the single numbers and texts that a case recorded, and its small tables of them, ready to print.

    >>> facts({"worst": 1e-15, "by grid": {"64": 0.1, "128": 0.05}, "series": [1, 2, 3]})
    [('worst', '1e-15'), ('by grid', '64: 0.1, 128: 0.05')]
    """
    found = []
    for name, value in data.items():
        if name == "verdict":  # on the statements that the check is evidence of: the table of claims has it
            continue
        if isinstance(value, Mapping) and 0 < len(value) <= most and all(map(_single, value.values())):
            found.append((name, ", ".join(f"{key}: {_text(entry)}" for key, entry in value.items())))
        elif _single(value):
            found.append((name, _text(value)))
    return found


def _single(value: object) -> bool:
    return value is None or isinstance(value, str | int | float)


def _text(value: Any) -> str:
    return str(value) if isinstance(value, str | bool) else number(value)


def again(evidence: Evidence) -> str:
    """Return a command that makes the run again; that of a solver under test is the recorded one."""
    run = evidence.run
    if evidence.solver is not None:
        return str(run["provenance"]["command"])
    only = "".join(f" --only {shlex.quote(pattern)}" for pattern in run["only"])
    return f"rough-friction verify --tier {run['tier']}{only} --json results.json"


def rerun(case: Case, evidence: Evidence) -> str:
    """Return the command that runs this case alone, with the solver that it was run with."""
    if evidence.solver is not None and case["origin"] is None:
        return rerun_with(evidence.run["provenance"]["command"], case["id"])
    tier = " --tier full" if case["tier"] == "full" else ""
    return f"rough-friction verify{tier} --only {shlex.quote(case['id'])}"
