"""Solves at the ends: full contact, flat planes, scenes that crashed, never came back or ran off."""

from __future__ import annotations

import sys
import threading
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl.planning.plan import Method

SIDE, M = 1e-3, 12
STEEL = rf.Material(200e9, 0.3)


POLYMER = rf.Material(3e9, 0.4)


def planes(friction: rf.Friction, load: float, side: float) -> rf.Scene:
    """Flat periodic planes; the pressure is the load over the area."""
    return rf.Scene(
        upper=rf.Body(STEEL, rf.Flat()), lower=rf.Body(POLYMER, rf.Flat()), friction=friction, load=load,
        side=side, periodic=True,
    )  # fmt: skip


@settings(max_examples=25, deadline=None)
@given(
    st.sampled_from(["fft", "dense"]), st.integers(1, 12), st.floats(-9, 3), st.floats(-6, 1), st.booleans()
)
def test_flat_periodic_planes_converge_on_every_grid(
    method: Method, M: int, load: float, side: float, rubs: bool
) -> None:
    """All displacements are rounding there, and a gap over an energy would be rounding over rounding."""
    pressure = 10**load / (10**side) ** 2
    friction = rf.Friction(min(0.1 * pressure, 1e7), 0.3) if rubs else rf.Friction()
    scene = planes(friction, 10**load, 10**side)
    if pressure > 1e9:
        scene = replace(scene, load=1e9 * scene.side**2)
    solution = rf.solve(scene, M, method=method)
    assert solution.status is rf.Status.CONVERGED
    np.testing.assert_allclose(solution.pressure, scene.load / scene.side**2, rtol=1e-12)


def test_heights_beyond_the_side_are_told_the_way_out() -> None:
    """Dimensionless set-ups: heights by s with moduli over s have the same pressures without slope terms."""
    z = np.random.default_rng(4).standard_normal((8, 8))

    def scene(s: float) -> rf.Scene:
        upper, lower = (rf.Body(rf.Material(E / s, 0.3), h) for E, h in ((1.0, rf.Flat()), (2.0, s * z)))
        return rf.Scene(upper=upper, lower=lower, friction=rf.Friction(0.1, 0.2), load=0.3, side=1.0)

    with pytest.raises(rf.InputError, match=r"times s .* same pressures"):
        rf.solve(scene(1.0), 8, oblique=False)
    ways_out = [rf.solve(scene(s), 8, oblique=False) for s in (0.01, 0.1)]
    np.testing.assert_allclose(ways_out[0].pressure, ways_out[1].pressure, atol=1e-7)
    assert 0 < ways_out[0].contact.sum() < 64


def test_threads_do_not_mix_the_notes_of_surfaces() -> None:
    """Python's filters of warnings belong to the process: solving leaves them alone."""
    draw, soft = np.random.default_rng(0), rf.Material(1e9, 0.3)
    scenes = [
        rf.Scene(
            upper=rf.Body(soft, rf.Sphere(0.01)),
            lower=rf.Body(soft, draw.normal(size=(8, 8) if k % 2 else (32, 32)) * 1e-6),
            friction=rf.Friction(1e6, 0.1),
            load=1e-2,
            side=1e-3,
        )
        for k in range(8)
    ]
    found: dict[int, list[str]] = {}

    def work(first: int) -> None:
        for k in range(first, len(scenes), 4):
            found[k] = [str(line) for line in rf.solve(scenes[k], grid=32).warnings]

    before, patience = list(warnings.filters), sys.getswitchinterval()
    sys.setswitchinterval(1e-5)  # threads take turns a thousand times as often
    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    try:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(patience)
    assert list(warnings.filters) == before
    for k, lines in found.items():
        assert sum("finer than the array" in line for line in lines) == k % 2


def test_a_tolerance_below_rounding_ends_at_the_floor_after_few_steps() -> None:
    """CG took 1009 steps there, its limit; 103 steps now."""
    found = rf.solve(rf.read_scene("table1-smooth"), 64, tolerance=1e-16)
    assert found.status is rf.Status.STAGNATED
    assert found.certificate.largest < 1e-13
    assert sum(found.cost.iterations.values()) < 200


def test_beta_beyond_all_sense_ends_with_a_status() -> None:
    """Without slopes nothing but displacements can run off."""
    scene = rf.Scene(
        upper=rf.Body(rf.Material(1.0, 0.0), rf.Flat()),
        lower=rf.Body(rf.Material(1e20, 0.3), rf.Flat()),
        friction=rf.Friction(4.3e-4, 1000.0),
        load=1e-4,
        side=1.0,
        sliding_direction=0.3,
    )
    assert not rf.solve(scene, grid=11, approach=0.75, oblique=False).converged


def test_contact_where_the_coarser_grid_had_none() -> None:
    """One element is likely, the grid before pressed others: the start has no pressure at all."""
    z = np.random.default_rng(1).normal(size=(32, 32))
    z *= 3.5e-6 / np.ptp(z)
    soft = rf.Material(E=4.3e7, nu=0.3)
    scene = rf.Scene(rf.Body(soft, z), rf.Body(soft, rf.Flat()), rf.Friction(), load=3.46e-4, side=3.95e-3)
    afresh = rf.solve(scene, grid=64)
    found = rf.solve(scene, grid=64, start=rf.solve(scene, grid=32))
    assert found.converged
    assert np.allclose(found.pressure, afresh.pressure, rtol=0, atol=1e-7 * afresh.max_pressure)
