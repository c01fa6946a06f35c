"""``python -m verification.matrix --json FILE``: which check sees which fault."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from reports.result_files import read_result
from verification.framework.files import write_result
from verification.matrix.merge import merged
from verification.matrix.run import CHEAP, Matrix, measure


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status 0 when every fault is seen, 1 when one is not; the file grows fault by fault."""
    parser = argparse.ArgumentParser(prog="python -m verification.matrix", description=__doc__)
    parser.add_argument("--json", metavar="FILE", type=Path, required=True, help="result file")
    parser.add_argument(
        "--cheap", metavar="S", type=float, default=CHEAP, help="CPU seconds a check may take (%(default)s)"
    )
    parser.add_argument(
        "--times", metavar="FILE", type=Path, help="results of an earlier `verify`, to skip dear cases by"
    )
    parser.add_argument(
        "--skip", metavar="GLOB", action="append", default=[], help="checks to exclude (repeat)"
    )
    parser.add_argument("--only", metavar="GLOB", action="append", help="checks to take (repeat; all)")
    parser.add_argument("--against", metavar="GLOB", action="append", help="faults to try (repeat; all)")
    parser.add_argument("--add", action="store_true", help="add other checks to what the file holds")
    asked = parser.parse_args(arguments)
    known = {}
    if asked.times is not None:
        cases = read_result(asked.times)["cases"]
        known = {case["id"]: case["seconds"] for case in cases}
    old = read_result(asked.json) if asked.add else None
    tried = [check["id"] for check in old["checks"]] if old is not None else []
    skip = [*asked.skip, *tried]
    matrix: Matrix | None = None
    for matrix in measure(asked.cheap, known, skip, asked.only or ("*",), asked.against or ("*",)):
        found = matrix.document()
        write_result(found if old is None else merged(old, found), asked.json)
    if matrix is None:
        print("no check is left to try", file=sys.stderr)
        return 1
    missed = [name for name, seen in matrix.caught_by.items() if not seen]
    print(
        f"{len(matrix.sound)} checks, {len(matrix.faults)} faults; seen by none: {', '.join(missed) or '-'}"
    )
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
