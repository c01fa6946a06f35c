"""`accuracy=`, error bars and derivatives: bars against Hertz and finer grids, similarity of derivatives."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import refimpl as rf
from verification.case import Measured
from verification.coverage.judge import verdicts
from verification.coverage.store import NUMBERS, climb, ladders
from verification.exact.hertz import UNCERTAINTY, Sphere
from verification.registry import case

SCENE = rf.read_scene("hertz")
EXACT = Sphere(load=SCENE.load, radius=0.14, modulus=SCENE.materials.reduced_modulus)
SEEDS, GRIDS = range(24), (32, 64, 96, 128, 192, 256, 512)


@case(
    "accuracy/hertz-area",
    title="The bar of accuracy=0.01 on the Hertz contact's area",
    claim="the area is within its bar of pi a^2, and the bar is within 1 % of the area",
    source="Hertz 1882; Johnson 1985, section 4.2",
    metric="at_most",
    tolerance=1.0,
    tolerance_reason="error over bar, and bar over what was asked for: either at most one",
    tags=("accuracy", "hertz"),
)
def hertz_area() -> Measured:
    found = rf.solve(SCENE, accuracy=0.01, quantity="contact_area")
    exact = math.pi * EXACT.contact_radius**2
    bar = sum(found.uncertainty["contact_area"].values())
    error = abs(found.contact_area - exact)
    return Measured(
        value=max(error / bar, bar / (0.01 * found.contact_area)),
        reference_uncertainty=UNCERTAINTY,
        data={"grid": found.grid.M, "error over area": error / exact, "bar over area": bar / exact},
    )


@case(
    "accuracy/stress-similarity",
    title="Derivatives obey the similarity of stresses",
    claim="moduli, tau and load times s change neither mu nor A and multiply f_max by s: their logarithmic "
    "derivatives add to 0, 0 and 1",
    source="dimensional analysis of Eqs (1)-(7)",
    metric="at_most",
    tolerance=2e-4,
    tolerance_reason="exact on every grid; GMRES leaves 1e-6 of each of four derivatives, of sizes to 10",
    tags=("sensitivity",),
)
def stress_similarity() -> Measured:
    scene = rf.read_scene("table1-rough")
    found = rf.sensitivity(scene, rf.solve(scene, 64))
    stresses = ("load", "friction.tau", "upper.material.E", "lower.material.E")
    powers = {"friction_coefficient": 0.0, "contact_area": 0.0, "max_pressure": 1.0}
    misfits = {
        number: abs(sum(found.relative(number, name) for name in stresses) - power)
        for number, power in powers.items()
    }
    return Measured(value=max(misfits.values()), data={"misfit": misfits})


@case(
    "accuracy/coverage",
    title="Bars of accuracy=0.01 on random scenes",
    claim="the true error of mu, A, corrected A and f_max lies inside the 95 % bar",
    source="grids twice as fine as any asked for; committed for 224 scenes in coverage.json",
    metric="at_least",
    tolerance=0.92,
    tolerance_reason="what a perfect 95 % bar passes with 97 % probability on 200 scenes",
    tier="full",
    tags=("accuracy",),
)
def coverage() -> Measured:
    with tempfile.TemporaryDirectory() as folder:
        store = Path(folder) / "store.jsonl"
        climb(store, SEEDS, GRIDS)
        found = verdicts(ladders(store), 0.01)
    shares = {
        number: sum(v.covered for v in found if v.number == number) / sum(v.number == number for v in found)
        for number in NUMBERS
    }
    return Measured(
        value=sum(verdict.covered for verdict in found) / len(found),
        data={"share": shares},
        note=f"{len(SEEDS)} scenes, reference {GRIDS[-1]} x {GRIDS[-1]}",
    )
