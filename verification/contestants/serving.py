"""Child process of a solver under test: reads the slug of a check, answers with the verdict."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait

from refimpl.errors import InputError
from verification.contestants.ending import Ended, unwinding
from verification.contestants.protocol import Contestant
from verification.contestants.suite import suite

Source = Callable[[], Contestant]
"""Factory of the solver under test, called in the process that will run the solver; picklable."""
PATIENCE = 1.0
"""Seconds to end what was started and to remove its files, once SIGTERM has come."""


def serve(pipe: Connection, source: Source) -> None:
    """Until the pipe is closed. SIGTERM, or the parent's death, also ends all in this process's group.

    A program that the solver runs may have a group of its own: it is ended by the `finally` of who ran
    it. What the solver prints goes to stderr, so that it cannot end up in a result file.
    """
    os.setsid()
    os.dup2(2, 1)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        with unwinding(signal.SIGTERM):
            _answer(pipe, source)
    except Ended:
        os.killpg(os.getpid(), signal.SIGKILL)


def _end_with_parent() -> None:
    """A parent that was killed closes no session: its solver would go on for ever."""
    parent, main = parent_process(), threading.main_thread().ident
    if parent is None or main is None:  # neither can be, in a child
        return
    wait([parent.sentinel])
    signal.pthread_kill(main, signal.SIGTERM)  # to that thread, so that it wakes up
    time.sleep(PATIENCE)
    os.killpg(os.getpid(), signal.SIGKILL)


def _answer(pipe: Connection, source: Source) -> None:
    checks, served_by = {check.slug: check for check in suite()}, os.getpid()
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
        result = checks[slug].case(contestant).run()
        if os.getpid() != served_by:  # the solver forked, and let its child return: one verdict is enough
            os._exit(1)
        pipe.send(result)
