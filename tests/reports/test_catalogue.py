"""Figures of the report, each as it is declared: what is drawn, from which columns, under which sentence."""

from __future__ import annotations

import pytest

from reports.catalogue import DECLARED
from reports.drawing import Figure


@pytest.mark.parametrize(
    "figure", DECLARED, ids=lambda figure: f"{figure.cases} {' '.join(figure.needs)[:40]}"
)
def test_a_figure_has_columns_a_drawing_and_a_sentence(figure: Figure) -> None:
    assert callable(figure.draw)
    assert isinstance(figure.caption, str)
    assert len(figure.caption.split()) > 3
    assert figure.caption.endswith(".")
    assert len(set(figure.needs)) == len(figure.needs) > 0
    assert all(isinstance(name, str) for name in (figure.cases, *figure.needs))
