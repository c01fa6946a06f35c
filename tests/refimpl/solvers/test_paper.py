"""The paper's own scheme: trace, tolerances, limits, and agreement with the dense reference."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Shape
from refimpl.model.certificate import State
from refimpl.model.problem import Terms
from refimpl.model.state import SolverResult, Status
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers.paper import Trace, solve_paper


def run(
    name: str, shape: Shape, tolerance: float = 1e-4, *, approach: float | None = None
) -> tuple[SolverResult, State, Trace]:
    scene = rf.read_scene(name)
    grid = rf.Grid(shape, scene.lengths)
    return solve_paper(discretise(scene, grid, Terms(oblique=False), approach), tolerance, Counter())


def difference(found: Array, reference: Array) -> float:
    return float(np.abs(found - reference).max() / reference.max())


@pytest.mark.parametrize(
    ("name", "M"),
    [("hertz", 24), ("table1-smooth", 24), ("table1-rough", 33), ("metal-polymer", 24)],
)
def test_with_a_small_tolerance_it_is_the_dense_reference(name: str, M: int) -> None:
    dense = rf.solve(rf.read_scene(name), grid=M, method="dense")
    paper = rf.solve(rf.read_scene(name), grid=M, method="paper", tolerance=1e-9)
    # pressure steps end at 1e-10; 100 of them for what steepest descent still had to go (measured: 1.2e-10)
    assert difference(paper.pressure, dense.pressure) <= 1e-8
    assert paper.friction_coefficient == pytest.approx(dense.friction_coefficient, rel=1e-8)
    assert np.array_equal(paper.excluded, dense.excluded)
    assert paper.status is dense.status


@pytest.mark.parametrize("direction", [0.0, 1.9, math.pi])
def test_direction_and_slope_correction(direction: float) -> None:
    ball = rf.Body(rf.Material(E=200e9, nu=0.30), rf.Sphere(radius=0.05))
    rough = rf.GaussianRoughness(rms=0.8e-6, correlation_length=150e-6, seed=3)
    scene = rf.Scene(
        upper=ball,
        lower=rf.Body(rf.Material(E=2.5e9, nu=0.38), rough),
        friction=rf.Friction(beta=0.12),
        load=5.0,
        side=2e-3,
        sliding_direction=direction,
    )
    dense = rf.solve(scene, grid=24, method="dense", slope_correction=True)
    paper = rf.solve(scene, grid=24, method="paper", slope_correction=True, tolerance=1e-9)
    assert difference(paper.pressure, dense.pressure) <= 1e-8


@pytest.mark.parametrize("M", [20, 24, 28])
def test_own_tolerance_is_the_default_and_holds(M: int) -> None:
    paper = rf.solve(rf.read_scene("table1-rough"), grid=M, method="paper")
    assert paper.tolerance == 1e-4
    assert paper.certificate.load_error <= 1e-4
    assert paper.status is Status.CONVERGED


def test_prescribed_approach_needs_no_iteration_two() -> None:
    reference = rf.solve(rf.read_scene("hertz"), grid=32, method="dense", approach=1e-6)
    result, _, trace = run("hertz", (32, 32), 1e-9, approach=1e-6)
    assert difference(result.pressure, reference.pressure) <= 1e-8
    assert [t.approaches for t in (*trace.coarser, trace)] == [1, 1]


def test_trace_counts_each_grid_by_itself() -> None:
    result, _, trace = run("hertz", (64, 128))
    assert [t.shape for t in (*trace.coarser, trace)] == [(16, 32), (32, 64), (64, 128)]
    assert all(t.coarser == () for t in trace.coarser)
    for key, name in {"periodic": "periodic_steps", "correction": "correction_steps"}.items():
        assert result.iterations[key] == sum(getattr(t, name) for t in (*trace.coarser, trace))
    assert trace.passes >= trace.approaches >= 1


@pytest.mark.parametrize("shape", [(33, 33), (64, 33), (30, 64)])
def test_an_odd_or_small_grid_has_no_coarser_one(shape: Shape) -> None:
    """Both axes are halved, as far as each has an even number of at least 32."""
    assert run("hertz", shape)[2].coarser == ()


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_residual_correction_removes_the_periodicity_error() -> None:
    result, _, trace = run("table1-rough", (32, 32), 1e-9)
    assert trace.periodicity_before > 1e-3 > 1e-9 > trace.periodicity_after
    assert trace.periodic_pressure is not None
    # no more than an error: the images of a contact that spans a third of the square
    assert 1e-3 < difference(trace.periodic_pressure, result.pressure) < 0.3


def test_cost_counts_the_periodic_transforms() -> None:
    cost = rf.solve(rf.read_scene("hertz"), grid=32, method="paper").cost
    # every step inverts once; every periodic step applies the periodic matrix as well
    steps = cost.iterations["periodic"] + cost.iterations["correction"]
    assert cost.applications["periodic"] >= steps + cost.iterations["periodic"]


def test_periodic_scene_is_refused() -> None:
    with pytest.raises(rf.InputError, match="periodic scene"):
        rf.solve(rf.read_scene("rough-planes"), grid=16, method="paper")


def test_no_contact_at_a_negative_approach() -> None:
    apart = rf.solve(rf.read_scene("hertz"), grid=16, method="paper", approach=-1e-9)
    assert apart.status is Status.NO_CONTACT


@pytest.mark.parametrize("M", [1, 2])
def test_the_smallest_grids(M: int) -> None:
    hertz = rf.read_scene("hertz")
    dense, paper = (rf.solve(hertz, M, method=m, tolerance=1e-9) for m in ("dense", "paper"))
    assert difference(paper.pressure, dense.pressure) <= 1e-8
