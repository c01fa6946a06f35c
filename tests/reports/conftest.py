"""The whole report from the committed results, made once for all tests of it, in whichever process."""

from __future__ import annotations

from pathlib import Path

import pytest
from filelock import FileLock

from reports.generator import render
from tests.documents import ROOT
from verification.output.result_files import read_results


@pytest.fixture(scope="session")
def page_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Processes of one run have folders side by side: the first makes the page, the others wait for it."""
    own = tmp_path_factory.getbasetemp()
    shared = own.parent if own.name.startswith("popen-") else own
    path = shared / "report.html"
    with FileLock(shared / "report.lock"):
        if not path.exists():
            documents = read_results(ROOT / "reports/results")
            path.write_text(render(documents["quick"], documents), encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def html(page_file: Path) -> str:
    return page_file.read_text(encoding="utf-8")
