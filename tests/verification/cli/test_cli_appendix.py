"""`appendix-a` on the command line: what it prints, what it writes, how far it says it is."""

from __future__ import annotations

import json
import math
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


def test_map_writes_the_table_that_its_package_reads(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def invented(
        slopes: tuple[float, ...], wavelengths: tuple[float, ...], positions: tuple[float, ...], **_: object
    ) -> CoefficientMap:
        shape = len(slopes), len(wavelengths), len(positions), 2
        parts = np.arange(math.prod(shape)).reshape(shape) / 100
        return CoefficientMap(
            slopes, wavelengths, positions, (-2.0, 2.0), parts, -parts, 0.01 + parts[..., 0]
        )

    monkeypatch.setattr("appendix_a.fem.map2d.compute", invented)  # the solves are others' tests
    path = tmp_path / "map.json"
    axes = ["--slopes-deg", "2.5,5,10,15", "--wavelengths", "16,32,64,128", "--positions", "0,0.25,0.5"]
    assert main(["appendix-a", "map", *axes, "--jobs", "1", "--json", str(path)]) == 0
    assert "percentage points" in capsys.readouterr().out
    table = CoefficientMap.read(path)
    assert (table.slope_deg, table.position) == ((2.5, 5.0, 10.0, 15.0), (0.0, 0.25, 0.5))
    assert table.kappa_part[0, 0, 1, 1] == 0.03


@pytest.mark.parametrize(
    ("option", "values"),
    [
        ("--positions", "0,0.25"),
        ("--positions", "0,0.1,0.5"),
        ("--slopes-deg", "2,4"),
        ("--wavelengths", "9,20"),
    ],
)
def test_incomplete_axes_of_a_map_are_refused_before_any_solve(
    option: str, values: str, capsys: Capture
) -> None:
    assert main(["appendix-a", "map", option, values, "--jobs", "1"]) == 2
    assert option in capsys.readouterr().err


def test_a_strip_has_percent_and_a_caution_where_the_first_order_cancels(capsys: Capture) -> None:
    wave = ["appendix-a", "strip", "--slope-deg=6.5", "--wavelength=100", "--position=0.25", "--offsets=-2,2"]
    assert main([*wave, "--nu=0"]) == 0
    shown = capsys.readouterr().out
    assert "caution" not in shown
    # tan 6.5 degrees over 6 ln 3 / pi = 2.098: 5.43 %, uphill less
    assert "-5.4" in shown
    assert "+5.4" in shown
    for arguments in (["--nu=0.5"], ["--nu=0", "--slope-deg=40"], ["--nu=0", "--wavelength=5"]):
        assert main([*wave, *arguments]) == 0
        assert "caution" in capsys.readouterr().out


def test_the_shipped_map_is_looked_up_for_a_body_and_a_pair(capsys: Capture) -> None:
    where = ["appendix-a", "look-up", "--slope-deg=6.5", "--wavelength=64", "--position=0.25", "--nu=0.3"]
    assert main([*where, "--json=-"]) == 0
    one = json.loads(capsys.readouterr().out)
    assert max(map(abs, (one["percent"][one["offsets"].index(x)] for x in (-2, 2)))) == pytest.approx(
        3.3, abs=0.2
    )
    assert main([*where, "--E=118", "--upper-E=200", "--upper-nu=0.3", "--json=-"]) == 0
    pair = json.loads(capsys.readouterr().out)
    assert np.abs(pair["percent"]).max() < np.abs(one["percent"]).max() / 2
    assert main([*where, "--upper-E=200"]) == 2
    assert "--upper-nu" in capsys.readouterr().err


def test_the_element_table_is_looked_up(capsys: Capture) -> None:
    assert main(["appendix-a", "element", "--slope-deg=6.5", "--nu=0.3", "--json=-"]) == 0
    assert json.loads(capsys.readouterr().out)["percent"]["in line"] == pytest.approx(4.15, abs=0.01)
    pair = ["--E=118", "--upper-E=200", "--upper-nu=0.3"]
    assert main(["appendix-a", "element", "--slope-deg=10", "--nu=0.3", *pair, "--json=-"]) == 0
    assert json.loads(capsys.readouterr().out)["percent"]["in line"] == pytest.approx(2.58, abs=0.01)
    assert main(["appendix-a", "element", "--slope-deg=10", "--nu=0.3"]) == 0
    assert "across" in capsys.readouterr().out


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
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    for label, number, factor, unit in (
        ("A", "contact_area", 1e6, "mm^2"),
        ("p_max", "max_pressure", 1e-6, "MPa"),
        ("approach", "approach", 1e6, "um"),
        ("N at this approach", "normal_force", 1.0, "N"),
    ):
        (line,) = [line for line in lines if line.startswith(f"{label} ")]
        assert f"{found['numbers'][number]['value'] * factor:.4g}" in line.split()
        assert line.endswith(f" {unit}")


def _surface_file(folder: Path, slope: float = 0.2) -> Path:
    """Heights (um) of crossed waves on 24 x 24 points, 1 um apart."""
    x = 2 * np.pi * np.arange(24) / 24
    path = folder / "heights.csv"
    np.savetxt(path, slope * 24 / (2 * np.pi) * np.cos(x)[:, None] * np.cos(x)[None, :], delimiter=",")
    return path


def test_a_surface_file_is_judged_below_a_rigid_flat(tmp_path: Path, capsys: Capture) -> None:
    picture = tmp_path / "map.svg"
    command = ["appendix-a", "surface", str(_surface_file(tmp_path)), "--unit", "um", "--pixel-size", "1e-6"]
    assert main([*command, "--grid", "24", "--nu", "0.2", "--plot", str(picture), "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert "rigid flat" in found["assumed"]
    assert "nu = 0.2" in found["assumed"]
    assert 0.5 < found["share_above_2_percent"] <= 1.0
    assert found["numbers"]["normal_force"]["stated"] > 0
    assert found["evidence"].startswith("slopes of")
    assert picture.read_text(encoding="utf-8").lstrip().startswith("<?xml")
    assert picture.stat().st_size < 200_000


def test_options_of_a_surface_file_are_refused_beside_a_scene(capsys: Capture) -> None:
    assert main(["appendix-a", "surface", "table1-rough", "--nu", "0.2"]) == 2
    assert "--nu" in capsys.readouterr().err


def test_neither_a_scene_nor_a_file_is_refused_by_name(tmp_path: Path, capsys: Capture) -> None:
    assert main(["appendix-a", "surface", str(tmp_path / "nothing.sur")]) == 2
    assert "a surface's file" in capsys.readouterr().err
    heights = _surface_file(tmp_path)
    assert main(["appendix-a", "surface", str(heights), "--pixel-size", "1e-6", "--unit", "um",
                 "--plot", str(tmp_path / "map.gif")]) == 2  # fmt: skip
    assert "--plot" in capsys.readouterr().err


def test_the_pressure_on_an_oblong_surface_is_the_load_over_its_area(tmp_path: Path, capsys: Capture) -> None:
    x = np.cos(2 * np.pi * np.arange(24) / 24)
    path = tmp_path / "oblong.csv"
    np.savetxt(path, 0.3 * x[:12, None] * x[None, :], delimiter=",")
    command = ["appendix-a", "surface", str(path), "--unit", "um", "--pixel-size", "1e-6", "--grid", "24"]
    assert main([*command, "--pressure", "30e6", "--json", "-"]) == 0
    assert "nominal pressure 30 MPa" in json.loads(capsys.readouterr().out)["assumed"]
