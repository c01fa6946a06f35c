"""The page: complete, self-contained, and honest about what is missing."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import pytest

from reports.generator import render
from reports.results import ResultFileError, check
from reports.text import judgement
from tests.reports.sample import ERRATUM, TEXTBOOK, case, results

VOID = {"meta", "input", "img", "br", "link", "hr"}


class Page(HTMLParser):
    """Ids, links, images and the nesting of a page."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.images: list[dict[str, str | None]] = []
        self.tags: list[str] = []
        self.text = ""
        self._open: list[str] = []
        self.feed(html)
        assert self._open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        self.tags.append(tag)
        self.ids += [v for k, v in attrs if k == "id" and v]
        self.links += [v for k, v in attrs if k in ("href", "src") and v]
        if tag == "svg" and found.get("class") == "plot":
            self.images.append(found)
        if tag not in VOID:
            self._open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag

    def handle_data(self, data: str) -> None:
        if not self._open or self._open[-1] not in ("script", "style"):
            self.text += data


def test_every_case_is_on_the_page_with_all_that_a_reader_needs() -> None:
    page = Page(
        render(results(case("hertz/a"), case("hertz/b", "fail", value=1.2, tier="full", note="see c")))
    )
    for text in (
        *("hertz/a", "Title of hertz/b", "Eq. (7) holds", "Johnson 1985", "first order in h", "see c"),
        *("0.01 ≤ 0.1", "0.2 > 0.1", "rough-friction verify --only hertz/a"),
        "rough-friction verify --tier full --only hertz/b",
    ):
        assert text in page.text
    assert len(page.ids) == len(set(page.ids))
    assert {link.removeprefix("#") for link in page.links if link.startswith("#")} <= set(page.ids)


def summary_of(page: str) -> Page:
    found = re.search(r'<section id="summary">.*?</section>', page, flags=re.S)
    assert found
    return Page(found[0])


def test_the_summary_lists_what_did_not_pass() -> None:
    broken = (
        case("a/2", "fail", value=1.2, note="see c"),
        case("a/3", "error", note="ValueError: no luck"),
        case("b/1", "unavailable", note="needs tamaas"),
    )
    old = results(case("c/1", "fail", title="Long and failed", value=1.3))
    page = summary_of(render(results(case("a/1"), *broken), {"old": old}))
    for text in (
        *("Title of a/2", "0.2 > 0.1", "see c", "ValueError: no luck", "not judged", "needs tamaas"),
        *("Long and failed", "0.3 > 0.1"),
    ):
        assert text in page.text
    assert [link for link in page.links if link.startswith("#case")] == [
        f"#case-{id}" for id in ("a.2", "a.3", "c.1", "b.1")
    ]


def test_no_request_leaves_the_page() -> None:
    page = Page(render(results(case("kernels/textbook-normal-fails", data=TEXTBOOK))))
    assert all(link.startswith(("#", "data:text/csv;charset=utf-8,")) for link in page.links)
    assert "link" not in page.tags
    assert page.images[0]["aria-label"]
    assert page.images[0]["role"] == "img"


def test_a_figure_without_data_is_not_available() -> None:
    page = Page(render(results(case("kernels/textbook-normal-fails", data={**TEXTBOOK, "textbook": []}))))
    assert page.images == []
    assert "Figure not available" in page.text


@pytest.mark.parametrize(
    ("metric", "status", "said"),
    [
        ("relative", "pass", "0.0123 ≤ 0.457"),
        ("relative", "fail", "0.0123 > 0.457"),
        ("at_least", "pass", "0.0123 ≥ 0.457"),
        ("at_least", "fail", "0.0123 < 0.457"),
    ],
)
def test_a_judgement_says_which_way_it_went(metric: str, status: str, said: str) -> None:
    # to three digits, and whichever numbers: the status decides
    judged = case("a/1", status, metric=metric, error=0.012346, tolerance=0.45678)
    assert judgement(judged) == said


def test_errata_an_uncommitted_tree_and_a_selection_are_shown() -> None:
    made = results(case("a/1"), errata=[ERRATUM], only=["a/*"])
    made["provenance"]["dirty"] = True
    page = Page(render(made))
    for text in ("A4", "sin xi", "0.3", "cos xi", "1e-12", "with uncommitted changes", "only a/*"):
        assert text in page.text


@pytest.mark.parametrize(
    "broken",
    [
        None,
        {"format": "another"},
        {k: v for k, v in results().items() if k != "cases"},
        results({k: v for k, v in case("a/1").items() if k != "tolerance_reason"}),
        results(case("a/1", "passed")),
        results(case("a/1"), errata=[{"equation": "A4"}]),
        results() | {"cases": {}},
        results(case("a/1", "fail"), case("a/1")),
        results(case("a/1"), provenance={}),
        results(case("a/1", "fail"), counts={"pass": 1, "fail": 0, "error": 0, "unavailable": 0}),
    ],
)
def test_what_is_not_a_result_file_is_refused(broken: object) -> None:
    with pytest.raises(ResultFileError):
        check(broken)
