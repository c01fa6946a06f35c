"""Predict the experiments and compare: ``python -m verification.experiments --json FILE`` (ten seconds)."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from verification.experiments.comparison import NAMES, measured
from verification.experiments.predictions import points
from verification.output.provenance import provenance
from verification.output.result_files import write_result

TEXTS = ("title", "quantity", "unit", "over", "trend_only", "source", "fitted", "reduction", "left_out",
         "failure")  # fmt: skip


def compared(name: str) -> dict[str, Any]:
    """Return an experiment's texts and points, as the result file has them."""
    data = measured(name)
    return {"name": name, **{key: data[key] for key in TEXTS}, "points": [p.row() for p in points(name)]}


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the comparison of all experiments."""
    parser = argparse.ArgumentParser(prog="python -m verification.experiments", description=__doc__)
    parser.add_argument("--json", type=Path, required=True, metavar="FILE")
    path = parser.parse_args(arguments).json
    write_result({"provenance": provenance(), "experiments": [compared(name) for name in NAMES]}, path)


if __name__ == "__main__":
    main()
