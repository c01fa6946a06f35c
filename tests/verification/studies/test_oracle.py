"""The oracle of the stress tests against known values, enumerated states and the dense solver."""

from __future__ import annotations

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

import refimpl as rf
from verification.exact import exact_operators, lawful_states
from verification.scenes.cross_checks import POLYMER, pressed
from verification.stress_tests import judge
from verification.stress_tests.axes.contacts import on, sheared
from verification.stress_tests.oracle import Exactly, Guess, NotSettled, Oracle

pytestmark = pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")  # few elements, for enumeration

BALL = pressed(lower=POLYMER, load=30.0, direction=0.7, friction=rf.Friction(1e5, 0.3))


def test_the_oracle_on_one_element_is_the_closed_form() -> None:
    """One square element of edge s under pressure p: approach p s 4 asinh(1) (1/(pi E*))."""
    scene = on(np.zeros((1, 1)), 3.0, friction=rf.Friction())
    exact = Oracle(scene, 1).solve(np.ones((1, 1)), np.ones((1, 1), dtype=bool))
    compliance = scene.materials.normal_compliance
    pressure = scene.load / scene.side**2
    assert float(exact.pressure[0]) == pytest.approx(pressure, rel=1e-15)
    expected = compliance * pressure * scene.side * 4 * np.arcsinh(1.0)
    assert float(exact.approach) == pytest.approx(expected, rel=1e-15)


def test_the_oracle_satisfies_the_contact_conditions_wherever_it_starts() -> None:
    oracle = Oracle(BALL, 4)
    support = np.ones((4, 4), dtype=bool)
    guesses = (np.eye(4), np.ones((4, 4)), np.arange(16.0).reshape(4, 4))
    found = [oracle.solve(guess, support) for guess in guesses]
    tilted = np.full((4, 4), 0.02), np.linspace(-0.03, 0.03, 16).reshape(4, 4)
    found.append(oracle.solve(guesses[1], support, tilted))
    for other in found[1:]:
        assert max(abs(found[0].pressure - other.pressure)) < 1e-15 * max(found[0].pressure)
    assert abs(found[0].normal - BALL.load) < mp.mpf(10) ** -15
    assert min(found[0].pressure) >= 0


@pytest.mark.parametrize(
    ("scene", "M"),
    [
        (replace(BALL, friction=rf.Friction(beta=0.3), periodic=True), 4),  # by the load
        (replace(BALL, load=300.0, friction=rf.Friction(beta=5.0)), 4),
        (sheared(1.78, 0.0, soft_below=False), 5),  # by tau alone: with less load no state is lawful
    ],
    ids=["periodic", "beta", "tau"],
)
def test_continuation_arrives_at_the_state_that_the_solver_finds(scene: rf.Scene, M: int) -> None:
    solution = rf.solve(scene, M, method="dense")
    assert solution.status is rf.Status.CONVERGED
    found = Oracle(scene, M).continued()
    assert np.array_equal(found.contact, solution.contact.ravel())
    assert solution.pressure.ravel() == pytest.approx(found.pressure.astype(float), rel=1e-9)


def test_a_route_whose_first_solve_fails_leaves_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    follow, tried = Oracle._continued, list[str]()

    def failing(self: Oracle, route: str, share: float) -> Exactly:
        tried.append(route)
        if route != "tau":
            raise NotSettled("at its first solve")
        return follow(self, route, share)

    monkeypatch.setattr(Oracle, "_continued", failing)
    Oracle(BALL, 4).continued()
    assert tried == ["load", "beta", "tau"]
    with pytest.raises(NotSettled, match="nor tau's"):
        Oracle(replace(BALL, friction=rf.Friction(beta=0.3)), 4).continued()


@pytest.mark.parametrize("tau", [1.0, 10.0, 30.0])
@pytest.mark.parametrize("seed", range(3))
def test_continuation_finds_lawful_states_and_no_other(tau: float, seed: int) -> None:
    """Enumeration of all contact sets, and integer programming over them, are its negative control."""
    scene = lawful_states.scene(seed, tau, soft_below=seed % 2 == 0)
    lawful = lawful_states.lawful_states(scene)
    assert lawful_states.none_is_lawful(scene, lawful_states.M) == (not lawful)
    oracle = Oracle(scene, lawful_states.M, oblique=False)
    if not lawful:
        with pytest.raises(NotSettled):
            oracle.continued()
    else:
        assert any(np.array_equal(oracle.continued().contact, state.ravel()) for state in lawful)


@pytest.mark.parametrize("block", [0, 24, 25, 75], ids=["pressure", "gap", "tangent", "approach"])
def test_the_oracle_ends_when_each_of_its_unknowns_has_settled(block: int) -> None:
    """A large number of one kind excuses no step of another kind."""
    oracle = Oracle(sheared(1.0, 0.0), 5)
    state = Guess(np.ones((76, 1)), np.arange(25) < 24, (1.0, 1.0, 1.0))
    for other in {0, 24, 25, 75} - {block}:
        state.x[other] = 1e9 if other != 0 else 1.0  # the pressure's peak is also the unit of the others
    step = np.zeros(76)
    step[block] = 1e-3
    assert not oracle._settled(state, step, 1e-8)
    step[block] = 1e-9
    assert oracle._settled(state, step, 1e-8)


@pytest.mark.parametrize("periodic", [False, True], ids=["free", "periodic"])
@pytest.mark.parametrize(("friction", "tolerance"), [((0.0, 0.3), 1e-13), ((1e5, 0.3), 1e-12)])
@pytest.mark.parametrize("prescribed", [False, True], ids=["load", "approach"])
def test_the_oracle_with_facet_tractions_is_the_dense_solver(
    periodic: bool, friction: tuple[float, float], tolerance: float, prescribed: bool
) -> None:
    """On steep slopes: all signs of all terms of G, g and of the slopes themselves."""
    heights = np.random.default_rng(3).uniform(0, 4e-4 / 5, (5, 5))
    flat = pressed(
        lower=POLYMER, radius=None, rms=None, side=4e-4, load=30.0, direction=0.7, periodic=periodic
    )
    scene = replace(flat, lower=rf.Body(POLYMER, heights), friction=rf.Friction(*friction))
    loaded = rf.solve(scene, 5, method="dense", slope_correction=True, tolerance=tolerance)
    assert 4 < loaded.contact.sum() < 25
    assert np.degrees(np.arctan(np.hypot(loaded.slopes.tan_x, loaded.slopes.tan_y))).max() > 8
    approach = loaded.approach if prescribed else None
    error, note = judge.exact_error(scene, loaded, approach=approach, slope_correction=True)
    assert error < 1e-9, note


def test_exact_periodic_operators_are_the_symbols_eigenfunctions() -> None:
    """A cosine of q under 2 pi / q, and under -2 pi i q_x / q^2."""
    M = 5
    i = np.indices((M, M))[0].ravel()
    wave, sine = np.cos(2 * np.pi * i / M), np.sin(2 * np.pi * i / M)
    q = 2 * np.pi / M
    np.testing.assert_allclose(
        exact_operators.normal(M, True).astype(float) @ wave, 2 * np.pi / q * wave, atol=1e-13
    )
    x = exact_operators.tangential(M, True)[0].astype(float)
    np.testing.assert_allclose(x @ wave, 2 * np.pi / q * sine, atol=1e-13)
