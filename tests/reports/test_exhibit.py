"""Series as CSV: columns where they are columns, and everything else below its name."""

from __future__ import annotations

import pytest

from reports.drawing import Figure
from reports.exhibit import as_csv


@pytest.mark.parametrize(
    ("data", "text"),
    [
        ({"a": [1, 2], "b": [0.5]}, "a,b\n1,0.5\n2,\n"),
        ({"a": [1], "b": {"x": 2, "y": [3, 4]}}, "a\n1\nb\nx,2\ny,3,4\n"),
        ({"a": [[1, 2], [3, 4]], "b": [5]}, "b\n5\na\n1,2\n3,4\n"),
        ({"a": [{"x": 1}, 2], "b": 0.25}, "a\n{'x': 1}\n2\nb\n0.25\n"),
    ],
)
def test_everything_that_a_figure_needs_is_in_the_file(data: dict[str, object], text: str) -> None:
    figure = Figure("*", ("a", "b"), lambda *_: None, "")
    assert as_csv(figure, data) == text


def test_the_file_holds_what_else_the_case_recorded_in_six_digits() -> None:
    figure = Figure("*", ("a",), lambda *_: None, "")
    data = {"b": [1 / 3], "a": [2], "verdict": "confirmed", "c": 0.5}
    assert as_csv(figure, data) == "a,b\n2,0.333333\nc\n0.5\n"
