"""The paper's scheme from within: steps, exclusion, bracket, starts and limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Mask
from refimpl.model.problem import Problem, Terms
from refimpl.model.state import Status
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers import paper as module
from refimpl.solvers.paper import _Scheme
from refimpl.solvers.tau_active_set import FixedSet, GradualSet


def hertz(M: int = 8, friction: rf.Friction | None = None) -> Problem:
    scene = rf.read_scene("hertz")
    scene = scene if friction is None else replace(scene, friction=friction)
    return discretise(scene, scene.grid(M), Terms(oblique=False))


def scheme(M: int = 8, friction: rf.Friction | None = None) -> _Scheme:
    return _Scheme(hertz(M, friction), 1e-9, Counter(), None)


class Press:
    """Stands for iteration one: a normal force as a function of the approach, and what was asked."""

    def __init__(self, force: Callable[[float], float]) -> None:
        self.force, self.asked = force, list[float]()

    def __call__(self, approach: float, active: Mask | None) -> float:
        self.asked.append(approach)
        return self.force(approach)


def asked(monkeypatch: pytest.MonkeyPatch, start: float, force: Callable[[float], float]) -> list[float]:
    """The approaches that iteration two tries; the force is in units of the load."""
    one = scheme()
    load = one.problem.load
    assert load is not None
    press = Press(lambda approach: load * force(approach))
    monkeypatch.setattr(one, "normal_force", press)
    assert one.balance(start, None) == press.asked[-1]
    assert one.settled
    return press.asked


def test_the_second_approach_is_hertzs(monkeypatch: pytest.MonkeyPatch) -> None:
    assert asked(monkeypatch, 2e-6, lambda d: (d / 3e-6) ** 1.5) == pytest.approx([2e-6, 3e-6], rel=1e-9)


@pytest.mark.parametrize(("start", "force"), [(2e-6, 0.25), (10e-6, 2.25)])
def test_the_third_approach_is_a_secants(start: float, force: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """From below and from above."""
    found = asked(monkeypatch, start, lambda d: (d - 1e-6) / 4e-6)
    assert found == pytest.approx([start, start * force ** (-2 / 3), 5e-6], rel=1e-9)


def test_tau_is_where_the_active_set_says() -> None:
    """On the coarser grids the gradual one: on contact, and in shares up to a clearance beside it."""
    one = scheme(friction=rf.Friction(tau=1e6, beta=0.0))
    one.pressure[2:5, 3] = 1e7, 1e-3, 0.0
    v = one._apply(one.pressure) + one.problem.gap
    reach = 2 * float(v[4, 3] - v.min() + 1e-9)
    approach = float(v[4, 3]) - reach / 4
    _, held = one._update(approach, GradualSet(reach))
    assert held[2:4, 3] == pytest.approx(1e6)
    assert held[4, 3] == pytest.approx(0.75e6)
    given = np.eye(8, dtype=bool)
    assert np.array_equal(one._update(0.0, FixedSet(given))[1], 1e6 * given)


@pytest.mark.parametrize("on_circle", [False, True])
def test_an_element_that_just_touches_is_excluded(on_circle: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Contact is pressure above zero; here elements do not feel each other."""
    one = scheme()
    for name in ("_apply", "_apply_periodic", "_invert"):
        monkeypatch.setattr(one, name, np.copy)
    u = np.zeros((8, 8))
    u[2:4, 2:4] = 1.0
    touching = np.ones((8, 8), dtype=bool)
    assert np.array_equal(one._iterate(u, touching, on_circle=on_circle), u > 0)
    assert np.array_equal(one.pressure, u)
    # the first step is exact; the second finds nothing to do, and is none
    assert (one.trace.periodic_steps, one.trace.correction_steps) == (on_circle, not on_circle)


def test_a_contact_that_never_settles_is_given_up_after_sixty_passes() -> None:
    one = scheme(4)
    one.tolerance = 0.0
    one.normal_force(4e-6, FixedSet(one.problem.gap < 0))
    assert one.trace.passes == 60
    assert not one.settled


def test_approaches_stay_within_their_bracket(monkeypatch: pytest.MonkeyPatch) -> None:
    """A late and steep force: secants and growth would leave the bracket, so that it is halved."""

    def force(approach: float) -> float:
        return max(0.0, 1000 * (approach - 3.0))

    low, high, halved = 0.0, math.inf, 0
    found = asked(monkeypatch, 1.0, force)
    for approach in found:
        assert low < approach < high
        halved += approach == 0.5 * (low + high)
        low, high = (approach, high) if force(approach) < 1 else (low, approach)
    assert halved >= 2
    assert found[-1] == pytest.approx(3.001, rel=1e-9)


def test_the_unit_of_pressure_changes_no_bit() -> None:
    """Powers of two scale without rounding, so every decision must be the same."""

    def scene(unit: float) -> rf.Scene:
        return rf.Scene(
            upper=rf.Body(rf.Material(200e9 * unit, 0.3), rf.Sphere(0.14)),
            lower=rf.Body(rf.Material(2.5e9 * unit, 0.3), rf.GaussianRoughness(0.2e-6, 200e-6, seed=3)),
            friction=rf.Friction(15e6 * unit, 0.08),
            load=20.0 * unit,
            side=1.61e-3,
        )

    one, other = (rf.solve(scene(unit), 16, method="paper") for unit in (1.0, 2.0**-40))
    assert one.status is other.status
    assert one.cost.iterations == other.cost.iterations
    assert np.array_equal(other.pressure, 2.0**-40 * one.pressure)


@pytest.mark.parametrize("limit", ["_STEPS", "_PASSES", "_APPROACHES", "_BUDGET"])
def test_a_loop_that_meets_its_limit_says_so(limit: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the certificate makes of the state that it left."""
    monkeypatch.setattr(module, limit, 1)
    result, _, _ = module.solve_paper(hertz(friction=rf.Friction(beta=0.1)), 1e-9, Counter())
    assert result.status is Status.ITERATION_LIMIT


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
