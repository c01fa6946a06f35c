"""`appendix-a` on the command line: numbers printed, tables written, limits stated."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from appendix_a.fem.coefficient_map import CoefficientMap
from tests.verification.cli.commands import answer, run, shown

FLANK = "--slope-deg 6.5 --wavelength 64 --position 0.25 --nu 0.3"
PAIR = "--E 118 --upper-E 200 --upper-nu 0.3"
WEDGE = "appendix-a wedge --r 1"
PIXELS = "--unit um --pixel-size 1e-6"


@pytest.mark.nightly
def test_fem_prints_the_four_keys_and_agrees_with_the_strip_on_a_gentle_slope() -> None:
    """On a terminal, finite elements show their progress."""
    wave = "--slope-deg 0.5 --wavelength 20 --position 0.25 --nu 0.3 --offsets=-3,3 --json -"
    done = {problem: run(f"appendix-a {problem} {wave}", terminal=True) for problem in ("strip", "fem")}
    assert "[5/5] finite elements" in done["fem"].err
    found = {problem: json.loads(one.out) for problem, one in done.items()}
    assert list(found["fem"]) == ["offsets", "wavy", "flat", "discretisation_error"]
    assert found["fem"]["offsets"] == [-3.0, 3.0]
    change = {name: np.subtract(f["wavy"], f["flat"]) for name, f in found.items()}
    # Uphill (-3) the wavy boundary yields less than the flat one, downhill more (paper, Fig. 12).
    assert change["fem"][0] > 0 > change["fem"][1]
    # Second order in a slope of 0.0087 is 1 % of the first, times the wave's curvature over the strip.
    np.testing.assert_allclose(change["strip"], change["fem"], rtol=0.03)


def test_map_writes_the_table_that_its_package_reads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
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
    axes = "--slopes-deg 2.5,5,10,15 --wavelengths 16,32,64,128 --positions 0,0.25,0.5"
    assert "percentage points" in shown(f"appendix-a map {axes} --jobs 1 --json {path}")
    table = CoefficientMap.read(path)
    assert (table.slope_deg, table.position) == ((2.5, 5.0, 10.0, 15.0), (0.0, 0.25, 0.5))
    assert table.kappa_part[0, 0, 1, 1] == 0.03


def test_a_strip_has_percent_and_a_caution_where_the_first_order_cancels() -> None:
    wave = "appendix-a strip --slope-deg 6.5 --wavelength 100 --position 0.25 --offsets=-2,2 --nu"
    printed = shown(f"{wave} 0")
    assert "caution" not in printed
    # tan 6.5 degrees over 6 ln 3 / pi = 2.098: 5.43 %, uphill less
    assert "-5.4" in printed
    assert "+5.4" in printed
    for arguments in ("0.5", "0 --slope-deg 40", "0 --wavelength 5"):
        assert "caution" in shown(f"{wave} {arguments}")


def test_the_shipped_tables_are_looked_up_for_a_body_and_a_pair() -> None:
    one, pair = (answer(f"appendix-a look-up {FLANK} {words}") for words in ("", PAIR))
    at_two = [abs(one["percent"][one["offsets"].index(x)]) for x in (-2, 2)]
    assert max(at_two) == pytest.approx(3.3, abs=0.2)
    assert np.abs(pair["percent"]).max() < np.abs(one["percent"]).max() / 2
    for words, percent in (("--slope-deg 6.5", 4.15), (f"--slope-deg 10 {PAIR}", 2.58)):
        found = answer(f"appendix-a element --nu 0.3 {words}")["percent"]["in line"]
        assert found == pytest.approx(percent, abs=0.01)
    assert "across" in shown("appendix-a element --slope-deg 10 --nu 0.3")


def test_wedge_of_no_slope_is_the_half_plane() -> None:
    found = answer(f"{WEDGE} --theta-deg 0 --gamma-deg 0")
    # Flamant's strip, -1 < x < 1, at depth 1 below its centre: -(1/pi)(2 atan 1 -+ sin(2 atan 1)).
    assert found["sigma_r"] == pytest.approx([-0.5 - 1 / math.pi], abs=1e-9)
    assert found["sigma_theta"] == pytest.approx([-0.5 + 1 / math.pi], abs=1e-9)
    assert found["tau_rtheta"] == pytest.approx([0.0], abs=1e-9)
    for gamma in (0.1, 33.3):  # an angle on the face is inside
        shown(f"{WEDGE} --gamma-deg {gamma} --theta-deg={gamma - 90},{90 - gamma},{round(90 - gamma, 6)}")


def test_surface_states_every_numbers_error_and_advises(tmp_path: Path) -> None:
    command = f"appendix-a surface table1-rough --grid 24 --plot {tmp_path}/map.png"
    found = answer(command)
    assert found["share_above_2_percent"] == 0.0
    assert found["advice"].startswith("keep the half-space")
    assert set(found["numbers"]) == {
        "friction_coefficient", "friction_coefficient_corrected", "contact_area", "max_pressure", "approach",
        "normal_force",
    }  # fmt: skip
    for row in found["numbers"].values():
        assert abs(row["corrected"] - row["value"]) <= row["stated"]
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    lines = [line.strip() for line in shown(command).splitlines()]
    for label, number, factor, unit in (
        ("contact area A", "contact_area", 1e6, "mm^2"),
        ("maximum pressure p_max", "max_pressure", 1e-6, "MPa"),
        ("approach", "approach", 1e6, "um"),
        ("normal force N", "normal_force", 1.0, "N"),
    ):
        (line,) = [line for line in lines if line.startswith(f"{label} ")]
        assert f"{found['numbers'][number]['value'] * factor:.4g}" in line.split()
        assert line.endswith(f" {unit}")


def test_a_surface_file_is_judged_below_a_rigid_flat(tmp_path: Path) -> None:
    """Crossed waves of slope 0.2 on 24 x 24 points, 1 um apart."""
    wave = np.cos(2 * np.pi * np.arange(24) / 24)
    for name, along_x in (("square", wave), ("oblong", wave[:12])):
        np.savetxt(tmp_path / f"{name}.csv", 0.2 * 24 / (2 * np.pi) * np.outer(along_x, wave), delimiter=",")
    command = f"appendix-a surface {tmp_path}/square.csv {PIXELS} --grid 24"
    found = answer(f"{command} --nu 0.2 --E 5e9 --tau 3e6 --plot {tmp_path}/map.svg")
    assert "rigid flat" in found["assumed"]
    assert "E = 5 GPa, nu = 0.2, tau = 3 MPa, beta = 0.1" in found["assumed"]
    assert 0.5 < found["share_above_2_percent"] <= 1.0
    assert found["numbers"]["normal_force"]["stated"] > 0
    assert found["evidence"].startswith("slopes of")
    assert (tmp_path / "map.svg").read_text(encoding="utf-8").lstrip().startswith("<?xml")
    assert (tmp_path / "map.svg").stat().st_size < 200_000
    oblong = answer(f"appendix-a surface {tmp_path}/oblong.csv {PIXELS} --grid 24 --pressure 30e6")
    assert "nominal pressure 30 MPa" in oblong["assumed"]  # the load over the area
