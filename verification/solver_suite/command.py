"""A program in any language as a solver under test: problems and answers as plain files.

The command is run as ``COMMAND DIRECTORY`` for each problem. In the directory it finds

    problem.json   one key a line: M, spacing (m), reduced_modulus (Pa), control ("load" or "approach"),
                   value (N or m), periodic (0 or 1), tolerance, friction (0 or 1), tau (Pa), beta,
                   shear_compliance (1/Pa), sliding_direction (rad), the last four 0 without friction; shape
                   (elements along x and y), lengths (of the domain along x and y, m), hardness (Pa, 0 for
                   none, as always unless the ability hardness is claimed). M and spacing are
                   the same numbers on a square of square elements, which is all that is posed unless the
                   abilities rectangle and oblong elements are claimed
    gap.csv        the gap (m): a line for each element along x, in it a number for each along y
    problem.npz    the same array under the name gap

and writes there, in the same layout, either ``pressure.csv`` or ``answer.npz`` (array ``pressure``), in Pa.
It may add ``answer.json``, ``{"converged": true}``; without it, exit status 0 claims success. Beside that the
object may have ``approach`` (m), ``contact_area`` (m^2) and ``mean_displacement`` (m), each of them judged by
the pressures where it is there. Anything else is an error of the case: another exit status, no answer or two,
a short one, NaN, too much time. What the numbers mean is said in `verification.solver_suite.protocol`.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
import zipfile
from dataclasses import dataclass, fields
from pathlib import Path
from typing import BinaryIO

import numpy as np

from refimpl.errors import InputError, require_number
from refimpl.grid import Array
from refimpl.operating_system import has_ended, words_of
from verification.output.result_files import parsed
from verification.solver_suite.identity import Identity, of_command
from verification.solver_suite.process import exit_text, reap, wait_until
from verification.solver_suite.protocol import NUMBERS, Abilities, Answer, BadAnswer, ContactProblem, Coupling

LONGEST = 86400.0
"""Seconds that one problem may take: a day. The system's clocks for waiting end at some weeks."""

MOST_READ = 65536
"""Bytes of a program's output that are looked through for its last line."""


def require_timeout(seconds: float) -> None:
    """Raise `InputError` for a time that nobody can wait."""
    allowed = f"seconds for one problem, above 0 and at most {LONGEST:g}"
    require_number("--timeout", seconds, allowed, above=0, at_most=LONGEST)


@dataclass(frozen=True)
class Command:
    """A program with arguments; ``timeout`` (s) of a problem. `InputError` if empty or out of range."""

    words: tuple[str, ...]
    abilities: Abilities
    timeout: float

    def __post_init__(self) -> None:
        if not self.words:
            raise InputError("--exec", "", "a command")
        require_timeout(self.timeout)

    @classmethod
    def of(cls, line: str, abilities: Abilities, timeout: float) -> Command:
        """Parse a command line as a shell splits it. `InputError` where its first word is no program."""
        try:
            words = tuple(words_of(line))
        except ValueError as unbalanced:
            raise InputError("--exec", line, f"a command ({unbalanced})") from unbalanced
        if words and shutil.which(words[0]) is None:
            raise InputError("--exec", line, "a command whose first word is a program that can be run")
        return cls(words, abilities, timeout)

    def solver(self) -> Command:
        """Return itself: a source for `verification.solver_suite.isolated`."""
        return self

    @property
    def identity(self) -> Identity:
        """Checksum of its files; their version only its author knows."""
        return of_command(self.words)

    def __call__(self, problem: ContactProblem) -> Answer:
        """Run the program on one problem. Raises `BadAnswer` for all but a readable claim of success."""
        with tempfile.TemporaryDirectory(prefix="contact-", ignore_cleanup_errors=True) as name:
            directory = Path(name)
            write_problem(problem, directory)
            self._run(directory)
            return read_answer(directory)

    def _run(self, directory: Path) -> None:
        with (directory / "output.txt").open("w+b") as output:
            try:
                process = subprocess.Popen(
                    [*self.words, str(directory)],
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    process_group=0 if os.name == "posix" else None,
                )
            except OSError as missing:
                raise BadAnswer(f"cannot run {self.words[0]}: {missing.strerror}") from missing
            try:
                if not wait_until(lambda: has_ended(process.pid), self.timeout):
                    raise BadAnswer(f"no answer within {self.timeout:g} s")
            finally:
                status = reap(process)
            if status:
                raise BadAnswer(f"{exit_text(status)}: {_last_line(output)}")


