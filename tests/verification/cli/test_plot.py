"""Pictures of a solution: window, peak, units, places of marks, formats."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

import refimpl as rf
from refimpl.grid import Array
from tests.changed import changed
from tests.verification.cli.commands import run
from verification.cli import plot
from verification.cli.plot import gap_histogram, pressure_histogram, profile
from verification.cli.plot_maps import (
    domain_map,
    gap_map,
    peak_of,
    pooled,
    pressure_map,
    shear_map,
    view_of,
)
from verification.cli.plot_style import scaled_unit

STEEL, SOFT = rf.Material(E=200e9, nu=0.3), rf.Material(E=3e9, nu=0.38)


def solved(grid: int | tuple[int, int] = 8, **changes: object) -> rf.Solution:
    bodies = rf.Body(STEEL, rf.Sphere(radius=0.05)), rf.Body(SOFT, rf.Flat())
    friction = rf.Friction(tau=0.3e6, beta=0.1)
    scene = rf.Scene(*bodies, friction=friction, load=5.0, **({"side": 1e-3} | changes))  # type: ignore[arg-type]
    return rf.solve(scene, grid=grid)


def marked(
    places: list[tuple[int, int]], shape: tuple[int, int] = (40, 40), lengths: float = 1e-3
) -> rf.Solution:
    """A solution with 3 MPa at the first place and 1 MPa at the others; gap 1 um outside of contact."""
    solution = solved()
    pressure = np.zeros(shape)
    for place in places:
        pressure[place] = 1e6
    pressure[places[0]] = 3e6
    grid = rf.solve(rf.read_scene("hertz"), grid=8).grid
    grid = dataclasses.replace(grid, shape=shape, lengths=(lengths, lengths * shape[1] / shape[0]))
    none = np.zeros(shape, dtype=bool)
    problem = dataclasses.replace(solution.details.problem, grid=grid)
    return changed(
        solution, pressure=pressure, traction=0.1 * pressure, max_pressure=3e6, grid=grid, problem=problem,
        excluded=none, plastic=none, gap=np.where(pressure > 0, 0.0, 1e-6),
    )  # fmt: skip


def shown(image: AxesImage) -> Array:
    values = image.get_array()
    assert values is not None
    return np.ma.filled(values, 0.0)


def test_the_window_is_the_contact_with_a_margin() -> None:
    view = view_of(marked([(20, 10), (25, 14)]))
    # contact 6 x 5 elements of 25 um; 12 % of 150 um is 18 um, one element; at least 8 elements a side
    assert (view.first, view.last) == ((19, 8), (27, 17))
    assert view.origin == pytest.approx((19 * 25e-6, 8 * 25e-6))
    assert view.extent == pytest.approx((475.0, 675.0, 200.0, 425.0))  # um, from the domain's corner
    assert (view.length.name, view.gap.name, view.pressure.name) == ("µm", "µm", "MPa")
    assert not view.whole


def test_windows_of_contact_all_over_of_none_and_of_a_line() -> None:
    view = view_of(marked([(1, 1), (38, 38)]))
    assert view.whole
    assert (view.first, view.last) == ((0, 0), (40, 40))
    empty = changed(marked([(1, 1)]), pressure=np.zeros((40, 40)), max_pressure=0.0)
    assert view_of(empty).whole
    line = view_of(marked([(i, 20) for i in range(5, 30)]))
    assert not line.is_slender
    assert line.cut(np.ones((40, 40))).shape[1] >= 8


def test_the_profiles_go_through_the_peak_and_never_through_a_groove() -> None:
    pressure = np.zeros((9, 9))
    pressure[4, 1] = pressure[4, 2] = pressure[4, 8] = 2.0  # equal peaks; the middle of the load is at 3.67
    assert peak_of(pressure) == (4, 2)
    pressure[7, 7] = 2.1
    assert peak_of(pressure) == (7, 7)
    assert peak_of(np.zeros((4, 6))) == (2, 3)


def test_blocks_of_a_fine_grid_keep_every_contact() -> None:
    field = np.zeros((1025, 3))
    field[1024, 2] = 5.0
    blocks, step = pooled(field)
    assert (blocks.shape, step) == ((342, 1), 3)
    assert blocks[-1, 0] == 5.0
    assert pooled(1.0 + field, lowest=True)[0].min() == 1.0


@pytest.mark.parametrize(("value", "name"), [(999.0, "Pa"), (1e3, "kPa"), (-2e6, "MPa")])
def test_units_are_at_scale(value: float, name: str) -> None:
    assert scaled_unit(value, "Pa").name == name


def test_maps_and_profiles_have_x_to_the_right_and_one_origin() -> None:
    solution = marked([(20, 10), (25, 14)])  # i along x, j along y
    view = view_of(solution)
    axes, shear, gap, along_x, along_y, whole = Figure().subplots(1, 6)
    pressure_map(axes, solution, view)
    row, column = np.unravel_index(np.argmax(shown(axes.images[0])), (9, 8))
    assert (int(row), int(column)) == (10 - 8, 20 - 19)  # y down the rows, x along the columns
    assert axes.images[0].get_extent() == pytest.approx(view.extent)
    across, upright = axes.lines
    assert across.get_ydata()[0] == pytest.approx(10.5 * 25)
    assert upright.get_xdata()[0] == pytest.approx(20.5 * 25)
    profile(along_x, solution, view, None, axis=0)
    profile(along_y, solution, view, None, axis=1)
    for panel, place in ((along_x, 20.5 * 25), (along_y, 10.5 * 25)):
        s, p = panel.lines[0].get_data()
        assert np.asarray(s)[np.argmax(p)] == pytest.approx(place)
        assert np.max(p) == pytest.approx(3.0)  # MPa
    assert along_x.get_xlim() == pytest.approx(view.extent[:2])
    assert along_y.get_xlim() == pytest.approx(view.extent[2:])
    shear_map(shear, solution, view)
    assert shown(shear.images[0]).max() == pytest.approx(300.0)  # kPa
    gap_map(gap, solution, view)
    assert [tuple(map(int, place)) for place in np.argwhere(shown(gap.images[1]))] == [(2, 1), (6, 6)]
    domain_map(whole, solution, view)
    frame = whole.patches[0]
    assert frame.get_bbox().bounds == pytest.approx((475.0, 200.0, 200.0, 225.0))  # type: ignore[attr-defined]


def test_histograms_are_shares() -> None:
    solution = marked([(20, 10), (25, 14)])
    view = view_of(solution)
    pressures, gaps = Figure().subplots(1, 2)
    pressure_histogram(pressures, solution, view)
    assert np.diff(np.asarray(pressures.patches[0].get_path().vertices)[:, 1]).max() == pytest.approx(50.0)
    gap_histogram(gaps, solution, view)
    assert "2.78 % of the window" in gaps.get_title()  # 2 of 8 x 9 elements
    bars = np.asarray(gaps.patches[0].get_path().vertices)[:, 1]
    assert bars.max() == pytest.approx(100 * 70 / 72)  # all others are 1 um apart


def texts(solution: rf.Solution) -> list[str]:
    return [str(handle.get_label()) for handle in plot.legend_of(solution, None)]


def test_the_legend_explains_what_is_there() -> None:
    plain = marked([(20, 10), (25, 14)])
    assert not any("adhesive" in text or "plastic" in text for text in texts(plain))
    excluded = np.zeros((40, 40), dtype=bool)
    excluded[25, 14] = True
    assert "shear map: no adhesive shear, r = β p" in texts(changed(plain, excluded=excluded))
    soft = rf.Material(E=3e9, nu=0.38, hardness=1e6)
    scene = rf.Scene(
        rf.Body(STEEL, rf.Sphere(radius=0.05)), rf.Body(soft, rf.Flat()), rf.Friction(), load=0.3, side=1e-3
    )
    capped = rf.solve(scene, grid=16)
    assert "pressure map: edge of plastic zones" in texts(capped)
    axes = Figure().subplots()
    pressure_histogram(axes, capped, view_of(capped))
    assert f"{100 * capped.plastic_share:.3g} % at the hardness" in axes.get_title()


MAGIC = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(
    ("command", "suffix"),
    [
        ("solve metal-polymer --grid 16", ".png"),
        ("solve hertz --grid 8 --approach 0", ".png"),  # no contact
        ("solve hertz --grid 16 --size 4e-3x2e-4", ".png"),  # slender
        ("sweep study.toml", ".pdf"),
        ("sweep study.toml --x grid --by load", ".svg"),
    ],
)
def test_pictures_are_written_in_every_format(command: str, suffix: str, folder: Path) -> None:
    Path("study.toml").write_text('scene = "hertz"\n[vary]\ngrid = [6, 8]\nload = [1.0, 2.0]\n')
    assert run(f"{command} --plot picture{suffix}").status in (0, 1)
    picture = Path(f"picture{suffix}").read_bytes()
    assert picture.startswith(MAGIC[suffix])
    assert len(picture) > 3000
