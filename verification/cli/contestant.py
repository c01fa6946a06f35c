"""`rough-friction verify --solver` and `--exec`: anyone's solver through the suite."""

from __future__ import annotations

import argparse
import os
import signal
import time
from typing import TYPE_CHECKING, Any

from verification.cli import suite_table
from verification.cli.output import columns, emit, judgement, output_file, wrapped

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from verification.contestants.serving import Source
    from verification.framework.case import Result
    from verification.framework.runner import Run

ONLY_WITH_SOLVER = ("able", "largest", "precision", "timeout", "table", "discretisation")


def add_options(parser: argparse.ArgumentParser) -> None:
    """The options that name a solver and say what it can do."""
    group = parser.add_argument_group(
        "bring your own solver",
        "Run the suite of verification.contestants with it, one case after the other whatever --tier\n"
        "and --jobs say: the cases that are within its abilities; the others are named. Of the abilities\n"
        "that a Python function carries, --able, --largest and --precision replace only what they state.",
    )
    who = group.add_mutually_exclusive_group()
    who.add_argument(
        "--solver",
        metavar="MODULE:FUNCTION",
        help="a Python function of one ContactProblem, see its module; or one of the published codes "
        "tamaas, contactmechanics, aspher, slippy",
    )
    who.add_argument(
        "--exec", metavar="COMMAND", help="a program, run as COMMAND DIRECTORY; files: contestants/command.py"
    )
    who.add_argument(
        "--self-test", action="store_true", help="run the suite on solvers that are broken on purpose"
    )
    group.add_argument(
        "--able",
        metavar="LIST",
        help="of aperiodic,periodic,load,approach (default),coupling,rectangle,oblong-elements,hardness",
    )
    group.add_argument(
        "--largest", metavar="M", type=int, help="most elements a side that it should be given"
    )
    group.add_argument(
        "--precision", metavar="P", type=float, help="relative residual that it claims (default 1e-8)"
    )
    group.add_argument(
        "--timeout",
        metavar="S",
        type=float,
        help="seconds for one problem (default 60); a --solver has 5 more",
    )
    group.add_argument(
        "--discretisation",
        choices=("same", "other"),
        help="other: judge limits and orders of convergence in the place of equality with element-wise\n"
        "pressures; exit status 0 when both hold, 3 when an order is low, 1 when a limit is wrong",
    )
    group.add_argument(
        "--table",
        metavar="FILE",
        type=output_file,
        help="write a table of the run beside the published codes: FILE ends in .csv, .tex or .md",
    )


def chosen(options: argparse.Namespace) -> bool:
    """True if a solver is named. Raises `InputError` for its options without one."""
    from refimpl.errors import InputError

    if options.solver is not None or options.exec is not None:
        return True
    for name in ONLY_WITH_SOLVER:
        if getattr(options, name) is not None:
            raise InputError(f"--{name}", getattr(options, name), "nothing without --solver or --exec")
    return False


def run(options: argparse.Namespace) -> int:
    """Run or list the suite; status 1 when a case failed or broke, or none passed."""
    from refimpl.errors import InputError
    from verification.contestants import convergence, isolated, short_list, suite
    from verification.contestants.ending import Ended, unwinding
    from verification.framework.case import Tier, readable
    from verification.framework.files import Progress, write_text
    from verification.framework.runner import Run

    try:
        among = convergence.CASES if options.discretisation == "other" else None
        checks = suite.select(options.only, among)
    except LookupError as nothing:
        raise InputError("--only", options.only, f"the id of a case ({nothing}; see --list)") from nothing
    if options.table is not None:
        suite_table.require_suffix(options.table)
    if options.list:
        listed = [{"id": c.id, "title": c.title, "claim": c.description} for c in checks]
        emit(listed, options.json, columns([[c.id, c.title] for c in checks], indent=""))
        return 0
    name, source, stated = _source(options)
    start, progress = time.perf_counter(), Progress(len(checks))
    results: list[Result] = []
    left: list[str] = []

    def judged(result: Result) -> None:
        results.append(result)
        progress.tick(f"{result.status:<11} {result.id}")

    ended: BaseException | None = None
    try:
        with unwinding(signal.SIGTERM, signal.SIGHUP):  # a batch queue's, a terminal's that is closed
            isolated.run(
                source,
                options.only,
                timeout=_timeout(options),
                name=name,
                among=among,
                begin=lambda check: progress.show(f"running     {check.id}"),
                tick=judged,
                left=left.append,
            )
    except (Ended, KeyboardInterrupt) as end:  # verdicts so far are shown and written
        ended = end
    progress.close()
    done = Run(Tier.FULL, tuple(options.only), tuple(results), time.perf_counter() - start)
    missing = [check.id for check in checks[len(results) :]]
    unseen = None if options.only or among or ended else unseen_faults(results)
    low = convergence.slow(results) if among else []
    document: dict[str, Any] = done.document() | {
        "suite": suite.identity(),
        "interrupted": ended is not None,
        "contestant": {
            **identity_of(options),
            "abilities": stated or None,
            "not_applicable": {r.id: r.note for r in results if r.status == "unavailable"},
            "not_judged": missing,
            "left_running": left,
            "low_order": low,
            "unseen_faults": unseen,
            "short_list": short_list.of_results(results),
        },
    }
    text = table(readable(name), done, unseen or [], left, len(missing))
    if among and results:
        orders = columns([[r.id, r.note] for r in results if r.status == "pass"])
        low_ones = "right in the limit, but of low order: " + ", ".join(low) if low else ""
        text = "\n\n".join(filter(None, [orders, low_ones, text]))
    emit(document, options.json, text)
    if options.table is not None:
        entry = suite_table.run_entry(document["contestant"], suite.VERSION, results)
        write_text(
            suite_table.text_of(options.table.suffix, [entry, *suite_table.published()]), options.table
        )
    if isinstance(ended, Ended):
        os.kill(os.getpid(), ended.number)  # everything is tidied up; now what the signal does by itself
    if ended is not None:
        raise ended
    return convergence.exit_status(results) if among else done.exit_status


