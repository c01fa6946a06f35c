"""Twin experiments for `refimpl.identification`: known tau and beta, noisy friction, a coarser model.

`python -m verification.coverage.identification --json FILE`. The friction of each twin is solved on a grid
2.7 times finer than the one of the fit, so that the fit has its grid's error as well as the noise. Surfaces,
materials, friction, loads and noise of a twin follow from its seed alone.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import refimpl as rf
from refimpl.identification import Identification, Row, identify
from verification.framework.case import jsonable
from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance

SEEDS = range(5000, 5300)
FIT_GRID, TRUE_GRID = 48, 128
KINDS = ("ball", "rough ball", "capped ball", "capped rough ball", "rough planes")
LEVEL = 0.92  # share of 95 % intervals that must cover, at least
SIDE = 1e-3  # m; the problem is scale-free


@dataclass(frozen=True, eq=False)
class Twin:
    """A scene with its true friction, rows with noise, a new load (N) and its true mu."""

    kind: str
    scene: rf.Scene
    rows: tuple[Row, ...]
    new_load: float
    new_mu: float
    noise: float


def twin(seed: int) -> Twin:
    """Return the twin of a seed: 3 to 12 loads over a factor of 2 to 40, noise of 0.5 to 5 %."""
    rng = np.random.default_rng([42, seed])

    def log(low: float, high: float) -> float:
        return float(math.exp(rng.uniform(math.log(low), math.log(high))))

    kind = KINDS[seed % len(KINDS)]
    scene = _scene(kind, seed, log)
    count, span, noise = int(rng.integers(3, 13)), log(2, 40), log(0.005, 0.05)
    loads = np.geomspace(scene.load / span, scene.load, count)
    new_load = scene.load * log(1 / span, 1.2)
    rows = []
    for load in map(float, loads):
        mu = true_friction(scene, load)
        u = noise * mu
        rows.append(Row(load, max(mu + u * float(rng.standard_normal()), 0.0), u))
    return Twin(kind, scene, tuple(rows), new_load, true_friction(scene, new_load), noise)


def _scene(kind: str, seed: int, log: Callable[[float, float], float]) -> rf.Scene:
    shape: rf.Surface
    rough: rf.Surface
    lower, upper = (rf.Material(E=log(2e9, 400e9), nu=log(0.15, 0.45)) for _ in range(2))
    modulus = 1 / (1 / lower.plane_strain_modulus + 1 / upper.plane_strain_modulus)
    if kind == "rough planes":
        length, slope = SIDE * log(0.06, 0.12), log(0.01, 0.05)
        rough = rf.GaussianRoughness(slope * length, length, 2 * seed)
        pressure = 0.3 * modulus * slope
        load, shape = 0.1 * pressure * SIDE**2, rf.Flat()
    else:
        R, a = SIDE * log(5, 100), SIDE * log(0.2, 0.35)
        load, shape = 4 * modulus * a**3 / (3 * R), rf.Sphere(R)
        pressure = load / (math.pi * a**2)
        rms = a**2 / R * log(0.02, 0.2) if "rough" in kind else 0.0
        rough = rf.GaussianRoughness(rms, SIDE * log(0.1, 0.3), 2 * seed) if rms else rf.Flat()
    if kind.startswith("capped"):
        lower = replace(lower, hardness=pressure * log(0.8, 2.0))
    friction = rf.Friction(tau=pressure * log(0.01, 0.3), beta=log(0.02, 0.3))
    return rf.Scene(
        upper=rf.Body(upper, shape),
        lower=rf.Body(lower, rough),
        friction=friction,
        load=load,
        side=SIDE,
        periodic=kind == "rough planes",
    )


def true_friction(scene: rf.Scene, load: float) -> float:
    """Return mu on the fine grid. Raises ArithmeticError where the solve does not converge."""
    solution = rf.solve(replace(scene, load=load), TRUE_GRID)
    if not solution.converged:
        raise ArithmeticError(f"the solve at {load:.4g} N ended as {solution.status.value}")
    return float(solution.friction_coefficient)


def blind(scene: rf.Scene) -> rf.Scene:
    """Return the scene without its friction: a fit starts from its own guess."""
    return replace(scene, friction=rf.Friction())


def judged(seed: int) -> dict[str, object]:
    """Return what the fit of one twin finds, beside the truth."""
    case = twin(seed)
    found = identify(blind(case.scene), case.rows, FIT_GRID, loads=(case.new_load,), design=False)
    tau, beta, mu = found.values["tau"], found.values["beta"], found.predictions[-1].mu
    truth = case.scene.friction
    measured = found.shares["measurement"]
    return {
        "seed": seed,
        "kind": case.kind,
        "loads": len(case.rows),
        "noise": case.noise,
        "tau": tau.low <= truth.tau <= tau.high,
        "beta": beta.low <= truth.beta <= beta.high,
        "mu": mu.low <= case.new_mu <= mu.high,
        "tau_half_width": 0.5 * (tau.high - tau.low) / tau.value if tau.value > 0 else None,
        "tau_error": tau.value / truth.tau - 1,
        "beta_error": beta.value / truth.beta - 1,
        "measurement_share": measured[0] / math.sqrt(found.covariance[0, 0]),
        "warned": not found.is_identified and _warns(found),
        "solves": found.solves,
    }


def _warns(found: Identification) -> bool:
    return any("not determined apart" in text for text in found.warnings)


def summary(twins: Iterable[Mapping[str, object]]) -> dict[str, object]:
    """Return coverages by number and kind, and whether the warning stands where it should."""
    rows = list(twins)
    solved = [row for row in rows if "failure" not in row]

    def share(name: str, kind: str | None = None) -> float:
        chosen = [bool(row[name]) for row in solved if kind is None or row["kind"] == kind]
        return float(np.mean(chosen)) if chosen else 0.0

    widths = [
        (math.inf if row["tau_half_width"] is None else float(str(row["tau_half_width"]))) for row in solved
    ]
    warned = [bool(row["warned"]) for row in solved]
    return {
        "twins": len(rows),
        "failures": len(rows) - len(solved),
        "coverage": {name: share(name) for name in ("tau", "beta", "mu")},
        "by_kind": {kind: {name: share(name, kind) for name in ("tau", "beta", "mu")} for kind in KINDS},
        "wide": sum(width > 0.25 for width in widths),
        "wide_without_warning": sum(w > 0.25 and not said for w, said in zip(widths, warned, strict=True)),
        "narrow": sum(width < 0.05 for width in widths),
        "narrow_with_warning": sum(w < 0.05 and said for w, said in zip(widths, warned, strict=True)),
        "most_solves_per_load": max(
            (float(str(row["solves"])) - 1) / float(str(row["loads"])) for row in solved
        ),
    }


def study(seeds: Iterable[int], log: Path | None = None) -> list[dict[str, object]]:
    """Return the twins of all seeds; one without a converged solve holds its message.

    ``log`` keeps finished twins, a line each: the study goes on where it was.
    """
    seeds = list(seeds)
    found = [json.loads(line) for line in log.read_text().splitlines()] if log and log.exists() else []
    found = [row for row in found if row["seed"] in seeds]
    line = Progress(len(seeds) - len(found))
    for seed in sorted(set(seeds) - {row["seed"] for row in found}):
        try:
            found.append(judged(seed))
        except ArithmeticError as failure:
            found.append({"seed": seed, "kind": KINDS[seed % len(KINDS)], "failure": str(failure)})
        if log is not None:
            with log.open("a") as file:
                file.write(json.dumps(jsonable(found[-1])) + "\n")
        line.tick(f"twin {seed}")
    line.close()
    return found


def main() -> None:
    """Run the study and write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, required=True)
    parser.add_argument("--first", type=int, default=SEEDS.start)
    parser.add_argument("--twins", type=int, default=len(SEEDS))
    parser.add_argument("--log", type=Path, help="finished twins, to go on from")
    options = parser.parse_args()
    twins = study(range(options.first, options.first + options.twins), options.log)
    document = {"summary": summary(twins), "twins": twins, "provenance": provenance()}
    write_result(document, options.json)
    print(document["summary"])


if __name__ == "__main__":
    main()
