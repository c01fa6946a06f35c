"""Curves have colours that readers with any colour blindness tell apart, and that stand out on the page."""

from __future__ import annotations

import re

import pytest

from reports.drawing import COLOURS
from tests.colour_vision import VISION, contrast, least_difference
from tests.documents import ROOT
from verification.cli import plot_curves, plot_style

APART = 15.0
"""Colour difference: that of the closest pair of Okabe and Ito 2008, who chose for such readers, is 16."""
PALETTES = {
    "report": COLOURS,
    "pictures": (plot_style.BLUE, plot_style.ORANGE, plot_style.GREEN, plot_style.PINK, plot_style.BLACK),
    "sweeps": plot_curves.COLOURS,
}


@pytest.mark.parametrize("palette", PALETTES)
@pytest.mark.parametrize("vision", VISION)
def test_no_two_curves_look_alike(palette: str, vision: str) -> None:
    assert least_difference(PALETTES[palette], VISION[vision]) >= APART


@pytest.mark.parametrize("colour", COLOURS)
def test_curves_of_the_report_stand_out_on_the_light_and_the_dark_page(colour: str) -> None:
    css = (ROOT / "reports/templates/report.css").read_text(encoding="utf-8")
    pages = re.findall(r"--page: (#\w+)", css)
    assert len(pages) == 2
    for page in pages:
        full = page if len(page) == 7 else "#" + "".join(2 * digit for digit in page[1:])
        assert contrast(colour, full) >= 3.0
