"""``python -m verification.chaos --sweeps 50 --json FILE``: sweeps killed at random (15 minutes)."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a campaign; status 1 when a table was different or a traceback was shown."""
    parser = argparse.ArgumentParser(prog="python -m verification.chaos", description=__doc__)
    parser.add_argument("--sweeps", metavar="N", type=int, default=50, help="default 50")
    parser.add_argument("--seed", metavar="K", type=int, default=2001, help="other faults (default 2001)")
    parser.add_argument("--json", type=Path, required=True, help="log to write")
    options = parser.parse_args(arguments)
    os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1"))

    from verification.chaos.campaign import campaign
    from verification.framework.files import Progress, write_result

    progress = Progress(options.sweeps)
    found = campaign(
        options.sweeps, options.seed, progress.tick, lambda part: write_result(part, options.json)
    )
    progress.close()
    write_result(found, options.json)
    print(f"{found['sweeps']} sweeps, {found['different']} different, {found['tracebacks']} tracebacks")
    return 1 if found["different"] or found["tracebacks"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
