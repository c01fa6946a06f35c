"""The paper's own scheme: trace, tolerances, limits, and agreement with the dense reference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Shape
from refimpl.model.certificate import State
from refimpl.model.problem import Problem, Terms
from refimpl.model.state import Status
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers import paper as module
from refimpl.solvers.paper import Trace, _Scheme, solve_paper
from refimpl.solvers.tau_active_set import FixedSet


def run(
    name: str, shape: Shape, tolerance: float = 1e-4, *, approach: float | None = None
) -> tuple[State, Trace]:
    scene = rf.read_scene(name)
    grid = rf.Grid(shape, scene.lengths)
    return solve_paper(discretise(scene, grid, Terms(oblique=False), approach), tolerance, Counter())


def difference(found: Array, reference: Array) -> float:
    return float(np.abs(found - reference).max() / reference.max())


def test_prescribed_approach_needs_no_iteration_two() -> None:
    reference = rf.solve(rf.read_scene("hertz"), grid=32, method="dense", approach=1e-6)
    result, trace = run("hertz", (32, 32), 1e-9, approach=1e-6)
    assert difference(result.pressure, reference.pressure) <= 1e-8
    assert [t.approaches for t in (*trace.coarser, trace)] == [1, 1]


def test_trace_counts_each_grid_by_itself() -> None:
    result, trace = run("hertz", (64, 128))
    assert [t.shape for t in (*trace.coarser, trace)] == [(16, 32), (32, 64), (64, 128)]
    assert all(t.coarser == () for t in trace.coarser)
    for key, name in {"periodic": "periodic_steps", "correction": "correction_steps"}.items():
        assert result.iterations[key] == sum(getattr(t, name) for t in (*trace.coarser, trace))
    assert trace.passes >= trace.approaches >= 1


@pytest.mark.parametrize("shape", [(33, 33), (64, 33), (30, 64)])
def test_an_odd_or_small_grid_has_no_coarser_one(shape: Shape) -> None:
    """Both axes are halved, as far as each has an even number of at least 32."""
    assert run("hertz", shape)[1].coarser == ()


def hertz(M: int = 8, friction: rf.Friction | None = None) -> Problem:
    scene = rf.read_scene("hertz")
    scene = scene if friction is None else replace(scene, friction=friction)
    return discretise(scene, scene.grid(M), Terms(oblique=False))


def scheme(M: int = 8, friction: rf.Friction | None = None) -> _Scheme:
    return _Scheme(hertz(M, friction), 1e-9, Counter(), None)


def test_a_contact_that_never_settles_is_given_up_after_sixty_passes() -> None:
    one = scheme(4)
    one.tolerance = 0.0
    one.normal_force(4e-6, FixedSet(one.problem.gap < 0))
    assert one.trace.passes == 60
    assert not one.settled


@pytest.mark.parametrize("limit", ["_STEPS", "_PASSES", "_APPROACHES", "_BUDGET"])
def test_a_loop_that_meets_its_limit_says_so(limit: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the certificate makes of the state that it left."""
    monkeypatch.setattr(module, limit, 1)
    result, _ = module.solve_paper(hertz(friction=rf.Friction(beta=0.1)), 1e-9, Counter())
    assert result.status is Status.ITERATION_LIMIT


def test_a_spent_budget_is_said_at_an_approach_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    """No load is balanced there, so the loops within say it themselves."""
    at = replace(hertz(friction=rf.Friction(beta=0.1)), load=None, approach=1e-6)
    monkeypatch.setattr(module, "_BUDGET", 3)
    assert module.solve_paper(at, 1e-9, Counter())[0].status is Status.ITERATION_LIMIT


def test_a_spent_budget_ends_every_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    """Limits of nested loops do not multiply. The mean pressure is the modulus here."""
    z = np.random.default_rng(1).normal(size=(16, 16))
    scene = rf.Scene(
        upper=rf.Body(rf.Material(1.0, 0.0), z * 0.25 / np.ptp(z)),
        lower=rf.Body(rf.Material(4e3, 0.5), rf.Flat()),
        friction=rf.Friction(0.1, 0.4),
        load=1.0,
        side=1.0,
        sliding_direction=0.3,
    )
    monkeypatch.setattr(module, "_BUDGET", 500)
    found = rf.solve(scene, grid=16, method="paper")
    assert found.status is Status.ITERATION_LIMIT
    taken = found.cost.iterations
    assert 500 <= taken["periodic"] + taken["correction"] + taken["passes"] < 500 + 3
