"""The pages of docs/ tell the truth: every block runs, every number shown is the one printed."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from refimpl.solution.model_warning import Limit
from tests.documents import FENCE, ROOT, agree, blocks, commands, run

DOCS = sorted((ROOT / "docs").glob("*.md"))

LONG = {
    "notebooks", "read-the-report", "friction-with-an-error-bar", "reference-data", "measured-surfaces",
    "yield",
}  # fmt: skip
"""Pages of 5 seconds and more, but for check-your-solver, whose program in C no other test of CI runs."""


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(
    "path",
    [pytest.param(p, id=p.stem, marks=[pytest.mark.nightly] if p.stem in LONG else []) for p in DOCS],
)
def test_a_page_is_true(path: Path, tmp_path: Path) -> None:
    for name in ("tests", "examples", "docs"):  # as seen from a checkout
        (tmp_path / name).symlink_to(ROOT / name)
    page = path.read_text(encoding="utf-8")
    if "\n$ cc " in page and shutil.which("cc") is None:
        pytest.skip("no C compiler")
    for words, library in (("to_xarray()\n", "xarray"), ("-m nbconvert", "nbconvert")):
        if words in page:
            pytest.importorskip(library, reason="an extra that dev includes")
    stated = [b for b in blocks(page) if b.language == "text" and not b.file]
    shown = [s for b in blocks(page) if b.language == "console" for _, s in commands(b) if s.strip()]
    assert run(page, tmp_path) == len(stated) + len(shown)


def test_the_solves_of_the_page_of_yield_are_true(tmp_path: Path) -> None:
    """With and without the cap; its sweep of hardnesses takes longer, and `make nightly` runs it."""
    page = (ROOT / "docs/yield.md").read_text(encoding="utf-8")
    parts = [b[0] for b in FENCE.finditer(page) if b[2] or "solve steel.toml" in b[3]]
    assert run("\n".join(parts), tmp_path) == 2


@pytest.mark.parametrize("path", [*DOCS, ROOT / "README.md"], ids=lambda path: path.stem)
def test_what_a_page_points_to_is_there(path: Path) -> None:
    page = re.sub(r"^```.*?^```$", "", path.read_text(encoding="utf-8"), flags=re.M | re.S)
    links = [link for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page) if "://" not in link]
    for link in links:
        assert (path.parent / link).exists(), link
    top = "refimpl|appendix_a|verification|reports|tests|docs|examples"
    for name in re.findall(rf"`((?:{top})/[\w./-]*)`", page):
        assert (ROOT / name).exists(), name


def test_the_readme_leads_to_every_page() -> None:
    """By docs/README.md, which has every other page, as the site's navigation has."""
    assert "docs/README.md" in (ROOT / "README.md").read_text(encoding="utf-8")
    order = (ROOT / "docs/README.md").read_text(encoding="utf-8")
    site = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    assert len(DOCS) > 15
    assert [path.name for path in DOCS if f"docs/{path.name}" not in site] == []
    assert [path.name for path in DOCS if path.name != "README.md" and f"]({path.name}" not in order] == []


def test_every_limit_of_a_result_stands_on_the_page_of_limits() -> None:
    page = (ROOT / "docs/limits.md").read_text(encoding="utf-8")
    assert [limit.value for limit in Limit if f"`{limit.value}`" not in page] == []
    assert "https://" in page


@pytest.mark.parametrize(
    ("printed", "stated", "same"),
    [
        ("mu = 0.0894 (ok)", "mu = 0.0893 (ok)", True),
        ("7.2e-07 of 1 in 0.31 s", "7.1e-07 of 1 in ... s", True),
        ("one\ntwo\nthree", "one\n...\nthree", True),
        ("mu = 0.0895 (ok)", "mu = 0.0893 (ok)", False),
        ("mu = 0.0893 (cycled)", "mu = 0.0893 (ok)", False),
        ("65 x 65", "64 x 64", False),
        ("7.3e-06", "7.3e-07", False),
        ("one two three", "one\n...\nfour", False),
    ],
)
def test_outputs_agree_or_not(printed: str, stated: str, same: bool) -> None:
    assert agree(printed, stated) is same


@pytest.mark.parametrize(
    "page",
    [
        "```python\nprint(1.5)\n```\n\n```text\n1.7\n```\n",
        "```console\n$ rough-friction solve hertz --grid 8 --tolerance 1e-4\nstatus: STAGNATED\n```\n",
        "```console\n$ rough-friction verify --list --tier full --only 'kernels/*' --json no/such\n```\n",
        "```console\n$ make tea\n```\n",
    ],
)
def test_a_page_that_lies_is_found_out(page: str, tmp_path: Path) -> None:
    with pytest.raises((AssertionError, SystemExit)):
        run(page, tmp_path)


def test_texts_name_what_they_mean_not_a_document_that_is_not_there() -> None:
    """A source like "SPEC 1" leads a reader nowhere."""
    packages = ("refimpl", "appendix_a", "verification", "reports", "docs")
    files = [f for name in packages for kind in ("*.py", "*.md") for f in (ROOT / name).rglob(kind)]
    assert len(files) > 200
    assert [f for f in files if re.search(r"\bSPEC\b", f.read_text(encoding="utf-8"))] == []
