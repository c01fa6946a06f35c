"""Surfaces and friction laws of one's own, through the public interface."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.solve import solve
from refimpl.errors import InputError
from refimpl.grid import Array, Grid, Mask
from refimpl.identification.data_table import Row
from refimpl.identification.identify import identify
from refimpl.scene.parameters import parameters
from refimpl.sensitivities.budget import budget
from refimpl.solution.quantities import QUANTITIES

SIZE = (1.2e-3, 0.9e-3)
SOFT, HARD = rf.Material(E=2.5e9, nu=0.2), rf.Material(E=200e9, nu=0.3)


@dataclass(frozen=True)
class Ridge(rf.Surface):
    """``-(x - at)^2 / (2 radius)``, a ridge along y at x = at (m), with waves along it."""

    at: float
    radius: float = 0.05

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        x, y = grid.x + offset[0] - self.at, grid.y + offset[1]
        z: Array = 1e-7 * np.cos(2e4 * y) - (x**2 / (2 * self.radius))[:, None]
        return z


@dataclass(frozen=True)
class Limited:
    """``r = min(tau + beta f, limit)``: jump = tau (Pa), slope = beta, limit in Pa."""

    jump: float = 0.3e6
    slope: float = 0.2
    limit: float = math.inf
    is_linear = False

    def traction(self, pressure: Array, active: Mask) -> Array:
        law = np.minimum(self.jump + self.slope * pressure, self.limit)
        return np.where(active, law, self.slope * pressure)

    def shear_offset(self, pressure: Array, active: Mask) -> Array:
        return self.traction(pressure, active) - self.slope * pressure


def scene(law: Any = rf.Friction(tau=0.3e6, beta=0.2), **more: Any) -> rf.Scene:  # noqa: B008  # immutable
    return rf.Scene(rf.Body(HARD, rf.Sphere(0.03)), rf.Body(SOFT, Ridge(5e-4)), law, 2.0, size=SIZE, **more)


@pytest.mark.parametrize(
    "z",
    [np.zeros((2, 3)), 0.0, np.zeros((3, 2), complex), np.full((3, 2), "1")],
    ids=["shape", "0", "i", "text"],
)
def test_heights_of_another_shape_or_kind_are_refused(z: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Ridge, "heights_on", lambda *_: z)
    with pytest.raises(InputError, match=r"Ridge\.heights_on.*\(3, 2\)"):
        scene().heights(scene().grid((3, 2)))


@pytest.mark.parametrize("part", ["surface", "law"])
def test_a_scene_file_has_neither(part: str) -> None:
    own = scene(Limited()) if part == "law" else scene()
    with pytest.raises(InputError, match="Limited" if part == "law" else "Ridge"):
        rf.scene_to_toml(own)


def test_a_law_with_a_limit_is_solved_corrected_and_summarised() -> None:
    """No element carries more than the limit; its contact edge's excess carries the same jump."""
    most = 1.2e6
    s, papers = (solve(scene(law), grid=32) for law in (Limited(limit=most), scene().friction))
    assert s.converged
    assert s.traction.max() == most
    assert most * s.contact_area > s.friction_force > 0.3e6 * s.contact_area
    np.testing.assert_array_equal(s.contact, papers.contact)
    taken_off = s.friction_coefficient - s.friction_coefficient_corrected
    assert taken_off == pytest.approx(papers.details.features.dmu_dA * s.details.features.excess, rel=1e-6)
    assert (
        json.loads(json.dumps(s.summary(), allow_nan=False))["friction_coefficient"] == s.friction_coefficient
    )


FRICTION = tuple(name for name in QUANTITIES if name.startswith("friction"))


def test_a_law_that_is_not_linear_has_no_error_bar_of_friction_and_is_named() -> None:
    law, name = Limited(limit=1.2e6), "Limited"
    s = solve(scene(law), grid=32)
    assert len(FRICTION) == 4
    assert [s.error(number) for number in FRICTION] == [None] * 4
    assert [s.summary()["error"][number] for number in FRICTION] == [None] * 4
    assert 0 < s.error("contact_area") < s.contact_area
    assert [line for line in s.warnings if name in line and "mu and F" in line]
    with pytest.raises(InputError, match=f"quantity.*contact_area.*{name}"):
        solve(scene(law), accuracy=0.05)
    assert solve(scene(law), accuracy=0.3, quantity="contact_area").converged


def test_a_law_that_is_not_linear_has_no_derivatives_and_a_linear_one_has() -> None:
    """Of ``r = jump + slope f`` with other names the derivatives are those of tau and beta."""
    own = scene(Limited(limit=1e9))
    found = solve(own, grid=32)
    with pytest.raises(InputError, match="linear"):
        rf.sensitivity(own, found)
    with pytest.raises(InputError, match="linear"):
        budget(own, found, {"load": 0.1})

    class Linear(Limited):
        is_linear = True

    twin = scene(Linear())
    assert {"friction.jump": 0.3e6, "friction.slope": 0.2}.items() <= parameters(twin).items()
    papers, ours = (rf.sensitivity(one, solve(one, grid=32)) for one in (scene(), twin))
    for theirs, name in (("friction.tau", "friction.jump"), ("friction.beta", "friction.slope")):
        expected = papers.derivatives["friction_coefficient_corrected"][theirs]
        assert ours.derivatives["friction_coefficient_corrected"][name] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    "law",
    [0.3, None, Limited(jump=-1.0), Limited(slope=math.nan), type("Half", (), {"jump": 1.0, "slope": 0.0})()],
)
def test_what_is_no_law_is_refused(law: object) -> None:
    with pytest.raises(InputError, match=r"^friction"):
        scene(law)


def test_the_plain_reference_and_identification_know_the_papers_law_alone() -> None:
    with pytest.raises(InputError, match="no other law"):
        solve(scene(Limited()), grid=16, method="dense")
    with pytest.raises(InputError, match="whose tau and beta are found"):
        identify(scene(Limited()), [Row(1.0, 0.3, 0.01), Row(2.0, 0.25, 0.01), Row(3.0, 0.2, 0.01)], 16)


def test_a_linear_law_of_another_form_has_the_bars_of_the_papers() -> None:
    """As at a sliding velocity whose logarithm raises both tau and beta."""

    class AtVelocity(Limited):
        is_linear = True

    papers, own = (
        solve(scene(law), grid=32) for law in (rf.Friction(0.33e6, 0.22), AtVelocity(1.1 * 0.3e6, 1.1 * 0.2))
    )
    assert [own.error(name) for name in FRICTION] == pytest.approx([papers.error(n) for n in FRICTION])
