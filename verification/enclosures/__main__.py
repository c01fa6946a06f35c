"""Prove every scene anew and write its file: ``python -m verification.enclosures --json DIR``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from verification.enclosures.build import proven
from verification.enclosures.store import write


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status 0 when all scenes are proven, 2 without the directory; raises `NotProven`."""
    parser = argparse.ArgumentParser(prog="python -m verification.enclosures", description=__doc__)
    parser.add_argument("--json", metavar="DIR", type=Path, required=True, help="directory of the JSON files")
    folder: Path = parser.parse_args(arguments).json
    if not folder.is_dir():
        print(f"{folder} is no directory", file=sys.stderr)
        return 2
    for known, proof in proven():
        path = write(known, proof, folder)
        print(f"{path.name}: {len(proof.pressures)} of {known.M**2} elements in contact, proven")
    return 0


if __name__ == "__main__":
    sys.exit(main())
