"""`rough-friction verify --solver` and `--exec`: anyone's solver through the suite."""

from __future__ import annotations

import argparse
import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, Any

from verification.cli import suite_report, suite_table
from verification.cli.options import Options, declare, file_of, option
from verification.cli.output import emit, refusal, select_or_refuse
from verification.cli.suite_report import Judged
from verification.output.text_table import columns

if TYPE_CHECKING:
    from verification.framework.case import Result
    from verification.solver_suite.check import Check
    from verification.solver_suite.process import Source

WHO: Options = {
    "--solver": option(
        "a Python function of one ContactProblem, see its module; or one of the published codes "
        "tamaas, contactmechanics, aspher, slippy",
        metavar="MODULE:FUNCTION",
    ),
    "--exec": option(
        "a program, run as COMMAND DIRECTORY; files: solver_suite/command.py", metavar="COMMAND"
    ),
    "--self-test": option("run the suite on solvers that are wrong on purpose", action="store_true"),
}
OPTIONS: Options = {
    "--able": option(
        "of aperiodic,periodic,load,approach (default),coupling,rectangle,oblong-elements,hardness",
        metavar="LIST",
    ),
    "--largest": option("largest number of elements per side", metavar="M", type=int),
    "--precision": option("relative residual that it claims (default 1e-8)", metavar="P", type=float),
    "--strongest": option(
        "largest strength of coupling, pi |c0| E* beta, that it should be given", metavar="K", type=float
    ),
    "--timeout": option(
        "seconds for one problem (default 60); a --solver has 5 more", metavar="S", type=float
    ),
    "--discretisation": option(
        "other: judge limits and orders of convergence in the place of equality with element-wise\n"
        "pressures; exit status 0 when both hold, 3 when an order is low, 1 when a limit is wrong",
        choices=("same", "other"),
    ),
    "--thorough": option(
        "further problems of the covering designs after the suite, from other seeds",
        action="store_const",
        const=True,
    ),
    "--table": option(
        "write a table of the run beside the published codes: FILE ends in .csv, .tex or .md",
        metavar="FILE",
        type=file_of(".csv", ".tex", ".md"),
    ),
}
"""Options that mean nothing without a solver."""


class Ended(KeyboardInterrupt):
    """A signal requested the end, as a batch queue's or that of a closed terminal."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


@contextmanager
def unwinding(*numbers: signal.Signals) -> Iterator[None]:
    """Raise `Ended` at the first of these signals in the block; the next find the clean-up under way.

    A signal that is ignored stays so (`nohup`). Only the main thread can have it so.
    """
    found = {number: signal.getsignal(number) for number in numbers}
    if threading.current_thread() is not threading.main_thread():
        found = {}
    taken = [number for number, action in found.items() if action is not signal.SIG_IGN]

    def unwind(number: int, frame: FrameType | None) -> None:
        for each in taken:
            signal.signal(each, signal.SIG_IGN)
        raise Ended(number)

    for number in taken:
        signal.signal(number, unwind)
    try:
        yield
    finally:
        for number in taken:
            signal.signal(number, found[number])


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that name a solver and say what it can do."""
    group = parser.add_argument_group(
        "bring your own solver",
        "Run the suite of verification.solver_suite with it, one case after the other whatever --tier\n"
        "and --jobs say: the cases that are within its abilities; the others are named. --only '!GLOB'\n"
        "excludes cases: '!*/design-large*' the largest grids. Of the abilities\n"
        "that a Python function carries, --able, --largest, --precision and --strongest replace only what\n"
        "they state.",
    )
    declare(group, WHO | OPTIONS, one_of=tuple(WHO))


def chosen(options: argparse.Namespace) -> bool:
    """Return True if a solver is named. Raises `InputError` for its options without one."""
    if options.solver is not None or options.exec is not None:
        return True
    for name in OPTIONS:
        if (value := getattr(options, name.removeprefix("--"))) is not None:
            raise refusal(name, value, "nothing without --solver or --exec")
    return False


def run(options: argparse.Namespace) -> int:
    """Run or list the suite; status 1 when a case failed or broke, or none passed."""
    from verification.framework.case import readable
    from verification.output.files import write_text
    from verification.solver_suite import convergence, suite

    if options.discretisation == "other" and options.thorough:
        raise refusal("--thorough", True, "nothing beside --discretisation other")
    among = suite.thorough() if options.thorough else suite.suite()
    if options.discretisation == "other":
        among = convergence.CASES
    checks = select_or_refuse(options.only, lambda: suite.select(options.only, among))
    if options.list:
        listed = [{"id": c.id, "title": c.title, "claim": c.description} for c in checks]
        emit(listed, options.json, columns([[c.id, c.title] for c in checks], indent=""))
        return 0
    name, source, stated = _source(options)
    judged = _judged(options, checks, among, name, source)
    document = suite_report.document(judged, readable(name), stated)
    emit(document, options.json, suite_report.text(readable(name), judged))
    if options.table is not None:
        ours = suite_table.run_entry(document["solver"], suite.VERSION, judged.results)
        write_text(suite_table.text_of(options.table.suffix, [ours, *suite_table.published()]), options.table)
    if isinstance(judged.ended, Ended):  # as the signal would have, once what is judged is shown and written
        os.kill(os.getpid(), judged.ended.number)
    if judged.ended is not None:
        raise judged.ended
    return convergence.exit_status(judged.results) if judged.of_convergence else judged.run.exit_status


def _judged(
    options: argparse.Namespace,
    checks: tuple[Check, ...],
    among: tuple[Check, ...],
    name: str,
    source: Source,
) -> Judged:
    """Judge the solver case by case; an end by a signal keeps the verdicts so far."""
    from refimpl.operating_system import END_SIGNALS
    from verification.output.files import Progress
    from verification.solver_suite import isolated

    start, progress = time.perf_counter(), Progress(len(checks))
    judged = Judged(checks, tuple(options.only), options.discretisation == "other")

    def tick(result: Result) -> None:
        judged.results.append(result)
        progress.tick(f"{result.status:<11} {result.id}")

    try:
        with unwinding(*END_SIGNALS):
            isolated.run(
                source,
                options.only,
                timeout=_timeout(options),
                name=name,
                among=among,
                identified=judged.identity.update,
                begin=lambda check: progress.show(f"running     {check.id}"),
                tick=tick,
                left=judged.left.append,
            )
    except KeyboardInterrupt as end:
        judged.ended = end
    progress.close()
    judged.seconds = time.perf_counter() - start
    return judged


def _timeout(options: argparse.Namespace) -> float:
    return 60.0 if options.timeout is None else float(options.timeout)


def _source(options: argparse.Namespace) -> tuple[str, Source, dict[str, Any]]:
    from dataclasses import asdict, replace

    from verification.adapters import PUBLISHED
    from verification.solver_suite.command import Command
    from verification.solver_suite.isolated import Named
    from verification.solver_suite.protocol import Abilities

    limits = {name: getattr(options, name) for name in ("largest", "precision", "strongest")}
    stated = {name: value for name, value in limits.items() if value is not None}
    if options.able is not None:
        listed = asdict(Abilities.named(options.able))
        stated = {name: able for name, able in listed.items() if name not in limits} | stated
    abilities = replace(Abilities(), **stated)  # refuses what cannot be, before anything is imported
    if options.solver is not None:
        return options.solver, Named(PUBLISHED.get(options.solver, options.solver), stated).solver, stated
    command = Command.of(options.exec, abilities, _timeout(options))
    return options.exec, command.solver, asdict(abilities)
