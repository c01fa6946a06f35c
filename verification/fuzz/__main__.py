"""``python -m verification.fuzz --inputs N --json FILE``: fuzz every reader of people's files."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a campaign; status 1 when a traceback or a hang was found."""
    parser = argparse.ArgumentParser(prog="python -m verification.fuzz", description=__doc__)
    parser.add_argument("--inputs", metavar="N", type=int, default=100_000, help="default 100 000")
    parser.add_argument("--seed", metavar="K", type=int, default=2001, help="other inputs (default 2001)")
    parser.add_argument("--json", type=Path, required=True, help="log to write")
    options = parser.parse_args(arguments)
    os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1"))

    from verification.framework.files import Progress, write_result
    from verification.fuzz.campaign import campaign
    from verification.fuzz.targets import targets

    progress = Progress(len(targets()))
    found = campaign(options.inputs, options.seed, progress.tick)
    progress.close()
    write_result(found, options.json)
    print(f"{found['inputs']} inputs, {found['tracebacks']} tracebacks, {found['hangs']} hangs")
    return 1 if found["tracebacks"] or found["hangs"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
