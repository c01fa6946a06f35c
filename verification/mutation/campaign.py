"""``python -m verification.mutation.campaign --log FILE --json FILE``: meaningful faults that tests notice.

The faults of ``faults.toml``, and of later lists beside it (``--table``), were invented from the source: a
sign, a column, a lost row, a wrong unit. With ``--random N`` they are N mutants of each area instead, of all
its modules. Each fault is written into a clone of the committed tree and judged there: by the doctests of its
module, the tests that import it and the tests of its area, until one fails. A verdict is kept in the log and
counts as long as the module stands as it was; an unnoticed fault is tried again when its tests have changed.
Areas take turns: a run that is stopped, or has ``--tries``, has judged a stratified sample.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import subprocess
import tempfile
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatch
from itertools import islice, zip_longest
from pathlib import Path
from typing import Any, NamedTuple

from reports.result_files import read_result
from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance
from verification.mutation.judge import Suite
from verification.mutation.mutants import candidates, mutant
from verification.mutation.score import explanations, lower_bound
from verification.mutation.session import in_fair_order
from verification.mutation.targets import definitions, near_first

ROOT = Path(__file__).resolve().parents[2]
TABLE = Path(__file__).with_name("faults.toml")
GOAL = 0.90  # share of the faults that tests notice
NOT_JUDGED = "not judged"
LIMIT = 600  # processor seconds of one trial: more than the tests of any area take

Record = dict[str, Any]
Areas = Mapping[str, Mapping[str, Sequence[str]]]


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


def read_areas() -> Areas:
    """Return the areas: their ``modules`` and ``tests``, by folder."""
    areas: Areas = tomllib.loads(TABLE.read_text(encoding="utf-8"))["areas"]
    return areas


def read_faults(path: Path = TABLE) -> list[Fault]:
    """Return the faults of a table, each of the area whose modules its file is one of."""
    files = tomllib.loads(path.read_text(encoding="utf-8"))["faults"]
    area = {folder: name for name, one in read_areas().items() for folder in one["modules"]}
    return [
        Fault(next(area[folder] for folder in area if file.startswith(f"{folder}/")), file, breaks, old, new)
        for file, texts in files.items()
        for breaks, (old, new) in texts.items()
    ]


def mutants_of(root: Path, name: str, folders: Sequence[str], seed: int) -> Iterable[Fault]:
    """Mutants of all modules of an area in a fair order, each as a fault of its whole file."""
    files = [path for folder in folders for path in sorted((root / folder).rglob("*.py"))]
    files = [path for path in files if path.name not in ("__init__.py", "__main__.py")]
    sources = {str(path.relative_to(root)): path.read_text(encoding="utf-8") for path in files}
    found = [one for file, source in sources.items() for one in candidates(file, source)]
    for candidate in in_fair_order(found, seed):
        source = sources[candidate.module]
        changed = mutant(candidate, source)
        if changed is not None:
            line = f"{candidate.operator}, line {changed.line}: {changed.before} -> {changed.after}"
            yield Fault(name, candidate.module, line, source, changed.source)


def tried(root: Path, fault: Fault, tests: Sequence[str], moment: int, sound: set[str]) -> Record:
    """Write a fault into the tree at ``root``, run the tests, and restore the file.

    ``moment`` (s) dates the file: bytecode of another trial is not taken for its own. A test that fails
    without the fault as well counts for nothing, and the trial is repeated without it; ``sound`` collects
    the tests that were seen to pass without one.
    """
    path, failing, seconds = root / fault.file, list[str](), 0.0
    source = path.read_text(encoding="utf-8")
    while True:
        try:
            path.write_text(fault.applied(source), encoding="utf-8")
            os.utime(path, (moment, moment))
            without = tuple(f"--deselect={test}" for test in failing)
            verdict = Suite(root, tests, by_file=True).verdict_of_tree(LIMIT, without)
        finally:
            path.write_text(source, encoding="utf-8")
            os.utime(path, (moment + 1, moment + 1))
        seconds += verdict.seconds
        if verdict.outcome != "killed" or not verdict.killer or verdict.killer in (*failing, *sound):
            break
        if Suite(root, [verdict.killer]).verdict_of_tree(LIMIT).outcome == "survived":
            sound.add(verdict.killer)
            break
        failing.append(verdict.killer)
    outcome = "unnoticed" if verdict.outcome == "survived" else "noticed"
    return {"outcome": outcome, "test": verdict.killer, "seconds": round(seconds, 2), "failing": failing}


def run(
    faults: Sequence[Fault],
    areas: Areas,
    log: Path,
    clone: Path,
    *,
    far: bool,
    first: Sequence[Record] = (),
    tries: int | None = None,
) -> list[Record]:
    """Try the faults that the log (JSON lines) does not hold; return the records of all that are judged.

    ``far`` has tests of other areas that import the module run as well. The test that noticed the fault
    before, in a record of ``first``, is in the file that comes first. Trials end after ``tries``.
    """
    known = {record["key"]: record for record in _read(log)}
    noticed_by = {record["breaks"]: str(record["test"]).partition("::")[0] for record in first}
    records, progress, sound = [], Progress(len(faults)), set[str]()
    Suite(clone, ["tests"]).import_foreign()
    for number, fault in enumerate(faults):
        source = (clone / fault.file).read_text(encoding="utf-8")
        names = definitions(source, fault.applied(source))
        near = near_first(clone, fault.file, areas[fault.area]["tests"], far=far, names=names)
        before = noticed_by.get(fault.breaks)
        tests = sorted((fault.file, *near), key=lambda test: test != before)
        key = _digest([*fault, source])
        suite = _digest((clone / test).read_text(encoding="utf-8") for test in tests)
        record = known.get(key)
        if record is None or (record["outcome"] == "unnoticed" and record["suite"] != suite):
            if tries is not None and (tries := tries - 1) < 0:
                continue
            found = tried(clone, fault, tests, 10**9 + 2 * number, sound)
            record = {"key": key, "suite": suite, "area": fault.area, "file": fault.file}
            record |= {"breaks": fault.breaks, **found}
            with log.open("a", encoding="utf-8") as lines:
                lines.write(json.dumps(record, ensure_ascii=False) + "\n")
        records.append(record)
        progress.tick(f"{record['outcome']} {fault.file}: {fault.breaks}")
    progress.close()
    return records


def summary(records: Sequence[Record], first: Sequence[Record] = ()) -> Record:
    """Return the result: noticed shares, by area as well, and faults that were not noticed from the first.

    ``first`` are the records of the faults as first judged, before any test was written for one of them.
    """
    before, reasons = {r["breaks"]: r["outcome"] for r in first or records}, _reasons()
    listed = [r for r in records if not r["outcome"] == before.get(r["breaks"]) == "noticed"]
    return {
        "all": _counts(records, before),
        "areas": [
            {"area": area, **_counts([r for r in records if r["area"] == area], before)}
            for area in dict.fromkeys(record["area"] for record in records)
        ],
        "list": [
            {name: record[name] for name in ("area", "file", "breaks", "outcome", "test")}
            | {"first": before.get(record["breaks"], NOT_JUDGED)}
            | {"reason": reasons.get((record["file"], record["breaks"].partition(": ")[2]))}
            for record in listed
        ],
    }


def _reasons() -> dict[tuple[str, str], str]:
    """Reasons for survivors of random mutants, by their file and by their lines before and after."""
    return {(file, f"{before} -> {after}"): why for (file, before, after), why in explanations().items()}


def _counts(records: Sequence[Record], before: Mapping[str, str]) -> Record:
    """Number of faults and of those judged at first; noticed shares at first and now; the lower bound (95 %)
    of the first.
    """
    judged = [before[record["breaks"]] for record in records if record["breaks"] in before]
    first, now = judged.count("noticed"), sum(record["outcome"] == "noticed" for record in records)
    return {
        "faults": len(records),
        "judged": len(judged),
        "first": round(first / len(judged), 4) if judged else None,
        "first_lower_bound": round(lower_bound(first, len(judged)), 4) if judged else None,
        "now": round(now / len(records), 4),
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status 0 when the goal is met, else 1."""
    parser = argparse.ArgumentParser(prog="python -m verification.mutation.campaign", description=__doc__)
    parser.add_argument("--only", nargs="+", default=["*"], help="patterns of the areas to try now")
    parser.add_argument("--table", type=Path, default=TABLE, help="list of faults (default: the first one)")
    parser.add_argument(
        "--random", type=int, metavar="N", help="N mutants of each area, in place of the list"
    )
    parser.add_argument("--seed", type=int, default=1, help="of the mutants' order")
    parser.add_argument("--far", action="store_true", help="tests of other areas too; the list has them")
    parser.add_argument("--tree", metavar="COMMIT", default="HEAD", help="what is judged (default HEAD)")
    parser.add_argument("--tries", type=int, metavar="N", help="end after N trials; the result is of what is")
    parser.add_argument("--log", type=Path, required=True, help="JSON lines: every verdict; resumed from")
    parser.add_argument("--first", type=Path, help="log, or earlier result, with first judgements")
    parser.add_argument("--json", type=Path, help="result to write")
    options = parser.parse_args(arguments)
    areas = read_areas()
    chosen = [name for name in areas if any(fnmatch(name, pattern) for pattern in options.only)]
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "clone"
        subprocess.run(["git", "clone", "-q", str(ROOT), str(clone)], check=True)
        subprocess.run(["git", "-C", str(clone), "checkout", "-q", "--detach", options.tree], check=True)
        if options.random is None:
            every = read_faults(options.table)
            drawn = [[fault for fault in every if fault.area == name] for name in chosen]
        else:
            orders = [mutants_of(clone, name, areas[name]["modules"], options.seed) for name in chosen]
            drawn = [list(islice(order, options.random)) for order in orders]
        listed = [fault for turn in zip_longest(*drawn) for fault in turn if fault is not None]
        first = first_judgements(options.first) if options.first else ()
        far = options.far or options.random is None
        records = run(listed, areas, options.log, clone, far=far, first=first, tries=options.tries)
    found = summary(records, first)
    if options.json:
        seed = {} if options.random is None else {"seed": options.seed}
        tree = {} if options.tree == "HEAD" else {"tree": options.tree}
        write_result({**found, **seed, **tree, "provenance": provenance()}, options.json)
    print(found["all"])
    return 0 if found["all"]["now"] >= GOAL else 1


def first_judgements(path: Path) -> list[Record]:
    """Return the records of a log (``.jsonl``), or those of a result's faults that were judged at first."""
    if path.suffix == ".jsonl":
        return _read(path)
    rows = read_result(path)["list"]
    return [{**row, "outcome": row["first"]} for row in rows if row["first"] != NOT_JUDGED]


def _read(log: Path) -> list[Record]:
    if not log.exists():
        return []
    return [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]


def _digest(texts: Iterable[str]) -> str:
    """Fingerprint of texts."""
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:12]


if __name__ == "__main__":
    raise SystemExit(main())
