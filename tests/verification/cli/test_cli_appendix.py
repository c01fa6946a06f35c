"""`appendix-a` on the command line: what it prints, what it writes, how far it says it is."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from appendix_a.fem.coefficient_map import CoefficientMap
from verification.cli import main

WEDGE = ["appendix-a", "wedge", "--r=1", "--theta-deg=0"]

Capture = pytest.CaptureFixture[str]


def test_fem_prints_the_four_keys_and_agrees_with_the_strip_on_a_gentle_slope(capsys: Capture) -> None:
    wave = ["--slope-deg=0.5", "--wavelength=50", "--position=0.25", "--nu=0.3", "--offsets=-3,3", "--json=-"]
    found = {}
    for problem in ("strip", "fem"):
        assert main(["appendix-a", problem, *wave]) == 0
        found[problem] = json.loads(capsys.readouterr().out)
    assert list(found["fem"]) == ["offsets", "wavy", "flat", "discretisation_error"]
    assert found["fem"]["offsets"] == [-3.0, 3.0]
    change = {name: np.subtract(f["wavy"], f["flat"]) for name, f in found.items()}
    # Uphill (-3) the wavy boundary yields less than the flat one, downhill more (paper, Fig. 12).
    assert change["fem"][0] > 0 > change["fem"][1]
    # Second order in a slope of 0.0087 is 1 % of the first, times the wave's curvature over the strip.
    np.testing.assert_allclose(change["strip"], change["fem"], rtol=0.03)


def test_map_writes_the_table_that_its_package_reads(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "map.json"
    axes = ["--slopes-deg", "6.5", "--wavelengths", "64", "--positions", "0.25", "--jobs", "1"]
    assert main(["appendix-a", "map", *axes, "--json", str(path)]) == 0
    assert "percentage points" in capsys.readouterr().out
    table = CoefficientMap.read(path)
    assert (table.slope_deg, table.wavelength, table.position) == ((6.5,), (64.0,), (0.25,))


def test_wedge_of_no_slope_is_the_half_plane(capsys: Capture) -> None:
    assert main([*WEDGE, "--gamma-deg", "0", "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    # Flamant's strip, -1 < x < 1, at depth 1 below its centre: -(1/pi)(2 atan 1 -+ sin(2 atan 1)).
    assert found["sigma_r"] == pytest.approx([-0.5 - 1 / 3.141592653589793], abs=1e-9)
    assert found["sigma_theta"] == pytest.approx([-0.5 + 1 / 3.141592653589793], abs=1e-9)
    assert found["tau_rtheta"] == pytest.approx([0.0], abs=1e-9)


@pytest.mark.parametrize("gamma", [0.1, 10.3, 33.3, 70.7])
def test_a_theta_on_the_face_is_inside(gamma: float) -> None:
    angles = f"--theta-deg={gamma - 90},{90 - gamma},{round(90 - gamma, 6)}"
    assert main([*WEDGE, "--gamma-deg", str(gamma), angles]) == 0


@pytest.mark.parametrize("terminal", [True, False])
def test_finite_elements_say_on_a_terminal_how_far_they_are(
    terminal: bool, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    wave = ["--slope-deg", "1", "--wavelength", "8", "--position", "0", "--nu", "0.3", "--offsets=2"]
    assert main(["appendix-a", "fem", *wave]) == 0
    assert ("[5/5] finite elements" in capsys.readouterr().err) is terminal


def test_surface_states_every_numbers_error_and_advises(tmp_path: Path, capsys: Capture) -> None:
    picture = tmp_path / "map.png"
    command = ["appendix-a", "surface", "table1-rough", "--grid", "32"]
    assert main([*command, "--plot", str(picture), "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["share_above_2_percent"] == 0.0
    assert found["advice"].startswith("keep the half-space")
    assert set(found["numbers"]) == {
        "friction_coefficient", "contact_area", "max_pressure", "approach", "normal_force",
    }  # fmt: skip
    for row in found["numbers"].values():
        assert abs(row["corrected"] - row["value"]) <= row["stated"]
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert main(command) == 0
    assert "stated error" in capsys.readouterr().out