def identity_of(options: argparse.Namespace) -> dict[str, str | None]:
    """Name, version and checksum of the solver."""
    from verification.adapters import PEERS
    from verification.contestants import identity
    from verification.framework.case import readable

    if options.exec is not None:
        found = identity.of_command(options.exec)
    elif options.solver in PEERS:
        found = identity.of_peer(PEERS[options.solver])
    else:
        found = identity.of_function(options.solver)
    return found | {"name": readable(options.solver or options.exec)}


def unseen_faults(results: Iterable[Result]) -> list[str]:
    """Faults that no case that ran is meant to catch: a solver of few abilities is judged by few cases."""
    from verification.contestants.check import Fault
    from verification.contestants.suite import suite

    ran = {r.id for r in results if r.status != "unavailable"}
    seen = {fault for check in suite() if check.id in ran for fault in check.catches}
    return [fault.value for fault in Fault if fault not in seen]


def _timeout(options: argparse.Namespace) -> float:
    return 60.0 if options.timeout is None else float(options.timeout)


def _source(options: argparse.Namespace) -> tuple[str, Source, dict[str, Any]]:
    """Name and source of the solver, and the abilities that are stated here: a program has no other."""
    from dataclasses import asdict, replace

    from verification.adapters import PEERS
    from verification.contestants.command import Command
    from verification.contestants.isolated import Named
    from verification.contestants.protocol import Abilities

    limits = {name: getattr(options, name) for name in ("largest", "precision")}
    stated = {name: value for name, value in limits.items() if value is not None}
    if options.able is not None:
        listed = asdict(Abilities.named(options.able))
        stated = {name: able for name, able in listed.items() if name not in limits} | stated
    abilities = replace(Abilities(), **stated)  # refuses what cannot be, before anything is imported
    if options.solver is not None:
        return options.solver, Named(PEERS.get(options.solver, options.solver), stated).contestant, stated
    command = Command.of(options.exec, abilities, _timeout(options))
    return options.exec, command.contestant, asdict(abilities)


def table(
    name: str, done: Run, unseen: Sequence[str] = (), left: Sequence[str] = (), missing: int = 0
) -> str:
    """Verdicts, reasons of failure, what was not run and why, what no case looked for, and the counts.

    ``left`` are processes that the solver left running, ``missing`` the cases that an interrupted run missed.
    """
    ran = [r for r in done.results if r.status != "unavailable"]
    rows = [[r.status, r.id, with_unit(r), f"{r.seconds:.1f} s"] for r in ran]
    reasons = [[r.id, reason(r)] for r in ran if r.status != "pass"]
    counts = ", ".join(f"{number} {status}" for status, number in done.counts.items())
    parts = [columns(rows, indent=""), columns(reasons), *_not_applicable(done)]
    from verification.contestants.short_list import of_results

    if listed := of_results(done.results):
        parts.append("problems of the covering design fail mostly where:\n  " + "\n  ".join(listed))
    if unseen:
        parts.append("looked for by none of these cases:\n" + wrapped(", ".join(unseen), "  "))
    if left:
        parts.append("processes that the solver left behind:\n  " + "\n  ".join(left))
    if missing:
        parts.append(f"interrupted: {missing} cases were not judged")
    return "\n\n".join([part for part in parts if part] + [f"{name}: {counts}; {done.seconds:.0f} s"])


def with_unit(result: Result) -> str:
    """The judgement in its unit; a relative error has none but that word."""
    unit = "relative" if result.metric == "relative" else result.unit
    return f"{judgement(result)} {unit}" if judgement(result) else ""


def reason(result: Result) -> str:
    """Why there is no verdict; or what was claimed, and what is known of the failure."""
    if result.status == "error":
        return result.note
    return f"{result.claim}. Found: {result.note}" if result.note else result.claim


def _not_applicable(done: Run) -> list[str]:
    left_out = [r for r in done.results if r.status == "unavailable"]
    reasons = dict.fromkeys(r.note for r in left_out)
    lines = [
        wrapped(", ".join(r.id.partition("/")[2] for r in left_out if r.note == note), f"  {note}: ")
        for note in reasons
    ]
    return ["\n".join(["not applicable, and not passed:", *lines])] if lines else []
