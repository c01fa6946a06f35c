"""Neglected terms cost nothing: operations counted, kernels watched, peak memory traced."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import refimpl as rf
from refimpl.model.problem import Terms
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers.production.nested_solver import solve_fft
from verification.cases import Measured, case

SOURCE = "the planner's own promise (README): what a scene does not require is neither built nor applied"
BARE = Terms(coupled=False, oblique=False, tilted=False)
M = 64
RETURNED = 4 * 8  # bytes per element: both deformed surfaces, gap and indentation, which bare solves lack


@cache
def scenes() -> dict[str, tuple[rf.Scene, bool | None]]:
    """Return the scenes that require normal contact alone, and ``oblique`` unless the scene says so."""
    hertz, table1 = rf.read_scene("hertz"), rf.read_scene("table1-smooth")
    twins = replace(table1, lower=rf.Body(table1.upper.material, table1.lower.surface))
    incompressible = rf.Material(E=10e6, nu=0.5)
    soft = replace(
        table1,
        upper=rf.Body(incompressible, table1.upper.surface),
        lower=rf.Body(rf.Material(E=1e6, nu=0.5), rf.Flat()),
        load=1e-3,
        friction=rf.Friction(tau=1.0, beta=0.08),
    )
    rough = rf.read_scene("rough-planes")
    return {
        "frictionless, smooth": (hertz, None),
        "identical materials, no slopes": (twins, False),
        "nu = 0.5 on both, no slopes": (soft, False),
        "frictionless, rough, no slopes": (replace(rough, friction=rf.Friction()), False),
    }


def bare(scene: rf.Scene) -> Counter:
    """Return the operation counts of normal contact, without the planner."""
    counter = Counter()
    problem = discretise(replace(scene, friction=rf.Friction()), scene.grid(M), BARE)
    solve_fft(problem, 1e-8, counter)
    return counter


def peak(run: Callable[[], object]) -> float:
    """Return the peak memory (bytes per element) of a second run: kernels are tabulated once."""
    run()
    tracemalloc.start()
    try:
        run()
        return tracemalloc.get_traced_memory()[1] / M**2
    finally:
        tracemalloc.stop()


@case("planning/operations", metric="equal", tolerance=0.0, source=SOURCE)
def operations() -> Measured:
    """Operations of scenes that require normal contact alone.

    Claim: a frictionless smooth scene, identical materials and incompressible ones perform the operations of
    a bare normal-contact solve, kind by kind, and no more
    Tolerance: operations are counted
    """
    rows = {}
    for name, (scene, oblique) in scenes().items():
        planned = dict(rf.solve(scene, M, oblique=oblique).cost.applications)
        alone = bare(scene).tally
        kinds = sorted({*planned, *alone})
        rows[name] = {kind: [planned.get(kind, 0), alone.get(kind, 0)] for kind in kinds}
    more = sum(abs(a - b) for row in rows.values() for a, b in row.values())
    sheared = sum(a for row in rows.values() for kind, (a, _) in row.items() if "shear" in kind)
    return Measured(more + sheared, 0.0, data={"planned and bare": rows})


@case("planning/cerruti", metric="equal", tolerance=0.0, source=SOURCE)
def cerruti() -> Measured:
    """Shear kernels that no scene requires.

    Claim: no tangential kernel is built or applied without friction, for identical materials without slope
    terms, and at an accuracy that shear's tilt does not reach; one is where shear matters
    Tolerance: kernels are counted
    """
    table1 = rf.read_scene("table1-smooth")
    twins = scenes()["identical materials, no slopes"][0]
    frictionless = replace(rf.read_scene("table1-rough"), friction=rf.Friction())
    without = {
        "frictionless, rough": rf.solve(frictionless, M),
        "identical materials, accuracy 0.1": rf.solve(twins, accuracy=0.1),
        "identical materials, no tilt": rf.solve(twins, M, tilted=False),
    }
    counts = {name: shear_operations(solution) for name, solution in without.items()}
    needed = shear_operations(rf.solve(table1, M))
    return Measured(
        float(sum(counts.values()) + (needed == 0)),
        0.0,
        data={"shear operations": counts | {"table1-smooth": needed}},
    )


def shear_operations(solution: rf.Solution) -> int:
    """Return the shear kernels built and applied."""
    return sum(number for kind, number in solution.cost.applications.items() if "shear" in kind)


@case("planning/memory", metric="at_most", tolerance=1.0, source=SOURCE)
def memory() -> Measured:
    """Peak memory of a frictionless smooth scene.

    Claim: a frictionless smooth scene holds no more at its peak than a bare normal-contact solve and the
    arrays that a solution returns beside it
    Tolerance: over the bare solve's peak plus 32 bytes an element; 0.99 measured at 64 x 64, where each array
    of the grid's size counts 0.06
    """
    scene = scenes()["frictionless, smooth"][0]
    alone, planned = peak(lambda: bare(scene)), peak(lambda: rf.solve(scene, M))
    whole = peak(lambda: rf.solve(replace(scene, friction=rf.Friction(15e6, 0.08)), M))
    data = {"bytes per element": {"bare": alone, "planned": planned, "with friction": whole}}
    return Measured(planned / (alone + RETURNED), data=data)
