"""End of a process: signals become exceptions, so that every `finally` on their way cleans up."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


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


def told(status: int | None) -> str:
    """An exit status in words; Python counts a signal as a negative one.

    >>> told(3), told(-11), told(-40)
    ('exit status 3', 'killed by SIGSEGV', 'killed by signal 40')
    """
    if status is None or status >= 0:
        return f"exit status {status}"
    names = {each.value: each.name for each in signal.Signals}
    return f"killed by {names.get(-status, f'signal {-status}')}"
