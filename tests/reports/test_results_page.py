"""The page of results is what the result files say."""

from __future__ import annotations

import re
from typing import Any

import pytest

from reports.results_page import FOLDER, PAGE, page
from tests.documents import ROOT
from verification.output.result_files import read_results


@pytest.fixture(scope="module")
def documents() -> dict[str, Any]:
    return read_results(FOLDER)


def test_the_committed_page_is_that_of_the_files(documents: dict[str, Any]) -> None:
    written = PAGE.read_text(encoding="utf-8")
    assert written == page(documents), "run python -m reports.results_page"


def test_every_section_names_files_that_are_there() -> None:
    _, *sections = PAGE.read_text(encoding="utf-8").split("\n## ")
    for section in sections:
        names = set(re.findall(r"\]\(results/([\w.]+)\)", section))
        assert names, section.partition("\n")[0]
        assert all((ROOT / "reports/results" / name).is_file() for name in names)


def test_a_refuted_claim_and_a_failed_check_are_named(documents: dict[str, Any]) -> None:
    assert "| not confirmed | Eq. (11) |" in page(documents)
    run = documents["quick"]
    unjudged = dict.fromkeys(("value", "reference", "reference_uncertainty", "error"))
    broken = {**run["cases"][0], **unjudged, "status": "error"}
    counts = run["counts"] | {"pass": run["counts"]["pass"] - 1, "error": 1}
    made = page({**documents, "quick": {**run, "cases": [broken, *run["cases"][1:]], "counts": counts}})
    (said,) = (line for line in made.splitlines() if "Failed or not run: " in line)
    assert f"`{broken['id']}` (error)" in said.partition("Failed or not run: ")[2]


def test_table_3_has_the_printed_numbers_with_e_and_u(documents: dict[str, Any]) -> None:
    lines = page(documents).partition("## Table 3")[2].partition("## Hertz")[0].splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if "| 512² |" in line]
    assert [[row[3] for row in rows if row[0] == kind] for kind in dict.fromkeys(r[0] for r in rows)] == [
        ["0.218", "0.643", "0.164"],
        ["0.106", "0.122", "1.91"],
        ["0.095", "0.07", "3.21"],
        ["0.089", "0.044", "5.28"],
    ]
    assert [r[7] for r in rows] == ["yes" if abs(float(r[5])) <= float(r[6]) else "no" for r in rows]
