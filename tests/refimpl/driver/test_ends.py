"""Solves that end: scenes of random searches that crashed, never came back, or were refused by a hair."""

from __future__ import annotations

import sys
import threading
import warnings

import numpy as np
import pytest

import refimpl as rf

RIGID = rf.Material(E=1e100, nu=0.3)


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


@pytest.mark.parametrize("tau", [1e11, 1e14])
def test_tau_beyond_all_pressures_ends_with_a_status(tau: float) -> None:
    scene = rf.Scene(
        upper=rf.Body(rf.Material(200e9, 0.3), rf.Sphere(radius=0.05)),
        lower=rf.Body(
            rf.Material(2.5e9, 0.38), rf.GaussianRoughness(rms=0.8e-6, correlation_length=150e-6, seed=3)
        ),
        friction=rf.Friction(tau=tau, beta=0.12),
        load=5.0,
        side=2e-3,
    )
    assert not rf.solve(scene, grid=64).converged


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


@pytest.mark.parametrize(("seed", "M"), [(13, 16), (170, 24)])
def test_what_the_loop_accepts_the_certificate_does(seed: int, M: int) -> None:
    """Shear and cosines are held for a pressure that is then scaled to the load, by 1e-8 or so."""
    draw = np.random.default_rng(seed)
    nu, beta = float(draw.choice([0.0, 0.2, 0.3])), float(draw.choice([0.8, 1.2, 1.5, 2.0]))
    lower: rf.Surface = rf.Flat()
    if draw.random() >= 0.3:
        lower = rf.GaussianRoughness(10 ** draw.uniform(-7.5, -5.5), 3e-4, seed=int(draw.integers(1000)))
    upper = rf.Flat() if draw.random() < 0.5 else rf.Sphere(radius=10 ** draw.uniform(-2, 1))
    scene = rf.Scene(
        upper=rf.Body(RIGID, upper),
        lower=rf.Body(rf.Material(5e9, nu), lower),
        friction=rf.Friction(beta=beta),
        load=5e3 * 10 ** draw.uniform(-4, -1),
        side=1e-3,
        sliding_direction=draw.uniform(0, 6),
    )
    assert rf.solve(scene, M, oblique=True).status is rf.Status.CONVERGED


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
        for k in range(24)
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
