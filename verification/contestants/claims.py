"""Right solvers through the whole suite at three claims: none may fail.

``python -m verification.contestants.claims --json FILE``; with ``--exec ./contestant`` a program as well,
such as that of ``tests/verification/contestants/contestant.c``.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from reports.result_files import write_result
from verification.contestants import own
from verification.contestants.command import Command
from verification.contestants.isolated import Limited
from verification.contestants.protocol import Abilities, Contestant, abilities_of
from verification.contestants.suite import run
from verification.framework.provenance import provenance

CLAIMS = (1e-6, 1e-8, 1e-10)
"""Relative residuals."""
OF_PROGRAM = Abilities(periodic=False, largest=16)
"""Abilities of the program in C."""
PATIENCE = 60.0
"""Seconds for one problem."""


def verdicts(contestant: Contestant, claim: float, globs: Iterable[str] = ()) -> dict[str, Any]:
    """Numbers of cases by status at a claim, and those that are neither passed nor beyond the abilities."""
    stated = replace(abilities_of(contestant), precision=claim)
    results = run(Limited(contestant, stated), globs)
    missed = {r.id: r.note or f"{r.error:.3g}" for r in results if r.status not in ("pass", "unavailable")}
    return {**Counter(str(r.status) for r in results), "claim": claim, "missed": missed}


def study(solvers: Mapping[str, Contestant], globs: Iterable[str] = ()) -> list[dict[str, Any]]:
    """Verdicts of every solver at every claim."""
    chosen = tuple(globs)
    return [
        {"solver": name, **verdicts(solver, claim, chosen)}
        for name, solver in solvers.items()
        for claim in CLAIMS
    ]


def main() -> int:
    """Run; status 1 where a case failed or broke."""
    parser = argparse.ArgumentParser(prog="python -m verification.contestants.claims", description=__doc__)
    parser.add_argument("--exec", help="a program for free squares without friction")
    parser.add_argument("--json", type=Path, help="result to write")
    options = parser.parse_args()
    solvers: dict[str, Contestant] = {"production": own.solve, "dense": own.dense}
    if options.exec:
        solvers["program"] = Command.of(options.exec, OF_PROGRAM, PATIENCE).contestant()
    found = study(solvers)
    if options.json:
        write_result({"runs": found, "provenance": provenance()}, options.json)
    print(json.dumps(found, indent=1))
    return int(any(each["missed"] for each in found))


if __name__ == "__main__":
    sys.exit(main())
