"""A solution to start from: the same answer with fewer transforms, whatever grid or load it is of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import refimpl as rf
from tests.refimpl.solvers.production.levels import BALL
from verification.properties import Sample, samples
from verification.properties.states import same_pressure

POLYMER = rf.Material(E=2.5e9, nu=0.2)
ROUGH = replace(
    BALL,
    lower=rf.Body(POLYMER, rf.GaussianRoughness(rms=2e-6, correlation_length=2e-4, seed=5)),
    friction=rf.Friction(tau=1e6, beta=0.1),
)
WAVY = replace(
    ROUGH,
    lower=rf.Body(POLYMER, rf.GaussianRoughness(rms=1e-6, correlation_length=2e-4, seed=5)),
    upper=rf.Body(rf.Material(E=200e9, nu=0.3), rf.Flat()),
    periodic=True,
)


@pytest.mark.parametrize(
    ("scene", "grid", "finer"),
    [
        (ROUGH, 32, 64),
        (ROUGH, 65, 65),
        (WAVY, 32, 64),
    ],
)
def test_the_answer_is_the_same_for_hardly_more_transforms(scene: rf.Scene, grid: int, finer: int) -> None:
    start = rf.solve(scene, grid)
    begun, afresh = rf.solve(scene, finer, start=start), rf.solve(scene, finer)
    assert begun.status is afresh.status is rf.Status.CONVERGED
    assert np.array_equal(begun.contact, afresh.contact)
    np.testing.assert_allclose(begun.pressure, afresh.pressure, rtol=0, atol=1e-6 * afresh.max_pressure)
    # of a rule of tau's supports only the first gets on faster; measured: 0.48 to 0.68; on waves 1.02:
    # 32 x 32 elements take a quarter of the work of 64 x 64, where CG took 15 steps instead of 13
    assert begun.cost.point_logs < (1.05 if scene.periodic else 0.75) * afresh.cost.point_logs


@given(samples(), st.sampled_from([0.3, 1.0, 2.5]))
@settings(max_examples=10, deadline=None)
def test_whatever_a_solve_starts_from(sample: Sample, share: float) -> None:
    """The samples of the invariants, from their own answer and from that to another load."""
    other = replace(sample.scene, load=share * sample.scene.load)
    start = rf.solve(other, sample.shape, tolerance=1e-12)
    assume(start.converged)
    begun, afresh = (rf.solve(sample.scene, sample.shape, tolerance=1e-12, start=s) for s in (start, None))
    assert begun.converged
    assert afresh.converged
    same_pressure(begun, afresh, sample)
    assert np.array_equal(begun.details.excluded, afresh.details.excluded)


def test_a_contact_that_grows_to_its_windows_edge_has_slopes_there() -> None:
    """Found by hypothesis: one-sided slopes on the edge left a slope residual of 1e-3 on the whole grid."""
    rows = ["3b860299", "5de60e71", "09154a1d", "6fe56e04", "44c67aec", "6e01b404", "009ef52f", "6fe56e04"]
    bumps = tuple(tuple(int(digit, 16) for digit in row) for row in rows)
    sample = Sample(bumps, upper=35, E=(111, 56), nu=(0, 29), pressure=12, tau=43, beta=27, angle=-3)
    start = rf.solve(replace(sample.scene, load=0.3 * sample.scene.load), 8)
    found, afresh = (rf.solve(sample.scene, 8, tolerance=1e-12, start=s) for s in (start, None))
    assert found.converged
    same_pressure(found, afresh, sample)


def test_a_start_may_have_another_load_or_approach() -> None:
    start = rf.solve(ROUGH, 48)
    for changed in ({"scene": replace(ROUGH, load=3.0)}, {"scene": ROUGH, "approach": 3e-6}):
        begun, afresh = rf.solve(**changed, grid=64, start=start), rf.solve(**changed, grid=64)
        assert begun.status is afresh.status
        assert begun.converged
        assert begun.normal_force == pytest.approx(afresh.normal_force, rel=1e-7)
        np.testing.assert_allclose(begun.pressure, afresh.pressure, rtol=0, atol=1e-6 * afresh.max_pressure)


@pytest.mark.parametrize(
    ("start", "asked", "said"),
    [
        ({"grid": 24}, {"grid": 16}, "16 x 16"),
        ({"grid": 16}, {"grid": 16, "method": "dense"}, "method fft"),
        ({"grid": 16}, {"accuracy": 0.1}, "method fft on a grid"),
        ({"grid": 16, "tolerance": 1e-17}, {"grid": 32}, "certificate holds"),
        ({"grid": 16}, {"grid": 16, "scene": replace(ROUGH, side=3e-3)}, "3e-03|0.003"),
    ],
)
def test_what_is_no_start_is_refused(start: dict[str, float], asked: dict[str, object], said: str) -> None:
    found = rf.solve(ROUGH, **start)
    with pytest.raises(rf.InputError, match=said) as caught:
        rf.solve(**{"scene": ROUGH} | asked, start=found)
    assert caught.value.field == "start"


def test_an_accuracy_climbs_from_answer_to_answer() -> None:
    """Grid by grid it costs what a chain of starts does."""
    forced = {"oblique": True, "coupled": True, "tilted": True, "tolerance": 1e-6}
    found = rf.solve(ROUGH, accuracy=0.2, **forced)
    chain = [rf.solve(ROUGH, 32, **forced)]
    while chain[-1].grid != found.grid:
        M = 64 if len(chain) == 1 else found.grid.shape[0]
        chain.append(rf.solve(ROUGH, M, start=chain[-1], **forced))
    assert found.cost.point_logs == sum(step.cost.point_logs for step in chain)
    assert np.array_equal(found.pressure, chain[-1].pressure)
