"""Processes of solvers under test: questions and replies, their own side, and what they leave.

A reply is a file: a line with a JSON object, then raw bytes. It appears in one step, and no more of it is
read than an answer has: no pickles come back. A solver may forge it: see `isolated`.
"""

from __future__ import annotations

import json
import os
import pickle
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import psutil

from refimpl.errors import InputError
from refimpl.operating_system import has_ended, in_session, kill_group, open_regular
from verification.framework.case import Reported, Unavailable, readable
from verification.solver_suite.protocol import NUMBERS, SolverUnderTest, abilities_of, ask

Source = Callable[[], SolverUnderTest]
"""Factory of the solver under test, called in the process that will run the solver; picklable."""
PATIENCE = 1.0
"""Seconds for a process to end by itself once no more is requested, and to be gone once killed."""
ROUNDS = 20
"""Most times that processes left behind are looked for."""
LONGEST_HEADER = 1 << 16
"""Bytes of a reply's first line."""
PAUSES = 5e-4, 0.02
"""Seconds between two looks for a reply, at first and at last."""
SOLVER_OF = "ROUGH_FRICTION_SOLVER_OF"
"""Environment variable of a solver's process and of all that it starts: its value is the run's mark."""
_SERVE = """import sys
sys.path[:] = {path!r}
from verification.solver_suite.process import serve
serve({folder!r})"""


def start(source: Source, folder: Path, mark: str) -> subprocess.Popen[bytes]:
    """Start a solver in a session of its own, with its folder; what it prints goes to standard error."""
    (folder / "source").write_bytes(pickle.dumps(source))
    return subprocess.Popen(
        [sys.executable, "-c", _SERVE.format(path=sys.path, folder=str(folder))],
        stdin=subprocess.PIPE,
        stdout=2,
        env=os.environ | {SOLVER_OF: mark, "TMPDIR": str(folder)},
        start_new_session=True,
    )


def pose(child: subprocess.Popen[bytes], folder: Path, number: int, problem: object) -> None:
    """Ask for the reply ``number``; a line never waits in its pipe, whoever reads it."""
    (folder / f"{number}.problem").write_bytes(pickle.dumps(problem))
    with suppress(OSError):  # an ended process is noticed at its reply
        assert child.stdin is not None
        child.stdin.write(b"%d\n" % number)
        child.stdin.flush()


def reply(
    child: subprocess.Popen[bytes], path: Path, seconds: float, length: int = 0
) -> tuple[dict[str, Any], bytes]:
    """Read a reply with the ``length`` bytes of an answer, once. Raises `Reported` for what came instead."""
    if not wait_until(lambda: os.path.exists(path) or has_ended(child.pid), seconds):
        raise Reported(f"no answer within {seconds:g} s")
    if has_ended(child.pid) and not os.path.exists(path):
        raise Reported(f"the solver's process died ({exit_text(reap(child))})")
    with suppress(OSError, ValueError, RecursionError):
        with open_regular(path) as file:
            header, body = json.loads(file.readline(LONGEST_HEADER)), file.read(length + 1)
        for read in (path, path.with_suffix(".problem")):
            with suppress(OSError):
                read.unlink()
        if isinstance(header, dict) and len(body) == length * (header.get("kind") == "answer"):
            return header, body
    raise Reported("the solver's process sent something else than an answer")


def wait_until(holds: Callable[[], bool], seconds: float) -> bool:
    """Return whether a condition holds by then; it is looked at in growing pauses."""
    deadline, (pause, longest) = time.monotonic() + seconds, PAUSES
    while not (held := holds()) and time.monotonic() < deadline:
        time.sleep(pause)
        pause = min(1.05 * pause, longest)
    return held


def exit_text(status: int | None) -> str:
    """Return an exit status in words; Python counts a signal as a negative one.

    >>> exit_text(3), exit_text(-11), exit_text(-40)
    ('exit status 3', 'killed by SIGSEGV', 'killed by signal 40')
    """
    if status is None or status >= 0:
        return f"exit status {status}"
    names = {each.value: each.name for each in signal.Signals}
    return f"killed by {names.get(-status, f'signal {-status}')}"


