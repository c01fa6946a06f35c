"""The child process in which a contestant is run: it answers the slug of a check with the verdict on it."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from multiprocessing.connection import Connection

from refimpl.errors import InputError
from verification.contestants.ending import Ended, unwinding
from verification.contestants.protocol import Contestant
from verification.contestants.suite import suite

Source = Callable[[], Contestant]
"""Makes the contestant, in the process that will run it; must be picklable."""


def serve(pipe: Connection, source: Source) -> None:
    """Until the pipe is closed or SIGTERM comes, which also ends all in this process's group.

    A program that the contestant runs may have a group of its own: it is ended by the `finally` of who ran
    it. What the solver prints goes to stderr, so that it cannot end up in a result file.
    """
    os.setsid()
    os.dup2(2, 1)
    try:
        with unwinding(signal.SIGTERM):
            _answer(pipe, source)
    except Ended:
        os.killpg(os.getpid(), signal.SIGKILL)


def _answer(pipe: Connection, source: Source) -> None:
    checks = {check.slug: check for check in suite()}
    try:
        contestant = source()
    except InputError as refused:
        pipe.send(refused)
        return
    pipe.send(None)
    while True:
        try:
            slug = pipe.recv()
        except EOFError:
            return
        pipe.send(checks[slug].case(contestant).run())
