"""How many threads transforms may take.

Threads change no bit of SciPy's transforms, and the last ones of ducc0's (0.42): up to 6e-16 of the largest
number for sizes of 150 to 700. ducc0 takes no more threads than OMP_NUM_THREADS says at first.
"""

from __future__ import annotations

import os


def allowed_threads() -> int:
    """Return OMP_NUM_THREADS, as for BLAS, or the number of cores that this process may use."""
    said = os.environ.get("OMP_NUM_THREADS", "")
    if said.isdigit() and int(said) > 0:
        return int(said)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
