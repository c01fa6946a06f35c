"""Entry of the console script: from its first line on, an interrupt ends it without a traceback."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Sequence


def run(arguments: Sequence[str] | None = None) -> int:
    """Import the command line, which takes a while, and run it; returns the exit status.

    Until `verification.cli.main` takes over, an interrupt ends the process as the system does, unless
    ignored. Messages to a closed standard error are lost. Pictures go to files, whatever ``MPLBACKEND`` says.
    """
    os.environ["MPLBACKEND"] = "agg"
    if sys.stderr is None:  # `2>&-`; a file opened later must not become descriptor 2 of child processes
        sys.stderr = os.fdopen(os.open(os.devnull, os.O_WRONLY), "w", encoding="utf-8")
        os.set_inheritable(sys.stderr.fileno(), True)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from verification.cli import main

    return main(arguments)
