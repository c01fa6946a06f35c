"""The whole report from the committed results, made once for all tests of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from reports.generator import render
from reports.result_files import read_results
from tests.documents import ROOT


@pytest.fixture(scope="session")
def html() -> str:
    documents = read_results(ROOT / "reports/results")
    return render(documents["quick"], documents)


@pytest.fixture(scope="session")
def page_file(html: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(html, encoding="utf-8")
    return path
