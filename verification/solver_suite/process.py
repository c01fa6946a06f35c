"""Processes of solvers under test: frames to and from them, their own side, signals, and what they leave.

A frame is the mark `FRAME`, the lengths of both parts, a JSON object and raw bytes: no pickles come back, and
no read is without an end. A solver can write whatever it likes into the descriptors that its process has.
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import socket
import struct
import threading
import time
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict
from multiprocessing import parent_process
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from types import FrameType
from typing import Any

import numpy as np
import psutil

from refimpl.errors import InputError
from refimpl.operating_system import in_group, kill_group, lead_group, terminate_thread
from verification.framework.case import Unavailable, readable
from verification.solver_suite.protocol import NUMBERS, SolverUnderTest, abilities_of, ask

Source = Callable[[], SolverUnderTest]
"""Factory of the solver under test, called in the process that will run the solver; picklable."""
PATIENCE = 1.0
"""Seconds to end what was started and to remove its files, once SIGTERM has come."""
ROUNDS = 20
"""Most times that processes left behind are looked for."""
FRAME = b"rough\x00\x01\xff"
HEAD = struct.Struct("<8sIQ")
LONGEST_HEADER, LONGEST_BODY = 1 << 16, 1 << 31
SOLVER_OF = "ROUGH_FRICTION_SOLVER_OF"
"""Environment variable of a solver's process and of all that it starts: its value is the run's mark."""


class Garbled(Exception):
    """Bytes that are no frame."""


class Late(Exception):
    """No whole frame within the time."""


def send(
    to: socket.socket, header: Mapping[str, Any], body: bytes = b"", *, seconds: float | None = None
) -> None:
    """Write a frame. Raises `Late` where nobody reads it within ``seconds``, OSError where nobody can."""
    text = json.dumps(header).encode()
    to.settimeout(seconds)
    try:
        to.sendall(HEAD.pack(FRAME, len(text), len(body)) + text + body)
    except TimeoutError as late:
        raise Late from late


def receive(source: socket.socket, *, seconds: float | None = None) -> tuple[dict[str, Any], bytes]:
    """Read a frame. Raises `Late`, `Garbled`, and EOFError at the end of the stream."""
    deadline = None if seconds is None else time.monotonic() + seconds
    mark, header_length, body_length = HEAD.unpack(_exactly(source, HEAD.size, deadline))
    if mark != FRAME or header_length > LONGEST_HEADER or body_length > LONGEST_BODY:
        raise Garbled("no frame")
    try:
        header = json.loads(_exactly(source, header_length, deadline))
    except ValueError as broken:
        raise Garbled(str(broken)) from broken
    if not isinstance(header, dict):
        raise Garbled("a header that is no object")
    return header, _exactly(source, body_length, deadline)


def _exactly(source: socket.socket, length: int, deadline: float | None) -> bytes:
    found = bytearray()
    while len(found) < length:
        left = None if deadline is None else deadline - time.monotonic()
        if left is not None and left <= 0:
            raise Late
        source.settimeout(left)
        try:
            part = source.recv(min(length - len(found), 1 << 20))
        except TimeoutError as late:
            raise Late from late
        if not part:
            raise EOFError
        found += part
    return bytes(found)


class Ended(BaseException):
    """A signal requested the end; no `Exception`, since nobody's solver is to take it for a failure."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


