"""``python -m verification.variational --json FILE``: measure Table 2's competitors and write them down."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure with one thread per library; the threads must be set before numpy is imported."""
    parser = argparse.ArgumentParser(prog="python -m verification.variational", description=__doc__)
    parser.add_argument("--json", type=Path, required=True, help="file to write")
    parser.add_argument("--budget", type=float, default=100.0, help="processor seconds for one solve")
    parser.add_argument("--rounds", type=int, default=2, help="turns of every method on every grid")
    parser.add_argument("--grids", type=int, nargs="+", help="elements per side, rising")
    options = parser.parse_args(arguments)
    os.environ.update(dict.fromkeys(THREADS, "1"))

    from verification.framework.files import write_result
    from verification.variational.document import document

    found = document(options.rounds, options.budget, options.grids)
    write_result(found, options.json)


if __name__ == "__main__":
    main()
