"""Child process of a solver under test: reads problems, answers with pressures. The judge is elsewhere."""

from __future__ import annotations

import os
import pickle
import signal
import socket
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import asdict
from multiprocessing import parent_process
from multiprocessing.connection import wait
from typing import Any

import numpy as np

from refimpl.errors import InputError
from verification.framework.case import Unavailable, readable
from verification.solver_suite import wire
from verification.solver_suite.asking import ask
from verification.solver_suite.ending import Ended, unwinding
from verification.solver_suite.protocol import NUMBERS, Contestant, abilities_of

Source = Callable[[], Contestant]
"""Factory of the solver under test, called in the process that will run the solver; picklable."""
PATIENCE = 1.0
"""Seconds to end what was started and to remove its files, once SIGTERM has come."""


def serve(judge: socket.socket, source: Source) -> None:
    """Until the socket is closed. SIGTERM, or the parent's death, also ends all in this process's group.

    A program that the solver runs may have a group of its own: it is ended by the `finally` of who ran
    it. What the solver prints goes to stderr, so that it cannot end up in a result file.
    """
    os.setsid()
    os.dup2(2, 1)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        with unwinding(signal.SIGTERM):
            _answer(judge, source)
    except (Ended, EOFError, OSError):
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


def _answer(judge: socket.socket, source: Source) -> None:
    served_by = os.getpid()
    try:
        contestant = source()
        ready = {"kind": "ready", "abilities": asdict(abilities_of(contestant))}
    except InputError as refused:
        wire.send(judge, {"kind": "refused", "field": refused.field, "allowed": refused.allowed,
                          "value": _text(refused.value)})  # fmt: skip
        return
    wire.send(judge, ready)
    while True:
        header, body = wire.receive(judge)
        problem = pickle.loads(body)  # from the judge, who is trusted here
        reply, pressure = _posed(contestant, problem)
        if os.getpid() != served_by:  # the solver forked, and let its child return: one answer is enough
            os._exit(1)
        wire.send(judge, {"number": header["number"], **reply}, pressure)


def _posed(contestant: Contestant, problem: Any) -> tuple[dict[str, Any], bytes]:
    """Header and body of the reply: checked numbers and pressures, or why there are none."""
    try:
        answer = ask(contestant, problem)
    except Unavailable as missing:
        return {"kind": "unavailable", "note": readable(str(missing))}, b""
    except (Exception, SystemExit) as failure:  # a solver may do anything
        frames = traceback.extract_tb(failure.__traceback__)
        place = f"{os.path.basename(frames[-1].filename)}:{frames[-1].lineno}" if frames else "no traceback"
        return {
            "kind": "failed",
            "note": f"{type(failure).__name__}: {readable(str(failure))} [{place}]",
        }, b""
    numbers = {name: getattr(answer, name) for name in NUMBERS}
    return {"kind": "answer", **numbers}, np.ascontiguousarray(answer.pressure, dtype="<f8").tobytes()


def _text(value: object) -> str:
    return readable(value if isinstance(value, str) else repr(value))
