"""Cross-check by fault: production with one fault in its source against the one-page reference.

`python -m tests.faults.run [--only ID ...] [--json FILE]` copies `refimpl` for each fault of ``faults.toml``,
patches the copy, solves all scenes with it in a process of its own, and prints what a comparison sees.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import NamedTuple

from tests.faults.scenes import NAMES, Record, difference, expected
from tests.layers import ROOT

LEAST = 1e-6  # relative difference that counts
SECONDS = 120  # limit of one process


class Fault(NamedTuple):
    """A replacement of ``old``, which occurs once in ``refimpl/file``, by ``new``."""

    id: str
    area: str
    file: str
    old: str
    new: str


class Verdict(NamedTuple):
    """Outcome of a fault.

    changed, differs : largest relative difference from the unpatched production solver, and from the reference
    where : the scene and number of the latter
    unexpected : scenes that end otherwise than they should, by name
    silent : whether production ends as converged or cycled everywhere
    """

    id: str
    area: str
    changed: float
    differs: float
    where: str
    unexpected: dict[str, str]
    silent: bool

    @property
    def noticed(self) -> bool:
        """Whether the comparison with the reference sees the fault."""
        return self.differs > LEAST or bool(self.unexpected)


FAULTS = tuple(
    Fault(**table) for table in tomllib.loads((ROOT / "tests/faults/faults.toml").read_text("utf-8"))["fault"]
)


def solved(fault: Fault | None, names: Sequence[str] = NAMES) -> dict[str, Record]:
    """Records of the scenes by a copy of production, with a fault in it if one is given."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "refimpl", Path(folder, "refimpl"))
        if fault:
            path = Path(folder, "refimpl", fault.file)
            path.write_text(path.read_text("utf-8").replace(fault.old, fault.new), "utf-8")
        command = [sys.executable, "-W", "ignore", "-m", "tests.faults.scenes", *names]
        paths = {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}", "OMP_NUM_THREADS": "1"}
        try:
            done = subprocess.run(
                command, cwd=folder, env=os.environ | paths, capture_output=True, text=True, timeout=SECONDS
            )
        except subprocess.TimeoutExpired:
            return {name: {"status": f"no end within {SECONDS} s"} for name in names}
    if done.returncode:
        return {name: {"status": done.stderr.strip().splitlines()[-1]} for name in names}
    return dict(json.loads(done.stdout))


@cache
def references(names: tuple[str, ...] = NAMES) -> tuple[dict[str, Record], dict[str, Record]]:
    """Records by the reference, and by production without a fault."""
    return {name: expected(name) for name in names}, solved(None, names)


def judged(fault: Fault, names: tuple[str, ...] = NAMES) -> Verdict:
    """Run a fault."""
    plain, unpatched = references(names)
    records = solved(fault, names)
    changed = max(difference(records[name], unpatched[name])[0] for name in names)
    (differs, number), scene = max((difference(records[name], plain[name]), name) for name in names)
    ended = {name: records[name]["status"] for name in names}
    unexpected = {name: status for name, status in ended.items() if status != plain[name]["status"]}
    silent = set(ended.values()) <= {"converged", "cycled"}
    return Verdict(fault.id, fault.area, changed, differs, f"{scene}: {number}", unexpected, silent)


def main() -> None:
    """Run the faults, two at a time, and print a table and its sums."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", metavar="ID")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    references()
    with ThreadPoolExecutor(2) as pool:
        verdicts = list(pool.map(judged, [f for f in FAULTS if not options.only or f.id in options.only]))
    for v in verdicts:
        verdict = ("silent" if v.silent else "status") if v.noticed else "UNSEEN"
        print(f"{v.id:24}{v.area:17}{v.changed:9.1e}{v.differs:9.1e}  {verdict}  {v.where}", *v.unexpected)
    changing = [v for v in verdicts if v.changed > LEAST]
    seen = [v for v in verdicts if v.noticed]
    print(f"{len(verdicts)} faults, {len(changing)} change a number by more than {LEAST:g}, of these noticed:")
    print(f"{sum(v.noticed for v in changing)}; by the comparison alone: {sum(v.silent for v in seen)}")
    if options.json:
        rows = [v._asdict() | {"noticed": v.noticed} for v in verdicts]
        finite = [{k: str(x) if x == math.inf else x for k, x in row.items()} for row in rows]
        options.json.write_text(json.dumps(finite, indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
