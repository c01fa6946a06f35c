"""Windows of a grid: bounding boxes, padding, edges."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Window


def test_the_bounding_box_of_marked_elements_with_a_margin() -> None:
    marked = np.zeros((6, 9), dtype=bool)
    assert Window.around(marked, margin=1) == Window.full((6, 9))
    marked[2, 1] = marked[3, 4] = True
    assert Window.around(marked, margin=0) == Window(2, 4, 1, 5)
    assert Window.around(marked, margin=2) == Window(0, 6, 0, 7)
    assert Window.around(marked, margin=9) == Window.full((6, 9))


def test_values_on_the_grid() -> None:
    window = Window(2, 4, 1, 3)
    assert window.shape == (2, 2)
    spread = window.spread(np.array([[1.0, 2.0], [3.0, 4.0]]), (5, 3))
    np.testing.assert_array_equal(spread[window.slices], [[1, 2], [3, 4]])
    assert spread.sum() == 10
    assert np.argwhere(window.mask((5, 3))).tolist() == [[2, 1], [2, 2], [3, 1], [3, 2]]


def test_a_window_is_filled_as_far_as_its_transform_costs_no_more() -> None:
    """Of n elements 2 n - 1 offsets are padded to a fast even length."""
    assert Window(2, 4, 1, 5).filling((6, 6)) == Window(2, 4, 1, 5)  # 3 and 7 are padded to 4 and 8
    assert Window(20, 37, 60, 64).filling((64, 64)) == Window(20, 38, 60, 64)  # 33 to 36: room for 18
    # eleven elements are padded to 24 points, which hold twelve; the twelfth lies on the inner side
    assert Window(13, 24, 0, 11).filling((24, 24)) == Window(12, 24, 0, 12)
    assert Window(6, 17, 6, 17).filling((24, 24)).shape == (12, 12)
    assert Window(0, 11, 2, 13).filling((11, 24)) == Window(0, 11, 2, 14)  # no further than the grid


def test_the_interior_is_without_edges_that_are_not_the_grids() -> None:
    assert Window(2, 5, 0, 6).interior((6, 6)) == Window(3, 4, 0, 6)
    assert Window(0, 6, 2, 5).interior((6, 6)) == Window(0, 6, 3, 4)
    assert Window.full((6, 4)).interior((6, 4)) == Window.full((6, 4))


@pytest.mark.parametrize(
    ("window", "inside"),
    [
        (Window(2, 5, 1, 5), np.s_[1:2, 1:3]),
        (Window(0, 3, 1, 5), np.s_[0:2, 1:3]),  # the grid's edge is no edge of the window
        (Window(3, 6, 2, 7), np.s_[1:3, 1:5]),
        (Window.full((6, 7)), np.s_[0:6, 0:7]),
    ],
)
def test_elements_on_a_windows_edge(window: Window, inside: tuple[slice, slice]) -> None:
    edge = np.ones(window.shape, dtype=bool)
    edge[inside] = False
    for element in np.ndindex(window.shape):
        alone = np.zeros(window.shape, dtype=bool)
        alone[element] = True
        assert window.on_edge(alone, (6, 7)) is bool(edge[element])
        assert alone.sum() == 1  # the argument is not changed
