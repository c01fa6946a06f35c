"""``python -m verification.coverage --json FILE``: error bars of ``accuracy=`` against far finer grids.

Finished solves stay in the store, so that the study may be killed and started again.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure with one thread per library; the threads must be set before numpy is imported."""
    parser = argparse.ArgumentParser(prog="python -m verification.coverage", description=__doc__)
    add = parser.add_argument
    add("--json", type=Path, required=True, help="file to write")
    add("--store", type=Path, default=Path("coverage.jsonl"), help="finished solves (default coverage.jsonl)")
    add("--accuracy", type=float, nargs="+", default=[0.01, 0.001], help="accuracies to ask for")
    add("--first", type=int, default=0, help="first seed; 1000 to 1199 trained the estimator")
    add("--scenes", type=int, default=208, help="number of scenes")
    options = parser.parse_args(arguments)
    os.environ.update(dict.fromkeys(THREADS, "1"))

    from verification.coverage.document import document
    from verification.framework.case import jsonable
    from verification.framework.files import write_result

    seeds = range(options.first, options.first + options.scenes)
    write_result(jsonable(document(options.accuracy, seeds, options.store)), options.json)


if __name__ == "__main__":
    main()
