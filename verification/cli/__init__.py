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
from importlib.metadata import version
from typing import NoReturn

from verification.cli import (
    appendix_a,
    identify,
    inspect,
    keys,
    report,
    solve,
    sweep,
    tradeoff,
    verify,
)

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130
OUTPUT_REFUSED = (
    errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO,
)  # fmt: skip

NEGATIVE = re.compile(r"-(\d|\.\d|inf|nan)", re.IGNORECASE)  # how no option begins

EPILOG = """exit status: 0 success, 1 a check failed or the solve did not converge, 2 bad input

examples:
  rough-friction solve table1-smooth --grid 256
  rough-friction verify --tier quick --json results.json
  rough-friction report --results results.json --output report
"""


class Parser(argparse.ArgumentParser):
    """A parser that refuses bad usage by one line on stderr."""

    def error(self, message: str) -> NoReturn:
        """Exit with status 2."""
        from refimpl.errors import printable

        self.exit(BAD_INPUT, f"{self.prog}: {printable(message)} (see {self.prog} --help)\n")


def parser() -> argparse.ArgumentParser:
    """The whole command line."""
    top = Parser(
        prog="rough-friction",
        description="Friction between rough elastic surfaces: solve scenes, verify the solvers, report.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=f"rough-friction {version('rough-friction')}")
    commands = top.add_subparsers(title="subcommands", metavar="COMMAND", required=True)
    for module in (solve, inspect, identify, keys, verify, report, sweep, tradeoff, appendix_a):
        module.add_parser(commands)
    return top


def joined(arguments: Sequence[str]) -> list[str]:
    """Arguments with negative numbers, and lists that begin with one, joined to the option before them.

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
    from refimpl.errors import InputError

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
        if type(hopeless) is not ArithmeticError:  # the solvers' own word; a division by zero is a bug
            raise
        print(f"{top.prog}: no solution was found: {hopeless}", file=sys.stderr)
        return FAILED
    return status


def _end_in_order() -> None:
    """Interrupts raise, so that no temporary file stays; no text fails on standard output's encoding."""
    started = threading.current_thread() is threading.main_thread()
    if started and signal.getsignal(signal.SIGINT) is signal.SIG_DFL:  # by `verification.start`
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
