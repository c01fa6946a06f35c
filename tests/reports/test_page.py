"""The whole report from the committed results: size, links, ids, names, captions, and places of figures."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest

from tests.reports.test_generator import Page


@pytest.mark.slow
def test_the_page_is_small_and_its_links_lead_somewhere(html: str) -> None:
    assert len(html.encode()) <= 3_000_000
    page = Page(html)
    assert len(page.ids) == len(set(page.ids))
    assert {link.removeprefix("#") for link in page.links if link.startswith("#")} <= set(page.ids)
    assert all(link.startswith(("#", "data:text/csv", "data:image/png")) for link in page.links)


@pytest.mark.slow
def test_everything_has_a_name(html: str) -> None:
    assert len(re.findall(r"<table\b", html)) == len(re.findall(r"<caption\b", html))
    assert not re.search(r"<th[^>]*>\s*</th>", html)  # the script makes buttons of heads
    assert all(image["aria-label"] for image in Page(html).images)
    captions = re.findall(r"<figcaption>Figure \d+\. (.*?)\s*<", html, flags=re.S)
    assert 30 < len(captions) <= 48
    assert "The series that the case recorded" not in html
    assert len(captions) == len(set(captions))
    levels = [int(level) for level in re.findall(r"<h(\d)\b", html)]
    assert all(b <= a + 1 for a, b in pairwise(levels))


@pytest.mark.slow
def test_a_statement_has_one_verdict_wherever_it_stands(html: str) -> None:
    """In the table of claims, beside figures and under every check; a check itself has none."""
    verdict = r'<span class="verdict [\w-]+">([^<]*)</span>'
    said = re.findall(rf'<tr id="claim-([\w-]+)">.*?{verdict}', html, flags=re.S)
    assert len(said) > 50
    known = dict(said)
    shown = [(label, v) for v, label in re.findall(rf'{verdict} <a href="#claim-([\w-]+)">', html)]
    checks = re.findall(
        r'<dt class="fact">Of the paper</dt><dd><a href="#claim-([\w-]+)">[^<]*</a>: (.*?)</dd>', html
    )
    assert len(checks) > 50
    assert {pair for pair in (*shown, *checks) if known[pair[0]] != pair[1]} == set()
    assert not re.search(r"<dt>Note</dt><dd>(not )?confirmed", html)
    assert '<dt class="fact">verdict</dt>' not in html


@pytest.mark.slow
def test_figures_have_symbols_and_units_and_no_hatching(html: str) -> None:
    figures = re.findall(r'<svg class="plot".*?</svg>', html, flags=re.S)
    assert len(figures) > 30
    texts = [text for figure in figures for text in re.findall(r"<text\b[^>]*>([^<]*)</text>", figure)]
    plain = re.compile(r"(?<![\w-])(mu|tau|beta|f_max|\d um|mm\^2|\(m\))(?![\w-])")
    assert [text for text in texts if plain.search(text)] == []
    assert not any("<pattern" in figure for figure in figures)


@pytest.mark.slow
def test_the_first_page_has_numbers_discrepancies_and_verdicts(html: str) -> None:
    first = html.partition('<section id="summary">')[2].partition("</section>")[0]
    parts = ["The three largest discrepancies", "How to run it again", "Verdicts", "How sure we are"]
    assert re.findall(r"<h3>(.*?)</h3>", first) == parts
    assert "n/a" not in first
    assert "passed" not in first
