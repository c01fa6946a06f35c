"""Evidence of a report: one run of `verify`, committed runs of long cases, and studies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from reports.results import FORMAT, STATUSES, Case, check
from reports.solver_under_test import solver

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
    """The run with the committed files, by name without suffix, that it does not replace.

    A case counts once: the run's own result, else that of the newest committed run in which it was judged.
    Committed runs of somebody else's solver are excluded: they are no evidence of this project's.
    Raises ResultFileError for a run, or a committed run of `verify`, that is none.
    """
    checked = check(run)
    runs = {name: check(file) for name, file in committed.items() if file.get("format") == FORMAT}
    own = {name: file for name, file in runs.items() if solver(file) is None}
    newest = sorted(own.items(), key=lambda item: str(item[1]["provenance"]["date"]), reverse=True)
    cases = {case["id"]: _case(case, None) for case in checked["cases"]}
    errata = {erratum["equation"]: erratum for erratum in checked["errata"]}
    for judged in (True, False):
        for name, file in newest:
            for case in file["cases"]:
                if (case["status"] in ("pass", "fail")) == judged:
                    cases.setdefault(case["id"], _case(case, _origin(name, file)))
    for _, file in newest:
        for erratum in file["errata"]:
            errata.setdefault(erratum["equation"], erratum)
    studies = {name: file for name, file in committed.items() if name not in runs}
    return Evidence(checked, tuple(cases.values()), tuple(errata.values()), studies, committed)


def _case(case: Case, origin: dict[str, Any] | None) -> Case:
    return {**case, "origin": origin}


def _origin(name: str, file: Mapping[str, Any]) -> dict[str, Any]:
    provenance = file["provenance"]
    return {
        "file": f"{name}.json",
        "date": provenance["date"],
        "commit": provenance["commit"],
        "command": provenance["command"],
    }


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
    """All cases; where somebody else's solver was run, its own ones apart from this project's."""
    if evidence.solver is None:
        return [Group("", evidence.cases)]
    theirs = [c for c in evidence.cases if c["origin"] is None]
    ours = [c for c in evidence.cases if c["origin"] is not None]
    return [Group(f"The solver under test, {evidence.solver}", theirs), Group(OWN, ours)]
