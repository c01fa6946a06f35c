"""The exhibit of checks and seeded faults: what it counts, what it says of silent checks, and its figure."""

from __future__ import annotations

from typing import Any

import pytest

from reports.drawing import svg
from reports.results import ResultFileError
from reports.studies import exhibit
from reports.studies.fault_matrix import FIGURE, purpose


@pytest.fixture
def document() -> dict[str, Any]:
    def fault(name: str, caught_by: list[str]) -> dict[str, Any]:
        return {"name": name, "what": f"{name} is wrong", "tried": 3, "broke": 0, "caught_by": caught_by}

    def check(id: str, catches: list[str], alone: list[str]) -> dict[str, Any]:
        return {"id": id, "claim": "c", "seconds": 0.1, "catches": catches, "alone": alone, "among_few": []}

    return {
        "faults": [
            fault("sign", ["hertz/a", "golden/b"]),
            fault("tie", ["golden/b"]),
            fault("missed", []),
        ],
        "checks": [
            check("hertz/a", ["sign"], []),
            check("golden/b", ["sign", "tie"], ["tie"]),
            check("errata/c", [], []),
        ],
        "excluded": {"cross-check/d": "takes 12.0 s"},
    }


def test_the_summary_counts(document: dict[str, Any]) -> None:
    shown = exhibit("fault_matrix", document)
    assert "3 checks" in shown.paragraphs[0]
    assert "2 faults are detected; not detected: missed." in shown.paragraphs[0]
    assert "1 checks are the only ones to see some fault, 1 see none." in shown.paragraphs[0]
    by_fault, alone, silent = shown.tables
    assert [row[0] for row in by_fault.rows] == ["missed", "tie", "sign"]
    assert by_fault.rows[2][1:] == ("sign is wrong", 3, 2, 0, "hertz/a, golden/b")
    assert list(alone.rows) == [("golden/b", "tie", 2)]
    assert list(silent.rows) == [("errata/c", purpose("errata/c"))]


def test_the_figure_draws_counts(document: dict[str, Any]) -> None:
    ((figure, data),) = exhibit("fault_matrix", document).figures
    assert figure is FIGURE
    assert data["checks that see it"] == [[1, 0, 0], [1, 1, 0], [0, 0, 0]]
    assert data["seen by one check alone"] == [False, True, False]
    drawn = svg(figure, data)
    assert drawn is not None
    assert drawn.startswith("<svg")


def test_a_silent_check_has_a_purpose() -> None:
    assert purpose("appendix-fem/flat-2d").startswith("judges the paper's appendix")
    assert purpose("unheard/of").startswith("guards")


def test_a_file_that_lacks_something_is_refused(document: dict[str, Any]) -> None:
    del document["excluded"]
    with pytest.raises(ResultFileError, match="excluded"):
        exhibit("fault_matrix", document)
