"""Random scenes of the study of error bars: classes in turn, shares of materials and friction, heights."""

from __future__ import annotations

import math

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from verification.coverage.drawing import Barrel, Wave, Waves, measured_like
from verification.coverage.scenes import CLASSES, random_scene

SIDE = 1e-3
DRAWN = {
    kind: [random_scene(8 * k + place) for k in range(40)] for place, kind in enumerate(CLASSES)
}  # classes take turns
ALL = [drawn for several in DRAWN.values() for drawn in several]


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_classes_take_turns_and_know_no_grid() -> None:
    for kind, several in DRAWN.items():
        assert {drawn.kind for drawn in several} == {kind}
        assert {drawn.scene.lengths for drawn in several} == {(SIDE, SIDE)}
        assert {drawn.scene.periodic for drawn in several} == {kind.startswith("periodic")}
        drawn, again = several[0], random_scene(several[0].seed)
        coarse, fine = (np.array(d.scene.heights(d.scene.grid(M))) for d, M in ((drawn, 32), (again, 96)))
        # every third centre of the fine grid is one of the coarse; mid-heights differ by the unsampled rest
        shift = fine[:, 1::3, 1::3] - coarse
        assert np.ptp(shift, axis=(1, 2)).max() <= 1e-12 * SIDE, kind


def test_shares_of_materials_and_friction() -> None:
    """A fifth of the pairs are of one material; a fifth has no tau, a fifth no beta, and a tenth neither."""
    alike = np.mean([drawn.scene.upper.material == drawn.scene.lower.material for drawn in ALL])
    no_tau, no_beta = (
        np.array([getattr(d.scene.friction, name) == 0 for d in ALL]) for name in ("tau", "beta")
    )
    for share, expected in (
        (alike, 0.2), (no_tau.mean(), 0.2), (no_beta.mean(), 0.2), ((no_tau & no_beta).mean(), 0.1)
    ):  # fmt: skip
        assert abs(share - expected) < 3 * math.sqrt(expected / 320)  # three standard deviations at least


def spectrum(z: Array) -> tuple[Array, Array]:
    """Waves per side, and the size of the Fourier coefficient there."""
    q = np.fft.fftfreq(len(z)) * len(z)
    return np.hypot(q[:, None], q[None, :]), np.abs(np.fft.fft2(z))


def test_heights_that_look_measured_are_self_affine_and_worn() -> None:
    """The mean spectrum falls by 2^1.7 from 8 to 16 waves at a Hurst exponent of 0.7, is level below the
    roll-off, and ends at a quarter of the points; summits are blunter than valleys are.
    """
    rng = np.random.default_rng(3)
    drawn = [measured_like(rng, 96, 1e-6, 0.7, roll_off=6) for _ in range(60)]
    q = spectrum(drawn[0])[0]
    power = np.mean([spectrum(z)[1] ** 2 for z in drawn], axis=0)
    levels = {k: math.sqrt(float(power[np.abs(q - k) < 0.5].mean())) for k in (2, 4, 5, 8, 16, 28)}
    assert levels[8] / levels[16] == pytest.approx(2**1.7, rel=0.15)
    assert levels[2] / levels[5] == pytest.approx(1, rel=0.15)
    assert levels[28] < 0.2 * levels[16]
    assert np.mean([float(((z - z.mean()) ** 3).mean()) for z in drawn]) < -0.3e-18
    assert all(z.std() == pytest.approx(1e-6) and abs(z.mean()) < 1e-20 for z in drawn)


def test_heights_of_barrels_and_waves() -> None:
    """A barrel's middle is the domain's; at x = 0.25, y = 0.1 of 1 x 0.4 mm, moved by 0.05 and 0.02 mm, it is
    0.2 mm from it along x and 0.08 mm along y. Waves there, 3 and 2: 0.9 and 0.6 of a turn.
    """
    grid = rf.Grid((2, 2), (1e-3, 4e-4))
    barrel = Barrel(across=2e-2, along=5e-2).heights(grid, (5e-5, 2e-5))
    assert barrel[0, 0] == pytest.approx(4e-8 / 4e-2 + 64e-10 / 0.1)
    waves = Waves(2e-6, (3, 2), (0.3, 0.5)).heights(grid, (5e-5, 2e-5))
    along_x, along_y = math.cos(1.8 * math.pi + 0.3), math.cos(1.2 * math.pi + 0.5)
    assert waves[0, 0] == pytest.approx(2e-6 * (along_x + along_y))
    for axis, (numbers, phase, expected) in enumerate((((3, 0), 0.3, along_x), ((0, 2), 0.5, along_y))):
        grooves = Wave(2e-6, numbers, phase).heights(grid, (5e-5, 2e-5))
        assert grooves.shape == (2, 2)
        assert grooves[0, 0] == pytest.approx(2e-6 * expected)
        assert np.ptp(grooves, axis=1 - axis).max() == 0
    oblique, zigzag = (
        Wave(2e-6, (3, 2), 0.3, straight).heights(grid, (5e-5, 2e-5))[0, 0] for straight in (False, True)
    )
    assert oblique == pytest.approx(2e-6 * math.cos(3.0 * math.pi + 0.3))
    assert zigzag == pytest.approx(2e-6 * (1 - 2 / math.pi * (math.pi - 0.3)))
