"""The summary of a report: whose cases were run, how many of each verdict, and which did not pass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reports.evidence import Evidence
from reports.results import STATUSES, Case

OWN = "This project's own cases, from committed runs: no evidence about the solver under test"


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
