"""``python -m verification.mutation --sample N --json FILE``: small faults that tests notice."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path

from verification.framework.case import Unavailable
from verification.framework.files import write_result
from verification.framework.provenance import provenance
from verification.mutation.score import passes, summary
from verification.mutation.session import in_fair_order, population, run
from verification.mutation.targets import JUDGES, TARGETS

ROOT = Path(__file__).resolve().parents[2]
GROUPS = {"numerics": TARGETS, "judges": JUDGES}


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status 0 when the goal is met, 1 when not, 2 when nothing can be run."""
    parser = argparse.ArgumentParser(prog="python -m verification.mutation", description=__doc__)
    parser.add_argument("--of", choices=GROUPS, default="numerics", help="what is mutated (default numerics)")
    parser.add_argument("--sample", type=int, default=600, help="mutants to try; more of them extend a run")
    parser.add_argument("--seed", type=int, default=1, help="of the sample's order")
    parser.add_argument("--only", nargs="+", default=["*"], help="patterns of the modules to try now")
    parser.add_argument("--log", type=Path, required=True, help="JSON lines: every verdict; resumed from")
    parser.add_argument("--json", type=Path, help="summary to write")
    options = parser.parse_args(arguments)
    group = GROUPS[options.of]
    try:
        everything = population(ROOT, group)
    except Unavailable as missing:
        print(missing, file=sys.stderr)
        return 2
    chosen = in_fair_order(everything, options.seed)[: options.sample]
    targets = [target for target in group if any(fnmatch(target.module, p) for p in options.only)]
    records = run(ROOT, targets, chosen, options.log)
    found = summary(records, len(everything), options.seed, of=options.of, targets=group)
    if options.json:
        write_result(found | {"provenance": provenance()}, options.json)
    print({name: found[name] for name in ("score", "score_lower_bound", "tried", "survived", "equivalent")})
    return 0 if passes(found) else 1


if __name__ == "__main__":
    raise SystemExit(main())
