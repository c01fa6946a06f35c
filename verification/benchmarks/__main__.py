"""``python -m verification.benchmarks``: measure in turns, append the run to a record and print it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from refimpl.errors import InputError
from verification.benchmarks.codes import codes
from verification.benchmarks.problems import FLATS
from verification.benchmarks.run import append, measured
from verification.benchmarks.summary import lines
from verification.cli.output import columns


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, append and print."""
    parser = argparse.ArgumentParser(prog="python -m verification.benchmarks", description=__doc__)
    parser.add_argument("--grids", default="128,256,512", help="elements per side, by commas")
    parser.add_argument("--codes", help=f"by commas; default: what is installed of {', '.join(codes())}")
    parser.add_argument("--kinds", default=",".join(FLATS), help="smooth, rough or both")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2, help="for every code alike")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds for one solve")
    parser.add_argument("--json", type=Path, required=True, help="record to append the run to")
    options = parser.parse_args(arguments)
    installed = [code.name for code in codes().values() if code.version is not None]
    run = measured(
        [int(M) for M in options.grids.split(",")],
        known("--codes", options.codes, installed),
        known("--kinds", options.kinds, list(FLATS)),
        options.rounds,
        options.threads,
        options.limit,
    )
    append(run, options.json)
    print(columns(lines(run["rows"], run["ratios"]), indent=""))


def known(option: str, names: str | None, allowed: Sequence[str]) -> list[str]:
    """The names in a comma-separated list, all of them by default. Raises `InputError` for a strange one.

    >>> known("--kinds", "rough", ["smooth", "rough"])
    ['rough']
    """
    asked = list(allowed) if names is None else [name.strip() for name in names.split(",")]
    for name in asked:
        if name not in allowed:
            raise InputError(option, name, f"one of those available here: {', '.join(allowed)}")
    return asked


if __name__ == "__main__":
    main()
