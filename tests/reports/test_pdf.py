"""The report on paper: size, tags, outline, contents and paper, and that packing loses nothing."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import pytest

from verification.cli import pdf
from verification.cli.pdf import printed

pikepdf = pytest.importorskip("pikepdf", reason="pikepdf, of the extra 'pdf', is not installed")
if pdf.browser() is None:
    pytest.skip(f"no browser: none of {', '.join(pdf.BROWSERS)} is installed", allow_module_level=True)

MOST_BYTES = 3_000_000
POINTS = {"a4": (595, 842), "letter": (612, 792)}


@pytest.fixture(scope="module", params=["a4", pytest.param("letter", marks=pytest.mark.nightly)])
def paper(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def path(paper: str, page_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    page = tmp_path_factory.mktemp(paper) / "report.html"
    page.write_bytes(page_file.read_bytes())
    return printed(page, paper)


def entries(item: Any) -> int:
    """Number of entries of an outline below the item."""
    count, child = 0, item.get("/First")
    while child is not None:
        count, child = count + 1 + entries(child), child.get("/Next")
    return count


@pytest.mark.slow
def test_the_pdf_is_small_tagged_and_has_an_outline_and_contents(path: Path, paper: str) -> None:
    assert path.stat().st_size <= MOST_BYTES
    assert [entry.name for entry in path.parent.iterdir() if entry.name.startswith(".")] == []
    with pikepdf.open(path) as document:
        root = document.Root
        assert root.MarkInfo.Marked
        assert "/StructTreeRoot" in root
        assert str(root.Lang) == "en"
        assert str(document.docinfo.Title).startswith("Verification and replication report")
        assert entries(root.Outlines) > 30
        assert {tuple(round(float(x)) for x in page.mediabox[2:]) for page in document.pages} == {
            POINTS[paper]
        }
        links = [note for note in document.pages[0].Annots if note.Subtype == "/Link"]
        assert len(links) >= 10  # the contents
        assert all("/Dest" in link or "/A" in link for link in links)
        after = root.Dests["/numbers"][0].objgen  # what follows the results on one page
        pages = [page.obj.objgen == after for page in document.pages].index(True)
        assert pages == 1  # on letter paper as well, which is 18 mm shorter


def two_pages(folder: Path) -> Path:
    page = folder / "report.html"
    page.write_text(
        "<!doctype html><html lang='en'><head><title>Two</title></head><body><h1>One</h1><p>first</p>"
        "<h1 style='break-before: page'>Two</h1><p>second</p></body></html>"
    )
    return page


def test_packing_keeps_every_page_and_tag(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small = printed(two_pages(tmp_path)).rename(tmp_path / "small.pdf")
    monkeypatch.setattr(pdf, "compacts", lambda: False)
    large = printed(two_pages(tmp_path))
    assert small.stat().st_size < large.stat().st_size
    with pikepdf.open(small) as packed, pikepdf.open(large) as plain:
        drawn = [[page.Contents.read_bytes() for page in document.pages] for document in (packed, plain)]
        assert len(drawn[0]) == 2
        assert drawn[0] == drawn[1]
        assert len(packed.objects) == len(plain.objects) + _streams(packed, "/ObjStm") + _streams(
            packed, "/XRef"
        )


def _streams(document: Any, kind: str) -> int:
    return sum(isinstance(item, pikepdf.Stream) and item.get("/Type") == kind for item in document.objects)


def test_a_browser_that_fails_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = two_pages(tmp_path)
    page.with_suffix(".pdf").write_text("old")
    failed = subprocess.CompletedProcess([], 1, b"", b"no display")
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: failed)
    with pytest.raises(ValueError, match=r"a browser that prints \(no display\)"):
        printed(page)
    assert page.with_suffix(".pdf").read_text() == "old"