def _last_line(output: BinaryIO) -> str:
    """Return the end of what a program said; it may have said gigabytes, or removed the file."""
    output.seek(max(0, output.seek(0, os.SEEK_END) - MOST_READ))
    said = output.read(MOST_READ).decode(errors="replace").split("\n")
    return next((line.strip() for line in reversed(said) if line.strip()), "nothing said")[:200]


def header_of(problem: ContactProblem) -> dict[str, object]:
    """Return the fields of ``problem.json``, all but the gap."""
    coupling, by_load = problem.coupling, problem.load is not None
    return {
        "M": problem.M,
        "spacing": problem.spacing,
        "reduced_modulus": problem.reduced_modulus,
        "control": "load" if by_load else "approach",
        "value": problem.load if by_load else problem.approach,
        "periodic": int(problem.periodic),
        "tolerance": problem.tolerance,
        "friction": int(coupling is not None),
        **{field.name: getattr(coupling, field.name, 0.0) for field in fields(Coupling)},
        "shape": problem.shape,
        "lengths": problem.lengths,
        "hardness": problem.hardness or 0.0,
    }


def write_problem(problem: ContactProblem, directory: Path) -> None:
    """Write the three files of a problem."""
    header = header_of(problem)
    lines = ",\n".join(f" {json.dumps(key)}: {json.dumps(value)}" for key, value in header.items())
    (directory / "problem.json").write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")
    np.savetxt(directory / "gap.csv", problem.gap, fmt="%.17g", delimiter=",")
    np.savez(directory / "problem.npz", gap=problem.gap)


def read_answer(directory: Path) -> Answer:
    """Return the answer in a directory, for `ask` to judge. Raises `BadAnswer` where there is none."""
    table, archive, header = (directory / name for name in ("pressure.csv", "answer.npz", "answer.json"))
    for path in (table, archive, header):
        if path.exists() and not path.is_file():  # a pipe would be read for ever
            raise BadAnswer(f"{path.name} is no regular file")
    if table.exists() == archive.exists():
        found = "both pressure.csv and" if table.exists() else "neither pressure.csv nor"
        raise BadAnswer(f"exit status 0, but {found} answer.npz")
    try:
        said = parsed(header.read_text(encoding="utf-8")) if header.exists() else {"converged": True}
        converged, numbers = said["converged"], {name: said.get(name) for name in NUMBERS}
        pressure = _read_table(table) if table.exists() else _read_archive(archive)
    except (ValueError, KeyError, TypeError, AttributeError, OSError, EOFError, zipfile.BadZipFile) as broken:
        raise BadAnswer(f"unreadable answer: {type(broken).__name__}: {broken}") from broken
    return Answer(pressure, converged, **numbers)


def _read_table(path: Path) -> Array:
    """Return the numbers between commas; ValueError names the line with others, or another count."""
    rows: list[list[float]] = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if not line:
            continue
        rows.append([_number(cell, number, k) for k, cell in enumerate(line.split(","), start=1)])
        if len(rows[-1]) != len(rows[0]):
            raise ValueError(
                f"lines of unequal length: line {number} has {len(rows[-1])} numbers, "
                f"those before have {len(rows[0])}"
            )
    if not rows:
        raise ValueError("no numbers")
    return np.array(rows)


def _number(cell: str, line: int, place: int) -> float:
    try:
        if cell.isascii() and "_" not in cell:
            return float(cell)
    except ValueError:
        pass
    raise ValueError(f"line {line}, number {place}: {cell[:40]!r} is no number")


def _read_archive(path: Path) -> Array:
    archive = np.load(path, allow_pickle=False)
    if isinstance(archive, np.ndarray):
        raise ValueError(f"{path.name} holds a single array: expected an archive, as of savez")
    with archive:
        return np.asarray(archive["pressure"])
