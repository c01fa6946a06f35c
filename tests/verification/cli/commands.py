"""The command line run in this process, and the files that its tests share."""

from __future__ import annotations

import io
import json
import shlex
import warnings
from contextlib import redirect_stderr, redirect_stdout
from typing import Any, NamedTuple

from verification.cli import main

SCENE = """
load = 5.0
side = 1e-3
sliding_direction = 0.5
[upper.material]
E = 200e9
nu = 0.3
[[upper.surface]]
kind = "sphere"
radius = 0.05
[lower.material]
E = 3e9
nu = 0.38
[friction]
tau = 0.3e6
beta = 0.1
"""
OBLONG = SCENE.replace("side = 1e-3\nsliding_direction = 0.5", "size = [2e-3, 1e-3]")
MEASURED = '[[lower.surface]]\nkind = "measured"\npath = "heights.npy"\nunit = "m"\npixel_size = 2e-4\n'
STUDY = 'scene = "table1-rough"\nrealisations = 2\n[vary]\ngrid = [8, 12]\n'


class Done(NamedTuple):
    status: int
    out: str
    err: str


class Stream(io.StringIO):
    """Standard error that is a terminal or not."""

    def __init__(self, terminal: bool) -> None:
        super().__init__()
        self.terminal = terminal

    def isatty(self) -> bool:
        return self.terminal


def run(command: str, *, terminal: bool = False) -> Done:
    out, err = io.StringIO(), Stream(terminal)
    with redirect_stdout(out), redirect_stderr(err):
        try:
            status = main(shlex.split(command))
        except SystemExit as usage:
            status = int(usage.code or 0)
    return Done(status, out.getvalue(), err.getvalue())


def shown(command: str, status: int = 0) -> str:
    """What a command prints, which must end with this status and nothing on standard error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        done = run(command)
    assert (done.status, done.err) == (status, "")
    return done.out


def answer(command: str, status: int = 0) -> Any:
    return json.loads(shown(f"{command} --json -", status))


def refused(command: str, says: str) -> None:
    """A command ends with status 2, one line on standard error, and nothing on standard output."""
    done = run(command)
    assert (done.status, done.out) == (2, "")
    assert done.err.startswith("rough-friction")
    assert done.err.count("\n") == 1
    assert says in done.err
