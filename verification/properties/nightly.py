"""Many seeded examples of every invariant for both solvers, in slices that can be resumed."""

from __future__ import annotations

import time
import traceback
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import refimpl as rf
from verification.output.files import Progress
from verification.output.provenance import provenance
from verification.output.result_files import read_result, write_result
from verification.properties.check import search
from verification.properties.registry import INVARIANTS, Solver

SOLVERS: Mapping[str, Solver] = {
    "fft": partial(rf.solve, method="fft", tolerance=1e-12),
    "dense": partial(rf.solve, method="dense", tolerance=1e-12),
}
"""Required residual, from which `verification.properties.states.RESIDUAL` is derived."""


def run(path: Path, examples: int, seed: int) -> bool:
    """Search at least ``examples`` samples in all, write the log after every slice; whether all held.

    A slice is one invariant for one solver with its own seed, ``seed`` plus its number. Slices that the log
    already has are not run again; a log of another ``seed`` or share of examples is started anew.
    """
    each = -(-examples // (len(SOLVERS) * len(INVARIANTS)))
    earlier = read_result(path)["slices"] if path.exists() else ()
    slices = [line for line in earlier if (line["seed"] - line["number"], line["asked"]) == (seed, each)]
    known = {(line["solver"], line["invariant"]) for line in slices}
    progress = Progress(len(SOLVERS) * len(INVARIANTS) - len(known))
    for number, (solver, name) in enumerate((s, n) for s in SOLVERS for n in INVARIANTS):
        if (solver, name) not in known:
            slices.append(one_slice(number, solver, name, each, seed))
            log = {
                "seed": seed,
                "examples": sum(line["held"] for line in slices),
                "counterexamples": sum(line["counterexample"] is not None for line in slices),
                "processor_seconds": round(sum(line["seconds"] for line in slices), 1),
                "slices": slices,
                "provenance": provenance(),
            }
            write_result(log, path)
            progress.tick(f"{solver} {name}")
    progress.close()
    return all(line["counterexample"] is None for line in slices)


def one_slice(number: int, solver: str, name: str, examples: int, seed: int) -> dict[str, Any]:
    """Search one invariant for one solver; a counter-example is kept as printed, shrunk."""
    begun, held, found = time.process_time(), 0, None
    try:
        held = search(INVARIANTS[name], SOLVERS[solver], examples, seed + number)
    except (AssertionError, ArithmeticError, ValueError) as broken:  # no solution, or no claim of one
        found = "".join(traceback.format_exception_only(broken))
    return {
        "number": number,
        "solver": solver,
        "invariant": name,
        "claim": INVARIANTS[name].claim,
        "seed": seed + number,
        "asked": examples,
        "held": held,
        "seconds": round(time.process_time() - begun, 2),
        "counterexample": found,
    }
