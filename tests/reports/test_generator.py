"""The page: complete, self-contained, and honest about what is missing."""

from __future__ import annotations

import base64
import json
import re
from html.parser import HTMLParser

import pytest

from reports.drawing import Figure, lines
from reports.evidence import gathered
from reports.generator import LEADING, facts, judgement, leading, pictures, render
from reports.results import ResultFileError, check
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
        if tag == "img":
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
        "hertz/a",
        "Title of hertz/b",
        "Eq. (7) holds",
        "Johnson 1985",
        "first order in h",
        "see c",
    ):
        assert text in page.text
    assert "0.01 ≤ 0.1" in page.text
    assert "0.2 > 0.1" in page.text
    assert "rough-friction verify --only hertz/a" in page.text
    assert "rough-friction verify --tier full --only hertz/b" in page.text
    assert len(page.ids) == len(set(page.ids))
    assert {link.removeprefix("#") for link in page.links if link.startswith("#")} <= set(page.ids)


def test_the_summary_counts_and_no_claim_passes_on_a_failure() -> None:
    page = render(
        results(case("a/1"), case("a/2", "fail"), case("b/1", claim="other"), case("c/1", "unavailable"))
    )
    assert re.search(r"<b>2</b> pass", page)
    assert re.search(r"<b>1</b> fail", page)
    assert re.search(r"<b>1</b> unavailable", page)
    rows = re.findall(r'<span class="mark (\w+)">\w+</span></td><td>(Eq\. \(7\) holds|other)</td>', page)
    assert rows == [("fail", "Eq. (7) holds"), ("pass", "other")]


def summary_of(page: str) -> Page:
    """The summary alone."""
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
    assert page.links == [f"#case-{id}" for id in ("a.2", "a.3", "b.1", "c.1")]


def test_the_summary_lists_nothing_when_all_passed() -> None:
    page = summary_of(render(results(case("a/1"), case("a/2"))))
    assert "table" not in page.tags
    assert page.links == []


def test_no_request_leaves_the_page() -> None:
    page = Page(render(results(case("kernels/textbook-x-fails", data=TEXTBOOK))))
    inside = ("#", "data:image/svg+xml;base64,", "data:text/csv;base64,")
    assert all(link.startswith(inside) for link in page.links)
    assert "link" not in page.tags
    svg = base64.b64decode(str(page.images[0]["src"]).partition(",")[2]).decode()
    assert not re.search(r'(href|src)="(?!#|data:)', svg)
    assert "currentColor" in svg
    assert page.images[0]["alt"]


@pytest.mark.parametrize("data", [{}, {**TEXTBOOK, "textbook": []}, {**TEXTBOOK, "production": None}])
def test_a_figure_without_data_is_not_available(data: dict[str, object]) -> None:
    page = Page(render(results(case("kernels/textbook-x-fails", data=data))))
    assert page.images == []
    assert "Figure not available" in page.text


def pictures_of(data: dict[str, object]) -> int:
    return len(Page(render(results(case("new/1", data=data)))).images)


def test_a_new_case_gets_a_figure_by_its_series() -> None:
    assert pictures_of({"M": [32, 64, 128], "error": [4.0, 2.0, 1.0]}) == 1
    assert pictures_of({"load": [1, 2, 3], "area": [1.0, None, 3.0], "law": [1.0, 2.0, 3.0]}) == 1
    assert pictures_of({"load": [3, 2, 1], "area": [1e-9, 1e-6, 1e-3]}) == 1


@pytest.mark.parametrize(
    "data",
    [
        {"load": [1, 2, 3]},
        {"load": [1, 3, 2], "area": [1, 2, 3]},
        {"load": [1, 2, 3], "area": [1, 2]},
        {"load": [1, 2, 3], "area": ["a", "b", "c"]},
        {"load": [1, 2, 3], **{f"area {k}": [1, 2, 3] for k in range(7)}},
        {"load": [1, 2, 3], "area": [1, 2, 3], "elements": [400, 500, 600]},
        {"load": [1, 2, 3], "area": [1, 2, 3], "maps": [[1, 2], [3, 4], [5, 6]]},
        {"load": [1, 2, 3], "area": [None, None, None]},
    ],
)
def test_series_that_are_no_figure_make_none(data: dict[str, object]) -> None:
    assert pictures_of(data) == 0


def test_unjudged_numbers_are_not_zero() -> None:
    page = Page(render(results(case("a/1", "error", note="RuntimeError: broken"))))
    assert "not judged" in page.text
    assert "RuntimeError: broken" in page.text
    assert "n/a" in page.text


