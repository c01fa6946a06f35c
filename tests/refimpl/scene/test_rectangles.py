"""The border of rectangular scenes: sizes, grids of two numbers, arrays of another ratio, rigid bodies."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.refinement import FIRST_GRIDS, GRID_SIZES
from refimpl.driver.options import Options

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)


def strip(size: object = (2e-3, 1e-3), **changes: object) -> rf.Scene:
    given = {
        "upper": rf.Body(STEEL, rf.Sphere(0.14)),
        "lower": rf.Body(COPPER, rf.Flat()),
        "friction": rf.Friction(tau=15e6, beta=0.08),
        "load": 20.0,
    }
    return rf.Scene(**given | changes, size=size)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "size",
    [(0.0, 1e-3), (1e-3, -1e-3), (1e-3,), (1e-3, 1e-3, 1e-3), 1e-3, "1x2", (1e-3, math.nan), (1e-3, True),
     (1e-3, 1.1), (1e-3, 9e-7), ("a", "b")],
)  # fmt: skip
def test_bad_sizes_are_refused(size: object) -> None:
    with pytest.raises(rf.InputError, match=r"^size = "):
        strip(size)


def test_side_and_size_are_one_or_the_other() -> None:
    with pytest.raises(rf.InputError, match=r"size = \(0\.002, 0\.001\): expected none beside side = 0\.001"):
        strip(side=1e-3)
    with pytest.raises(rf.InputError, match="side = None: expected a length in m, or size"):
        strip(None)
    assert strip(None, side=1e-3).lengths == (1e-3, 1e-3)
    assert strip([2e-3, np.float64(1e-3)]).lengths == (2e-3, 1e-3)
    assert replace(strip(), size=(1e-3, 3e-3)).lengths == (1e-3, 3e-3)


@pytest.mark.parametrize(
    "grid", [(64,), (64, 32, 16), (64, 0), (64, -1), (64.0, 32), "64", (4096, 1), 0, 1.5, True]
)
def test_bad_grids_are_refused(grid: object) -> None:
    with pytest.raises(rf.InputError, match=r"^grid = "):
        Options(scene=strip(), grid=grid)  # type: ignore[arg-type]


def test_one_number_counts_along_the_longer_side() -> None:
    assert strip().grid(64).shape == (64, 32)
    assert strip((1e-3, 2e-3)).grid(64).shape == (32, 64)
    assert strip((3e-3, 1e-3)).grid(64).shape == (64, 21)
    assert strip((1.0, 60.0)).grid(7).shape == (1, 7)
    assert strip((1e-3, 1e-3)).grid(7).shape == (7, 7)


def test_grids_of_a_refinement_have_one_element_ratio() -> None:
    for ratio in (1.0, 1.3, 2.5, 3.999, 4.0, 4.1, 12.0, 60.0, 777.0):
        scene = strip((1e-3, ratio * 1e-3), load=1e-6)
        grids = [scene.refined(M * scene.slenderness) for M in (*FIRST_GRIDS, *GRID_SIZES)]
        ratios = [grid.spacings[0] / grid.spacings[1] for grid in grids]
        assert ratios == pytest.approx([ratios[0]] * len(ratios), rel=1e-14)
        assert 1 / math.sqrt(1.25) <= ratios[0] <= math.sqrt(1.25)
        assert [max(grid.shape) for grid in grids] == [
            M * scene.slenderness for M in (*FIRST_GRIDS, *GRID_SIZES)
        ]
    square = strip((1e-3, 1e-3))
    assert [square.refined(M).shape for M in FIRST_GRIDS] == [(M, M) for M in FIRST_GRIDS]


def test_accuracy_on_a_rectangle() -> None:
    found = rf.solve(strip((2.2e-3, 1e-3)), accuracy=0.02)
    assert found.converged
    nx, ny = found.grid.shape
    assert 2.2 / nx * ny == pytest.approx(2.2 / 16 * 7)
    assert found.summary()["grid"] == [nx, ny]
    assert found.summary()["size"] == [2.2e-3, 1e-3]
    square = rf.solve(strip(None, side=1e-3), 16).summary()
    assert (square["grid"], square["side"], "size" in square) == (16, 1e-3, False)


# --- arrays ---


def test_arrays_are_never_squeezed() -> None:
    z = 1e-7 * np.random.default_rng(0).normal(size=(128, 64))
    with pytest.raises(
        rf.InputError, match=r"whose pixels here are 7\.8125e-06 x 1\.5625e-05 m'.*pixel=\(dx, dy\)"
    ):
        rf.solve(strip((1e-3, 1e-3), lower=rf.Body(COPPER, z)), 64)
    stated = rf.ArraySurface(z, pixel=(1e-3 / 128, 1e-3 / 64))
    assert rf.solve(strip((1e-3, 1e-3), lower=rf.Body(COPPER, stated)), 32).converged
    assert rf.solve(strip((1e-3, 0.5e-3), lower=rf.Body(COPPER, z)), 32).converged
    assert rf.solve(strip((1e-3, 0.5049e-3), lower=rf.Body(COPPER, z)), 32).converged  # 1 % are let pass
    with pytest.raises(rf.InputError, match=r"heights"):
        rf.solve(strip((1e-3, 0.506e-3), lower=rf.Body(COPPER, z)), 32)
    with pytest.raises(
        rf.InputError, match=r"pixel = 'array of 0\.001 x 0\.001 m on a domain of 0\.001 x 0\.0005 m'"
    ):
        rf.solve(strip((1e-3, 0.5e-3), lower=rf.Body(COPPER, stated)), 32)
    assert strip(None, lower=rf.Body(COPPER, stated)).lengths == pytest.approx((1e-3, 1e-3))
    for pixel in (0.0, (1.0,), (1.0, -1.0), "a"):
        with pytest.raises(rf.InputError, match=r"^pixel = "):
            rf.ArraySurface(z, pixel=pixel)  # type: ignore[arg-type]


# --- rigid bodies ---


def test_two_rigid_bodies_are_refused() -> None:
    rigid = rf.Material(E=math.inf, nu=0.3)
    with pytest.raises(rf.InputError, match=r"upper\.material\.E = inf: expected a finite modulus"):
        strip(upper=rf.Body(rigid, rf.Flat()), lower=rf.Body(rigid, rf.Flat()))
