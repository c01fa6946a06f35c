"""A mutation run: which mutants, in which order, and what is known of them already."""

from __future__ import annotations

import hashlib
import json
import random
from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from verification.framework.files import Progress
from verification.mutation.judge import Suite
from verification.mutation.mutants import Candidate, candidates, mutant
from verification.mutation.targets import Target

ALLOWANCE = 2.5
"""A trial may take this many times the unmutated suite's processor time ..."""
LEAST = 8
"""... but at least so many seconds: shrinking an invariant's counter-example costs some."""

Record = dict[str, Any]


def in_fair_order(found: Iterable[Candidate], seed: int) -> list[Candidate]:
    """The candidates in an order every beginning of which is a proportional sample of modules and strata.

    Each stratum of each module is shuffled and spread evenly over the whole.
    """
    strata = defaultdict(list)
    for candidate in found:
        strata[candidate.module, candidate.stratum].append(candidate)
    placed = []
    for name, members in strata.items():
        chance = random.Random(f"{seed} {name}")  # own generator, independent of the other modules
        chance.shuffle(members)
        offset = chance.random()
        placed += [((k + offset) / len(members), chance.random(), c) for k, c in enumerate(members)]
    return [candidate for *_, candidate in sorted(placed, key=lambda place: place[:2])]


def population(root: Path, targets: Sequence[Target]) -> list[Candidate]:
    """Every candidate of the targets' modules. Raises Unavailable without cosmic-ray."""
    return [c for t in targets for c in candidates(t.module, (root / t.module).read_text(encoding="utf-8"))]


def run(root: Path, targets: Sequence[Target], chosen: Sequence[Candidate], log: Path) -> list[Record]:
    """Try the chosen candidates that ``log`` (JSON lines) does not know; all records of the chosen.

    A record holds for its module's source; one that survived is tried again when the suite has changed.
    """
    known = {_identity(record): record for record in _read(log)}
    records: list[Record] = []
    for target in targets:
        mine = [c for c in chosen if c.module == target.module]
        stamp = {"source": _digest([root / target.module]), "suite": _digest(root / t for t in target.files)}
        open_ones = []
        for candidate in mine:
            record = known.get(_identity(vars(candidate) | stamp))
            if record is None or (record["outcome"] == "survived" and record["suite"] != stamp["suite"]):
                open_ones.append(candidate)
            else:
                records.append(record)
        if open_ones:
            records += _try(root, target, open_ones, stamp, log)
    return records


def _try(
    root: Path, target: Target, open_ones: list[Candidate], stamp: dict[str, str], log: Path
) -> list[Record]:
    """Try candidates of one module; each verdict is appended to the log at once."""
    source = (root / target.module).read_text(encoding="utf-8")
    suite, records = Suite(root, target.suite), []
    limit = max(LEAST, int(ALLOWANCE * suite.baseline()))
    progress = Progress(len(open_ones))
    for candidate in open_ones:
        changed = mutant(candidate, source)
        record = vars(candidate) | stamp
        if changed is None:
            record |= {"outcome": "void", "line": 0, "before": "", "after": ""}
            record |= {"killer": None, "seconds": 0.0}
        else:
            verdict = suite.verdict(target.module, changed.source, limit)
            record |= {"line": changed.line, "before": changed.before, "after": changed.after}
            record |= verdict._asdict()
        with log.open("a", encoding="utf-8") as lines:
            lines.write(json.dumps(record, ensure_ascii=False) + "\n")
        records.append(record)
        progress.tick(f"{record['outcome']} {target.module}:{record['line']}")
    progress.close()
    return records


def _read(log: Path) -> list[Record]:
    if not log.exists():
        return []
    return [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]


def _identity(record: Record) -> tuple[object, ...]:
    return tuple(record[name] for name in ("module", "operator", "occurrence", "source"))


def _digest(files: Iterable[Path]) -> str:
    """Fingerprint of the files' contents."""
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:12]
