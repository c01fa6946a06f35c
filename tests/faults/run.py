"""Cross-check by fault: production with one fault in its source against the one-page reference.

For each fault of ``faults.toml`` `refimpl` is copied, the copy patched, and all scenes are solved with it in
a process of its own.
"""

from __future__ import annotations

import argparse
import json
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
    """A replacement of ``old``, once in ``refimpl/file``; ``unseen``: why it changes no number."""

    id: str
    area: str
    file: str
    old: str
    new: str
    unseen: str = ""


TABLE = tomllib.loads((ROOT / "tests/faults/faults.toml").read_text("utf-8"))["fault"]
FAULTS = {table["id"]: Fault(**table) for table in TABLE}


class Verdict(NamedTuple):
    """Largest relative changes from production without the fault, and differences from the reference.

    ``where`` is the scene and number of the latter, ``unexpected`` are scenes with another status, and
    ``silent`` says whether production ends as converged or cycled everywhere.
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


def solved(fault: Fault | None, names: Sequence[str] = NAMES) -> dict[str, Record]:
    """Records of the scenes by a copy of production, with a fault in it if one is given."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "refimpl", Path(folder, "refimpl"))
        if fault:
            path = Path(folder, "refimpl", fault.file)
            path.write_text(path.read_text("utf-8").replace(fault.old, fault.new), "utf-8")
        command = [sys.executable, "-W", "ignore", "-m", "tests.faults.scenes", *names]
        environment = os.environ | {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}", "OPENBLAS_NUM_THREADS": "1"}
        try:
            done = subprocess.run(
                command, cwd=folder, env=environment, capture_output=True, text=True, timeout=SECONDS
            )
        except subprocess.TimeoutExpired:
            return {name: {"status": f"no end within {SECONDS} s"} for name in names}
    if done.returncode:
        return {name: {"status": done.stderr.strip().splitlines()[-1]} for name in names}
    return dict(json.loads(done.stdout))


@cache
def references(names: Sequence[str] = NAMES) -> tuple[dict[str, Record], dict[str, Record]]:
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


def main() -> int:
    """Run the faults, two at a time, and print them; return how many change numbers without being noticed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", metavar="ID", default=FAULTS)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    references()  # once, before the threads ask
    with ThreadPoolExecutor(2) as pool:
        verdicts = list(pool.map(judged, [FAULTS[name] for name in options.only]))
    for v in verdicts:
        seen = ("comparison alone" if v.silent else "production too") if v.noticed else "not noticed"
        print(f"{v.id:24}{v.area:17}{v.changed:9.1e}{v.differs:9.1e}  {seen}  {v.where}")
    changing = [v for v in verdicts if v.changed > LEAST]
    noticed = [v for v in changing if v.noticed]
    alone = sum(v.silent for v in noticed)
    print(f"{len(verdicts)} faults; {len(changing)} change a number by more than {LEAST:g}; noticed:")
    print(f"{len(noticed)}, {alone} by the comparison alone: production ends as converged or cycled")
    if options.json:
        rows = [v._asdict() | {"noticed": v.noticed} for v in verdicts]
        options.json.write_text(json.dumps(rows, indent=1).replace("Infinity", '"inf"') + "\n", "utf-8")
    return len(changing) - len(noticed)


if __name__ == "__main__":
    sys.exit(main())
