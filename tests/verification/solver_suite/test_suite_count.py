"""The documents' numbers of cases are the suite's."""

from __future__ import annotations

import pytest

from tests.documents import ROOT
from verification.solver_suite.suite import suite


@pytest.mark.parametrize("page", ["README.md", "docs/check-your-solver.md"])
def test_the_cases_are_as_many_as_the_page_says(page: str) -> None:
    drawn = sum("/design-" in case.id for case in suite())
    text = (ROOT / page).read_text(encoding="utf-8")
    assert f" {len(suite()) - drawn} cases" in text
    assert f"{drawn} " in text
