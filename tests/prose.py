"""Sentences and paragraphs of Markdown and HTML: what a reader reads, without code, tables and headings."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator

LONGEST_SENTENCE = 25  # words
LONGEST_PARAGRAPH = 120  # words
SHORTENED = r"\b(?:Eqs?|Figs?|No|al|vs|cf|approx|e\.g|i\.e|St|[A-Z])\.$"
ITEM = re.compile(r"^\s*(?:[-*]|\d+\.)\s+")


def paragraphs(page: str) -> Iterator[str]:
    """Yield each paragraph and list item of a Markdown page as plain words.

    >>> list(paragraphs("# Head\\n\\nOne `x y` and [two](a.md).\\n\\n| a | b |\\n\\n- three\\n- four\\n"))
    ['One code and two.', 'three', 'four']
    """
    page = re.sub(r"^(```+).*?^\1$|<!--.*?-->|^\$\$.*?^\$\$$", "", page, flags=re.M | re.S)
    for block in re.split(r"\n\s*\n", page):
        lines = [line for line in block.splitlines() if not re.match(r"\s*(?:#|\||!\[)", line)]
        items: list[list[str]] = [[]]
        for line in lines:
            if ITEM.match(line):
                items.append([])
            items[-1].append(ITEM.sub("", line))
        yield from (plain(" ".join(item)) for item in items if "".join(item).strip())


def plain(text: str) -> str:
    """Return Markdown without marks: code and formulas are one word each, links their text."""
    text = re.sub(r"\$[^$\s](?:[^$]*[^$\s])?\$", "x", re.sub(r"`[^`]+`", "code", text))
    text = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", text)
    return " ".join(text.replace("**", "").split())


def visible(page: str) -> Iterator[str]:
    """Yield the paragraphs of an HTML template, each expression as one word.

    >>> list(visible("<p>One {{ two }} <b>three</b>.</p>{% if x %}<td>cell</td>"))
    ['One x three.']
    """
    page = re.sub(r"{{.*?}}", "x", re.sub(r"{%.*?%}|{#.*?#}", " ", page, flags=re.S), flags=re.S)
    for body in re.findall(r"<(?:p|li|figcaption)\b[^>]*>(.*?)</(?:p|li|figcaption)>", page, flags=re.S):
        yield " ".join(html.unescape(re.sub(r"<[^>]+>", "", body)).split())


def sentences(paragraph: str) -> Iterator[str]:
    """Yield the sentences of a paragraph.

    >>> list(sentences("By Eq. (4) it is so. Is it? Yes."))
    ['By Eq. (4) it is so.', 'Is it?', 'Yes.']
    """
    sentence = ""
    for piece in re.split(r"(?<=[.?!])\s+|(?<=[.?!][)\"'])\s+", paragraph):
        sentence = f"{sentence} {piece}".strip()
        if not re.search(SHORTENED, sentence):
            yield sentence
            sentence = ""
    if sentence:
        yield sentence


def words(text: str) -> int:
    """Return the number of words: pieces with a letter or a digit."""
    return sum(bool(re.search(r"\w", piece)) for piece in text.split())


def too_long(texts: Iterator[str]) -> Iterator[str]:
    """Yield paragraphs and sentences that have more words than a reader takes in at once."""
    for paragraph in texts:
        if words(paragraph) > LONGEST_PARAGRAPH:
            yield paragraph
        yield from (one for one in sentences(paragraph) if words(one) > LONGEST_SENTENCE)
