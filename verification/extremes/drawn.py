"""States drawn at random over all parameters at once, each judged by the oracle in 34 digits.

``python -m verification.extremes.drawn --states 400 --seed 2026 --json FILE`` runs the study (ten minutes).
State k of a seed is the same however many are drawn.
"""

from __future__ import annotations

import argparse
import math
import os
import random
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

FORMAT = "rough-friction drawn extremes, version 1"
SECONDS = 30.0  # processor time after which a state counts as endless
SAVED_EVERY = 20
RANGES: dict[str, Any] = {
    "elements a side": [1, 6],
    "side (m), log10": [-9, 3],
    "Young's moduli (Pa), log10": [3, 13],
    "Poisson's ratios": [-0.9, 0.5],
    "incompressible, share": 0.1,
    "one body rigid, share": 0.1,
    "mean pressure over the mean modulus, log10": [-12, 0],
    "tau over the mean pressure, log10": [-6, 2],
    "tau = 0, share": 0.3,
    "beta, log10": [-4, 1],
    "beta = 0, share": 0.3,
    "peak-to-valley over the side, log10": [-9, -0.1],
    "flat, share": 0.05,
    "one high element, share": 0.1,
    "sliding direction (rad)": [0, 6.283185307179586],
    "periodic, share": 0.3,
    "prescribed approach, share": 0.2,
    "approach over peak-to-valley, log10": [-4, 0],
    "without slope terms, share": 0.3,
    "with the slope correction, share": 0.2,
    "dense solver, share": 0.5,
}
"""Uniform between the bounds, of the logarithm where that is said."""


@dataclass(frozen=True)
class Drawn:
    """One state: parameters in SI units, as plain numbers for the log."""

    number: int
    M: int
    parameters: dict[str, Any]