@pytest.mark.parametrize(
    ("metric", "status", "said"),
    [
        ("relative", "pass", "0.0123 ≤ 0.457"),
        ("relative", "fail", "0.0123 > 0.457"),
        ("absolute", "pass", "0.0123 ≤ 0.457"),
        ("at_most", "fail", "0.0123 > 0.457"),
        ("at_least", "pass", "0.0123 ≥ 0.457"),
        ("at_least", "fail", "0.0123 < 0.457"),
        ("equal", "pass", "0.0123 ≤ 0.457"),
    ],
)
def test_a_judgement_says_which_way_it_went(metric: str, status: str, said: str) -> None:
    # to three digits, and whichever numbers: the status decides
    judged = case("a/1", status, metric=metric, error=0.012346, tolerance=0.45678)
    assert judgement(judged) == said


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({"table": {}}, []),
        ({"table": {str(k): k for k in range(12)}}, ["table"]),
        ({"table": {str(k): k for k in range(13)}}, []),
        ({"table": {"deep": [1]}}, []),
        ({"word": "so", "truth": True, "nothing": None, "share": 0.123456}, ["so", "True", "n/a", "0.1235"]),
    ],
)
def test_of_what_a_case_recorded_single_entries_are_printed(data: dict[str, object], said: list[str]) -> None:
    found = facts(data)
    assert [name if name == "table" else text for name, text in found] == said


def test_texts_are_escaped() -> None:
    bad = "<script>alert(1)</script>"
    page = render(
        results(
            case("a/1", title=bad, claim=bad, note=bad, source=bad, tags=[bad]),
            errata=[{**ERRATUM, "printed": bad}],
        )
    )
    assert bad not in page
    assert page.count("&lt;script&gt;") >= 6


def test_errata_are_shown() -> None:
    page = Page(render(results(case("a/1"), errata=[ERRATUM])))
    for text in ("A4", "sin xi", "0.3", "cos xi", "1e-12", "residual", "pass"):
        assert text in page.text


def test_an_uncommitted_tree_and_a_selection_are_said() -> None:
    made = results(case("a/1"), only=["a/*"])
    made["provenance"]["dirty"] = True
    text = Page(render(made)).text
    assert "with uncommitted changes" in text
    assert "only a/*" in text


def test_the_same_results_make_the_same_page() -> None:
    made = results(case("kernels/textbook-x-fails", data=TEXTBOOK))
    assert render(made) == render(json.loads(json.dumps(made)))


@pytest.mark.parametrize(
    "broken",
    [
        None,
        [],
        {"format": "another"},
        {k: v for k, v in results().items() if k != "cases"},
        results({k: v for k, v in case("a/1").items() if k != "tolerance_reason"}),
        results(case("a/1", "passed")),
        results(case("a/1"), errata=[{"equation": "A4"}]),
        results(case("a/1"), errata={}),
        results() | {"cases": {}},
        results(case("a/1", "fail"), case("a/1")),
        results(case("a/1"), provenance={}),
        results(case("a/1", "fail"), counts={"pass": 1, "fail": 0, "error": 0, "unavailable": 0}),
    ],
)
def test_what_is_not_a_result_file_is_refused(broken: object) -> None:
    with pytest.raises(ResultFileError):
        check(broken)


def test_a_quick_case_leaves_its_figure_to_its_long_twin() -> None:
    data = {"M": [32, 64, 128], "error": [4.0, 2.0, 1.0]}
    quick, long = case("new/1", data=data), case("new/1-full", data=data)
    assert len(Page(render(results(quick, long))).images) == 1
    assert len(Page(render(results(quick, case("new/1-full", "fail", data=data)))).images) == 2


@pytest.mark.parametrize("other", ["new/0-full", "new/2-full", "new/1-fuller", "zzz/1-full"])
def test_nobody_else_is_its_twin(other: str) -> None:
    data = {"M": [32, 64, 128], "error": [4.0, 2.0, 1.0]}
    quick = case("new/1", data=data)
    assert len(pictures(quick, gathered(results(quick, case(other)), {}))) == 1


def test_the_first_page_has_the_first_figure_of_the_best_case_that_has_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    first, second = (
        Figure("*", ("M", name), lines("M", {name: name}, xlabel="M", ylabel=name), name)
        for name in ("error", "time")
    )
    monkeypatch.setattr("reports.figures.figures_of", lambda *_: [first, second])
    series = {"M": [32, 64, 128], "error": [4.0, 2.0, 1.0], "time": [1.0, 2.0, 3.0]}
    (best, quick), (empty, stand_in, other), (last,) = LEADING
    present = [case(id, data=series) for id in (other, stand_in, quick, last)]
    present.append(case(empty, data={"M": []}))
    shown = leading(gathered(results(*present), {}))
    assert [(c["id"], picture["caption"]) for c, picture in shown] == [
        (quick, "error"), (stand_in, "error"), (last, "error"),
    ]  # fmt: skip
    shown = leading(gathered(results(*present, case(best, data=series)), {}))
    assert [c["id"] for c, _ in shown] == [best, stand_in, last]


def test_progress_names_every_case_as_it_is_drawn() -> None:
    told: list[str] = []
    render(results(case("a/1"), case("hertz/b")), progress=told.append)
    assert {"a/1", "hertz/b"} <= set(told)
