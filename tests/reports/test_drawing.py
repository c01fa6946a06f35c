"""Figures: they draw what they are given, in the page's colours, and their data as CSV."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure as Canvas

from reports.catalogue import DECLARED
from reports.drawing import INK, Draw, Figure, curves, maps, svg
from reports.exhibit import as_csv


def drawn(draw: Draw, data: dict[str, Any]) -> Canvas:
    canvas = Canvas()
    draw(canvas, data)
    return canvas


def test_lines_hold_the_series() -> None:
    figure = curves("*", "", "x", {"p": "pressure"}, exact={"hertz": "Hertz"}, xlabel="x (mm)", ylabel="MPa")
    assert figure.needs == ("x", "p", "hertz")
    axes = drawn(figure.draw, {"x": [0, 1], "p": [1, None], "hertz": [1, 2]}).axes[0]
    np.testing.assert_array_equal(axes.lines[1].get_ydata(), [1, 2])
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), [1, np.nan])
    assert axes.lines[1].get_linestyle() == "--"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (mm)", "MPa")


@pytest.mark.parametrize(
    ("x", "labels"),
    [
        ([2.0, 3.01283, 10.3085, 80.0], ["2", "3.01", "10.3", "80"]),
        ([1, 10, 1000], None),  # decades have labels of their own
    ],
)
def test_few_points_of_a_logarithmic_axis_are_its_ticks(x: list[float], labels: list[str] | None) -> None:
    draw = curves("*", "", "x", {"y": "y"}, xlabel="x", ylabel="y", log="x").draw
    axes = drawn(draw, {"x": x, "y": x}).axes[0]
    shown = [tick.get_text() for tick in axes.get_xticklabels()]
    assert (shown == labels) is (labels is not None)


def test_maps_have_x_to_the_right_and_blank_zeros() -> None:
    draw = maps({"p": "Pressure"}, side="side", unit="MPa")
    image = drawn(draw, {"p": [[0.0, 0.0], [3.0, 0.0]], "side": 1.6}).axes[0].images[0]
    shown = image.get_array()
    assert shown is not None
    assert shown[0, 1] == 3.0  # p[1, 0]: at large x and small y, that is right of the first row
    assert np.ma.getmaskarray(shown).tolist() == [[True, False], [True, True]]
    assert list(image.get_extent()) == [0.0, 1.6, 0.0, 1.6]


def test_the_export_takes_the_readers_colours() -> None:
    figure = curves("*", "a caption", "x", {"y": "y"}, xlabel="x", ylabel="y")
    text = svg(figure, {"x": [0, 1], "y": [1, 2]})
    assert text is not None
    assert INK not in text
    assert "currentColor" in text
    assert not re.search(r"\d{4}-\d\d-\d\dT", text)


def test_curves_that_coincide_have_a_panel_of_their_difference() -> None:
    draw = curves(
        "*", "", "x", {"p": "ours"}, exact={"q": "exact"}, band=("w", "95 %"), xlabel="x", ylabel="p",
        difference="less", per_x=10.0,
    ).draw  # fmt: skip
    above, below = drawn(draw, {"x": [0, 1], "p": [1.0, 2.0], "q": [1.0, 1.5], "w": [0.1, 0.1]}).axes
    np.testing.assert_array_equal(below.lines[0].get_ydata(), [0.0, 0.5])
    np.testing.assert_array_equal(above.lines[0].get_xdata(), [0, 10])
    assert (above.get_xlabel(), below.get_xlabel(), below.get_ylabel()) == ("", "x", "less")


@pytest.mark.parametrize(
    ("data", "text"),
    [
        ({"a": [1, 2], "b": [0.5]}, "a,b\n1,0.5\n2,\n"),
        ({"a": [1], "b": {"x": 2, "y": [3, 4]}}, "a\n1\nb\nx,2\ny,3,4\n"),
        ({"a": [{"x": 1}, 2], "b": 0.25}, "a\n{'x': 1}\n2\nb\n0.25\n"),
    ],
)
def test_everything_that_a_figure_needs_is_in_the_file(data: dict[str, object], text: str) -> None:
    figure = Figure("*", ("a", "b"), lambda *_: None, "")
    assert as_csv(figure, data) == text


def test_figures_have_columns_and_a_sentence() -> None:
    for figure in DECLARED:
        assert len(figure.caption.split()) > 3, figure.cases
        assert figure.caption.endswith("."), figure.cases
        assert len(set(figure.needs)) == len(figure.needs) > 0, figure.cases
