"""Threads of this process and its children, of BLAS and of transforms: one by default."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_info, threadpool_limits

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Where libraries of BLAS, ducc0 and `refimpl.operators.threads` read it, most of them at import."""

_TURN = threading.RLock()


@contextmanager
def one_thread() -> Iterator[None]:
    """Give processes started in the block one thread; the environment is put back as it was.

    >>> import os
    >>> before = dict(os.environ)
    >>> with one_thread():
    ...     os.environ["MKL_NUM_THREADS"]
    '1'
    >>> os.environ == before
    True
    """
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def limited_to_one_thread() -> Iterator[None]:
    """Limit this process to one thread in the block, whatever its environment was at import.

    BLAS is limited by its own interface; transforms read the environment at every call. Both are the
    process's own, so blocks of several threads take turns. Raises RuntimeError where a library of BLAS or
    OpenMP does not take the limit.
    """
    with _TURN, one_thread(), threadpool_limits(1):
        loose = [pool["internal_api"] for pool in threadpool_info() if pool["num_threads"] != 1]
        if loose:
            raise RuntimeError(f"{', '.join(loose)} cannot be limited to one thread")
        yield