def drawn(number: int, seed: int) -> Drawn:
    """Draw a state by its number."""
    source = random.Random(f"{seed} {number}")

    def uniform(name: str) -> float:
        return source.uniform(*RANGES[name])

    def power(name: str) -> float:
        return float(10.0 ** uniform(f"{name}, log10"))

    def happens(name: str) -> bool:
        return bool(source.random() < RANGES[f"{name}, share"])

    M = source.randint(*RANGES["elements a side"])
    side = power("side (m)")
    moduli = [power("Young's moduli (Pa)") for _ in range(2)]
    ratios = [0.5 if happens("incompressible") else uniform("Poisson's ratios") for _ in range(2)]
    pressure = power("mean pressure over the mean modulus") * math.sqrt(moduli[0] * moduli[1])
    rigid = source.randrange(2) if happens("one body rigid") else None
    height = 0.0 if happens("flat") else side * power("peak-to-valley over the side")
    single = happens("one high element")
    heights = [[source.random() for _ in range(M)] for _ in range(M)]
    if single:
        heights = [[float(i == j == M // 2) for j in range(M)] for i in range(M)]
    periodic = happens("periodic")
    approach = None
    if happens("prescribed approach") and height:
        depth = height * power("approach over peak-to-valley")
        approach = -depth if periodic else depth
    return Drawn(
        number, M,
        {
            "side": side, "load": pressure * side**2, "ratios": ratios,
            "moduli": ["rigid" if k == rigid else E for k, E in enumerate(moduli)],
            "tau": 0.0 if happens("tau = 0") else pressure * power("tau over the mean pressure"),
            "beta": 0.0 if happens("beta = 0") else power("beta"),
            "heights": [[height * z for z in row] for row in heights],
            "direction": uniform("sliding direction (rad)"), "periodic": periodic, "approach": approach,
            "oblique": not happens("without slope terms"),
            "slope_correction": happens("with the slope correction"),
            "method": "dense" if happens("dense solver") else "fft",
        },
    )  # fmt: skip


def run(state: Drawn) -> dict[str, Any]:
    """Solve and judge a state: its row in the log."""
    from verification.extremes.state import Extreme
    from verification.extremes.study import judged

    row = judged(
        Extreme("drawn", "random", str(state.number), float(state.number), lambda: _judged(state), SECONDS)
    )
    kept = ("at", "verdict", "status", "error", "note", "seconds")
    parameters = {"parameters": state.parameters} if row["verdict"] in ("wrong", "crash") else {}
    return {name: row[name] for name in kept} | {"elements": state.M} | parameters


def _judged(state: Drawn) -> Any:
    """The verdict; building the scene is part of what may be refused.

    The upper body is flat. Where it is rigid, its plane is the common surface, whose slopes are zero: the
    plan may neglect slope terms there. On a contact of one or two elements the discrete equations have slopes
    all the same, half of those of the other body across the contact's edge. A state whose plan neglects slope
    terms for a rigid plane is judged without them as well.
    """
    import numpy as np

    import refimpl as rf
    from verification.extremes.judge import GOOD, TOLERANCE, exact_error, guarded, verdict
    from verification.extremes.oracle import NotSettled

    p = state.parameters

    def solved() -> Any:
        moduli = [math.inf if E == "rigid" else E for E in p["moduli"]]
        materials = [rf.Material(E, nu) for E, nu in zip(moduli, p["ratios"], strict=True)]
        scene = rf.Scene(
            upper=rf.Body(materials[0], rf.Flat()), lower=rf.Body(materials[1], np.array(p["heights"])),
            friction=rf.Friction(p["tau"], p["beta"]), load=p["load"], side=p["side"],
            sliding_direction=p["direction"], periodic=p["periodic"],
        )  # fmt: skip
        options: dict[str, Any] = {} if p["oblique"] else {"oblique": False}
        if p["oblique"] and p["slope_correction"]:
            options["slope_correction"] = True
        if p["approach"] is not None:
            options["approach"] = p["approach"]
        solution = rf.solve(scene, state.M, method=p["method"], tolerance=TOLERANCE, **options)
        if p["moduli"][0] == "rigid" and not solution.plan.includes("oblique"):
            options["oblique"] = False
        try:
            error, note = exact_error(scene, solution, **options)
        except NotSettled as unsettled:
            if solution.status in GOOD:
                raise
            error, note = math.inf, f"the oracle found no state either: {unsettled}"
        return verdict(solution, error, "the exact discrete state, 34 digits", note)

    return guarded(solved)


def study(
    states: int,
    seed: int,
    tick: Callable[[str], None] = lambda _: None,
    save: Callable[[dict[str, Any]], None] = lambda _: None,
) -> dict[str, Any]:
    """Run so many states; the document, which is saved now and then."""
    rows: list[dict[str, Any]] = []
    for number in range(states):
        rows.append(run(drawn(number, seed)))
        tick(f"{rows[-1]['verdict']:<14} {number}")
        if len(rows) % SAVED_EVERY == 0:
            save(document(rows, seed))
    return document(rows, seed)


def document(rows: list[dict[str, Any]], seed: int) -> dict[str, Any]:
    """The result file: seed, ranges, counts, rows; parameters of wrong states and of crashes."""
    from verification.extremes.state import Verdict
    from verification.framework.provenance import provenance

    counts = Counter(row["verdict"] for row in rows)
    return {
        "format": FORMAT,
        "seed": seed,
        "ranges": RANGES,
        "states": len(rows),
        "counts": {verdict.value: counts[verdict.value] for verdict in Verdict},
        "statuses": dict(sorted(Counter(row["status"] for row in rows).items())),
        "rows": rows,
        "provenance": provenance(),
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the study; status 1 when a number was wrong."""
    parser = argparse.ArgumentParser(prog="python -m verification.extremes.drawn", description=__doc__)
    parser.add_argument("--states", metavar="N", type=int, default=400, help="default 400")
    parser.add_argument("--seed", metavar="K", type=int, default=2026, help="other states (default 2026)")
    parser.add_argument("--json", type=Path, required=True, help="file to write")
    options = parser.parse_args(arguments)
    os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1"))

    from verification.framework.files import Progress, write_result

    progress = Progress(options.states)
    found = study(options.states, options.seed, progress.tick, lambda part: write_result(part, options.json))
    progress.close()
    write_result(found, options.json)
    print(", ".join(f"{number} {verdict}" for verdict, number in found["counts"].items()))
    return 1 if found["counts"]["wrong"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