def serve(folder: str) -> None:
    """Reply to each number on standard input with the file of that name, until the input ends.

    It ends with the judge too: soon after all that the solver has started is killed.
    """
    numbers: queue.SimpleQueue[int] = queue.SimpleQueue()
    asked = os.fdopen(os.dup(0), encoding="ascii")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    ending = threading.Lock()  # who holds it alone writes to the folder, or removes it
    given = (asked, numbers, folder, os.environ[SOLVER_OF], ending)  # a solver may clear its environment
    threading.Thread(target=_listen, args=given, daemon=True).start()
    served_by = os.getpid()
    try:
        _answer(Path(folder), numbers, ending)
    finally:
        if os.getpid() == served_by:  # no child that the solver forked
            ending.acquire()  # kept: the other thread is not cut off half-way
            shutil.rmtree(folder, ignore_errors=True)


def _listen(
    asked: Iterable[str], numbers: queue.SimpleQueue[int], folder: str, mark: str, ending: threading.Lock
) -> None:
    with suppress(OSError, ValueError):  # a solver may have opened a file in the pipe's place
        for line in asked:
            numbers.put(int(line))
    numbers.put(0)
    time.sleep(2 * PATIENCE)
    with ending:
        for each in _marked(mark) - {psutil.Process()}:
            with suppress(psutil.Error):
                each.kill()
        shutil.rmtree(folder, ignore_errors=True)
        kill_group(os.getpid())


def _answer(folder: Path, numbers: queue.SimpleQueue[int], ending: threading.Lock) -> None:
    served_by = os.getpid()
    try:
        solver = pickle.loads((folder / "source").read_bytes())()  # from the judge, who is trusted here
        identity = getattr(solver, "identity", {})
        _write(folder / "0", {"abilities": asdict(abilities_of(solver)), "identity": identity})
    except InputError as refused:
        value = readable(refused.value if isinstance(refused.value, str) else repr(refused.value))
        _write(folder / "0", {"field": refused.field, "value": value, "allowed": refused.allowed})
        numbers.get()  # until the judge has read it
        return
    while number := numbers.get():
        problem = pickle.loads((folder / f"{number}.problem").read_bytes())
        header, pressure = _posed(solver, problem)
        if os.getpid() != served_by:  # the solver forked, and let its child return: one answer is enough
            os._exit(1)
        with ending:
            _write(folder / str(number), header, pressure)


def _write(path: Path, header: Mapping[str, Any], body: bytes = b"") -> None:
    part = path.with_suffix(".part")
    part.write_bytes(json.dumps(header).encode() + b"\n" + body)
    os.replace(part, path)


def _posed(solver: SolverUnderTest, problem: Any) -> tuple[dict[str, Any], bytes]:
    """Return the header and body of the reply: checked numbers and pressures, or why there are none."""
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
    try:
        return bool(process.is_running() and process.status() != psutil.STATUS_ZOMBIE)
    except psutil.Error:
        return False


def _marked(mark: str) -> set[psutil.Process]:
    """Return the living processes that carry the mark in their environment, whatever session they are in."""
    found = set()
    for process in psutil.process_iter():
        with suppress(psutil.Error, OSError):
            if process.environ().get(SOLVER_OF) == mark and _alive(process):
                found.add(process)
    return found


def _gone(processes: Iterable[psutil.Process]) -> bool:
    return not any(map(_alive, processes))


def reap(leader: subprocess.Popen[bytes]) -> int:
    """Kill the group of a process, and return its exit status: then its number may be anybody's."""
    if leader.returncode is None:
        kill_group(leader.pid)
        leader.kill()
    return leader.wait()


def end_all(leader: subprocess.Popen[bytes], mark: str) -> list[str]:
    """End a solver's process and all that it started; return what was in other sessions than its own.

    These are the processes below it, those that carry the mark in their environment, and what they start.
    """
    below: set[psutil.Process] = set()
    if leader.returncode is None:
        with suppress(psutil.Error):
            below = {*psutil.Process(leader.pid).children(recursive=True)}
        with suppress(OSError):
            assert leader.stdin is not None
            leader.stdin.close()
        wait_until(lambda: has_ended(leader.pid), PATIENCE)
        reap(leader)
    found: dict[int, str] = {}
    for _ in range(ROUNDS):
        left = {each for each in below | _marked(mark) if _alive(each)}
        if not left:
            break
        for each in left:
            with suppress(psutil.Error):
                below |= {*each.children(recursive=True)}
                if not in_session(each.pid, leader.pid):
                    found.setdefault(each.pid, f"{' '.join(each.cmdline())[:80]} (process {each.pid}): ended")
                each.kill()
        wait_until(partial(_gone, left), PATIENCE)
    return [found[pid] for pid in sorted(found)]
