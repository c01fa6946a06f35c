"""Curves by hand, and the picture's options: columns named, formats, refusals before any run."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from refimpl.errors import InputError
from tests.verification.sweep.test_quality import row
from verification.cli import main, plot_curves
from verification.sweep.curves import Point, curves

STUDY = """scene = "table1-rough"
realisations = 2
[vary]
grid = 16
load = [7.0, 70.0]
lower_rms = [0.5e-6, 1e-6]
"""


def test_points_by_hand() -> None:
    rows = [
        row(0, 0.1, 1.0) | {"load": 1.0},
        row(1, 0.3, 3.0) | {"load": 1.0, "friction_coefficient_error": 0.03},
        row(0, 0.2, 1.0) | {"load": 2.0},
    ]
    first, second = curves(rows, "load", "friction_coefficient")[None]
    assert (first.x, first.realisations, second.realisations) == (1.0, 2, 1)
    assert (first.mean, first.scatter, first.error) == pytest.approx((0.2, math.sqrt(0.02), 0.02))
    assert second == Point(2.0, 0.2, 0.0, 0.01, 1)
    assert curves(rows, "load", "contact_area")[None][0].error == math.inf
    unbounded = [one | {"friction_coefficient_error": None} for one in rows]  # as a store keeps it
    assert curves(unbounded, "load", "friction_coefficient")[None][1].error == math.inf
    with pytest.raises(InputError, match="--x"):
        curves(rows, "status", "contact_area")


def test_means_bars_and_bands_are_in_the_units_of_the_axes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """2 +- 0.25 and 3 mm^2, with a band of 0.5 mm^2, over 1 and 4 um; the second has no bar."""
    drawn: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: drawn.append(figure))
    points = [Point(1e-6, 2e-6, 0.5e-6, 0.25e-6, 3), Point(4e-6, 3e-6, 0.5e-6, math.inf, 3)]
    plot_curves.draw_sweep({14.0: points}, "lower_rms", "contact_area", "load", tmp_path / "a.png")
    (axes,) = drawn[0].axes
    line, _, (bars,) = axes.containers[0]
    assert line.get_xydata().tolist() == [pytest.approx([1, 2]), pytest.approx([4, 3])]
    assert bars.get_segments()[0][:, 1] == pytest.approx([1.75, 2.25])
    band = axes.collections[-1].get_paths()[0].vertices
    assert (band[:, 1].min(), band[:, 1].max()) == (pytest.approx(1.5), pytest.approx(3.5))
    assert axes.get_legend().get_texts()[0].get_text() == "load = 14 N"
    assert "1 error bars unbounded" in axes.get_title(loc="left")


@pytest.mark.parametrize(
    ("by", "value", "entry"),
    [
        ("lower_rms", 1.68e-6, "lower rms = 1.68 µm"),
        ("tau", 15e6, "tau = 15 MPa"),
        ("beta", 0.1, "beta = 0.1"),
    ],
)
def test_a_legend_has_the_units_of_the_axes(by: str, value: float, entry: str) -> None:
    assert plot_curves._entry(by, value) == entry
    assert plot_curves._entry(None, value) is None


def test_logarithmic_axes_have_plain_numbers() -> None:
    axes = Figure().subplots()
    axes.plot([5.0, 20.0, 70.0], [1.0, 2.0, 3.0])
    axes.set_xscale("log")
    plot_curves._plain_decades(axes.xaxis)
    low, high = axes.get_xlim()
    shown = [axes.xaxis.get_major_formatter()(x) for x in axes.get_xticks() if low <= x <= high]
    assert shown == ["5", "10", "20", "50"]


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
def test_a_sweep_is_drawn(suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY)
    picture = Path(f"mu{suffix}")
    columns = ["--x", "load", "--by", "lower_rms"]
    assert main(["sweep", "study.toml", "--workers", "1", "--plot", str(picture), *columns]) == 0
    assert picture.stat().st_size > 3_000


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--plot", "mu.jpg"], ".svg"),
        (["--plot", "mu.png", "--x", "rms"], "--x"),
        (["--x", "load"], "--x"),
    ],
)
def test_a_wrong_picture_is_refused_before_any_run(
    arguments: list[str],
    named: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY)
    assert main(["sweep", "study.toml", *arguments]) == 2
    assert named in capsys.readouterr().err
    assert not Path("study.sqlite").exists()
