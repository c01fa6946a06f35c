"""The console script `rough-friction`: one module per subcommand, heavy imports only where they are used."""

from __future__ import annotations

import argparse
import errno
import io
import re
import signal
import sys
import threading
from collections.abc import Sequence
from typing import NoReturn

from verification.cli import (
    appendix_a,
    identify,
    inspect,
    keys,
    report,
    solve,
    suite_run,
    sweep,
    tradeoff,
    verify,
)
from verification.cli.options import subcommand

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130
OUTPUT_REFUSED = (
    errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO,
    errno.ENXIO, errno.EPIPE,
)  # fmt: skip

NEGATIVE = re.compile(r"-(\d|\.\d|inf|nan)", re.IGNORECASE)  # how no option begins

EPILOG = """exit status: 0 success, 1 a check failed or the solve did not converge, 2 bad input

examples:
  rough-friction solve table1-smooth --grid 256
  rough-friction verify --tier quick --json results.json
  rough-friction report --results results.json --output report
"""

TRADEOFF = "the cost-accuracy table of a scene: grid and seconds for an error in mu, A or p_max"
COMMANDS = (
    (solve, "solve a scene",
     "Solve a scene: friction, contact area, pressures, and how well it converged."),
    (inspect, "a surface file: points, units, orientation, roughness parameters, picture",
     "Read a file of heights as a scene would, and print what it holds and how rough it is."),
    (identify, "find tau and beta from friction measured at several loads",
     "Find tau and beta, with 95 % intervals, from friction measured at several loads."),
    (keys, "every key of scene and study files: type, unit, default, allowed values, meaning",
     "Print the keys of scene and study files, or write them as a page."),
    (verify, "run the verification cases",
     "Run the verification cases. A case that could not run is never a pass."),
    (report, "make the report of verification and replication",
     "Make the report of verification and replication, one HTML file, from a result file of 'verify' and\n"
     "the committed results of long cases and studies."),
    (sweep, "solve the runs of a study: realisations x roughness x load x direction x grid",
     "Solve the runs of a study in worker processes, resumably, and export the table."),
    (tradeoff, TRADEOFF, f"Print {TRADEOFF}."),
)  # fmt: skip
"""Modules with the help and the description of the subcommands that have their names."""


class Parser(argparse.ArgumentParser):
    """A parser that refuses bad usage by one line on stderr."""

    def error(self, message: str) -> NoReturn:
        """Exit with status 2."""
        from refimpl.errors import printable

        self.exit(BAD_INPUT, f"{self.prog}: {printable(message)} (see {self.prog} --help)\n")


class _Version(argparse.Action):
    """Print the version, for which alone `refimpl` is imported: --help is quick."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from refimpl import __version__

        parser.exit(0, f"{parser.prog} {__version__}\n")


def parser() -> argparse.ArgumentParser:
    """Return the whole command line."""
    top: argparse.ArgumentParser = Parser(
        prog="rough-friction",
        description="Friction between rough elastic surfaces: solve scenes, verify the solvers, report.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action=_Version, nargs=0, help="show the program's version and exit")
    commands = top.add_subparsers(title="subcommands", metavar="COMMAND", required=True)
    for module, text, about in COMMANDS:
        name, one_of = module.__name__.rpartition(".")[2], solve.ONE_OF if module is solve else ()
        texts = {"help": text, "description": about, "epilog": module.EPILOG}
        made = subcommand(commands, name, module.run, module.OPTIONS, one_of, **texts)
        if module is verify:
            suite_run.add_options(made)
    appendix_a.add_parser(commands)
    return top


def joined(arguments: Sequence[str]) -> list[str]:
    """Return the arguments with negative numbers, and lists from one on, joined to their option.

    By itself, argparse (Python 3.11) takes "-1e-6" and "-3,3" for options, and misses a value.

    >>> joined(["solve", "scene.toml", "--approach", "-1e-6", "--budget"])
    ['solve', 'scene.toml', '--approach=-1e-6', '--budget']
    """
    found: list[str] = []
    for argument in arguments:
        if found and re.fullmatch("--[^=]+", found[-1]) and NEGATIVE.match(argument):
            found[-1] += f"={argument}"
        else:
            found.append(argument)
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status. Errors that nobody foresaw keep their traceback."""
    try:
        return _run(arguments)
    except KeyboardInterrupt:
        return INTERRUPTED


def _run(arguments: Sequence[str] | None) -> int:
    top = parser()
    _end_in_order()
    options = top.parse_args(joined(sys.argv[1:] if arguments is None else arguments))
    from appendix_a.errors import InputError as AppendixInputError  # here and not above: --help is quick
    from refimpl.errors import InputError, NotConverged

    try:
        status: int = options.run(options)
    except (InputError, AppendixInputError) as refused:
        print(f"{top.prog}: {' '.join(str(refused).split())}", file=sys.stderr)
        return BAD_INPUT
    except OSError as failure:
        if failure.errno not in OUTPUT_REFUSED:
            raise
        where = f" ({failure.filename})" if failure.filename else ""
        print(f"{top.prog}: the output could not be written: {failure.strerror}{where}", file=sys.stderr)
        return FAILED
    except ArithmeticError as hopeless:
        if type(hopeless) not in (ArithmeticError, NotConverged):  # the solvers' own; 1 / 0 is a bug
            raise
        print(f"{top.prog}: no solution was found: {hopeless}", file=sys.stderr)
        return FAILED
    return status


def _end_in_order() -> None:
    """Make interrupts raise, so that no temporary file stays; no text fails on standard output's encoding."""
    started = threading.current_thread() is threading.main_thread()
    if started and signal.getsignal(signal.SIGINT) is signal.SIG_DFL:  # by `verification.start`
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