@contextmanager
def unwinding(*numbers: signal.Signals) -> Iterator[None]:
    """Within the block, the first of these signals raises `Ended`; the next find the clean-up under way.

    A signal that is ignored stays so (`nohup`), and a process that is forked within gets them as ever. Only
    the main thread can have it so; in another the block is run as it is.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    found = {number: signal.getsignal(number) for number in numbers}
    taken = [number for number in numbers if found[number] is not signal.SIG_IGN]
    owner = os.getpid()

    def unwind(number: int, frame: FrameType | None) -> None:
        if os.getpid() != owner:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
            return
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


def exit_text(status: int | None) -> str:
    """An exit status in words; Python counts a signal as a negative one.

    >>> exit_text(3), exit_text(-11), exit_text(-40)
    ('exit status 3', 'killed by SIGSEGV', 'killed by signal 40')
    """
    if status is None or status >= 0:
        return f"exit status {status}"
    names = {each.value: each.name for each in signal.Signals}
    return f"killed by {names.get(-status, f'signal {-status}')}"


def serve(judge: socket.socket, source: Source) -> None:
    """Until the socket is closed. SIGTERM, or the parent's death, also ends all in this process's group.

    A program that the solver runs may have a group of its own: it is ended by the `finally` of who ran
    it. What the solver prints goes to stderr, so that it cannot end up in a result file.
    """
    lead_group()
    os.dup2(2, 1)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        with unwinding(signal.SIGTERM):
            _answer(judge, source)
    except (Ended, EOFError, OSError):
        kill_group(os.getpid())


def _end_with_parent() -> None:
    """A parent that was killed closes no session: its solver would go on for ever."""
    parent, main = parent_process(), threading.main_thread().ident
    if parent is None or main is None:  # neither can be, in a child
        return
    wait([parent.sentinel])
    terminate_thread(main)
    time.sleep(PATIENCE)
    kill_group(os.getpid())


def _answer(judge: socket.socket, source: Source) -> None:
    served_by = os.getpid()
    try:
        solver = source()
        identity = getattr(solver, "identity", {})
        ready = {"kind": "ready", "abilities": asdict(abilities_of(solver)), "identity": identity}
    except InputError as refused:
        value = readable(refused.value if isinstance(refused.value, str) else repr(refused.value))
        send(judge, {"kind": "refused", "field": refused.field, "allowed": refused.allowed, "value": value})
        return
    send(judge, ready)
    while True:
        header, body = receive(judge)
        problem = pickle.loads(body)  # from the judge, who is trusted here
        reply, pressure = _posed(solver, problem)
        if os.getpid() != served_by:  # the solver forked, and let its child return: one answer is enough
            os._exit(1)
        send(judge, {"number": header["number"], **reply}, pressure)


def _posed(solver: SolverUnderTest, problem: Any) -> tuple[dict[str, Any], bytes]:
    """Header and body of the reply: checked numbers and pressures, or why there are none."""
    try:
        answer = ask(solver, problem)
    except Unavailable as missing:
        return {"kind": "unavailable", "note": readable(str(missing))}, b""
    except (Exception, SystemExit) as failure:  # a solver may do anything
        frames = traceback.extract_tb(failure.__traceback__)
        place = f"{os.path.basename(frames[-1].filename)}:{frames[-1].lineno}" if frames else "no traceback"
        note = f"{type(failure).__name__}: {readable(str(failure))} [{place}]"
        return {"kind": "failed", "note": note}, b""
    numbers = {name: getattr(answer, name) for name in NUMBERS}
    return {"kind": "answer", **numbers}, np.ascontiguousarray(answer.pressure, dtype="<f8").tobytes()


def _alive(process: psutil.Process) -> bool:
    """Whether a process is there and no zombie."""
    try:
        return bool(process.is_running() and process.status() != psutil.STATUS_ZOMBIE)
    except psutil.Error:
        return False


def _marked(mark: str) -> set[psutil.Process]:
    """Living processes that carry the mark in their environment, whatever session they are in."""
    found = set()
    for process in psutil.process_iter():
        with suppress(psutil.Error, OSError):
            if process.environ().get(SOLVER_OF) == mark and _alive(process):
                found.add(process)
    return found


def _gone(processes: Iterable[psutil.Process], seconds: float) -> None:
    """Wait until none of the processes is alive, for so many seconds at most."""
    deadline = time.monotonic() + seconds
    while any(map(_alive, processes)) and time.monotonic() < deadline:
        time.sleep(0.01)


def end_all(leader: BaseProcess, mark: str) -> list[str]:
    """End a solver's process and its group, then all that it started elsewhere; return what that was.

    The process ends in good order within `PATIENCE`, or by force. Elsewhere are processes below it, and
    those that carry the mark in their environment; what these start in turn is ended too.
    """
    below: set[psutil.Process] = set()
    if leader.pid is not None:
        with suppress(psutil.Error):
            below = {*psutil.Process(leader.pid).children(recursive=True)}
    leader.terminate()
    wait([leader.sentinel], PATIENCE)
    group = below | _marked(mark)
    if leader.pid is not None:
        group = {each for each in group if in_group(each.pid, leader.pid)}
        kill_group(leader.pid)
    leader.kill()
    leader.join()
    _gone(group, PATIENCE)
    found: dict[int, str] = {}
    for _ in range(ROUNDS):
        left = {each for each in below | _marked(mark) if _alive(each)}
        if not left:
            break
        for each in left:
            with suppress(psutil.Error):
                below |= {*each.children(recursive=True)}
                found.setdefault(each.pid, f"{' '.join(each.cmdline())[:80]} (process {each.pid}): ended")
                each.kill()
        _gone(left, PATIENCE)
    return [found[pid] for pid in sorted(found)]
