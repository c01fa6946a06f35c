"""The examples run, print what they should, and draw their picture; here on small grids."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from tests.documents import ROOT, agree
from verification.cases.appendix_a import half_space
from verification.output import result_files

EXAMPLES = {
    "first_result": (["64"], "mu = 0.1195 +- 0.0024, A = 0.185 +- 0.011 mm^2 (converged)"),
    "first_scene": (["64"], "mu = 0.124 +- 0.002, 2 patches (converged)"),
    "measured_map": (["100"], "mu = 0.120 +- 0.002, converged"),
    "fitted_friction": (["64"], "tau = 15.3 MPa (14.3 to 16.3)\nbeta = 0.078 (0.065 to 0.092)"),
    "capped_contact": (
        ["64"],
        "capped at 0.8 GPa: mu = 0.0989 +- 0.0025, p_max = 0.80 GPa (converged)\n"
        "elastic: mu = 0.0860 +- 0.0054, p_max = 6.94 GPa (converged)",
    ),
    "two_roughnesses": (
        ["64"],
        "Gaussian, lay of 30 degrees: rms 0.53 um\nself-affine, Hurst exponent 0.8: rms 0.46 um",
    ),
    "cost_of_an_accuracy": (
        ["32,48"],
        "table1-smooth: 0.29, 0.17 % of mu\ntable1-rough: 8.6, 2.9 % of mu\n"
        "metal-polymer: 2.5, 0.95 % of mu\nrough-planes: 89, 6.9 % of mu",
    ),
    "rough_friction": (["0.05"], "converged on 64 x 64\nmu = 0.1366 +- 0.0015\nA  = 0.2339 +- 0.0129 mm^2"),
    "check_my_solver": (["solver/pins"], "pass solver/pins ... of 2.0e+00"),
    "which_way_up": (
        ["32"],
        "on the lower body it touches first at x = +0.20, y = +0.21 mm\n"
        "on the upper body it touches first at x = +0.20, y = -0.21 mm",
    ),
    "conventions": (["33"], "centre of pressure at x = -0.046 mm, theta_x in front up to +0.088"),
    "small_slopes": (["32"], "a / R = 0.02: p_max +0.0 %\n...a / R = 0.33: p_max +6.3 %"),
    "half_space_map": (
        ["0.3"],
        "copper, flank, 10 degrees: 4.8 % on waves of 4 elements, 5.2 on 128\n"
        "copper, crest, 10 degrees: 1.3 % on waves of 4 elements, 0.1 on 128\n"
        "steel on copper, 10 degrees: 1.6 % on waves of 4 elements, 1.7 on 128",
    ),
    "half_space_wave": (
        ["model_form"],
        "15 degrees, approach under the load: 8.5 %, first order 9.3, stated 11.8\n"
        "15 degrees, N at the approach: 14.2 %, first order 14.8, stated 19.1",
    ),
    "corrected_friction": (
        [],
        " 64  summed 0.1051, corrected 0.1008 +- 0.0026\n"
        " 96  summed 0.1043, corrected 0.1011 +- 0.0009\n"
        "128  summed 0.1036, corrected 0.1011 +- 0.0005\n"
        "192  summed 0.1024, corrected 0.1011 +- 0.0002\n"
        "256  summed 0.1021, corrected 0.1011 +- 0.0002\n"
        "384  summed 0.1016, corrected 0.1011 +- 0.0001",
    ),
    "direction_scan": (
        ["32", "2"],
        "2 directions, 2 converged\nmu from 0.1365 to 0.1367, Q/P from -0.0011 to +0.0011",
    ),
}


def test_no_example_is_left_out() -> None:
    assert {path.stem for path in (ROOT / "examples").glob("*.py")} == set(EXAMPLES)
    sizes = {name: (ROOT / f"docs/{name}.png").stat().st_size for name in EXAMPLES}
    assert [name for name, size in sizes.items() if not 5_000 < size <= 120_000] == []


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_is_short(name: str) -> None:
    assert len((ROOT / f"examples/{name}.py").read_text(encoding="utf-8").splitlines()) <= 50


def legible(script: str, inches: float) -> bool:
    """Return whether the smallest letters of a picture of that width have 9 pixels on a phone.

    They have 10 points unless a size is stated; a window of 420 pixels shows a picture on 388.
    """
    smallest = min([10.0, *map(float, re.findall(r"fontsize=([\d.]+)", script))])
    return smallest / 72 / inches * 388 >= 9


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_picture_is_legible_on_a_phone(name: str) -> None:
    """It has 100 pixels per inch."""
    script = (ROOT / f"examples/{name}.py").read_text(encoding="utf-8")
    with Image.open(ROOT / f"docs/{name}.png") as picture:
        assert legible(script, picture.size[0] / 100)


IN_CI = ("first_result", "capped_contact", "conventions")


RUN = """import runpy, sys
for words in sys.argv[1:]:
    sys.argv = words.split("|")
    runpy.run_path(sys.argv[0], run_name="__main__")
"""


@pytest.mark.parametrize("names", [IN_CI, *(pytest.param((n,), marks=pytest.mark.nightly) for n in EXAMPLES)])
def test_examples(names: tuple[str, ...], tmp_path: Path) -> None:
    """In a process of their own, which imports what they share once."""
    runs, pictures = [], [tmp_path / f"{name}.png" for name in names]
    for name, picture in zip(names, pictures, strict=True):
        runs.append("|".join([str(ROOT / f"examples/{name}.py"), *EXAMPLES[name][0], str(picture)]))
    done = subprocess.run(
        [sys.executable, "-c", RUN, *runs],
        capture_output=True,
        text=True,
        env={**os.environ, "MPLBACKEND": "agg"},
        cwd=tmp_path,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert agree(done.stdout, "\n".join(EXAMPLES[name][1] for name in names)), done.stdout
    for picture in pictures:
        with Image.open(picture) as made:
            assert min(made.size) > 150


@pytest.mark.nightly
def test_the_wave_is_drawn_from_a_fresh_record_of_its_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """All that the example reads is in the record of the case, here of two of its slopes."""
    monkeypatch.setattr(half_space, "WAVE_SLOPES", (6.5, 15.0))
    monkeypatch.setenv("MPLBACKEND", "agg")
    record = {"id": "model-form/half-space-wave", "data": half_space.wave().data}
    monkeypatch.setattr(result_files, "committed", lambda _: {"cases": [record]})
    monkeypatch.setattr(sys, "argv", ["", "fresh", str(tmp_path / "picture.png")])
    runpy.run_path(str(ROOT / "examples/half_space_wave.py"))
    assert agree(capsys.readouterr().out, EXAMPLES["half_space_wave"][1])
