"""``python -m verification.extremes --json FILE``: run the study (four minutes), or go on with it."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the study; status 1 when a number was wrong."""
    parser = argparse.ArgumentParser(prog="python -m verification.extremes", description=__doc__)
    parser.add_argument("--json", type=Path, required=True, help="file to write, and to go on with")
    parser.add_argument("--axis", action="append", default=[], help="only this axis; may be repeated")
    options = parser.parse_args(arguments)
    os.environ.update(dict.fromkeys(THREADS, "1"))

    from verification.extremes import study
    from verification.extremes.state import axes
    from verification.framework.files import Progress

    unknown = [name for name in options.axis if name not in axes()]
    if unknown:
        parser.error(f"--axis {unknown[0]!r}: expected one of {', '.join(axes())}")
    progress = Progress(study.total(options.axis))
    found = study.study(options.json, options.axis, progress.tick)
    progress.close()
    counts = found["counts"]
    print(", ".join(f"{number} {verdict}" for verdict, number in counts.items()), file=sys.stdout)
    return 1 if counts["wrong"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
