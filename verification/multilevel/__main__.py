"""``python -m verification.multilevel``: do the intervals cover, and at what share of plain sampling?"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance
from verification.multilevel.ensemble import QUANTITIES, TOLERANCE, Ensemble, ensemble
from verification.sweep.study_file import study_from_dict

SCENE = "table1-rough"
GRIDS = [64, 128, 256, 512]
PLAIN = 75  # realisations of the paper
_APART = 10**5  # seeds between repetitions


def main(arguments: Sequence[str] | None = None) -> None:
    """Repeat the ensemble with disjoint seeds; each run is kept, so that a killed study goes on."""
    parser = argparse.ArgumentParser(prog="python -m verification.multilevel", description=main.__doc__)
    parser.add_argument("--repetitions", type=int, default=50)
    parser.add_argument("--target", type=float, default=0.0085, help="relative standard error")
    parser.add_argument("--store", type=Path, default=Path("multilevel.sqlite"))
    parser.add_argument("--json", type=Path, required=True)
    options = parser.parse_args(arguments)
    progress = Progress(options.repetitions)
    done = []
    for repetition in range(options.repetitions):
        done.append(_repetition(repetition, options.target, options.store))
        progress.tick(f"repetition {repetition + 1}")
    progress.close()
    write_result(document(done, options.target), options.json)


def _repetition(repetition: int, target: float, store: Path) -> Ensemble:
    table = {"scene": SCENE, "first_seed": 1 + repetition * _APART, "vary": {"grid": GRIDS}}
    return ensemble(study_from_dict(table), store, target, workers=0)


def document(done: Sequence[Ensemble], target: float) -> dict[str, Any]:
    """Coverage of the repetitions' common mean, and costs over plain sampling's, by quantity."""
    quantities = {}
    cost, seconds = (float(np.mean([getattr(e, s) for e in done])) for s in ("cost", "finest_seconds"))
    for name in QUANTITIES:
        estimates = [e.means[name] for e in done]
        mean = float(np.mean([e.mean for e in estimates]))
        finest = np.array([value for e in done for value in e.finest[name]])
        error = float(np.mean([e.standard_error**2 for e in estimates]))
        quantities[name] = {
            "mean": mean,
            "doubt": float(np.std([e.mean for e in estimates], ddof=1) / len(done) ** 0.5),
            "covered": int(sum(abs(e.mean - mean) <= e.half_width for e in estimates)),
            "mean of the finest solves alone": float(finest.mean()),
            "its standard error": float(finest.std(ddof=1) / len(finest) ** 0.5),
            "means": [e.mean for e in estimates],
            "half widths": [e.half_width for e in estimates],
            "standard error": float(np.mean([e.standard_error for e in estimates]) / mean),
            "cost over plain": cost / (seconds * float(finest.var(ddof=1)) / error),
        }
    return {
        "scene": SCENE,
        "grids": list(done[0].grids),
        "target": target,
        "tolerance": TOLERANCE,
        "repetitions": len(done),
        "met": int(sum(e.met for e in done)),
        "samples": np.mean([e.samples for e in done], axis=0).tolist(),
        "seconds of a sample": np.mean([e.seconds for e in done], axis=0).tolist(),
        "seconds": cost,
        "seconds on the finest grid": seconds,
        "plain realisations": PLAIN,
        "quantities": quantities,
        "provenance": provenance(),
    }


if __name__ == "__main__":
    main()
