"""Evidence of a report: one run of `verify`, committed runs of long cases, and studies."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any

from reports.results import FORMAT, STATUSES, Case, check
from reports.text import number

OWN = "This project's own cases, from committed runs: no evidence about the solver under test"


@dataclass(frozen=True)
class Evidence:
    """Cases by id (the run's own first), errata by equation, and studies by the name of their file.

    The ``origin`` of a case is its committed run (file, command, date, commit), None for the run's own.
    """

    run: Mapping[str, Any]
    cases: tuple[Case, ...]
    errata: tuple[Mapping[str, Any], ...]
    studies: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    files: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """All committed files by name."""

    @property
    def solver(self) -> str | None:
        """Name of somebody else's solver that the run is about; None where it is about this project's."""
        return solver(self.run)


def gathered(run: object, committed: Mapping[str, Mapping[str, Any]]) -> Evidence:
    """Return the run with the committed files, by name without suffix, that it does not replace.

    A case counts once: the run's own result, else that of the newest committed run in which it was judged.
    Committed runs of somebody else's solver are excluded: they are no evidence of this project's.
    Raises ResultFileError for a run, or a committed run of `verify`, that is none.
    """
    checked = check(run)
    runs = {name: check(file) for name, file in committed.items() if file.get("format") == FORMAT}
    own = {name: file for name, file in runs.items() if solver(file) is None}
    newest = sorted(own.items(), key=lambda item: str(item[1]["provenance"]["date"]), reverse=True)
    cases = {case["id"]: {**case, "origin": None} for case in checked["cases"]}
    errata = {erratum["equation"]: erratum for erratum in checked["errata"]}
    for judged in (True, False):
        for name, file in newest:
            for case in file["cases"]:
                if (case["status"] in ("pass", "fail")) == judged:
                    cases.setdefault(case["id"], {**case, "origin": _origin(name, file)})
    for _, file in newest:
        for erratum in file["errata"]:
            errata.setdefault(erratum["equation"], erratum)
    studies = {name: file for name, file in committed.items() if name not in runs}
    return Evidence(checked, tuple(cases.values()), tuple(errata.values()), studies, committed)


def _origin(name: str, file: Mapping[str, Any]) -> dict[str, Any]:
    made = {key: file["provenance"][key] for key in ("date", "commit", "command")}
    return {"file": f"{name}.json", **made}


@dataclass(frozen=True)
class Group:
    """Cases that are counted together; ``title`` is "" where there is but one group."""

    title: str
    cases: Sequence[Case]

    @property
    def counts(self) -> dict[str, int]:
        """Number of cases by status."""
        return {status: sum(c["status"] == status for c in self.cases) for status in STATUSES}

    @property
    def not_passed(self) -> list[Case]:
        """The cases to look at first."""
        return [c for c in self.cases if c["status"] != "pass"]


def groups(evidence: Evidence) -> list[Group]:
    """Return all cases; where somebody else's solver was run, its own ones apart from this project's."""
    if evidence.solver is None:
        return [Group("", evidence.cases)]
    theirs = [c for c in evidence.cases if c["origin"] is None]
    ours = [c for c in evidence.cases if c["origin"] is not None]
    return [Group(f"The solver under test, {evidence.solver}", theirs), Group(OWN, ours)]


ELSEWHERE = ("--only", "--tier", "--jobs", "--json")
"""Options of `verify` that are no part of which solver is run, and how; each has a value."""


def solver(results: Mapping[str, Any]) -> str | None:
    """Name of the solver under test: its MODULE:FUNCTION or command; None for the project's own cases."""
    solver = results.get("solver")
    return None if solver is None else str(solver["name"])


def rerun(command: str, case_id: str) -> str:
    """Return the command that runs one case with the solver, its abilities and limits as in ``command``."""
    words, kept = iter(shlex.split(command)[1:]), []
    for word in words:
        option, equals, _ = word.partition("=")
        # argparse takes a beginning that is no other option's, so whatever begins one of these is meant by it
        if len(option) <= 2 or not any(name.startswith(option) for name in ELSEWHERE):
            kept.append(word)
        elif not equals:
            next(words, None)
    return shlex.join(["rough-friction", *kept, "--only", case_id])


NOT_KNOWN = "n/a"


def revisions_of(evidence: Evidence) -> list[tuple[str, str, str]]:
    """Return the file, date and commit of every result file of the report; the run first."""
    rows = [("this run", *_made(evidence.run.get("provenance")))]
    for name, file in sorted(evidence.files.items()):
        provenance = file.get("provenance") if file.get("format") == FORMAT else newest(file)
        rows.append((f"{name}.json", *_made(provenance)))
    return rows


def newest(document: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Return the provenance of a study's document or newest run; else the document, if it is dated."""
    listed = [entry for value in document.values() if isinstance(value, list) for entry in value]
    items = [item for item in (document, *listed) if isinstance(item, Mapping)]
    records = [item["provenance"] for item in items if "provenance" in item]
    otherwise = document if "date" in document else None
    return max(records, key=lambda record: str(record["date"]), default=otherwise)


def _made(provenance: Mapping[str, Any] | None) -> tuple[str, str]:
    if provenance is None:
        return NOT_KNOWN, NOT_KNOWN
    commit = str(provenance.get("commit") or NOT_KNOWN)[:12]
    changed = " and uncommitted changes" if provenance.get("dirty") else ""
    return str(provenance.get("date"))[:10], f"{commit}{changed}"


_CLOCKS = timedelta(days=1)  # by which clocks and time zones of two machines differ
_SHOWN = 12  # cases that one sentence names
_RUN = "this run"


def departures(
    evidence: Evidence,
    registered: Mapping[str, Mapping[str, Any]],
    known: Callable[[str], bool],
    now: datetime,
) -> list[str]:
    """Return a sentence for each kind of departure in each file; none where all agree.

    ``registered``: claim, metric, tolerance and tier of this version's cases by id; ``known`` returns whether
    a commit is one of the checkout, and True where there is none.
    """
    made = {_RUN: evidence.run["provenance"]}
    found: dict[tuple[str, str], list[str]] = {}
    for case in evidence.cases:
        file = _RUN if case["origin"] is None else case["origin"]["file"]
        made.setdefault(file, case["origin"])
        for kind, text in _of_case(case, registered.get(case["id"])):
            found.setdefault((file, kind), []).append(text)
    if evidence.solver is None and not evidence.run["only"]:
        ids = {case["id"] for case in evidence.run["cases"]}
        tiers = ("quick", evidence.run["tier"])
        missing = [id for id, row in registered.items() if row["tier"] in tiers and id not in ids]
        found |= {(_RUN, "cases of its tier that are missing"): missing} if missing else {}
    said = [f"{file}: {kind}: {_listed(texts)}" for (file, kind), texts in found.items()]
    return said + [f"{file}: {text}" for file, one in made.items() for text in _of_origin(one, known, now)]


def _of_case(case: Case, row: Mapping[str, Any] | None) -> Iterator[tuple[str, str]]:
    """Yield the kinds of departure of a case, each with the case's id and both values."""
    id = case["id"]
    if row is None:
        yield "cases that this version does not have", id
        return
    if case["claim"] != row["claim"]:
        yield "another claim than this version's", id
    if case["metric"] != row["metric"]:
        yield "another metric than this version's", f"{id} ({case['metric']}, not {row['metric']})"
    if case["tolerance"] != row["tolerance"]:
        stated, own = number(case["tolerance"]), number(row["tolerance"])
        yield "another tolerance than this version's", f"{id} ({stated}, not {own})"


def _of_origin(made: Mapping[str, Any], known: Callable[[str], bool], now: datetime) -> Iterator[str]:
    try:
        stated = datetime.fromisoformat(made["date"])
        if stated.replace(tzinfo=stated.tzinfo or UTC) > now + _CLOCKS:
            yield f"its date {made['date']} is in the future"
    except ValueError:
        yield f"its date {made['date'][:40]!r} is no date"
    if made["commit"] is not None and not known(made["commit"]):
        yield f"its commit {made['commit'][:12]!r} is none of this checkout's"


def _listed(texts: list[str]) -> str:
    more = f" and {len(texts) - _SHOWN} more" if len(texts) > _SHOWN else ""
    return ", ".join(texts[:_SHOWN]) + more
