"""The table of bars by class is that of the committed study, digit by digit."""

from __future__ import annotations

from reports.result_files import committed
from tests.documents import ROOT

NUMBERS = ("contact_area", "contact_area_corrected", "friction_coefficient", "max_pressure", "approach")
HEAD = "| class of scene | A | A, corrected | mu | p_max | approach |"


def test_every_class_and_number_is_that_of_the_study() -> None:
    lines = (ROOT / "docs/error-bars.md").read_text(encoding="utf-8").splitlines()
    start = lines.index(HEAD) + 2
    stated = {}
    for line in lines[start : lines.index("", start)]:
        name, *cells = (cell.strip() for cell in line.strip("|").split("|"))
        stated[name] = cells
    table = committed("coverage_classes")["table"]
    found: dict[str, list[str]] = {}
    for row in table:
        if row["class"] and row["number"] in NUMBERS:
            cell = f"{100 * row['held']:.0f} % / {100 * row['usable']:.0f} %"
            found.setdefault(row["class"], []).append(cell)
    assert stated == found
