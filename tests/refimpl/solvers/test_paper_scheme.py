"""The paper's scheme from within: steps, exclusion, bracket, starts and limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Mask, Shape
from refimpl.model.problem import Problem, Terms
from refimpl.model.state import Status
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers import paper as module
from refimpl.solvers.paper import Trace, _interpolated, _Scheme
from refimpl.solvers.tau_active_set import FixedSet, GradualSet


def hertz(M: int = 8, friction: rf.Friction | None = None) -> Problem:
    scene = rf.read_scene("hertz")
    scene = scene if friction is None else replace(scene, friction=friction)
    return discretise(scene, scene.grid(M), Terms(oblique=False))


def scheme(M: int = 8, friction: rf.Friction | None = None) -> _Scheme:
    return _Scheme(hertz(M, friction), 1e-9, Counter(), None)


def test_the_correction_solves_on_the_contact_alone() -> None:
    """From pressures that reach beyond it, and as well for pressures below one pascal."""
    one = scheme()
    inside = np.zeros((8, 8), dtype=bool)
    inside[2:6, 3:6] = True
    expected = np.random.default_rng(5).uniform(0.5, 0.9, (8, 8)) * inside
    one.pressure = np.ones((8, 8))
    left = one._iterate(one._apply(expected), inside, on_circle=False)
    assert np.array_equal(left, inside)
    # steps end at 1e-10 of the pressure; 100 of them for what steepest descent still had to go
    assert np.abs(one.pressure - expected).max() <= 1e-8 * expected.max()


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


def test_without_contact_the_approach_grows_fourfold(monkeypatch: pytest.MonkeyPatch) -> None:
    found = asked(monkeypatch, 1e-6, lambda d: max(0.0, d / 15e-6 - 1 / 15))
    assert found[:3] == pytest.approx([1e-6, 4e-6, 16e-6], rel=1e-9)


def test_a_force_that_falls_at_first_is_met_by_twice_the_approach(monkeypatch: pytest.MonkeyPatch) -> None:
    """The secant would go back, to what is known to be too little."""
    forces = {1.0: 0.5, 0.5 ** (-2 / 3): 0.4}  # in units of 1e-6 m and of the load
    found = asked(
        monkeypatch, 1e-6, lambda d: next((f for x, f in forces.items() if math.isclose(d, x * 1e-6)), 1.0)
    )
    assert found == pytest.approx([1e-6, 1.5874e-6, 2 * 1.5874e-6], rel=1e-4)


@pytest.mark.parametrize("nothing_known", [None, 0.0])
def test_the_first_approach_is_a_small_part_of_the_gap(
    nothing_known: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So that few elements touch; between flats, which have no gap, it is of an element's size."""
    one = scheme()
    load = one.problem.load
    assert load is not None
    press = Press(lambda approach: load)
    monkeypatch.setattr(one, "normal_force", press)
    one.balance(nothing_known, None)
    assert 0.01 <= press.asked[0] / one.problem.gap.max() <= 0.2
    one.problem = replace(one.problem, gap=0 * one.problem.gap)
    one.balance(nothing_known, None)
    assert press.asked[1] == one.problem.grid.element_size


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


@pytest.mark.parametrize(
    "forces",
    [
        {1.0: 0.0, 4.0: 3.0, 2.0: -1.0, 3.0: 0.0, 3.5: 1.0},  # the secant from 2 and 3 meets the load at 4
        {1.0: 0.0, 4.0: 3.0, 2.0: 2.0, 1.5: 1.5, 1.25: 1.0},  # the one from 2 and 1.5 meets it at 1
    ],
)
def test_an_end_of_the_bracket_is_not_tried_again(
    forces: dict[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the force was there is known: the bracket is halved. Small integers, so that nothing rounds."""
    assert asked(monkeypatch, 1.0, forces.__getitem__) == list(forces)


def test_iteration_one_starts_within_the_interference_and_the_contact_so_far(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one = scheme(16)
    begun: list[Mask] = []
    iterate = one._iterate

    def recorded(u: Array, inside: Mask, *, on_circle: bool) -> Mask:
        if on_circle:
            begun.append(inside.copy())
        return iterate(u, inside, on_circle=on_circle)

    monkeypatch.setattr(one, "_iterate", recorded)
    one.normal_force(4e-6, FixedSet(one.problem.gap < 0))
    found = one.pressure > 0
    one.normal_force(6e-6, FixedSet(one.problem.gap < 0))
    assert np.array_equal(begun[0], one.problem.gap < 4e-6)
    assert 0 < found.sum() < begun[0].sum()
    assert np.array_equal(begun[1], found)


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


def test_passes_are_as_many_as_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    for passes in (1, 2):
        monkeypatch.setattr(module, "_PASSES", passes)
        one = scheme(16)
        one.tolerance = 0.0
        one.normal_force(4e-6, FixedSet(one.problem.gap < 0))
        assert one.trace.passes == passes
        assert not one.settled


def test_a_contact_that_never_settles_is_given_up_after_sixty_passes() -> None:
    one = scheme(4)
    one.tolerance = 0.0
    one.normal_force(4e-6, FixedSet(one.problem.gap < 0))
    assert one.trace.passes == 60
    assert not one.settled


def test_a_trace_is_itself_only() -> None:
    """It holds an array, which has no single truth to compare by."""
    one, other = Trace((8, 8)), Trace((8, 8))
    assert {one, other, one} == {other, one}
    assert one != other


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
    result, _ = module.solve_paper(hertz(friction=rf.Friction(beta=0.1)), 1e-9, Counter())
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


def test_a_scheme_that_settles_late_has_settled(monkeypatch: pytest.MonkeyPatch) -> None:
    """An approach that did not settle is not the last one."""
    iterate, contacts = _Scheme._iterate, list[Mask]()

    def left_open(one: _Scheme, u: Array, inside: Mask, *, on_circle: bool) -> Mask:
        contact = iterate(one, u, inside, on_circle=on_circle)
        if not contacts:
            one.settled = False
        contacts.append(contact)
        return contact

    monkeypatch.setattr(_Scheme, "_iterate", left_open)
    found = rf.solve(rf.read_scene("hertz"), grid=16, method="paper")
    assert found.cost.iterations["approaches"] > 1
    assert found.status is Status.CONVERGED


def test_displacements_are_applied_anew_only_where_elements_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """A step without exclusion adds what it moved: one application for it, and one for the start."""
    one = scheme()
    applied: list[Array] = []
    flexibility = one._apply
    monkeypatch.setattr(one, "_apply", lambda p: (applied.append(p), flexibility(p))[1])
    inside = np.zeros((8, 8), dtype=bool)
    inside[2:6, 2:6] = True
    one._iterate(flexibility(1e6 * inside), inside, on_circle=False)
    assert len(applied) == 1 + one.trace.correction_steps


def test_start_on_the_finer_grid_is_cubic_and_not_negative() -> None:
    def sampled(shape: Shape) -> Array:
        x, y = ((np.arange(n) + 0.5) / n for n in shape)
        return 2 + np.outer(x**3 - x, 1 + y**2)

    inner = np.s_[16:-16, 16:-16]  # away from the border, whose mirror bends the spline
    # bilinear interpolation would leave h^2 z'' / 8 = 9e-4 here; a cubic spline reproduces cubics, but for
    # the border's influence, which decays by 2 - sqrt(3) an element: 0.268^8 = 3e-5 of h z' there
    assert np.abs(_interpolated(sampled((32, 40))) - sampled((64, 80)))[inner].max() <= 2e-6
    step = np.zeros((8, 8))
    step[4:] = 1.0
    assert _interpolated(step).min() == 0.0
