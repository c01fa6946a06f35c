"""Number of threads that transforms may take.

Threads change no bit of SciPy's transforms, and the last ones of ducc0's (0.42): up to 6e-16 of the largest
number for sizes of 150 to 700. ducc0 takes no more threads than OMP_NUM_THREADS says at first.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager

from refimpl.operating_system import cores

_NAMES = ("OMP_NUM_THREADS", "DUCC0_NUM_THREADS")


def allowed_threads() -> int:
    """Return OMP_NUM_THREADS, or its first number in a list, or the number of cores for this process."""
    said = _number(os.environ.get("OMP_NUM_THREADS", "").partition(",")[0])
    if said is not None:
        return said
    return cores()


@contextmanager
def plain_number_of_threads() -> Iterator[None]:
    """Write whole numbers of threads into the environment, in the block; ducc0 asserts that they are."""
    before = {name: os.environ.get(name) for name in _NAMES}
    plain = {name: str(_number(said or "") or allowed_threads()) for name, said in before.items()}
    os.environ.update(plain)
    try:
        yield
    finally:
        for name, said in before.items():
            if said is None:
                del os.environ[name]
            else:
                os.environ[name] = said


def _number(said: str) -> int | None:
    """Return the positive whole number that the text is, of six digits at most."""
    return int(said) if re.fullmatch(r"\s*0*[1-9][0-9]{0,5}\s*", said) else None
