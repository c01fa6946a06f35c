"""Cost of a solve over its solver alone, and of friction over none: ``python -m`` this module.

Both take turns, A B A B, in one process; ratios are of processor seconds by round. Work is counted.
"""

from __future__ import annotations

import argparse
import math
import time

import numpy as np

from refimpl.grid import Array
from verification.benchmarks.codes import OWN, SETTINGS, SLOPED, alone, own
from verification.benchmarks.problems import FLATS
from verification.benchmarks.rounds import CERTIFIED
from verification.output.text_table import columns


def turns(name: str, kind: str, M: int, count: int, *, bars: bool = False) -> tuple[Array, float]:
    """Return processor seconds of the solve and of its solver, ``(count, 2)``, and the work of a solve."""
    both = own(*SETTINGS[name], kind, M, CERTIFIED, bars=bars), alone(*SETTINGS[name], kind, M, CERTIFIED)
    work = [press().operations["n log2 n"] for press in both]  # a first solve each, which is not timed
    clocks = np.empty((count, 3))
    for row in clocks:
        row[0] = time.process_time()
        for place, press in enumerate(both, start=1):
            press()
            row[place] = time.process_time()
    return np.diff(clocks), work[0]


def main() -> None:
    """Print medians, the quartiles of the ratios, and the work over that without friction."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--grids", nargs="+", type=int, default=[128, 256, 512])
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--bars", action="store_true", help="solves with their error bars and warnings")
    options = parser.parse_args()
    rows, least = [["problem", "code", "ms", "solver, ms", "ratio", "quartiles", "work over none"]], math.nan
    for kind, M, name in ((kind, M, name) for kind in FLATS for M in options.grids for name in (OWN, SLOPED)):
        seconds, work = turns(name, kind, M, options.rounds, bars=options.bars)
        least = work if name == OWN else least
        low, middle, high = np.quantile(seconds[:, 0] / seconds[:, 1], [0.25, 0.5, 0.75])
        medians = [f"{1e3 * value:.3g}" for value in np.median(seconds, axis=0)]
        ratio = [f"{middle:.2f}", f"{low:.2f} to {high:.2f}", f"{work / least:.2f}"]
        rows.append([f"{kind} {M}", name, *medians, *ratio])
    print(columns(rows, indent=""))


if __name__ == "__main__":
    main()
