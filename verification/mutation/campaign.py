"""``python -m verification.mutation.campaign --log FILE --json FILE``: meaningful faults that tests notice.

The faults of ``faults.toml`` were invented by reading the source: a sign, a column, a lost row, a wrong unit.
Each is written into a clone of the committed tree and judged there by the doctests of its module, the tests
that import it and the tests of its area, until one fails. A verdict is kept in the log and counts as long as
the module stands as it was; an unnoticed fault is tried again when its tests have changed.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import json
import os
import subprocess
import tempfile
import tomllib
from collections.abc import Mapping, Sequence
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, NamedTuple

from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance
from verification.mutation.judge import Suite
from verification.mutation.score import lower_bound

ROOT = Path(__file__).resolve().parents[2]
TABLE = Path(__file__).with_name("faults.toml")
GOAL = 0.90  # share of the faults that tests notice
LIMIT = 600  # processor seconds of one trial: more than the tests of any area take

Record = dict[str, Any]


class Fault(NamedTuple):
    """A wrong text ``new`` for ``old``, which stands once in ``file``; ``breaks`` names the effect."""

    area: str
    file: str
    breaks: str
    old: str
    new: str

    def applied(self, source: str) -> str:
        """Return the source with the fault; raises ValueError unless the old text stands there once."""
        if source.count(self.old) != 1:
            raise ValueError(f"{self.file}: {self.old!r} stands there {source.count(self.old)} times")
        return source.replace(self.old, self.new)


def read_faults(path: Path = TABLE) -> tuple[list[Fault], dict[str, list[str]]]:
    """Return the faults of a table, and the folders of tests by area."""
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    return [Fault(**row) for row in table["fault"]], table["areas"]


def tests_of(root: Path, file: str, folders: Sequence[str]) -> tuple[str, ...]:
    """Return the arguments for pytest, nearest first: doctests, the mirror test, tests that import the file,
    and the rest of the area.
    """
    module = file.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    area = sorted(path for folder in folders for path in (root / folder).rglob("test_*.py"))
    every = sorted((root / "tests").rglob("test_*.py"))
    importing = [path for path in every if module in imported(path.read_text(encoding="utf-8"))]
    mirrors = [path for path in area if path.name == f"test_{Path(file).stem}.py"]
    near = [path for path in importing if path in area]
    ordered = dict.fromkeys((*mirrors, *near, *importing, *area))
    return file, *(str(path.relative_to(root)) for path in ordered)


def imported(source: str) -> set[str]:
    """Return the names of modules that a source imports, and of what it imports from packages.

    >>> sorted(imported("import a.b\\nfrom c import d"))
    ['a.b', 'c', 'c.d']
    """
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{name.name}" for name in node.names)}
    return found


def tried(root: Path, fault: Fault, tests: Sequence[str], moment: int) -> Record:
    """Write a fault into the tree at ``root``, run the tests, and restore the file.

    ``moment`` (s) dates the file: bytecode of another trial is not taken for its own. A test that fails
    without the fault as well counts for nothing, and the trial is repeated without it.
    """
    path, failing, seconds = root / fault.file, list[str](), 0.0
    source = path.read_text(encoding="utf-8")
    while True:
        try:
            path.write_text(fault.applied(source), encoding="utf-8")
            os.utime(path, (moment, moment))
            without = [f"--deselect={test}" for test in failing]
            verdict = Suite(root, [*tests, *without]).verdict_of_tree(LIMIT)
        finally:
            path.write_text(source, encoding="utf-8")
            os.utime(path, (moment + 1, moment + 1))
        seconds += verdict.seconds
        if verdict.outcome != "killed" or not verdict.killer or verdict.killer in failing:
            break
        if Suite(root, [verdict.killer]).verdict_of_tree(LIMIT).outcome == "survived":
            break
        failing.append(verdict.killer)
    outcome = "unnoticed" if verdict.outcome == "survived" else "noticed"
    return {"outcome": outcome, "test": verdict.killer, "seconds": round(seconds, 2), "failing": failing}


def run(faults: Sequence[Fault], areas: Mapping[str, Sequence[str]], log: Path) -> list[Record]:
    """Try the faults that the log (JSON lines) does not hold; return the records of all, in their order."""
    known = {record["key"]: record for record in _read(log)}
    records, progress = [], Progress(len(faults))
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "clone"
        subprocess.run(["git", "clone", "-q", str(ROOT), str(clone)], check=True)
        Suite(clone, ["tests"]).import_foreign()
        for number, fault in enumerate(faults):
            tests = tests_of(clone, fault.file, areas[fault.area])
            key = _digest([*fault, (clone / fault.file).read_text(encoding="utf-8")])
            suite = _digest((clone / test).read_text(encoding="utf-8") for test in tests)
            record = known.get(key)
            if record is None or (record["outcome"] == "unnoticed" and record["suite"] != suite):
                found = tried(clone, fault, tests, 10**9 + 2 * number)
                record = {"key": key, "suite": suite, "area": fault.area, "file": fault.file}
                record |= {"breaks": fault.breaks, **found}
                with log.open("a", encoding="utf-8") as lines:
                    lines.write(json.dumps(record, ensure_ascii=False) + "\n")
            records.append(record)
            progress.tick(f"{record['outcome']} {fault.file}: {fault.breaks}")
    progress.close()
    return records


def summary(records: Sequence[Record], first: Sequence[Record] = ()) -> Record:
    """Return the result: noticed shares, by area as well, and every fault with its outcome.

    ``first`` are the records of the faults as first judged, before any test was written for one of them.
    """
    before = {record["breaks"]: record["outcome"] for record in first or records}
    areas = list(dict.fromkeys(record["area"] for record in records))
    return {
        "faults": len(records),
        "noticed": _share([record["outcome"] for record in records]),
        "noticed_lower_bound": lower_bound(
            sum(record["outcome"] == "noticed" for record in records), len(records)
        ),
        "first_noticed": _share(list(before.values())),
        "first_lower_bound": lower_bound(
            sum(outcome == "noticed" for outcome in before.values()), len(before)
        ),
        "areas": [
            {
                "area": area,
                "faults": sum(record["area"] == area for record in records),
                "first": _share([before[r["breaks"]] for r in records if r["area"] == area]),
                "now": _share([r["outcome"] for r in records if r["area"] == area]),
            }
            for area in areas
        ],
        "list": [
            {name: record[name] for name in ("area", "file", "breaks", "outcome", "test")}
            | {"first": before[record["breaks"]]}
            for record in records
        ],
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status 0 when the goal is met, else 1."""
    parser = argparse.ArgumentParser(prog="python -m verification.mutation.campaign", description=__doc__)
    parser.add_argument("--only", nargs="+", default=["*"], help="patterns of the areas to try now")
    parser.add_argument("--log", type=Path, required=True, help="JSON lines: every verdict; resumed from")
    parser.add_argument("--first", type=Path, help="log of the faults as first judged")
    parser.add_argument("--json", type=Path, help="result to write")
    options = parser.parse_args(arguments)
    faults, areas = read_faults()
    chosen = [fault for fault in faults if any(fnmatch(fault.area, pattern) for pattern in options.only)]
    found = summary(run(chosen, areas, options.log), _read(options.first) if options.first else ())
    if options.json:
        write_result(found | {"provenance": provenance()}, options.json)
    print({name: found[name] for name in ("faults", "noticed", "first_noticed")})
    return 0 if found["noticed"] >= GOAL else 1


def _share(outcomes: Sequence[str]) -> float:
    return round(outcomes.count("noticed") / len(outcomes), 4)


def _read(log: Path) -> list[Record]:
    if not log.exists():
        return []
    return [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]


def _digest(texts: Any) -> str:
    """Fingerprint of texts."""
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:12]


if __name__ == "__main__":
    raise SystemExit(main())
