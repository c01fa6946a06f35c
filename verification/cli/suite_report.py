"""Report of a run of the suite with one solver: the document for ``--json``, and the text."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from verification.cli.output import judgement
from verification.output.text_table import columns, wrapped

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from verification.framework.case import Result
    from verification.framework.runner import Run
    from verification.solver_suite.check import Check


@dataclass
class Judged:
    """A run of the suite, filled while it runs, perhaps an interrupted one.

    checks : checks that were to be run
    only : patterns that chose the checks
    of_convergence : whether limits and orders were judged instead of the suite
    results : verdicts, those of the first checks where the run was interrupted
    identity : version and checksum of the solver, as far as they are known
    left : processes that the solver left behind
    ended : the signal or Ctrl-C that interrupted the run, or None
    seconds : duration
    """

    checks: tuple[Check, ...]
    only: tuple[str, ...]
    of_convergence: bool
    results: list[Result] = field(default_factory=list)
    identity: dict[str, str | None] = field(default_factory=dict)
    left: list[str] = field(default_factory=list)
    ended: BaseException | None = None
    seconds: float = 0.0

    @property
    def run(self) -> Run:
        """The run as those of the project's own cases are."""
        from verification.framework.case import Tier
        from verification.framework.runner import Run

        return Run(Tier.FULL, self.only, tuple(self.results), self.seconds)

    @property
    def missing(self) -> list[str]:
        """Ids of the checks that an interrupted run did not reach."""
        return [check.id for check in self.checks[len(self.results) :]]

    @property
    def unseen(self) -> list[str] | None:
        """Faults that no case looked for, after a whole run of the suite; None after any other run."""
        whole = not self.only and not self.of_convergence and self.ended is None
        return unseen_faults(self.results) if whole else None

    @property
    def low_order(self) -> list[str]:
        """Ids of convergence cases whose limit is right and whose order is low."""
        from verification.solver_suite import convergence

        return convergence.slow(self.results) if self.of_convergence else []


def unseen_faults(results: Iterable[Result]) -> list[str]:
    """Return the faults that no case that ran is meant to catch: few abilities, few cases."""
    from verification.solver_suite.check import Fault
    from verification.solver_suite.suite import suite

    ran = {r.id for r in results if r.status != "unavailable"}
    seen = {fault for check in suite() if check.id in ran for fault in check.catches}
    return [fault.value for fault in Fault if fault not in seen]


def likely_faults(results: Iterable[Result]) -> list[str]:
    """Return the first four faults by the share of the naming cases that fail, then by their number.

    A fault fails wherever it is named, so a case that names it and passes speaks against it.
    """
    from verification.solver_suite.check import Fault
    from verification.solver_suite.suite import suite

    status = {r.id: r.status for r in results if r.status in ("pass", "fail")}
    ranked = []
    for fault in Fault:
        named = [status[check.id] for check in suite() if fault in check.catches and check.id in status]
        if failed := named.count("fail"):
            ranked.append((failed / len(named), failed, f"{fault} ({failed} of {len(named)})"))
    return [words for *_, words in sorted(ranked, key=lambda each: each[:2], reverse=True)[:4]]


def document(judged: Judged, name: str, stated: Mapping[str, Any]) -> dict[str, Any]:
    """Return the JSON document; ``name`` is the solver's, ``stated`` its abilities."""
    from verification.solver_suite import failures, suite

    return judged.run.document() | {
        "suite": suite.identity(),
        "thorough": len({c.id for c in judged.checks} - {c.id for c in suite.suite()})
        if not judged.of_convergence
        else 0,
        "interrupted": judged.ended is not None,
        "solver": {
            "name": name,
            "version": judged.identity.get("version"),
            "checksum": judged.identity.get("checksum"),
            "abilities": dict(stated) or None,
            "not_applicable": {r.id: r.note for r in judged.results if r.status == "unavailable"},
            "not_judged": judged.missing,
            "left_running": judged.left,
            "low_order": judged.low_order,
            "unseen_faults": judged.unseen,
            "likely_faults": likely_faults(judged.results),
            "failures_by_dimension": failures.by_dimension(judged.results),
        },
    }


def text(name: str, judged: Judged) -> str:
    """Return the verdicts; before them, of limits and orders, the orders that were found."""
    verdicts = table(name, judged)
    if not judged.of_convergence or not judged.results:
        return verdicts
    orders = columns([[r.id, r.note] for r in judged.results if r.status == "pass"])
    low = judged.low_order
    slow = "right in the limit, but of low order: " + ", ".join(low) if low else ""
    return "\n\n".join(filter(None, [orders, slow, verdicts]))


def table(name: str, judged: Judged) -> str:
    """Return verdicts, reasons of failure, what was not run and why, what no case looked for, counts."""
    from verification.solver_suite import failures

    done = judged.run
    ran = [r for r in done.results if r.status != "unavailable"]
    units = ["relative" if r.metric == "relative" else r.unit for r in ran]  # a relative error has none else
    errors = [f"{judgement(r)} {unit}" if judgement(r) else "" for r, unit in zip(ran, units, strict=True)]
    rows = [[r.status, r.id, error, f"{r.seconds:.1f} s"] for r, error in zip(ran, errors, strict=True)]
    claims = {check.id: check.claim for check in judged.checks}
    reasons = [
        [r.id, reason(r, claims[r.id], error)]
        for r, error in zip(ran, errors, strict=True)
        if r.status != "pass"
    ]
    counts = ", ".join(f"{number} {status}" for status, number in done.counts.items())
    parts = [columns(rows, indent=""), columns(reasons)]
    left_out = [r for r in done.results if r.status == "unavailable"]
    if left_out:
        ids = {r.note: [o.id.partition("/")[2] for o in left_out if o.note == r.note] for r in left_out}
        lines = [wrapped(", ".join(of_note), f"  {note}: ") for note, of_note in ids.items()]
        parts.append("\n".join(["not applicable, and not passed:", *lines]))
    if named := likely_faults(done.results):
        parts.append("faults by the share of their cases that fail:\n" + wrapped(", ".join(named), "  "))
    if listed := failures.in_words(failures.by_dimension(done.results)):
        lines = [wrapped(each, "  ") for each in listed]
        parts.append("\n".join(["failures by dimension of the designs:", *lines]))
    if judged.unseen:
        parts.append("looked for by none of these cases:\n" + wrapped(", ".join(judged.unseen), "  "))
    if judged.left:
        parts.append("processes that the solver left behind:\n  " + "\n  ".join(judged.left))
    if judged.missing:
        parts.append(f"interrupted: {len(judged.missing)} cases were not judged")
    return "\n\n".join([part for part in parts if part] + [f"{name}: {counts}; {done.seconds:.0f} s"])


def reason(result: Result, claim: str, error: str) -> str:
    """Return the reason for no verdict; or the claim, the error beside its tolerance, and the finding."""
    if result.status == "error":
        return result.note
    return f"{claim}. Found: {'; '.join(filter(None, (error, result.note)))}"
