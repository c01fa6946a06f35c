"""``python -m verification.properties --examples N --json FILE``: the invariants with new seeds, for long."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from verification.properties.nightly import run


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status 0 when every example held, 1 when there is a counter-example."""
    parser = argparse.ArgumentParser(prog="python -m verification.properties", description=__doc__)
    parser.add_argument("--examples", type=int, default=10_000, help="at least so many in all")
    parser.add_argument("--seed", type=int, default=1, help="another seed, other examples")
    parser.add_argument("--json", type=Path, required=True, help="log to write, and to resume from")
    options = parser.parse_args(arguments)
    return 0 if run(options.json, options.examples, options.seed) else 1


if __name__ == "__main__":
    raise SystemExit(main())
