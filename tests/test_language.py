"""The language of names, docstrings, messages, pages and report: no pattern of `language.toml`, no long text.

An exception stands in ``EXCEPTIONS`` or ``KEPT`` with its reason; one that matches nothing any more fails.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from tests.layers import FILES, ROOT
from tests.prose import paragraphs, plain, too_long, visible

LANGUAGE = tomllib.loads((ROOT / "tests/language.toml").read_text(encoding="utf-8"))
PATTERNS, WORDS = LANGUAGE["pattern"], LANGUAGE["names"]

SUMMITS = "summits in the sense of Nayak, and of Greenwood and Tripp"
KEY = "key of recorded results"
FAULT = "name of a fault in recorded results"

EXCEPTIONS: dict[tuple[str, str], str] = {
    ("reports/studies/benchmarks.py", "seconds again"): KEY,
    ("verification/benchmarks/summary.py", "seconds again"): KEY,
    ("verification/cases/contact/rough_planes.py", "summit"): SUMMITS,
    ("verification/cases/contact/rough_planes.py", "summits"): SUMMITS,
    ("verification/solver_suite/check.py", "left out"): FAULT,
    ("refimpl/solution/rough_contact.py", "summits"): SUMMITS,
    ("verification/cases/contact/rough_theories.py", "summits"): SUMMITS,
    ("verification/exact/rough_plane.py", "summits"): SUMMITS,
    ("verification/exact/greenwood_tripp.py", "summit"): SUMMITS,
    ("verification/exact/greenwood_tripp.py", "summits"): SUMMITS,
    ("verification/reproduction/fig6.py", "summit"): SUMMITS,
    ("verification/reproduction/fig6.py", "summits"): SUMMITS,
}
"""Reasons, by file and matched text."""

KEPT = {
    "reports/studies/extremes.py": "named after the committed result that it shows",
    "Extreme": "a state at an end of its axis",
    "run_state(extreme)": "a state at an end of its axis",
    **dict.fromkeys(("summits", "gaussian_summits"), SUMMITS),
    **dict.fromkeys(("summit_rms", "summit_density", "summit_radius"), SUMMITS),
}
"""Reasons of names."""


def names(path: Path) -> Iterator[str]:
    """Folders and file of a path; its classes, fields, functions but those of tests, and their parameters."""
    relative = path.relative_to(ROOT)
    yield from map(str, [*relative.parents, relative])
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("test_"):
            yield node.name
            parameters = [] if node.name.startswith("_") else [*node.args.args, *node.args.kwonlyargs]
            yield from (f"{node.name}({parameter.arg})" for parameter in parameters)
        elif isinstance(node, ast.ClassDef):
            fields = [part.target for part in node.body if isinstance(part, ast.AnnAssign)]
            yield from [node.name, *(field.id for field in fields if isinstance(field, ast.Name))]


@cache
def replaced_words(name: str) -> list[str]:
    """Words of the last part of a name that have another word in ``language.toml``.

    >>> replaced_words("refimpl/TrapsOf_twins.py"), replaced_words("solve(bed)"), replaced_words("trapezoid")
    (['trap', 'twin'], ['bed'], [])
    """
    last = re.split(r"[/(]", name.removesuffix(".py"))[-1]
    words = [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", last)]
    return [known for word in words for known in WORDS if known in (word, word.removesuffix("s"))]


def test_names_have_the_fields_words() -> None:
    files = [*FILES, *(ROOT / "tests").rglob("*.py")]
    matches = {name: words for path in files for name in names(path) if (words := replaced_words(name))}
    assert {name: words for name, words in matches.items() if name not in KEPT} == {}
    assert set(KEPT) <= set(matches)  # each is needed


def texts(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of comments, public docstrings, messages (other strings with a space); no keys."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    tree = ast.parse(source)
    private = set()
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        named = getattr(node, "name", "")
        if isinstance(body, list) and body and isinstance(body[0], ast.Expr):
            docstring = body[0].value
            if isinstance(docstring, ast.Constant) and isinstance(docstring.value, str):
                private.add(docstring)
                if not named.startswith("_"):
                    yield docstring.lineno, f'"""{docstring.value}'
        if isinstance(node, ast.Subscript | ast.Dict):  # keys belong to file formats
            private.update([node.slice] if isinstance(node, ast.Subscript) else node.keys)
    for node in ast.walk(tree):
        message = isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value
        if message and node not in private:
            yield node.lineno, node.value


def found(path: Path) -> list[tuple[int, str, str]]:
    """Line, matched text and advice of every match in a file."""
    matches, read = [], list(texts(path.read_text(encoding="utf-8")))
    whole = "\0".join(text for _, text in read)
    for pattern in PATTERNS:
        if not re.search(pattern["match"], whole, re.IGNORECASE):
            continue
        for line, text in read:
            for match in re.finditer(pattern["match"], text, re.IGNORECASE):
                at = line + text.count("\n", 0, match.start())
                matches.append((at, match.group(), pattern["instead"]))
    return matches


def test_no_pattern_is_used_but_for_exceptions() -> None:
    assert len(PATTERNS) <= 40
    names = {path: str(path.relative_to(ROOT)) for path in FILES}
    matches = [(name, *match) for path, name in names.items() for match in found(path)]
    assert [m for m in matches if (m[0], m[2].lower()) not in EXCEPTIONS] == []
    assert set(EXCEPTIONS) <= {(m[0], m[2].lower()) for m in matches}  # each is needed


def prose() -> dict[str, list[str]]:
    """Paragraphs by page, template, or list of claims."""
    files = [*(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md"))]
    files += sorted((ROOT / "docs").glob("*.md"))
    found = {path.name: list(paragraphs(path.read_text(encoding="utf-8"))) for path in files}
    found["docs/README.md"] = list(paragraphs((ROOT / "docs/README.md").read_text(encoding="utf-8")))
    found["README.md"] = list(paragraphs((ROOT / "README.md").read_text(encoding="utf-8")))
    for path in sorted((ROOT / "reports/templates").glob("*.html")):
        found[path.name] = list(visible(path.read_text(encoding="utf-8")))
    claims = tomllib.loads((ROOT / "reports/paper.toml").read_text(encoding="utf-8"))["claim"]
    findings = [plain(claim["finding"]) for claim in claims if "finding" in claim]
    found["paper.toml"] = [re.sub(r"{[^}]*}", "x", finding) for finding in findings]  # a number is one word
    return found


PROSE = prose()
LONG: dict[tuple[str, str], str] = {}
"""Reasons, by text and beginning of a long sentence or paragraph; 40 at most."""

REPORTED = {
    ("notation.md", "binormal"): "name of the attribute",
}
"""Reasons of words, by text and match."""


@pytest.mark.parametrize("name", PROSE)
def test_sentences_and_paragraphs_are_short(name: str) -> None:
    found = list(too_long(iter(PROSE[name])))
    allowed = [start for text, start in LONG if text == name]
    assert [text for text in found if not text.startswith(tuple(allowed) or ("\0",))] == []
    assert [start for start in allowed if not any(text.startswith(start) for text in found)] == []
    assert len(LONG) <= 40


def test_pages_keep_within_their_words() -> None:
    """Words of README, CONTRIBUTING and docs/*.md with tables and headings, without code and output."""
    files = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")]
    texts = [
        re.sub(r"^(```+).*?^\1$", "", path.read_text(encoding="utf-8"), flags=re.M | re.S) for path in files
    ]
    assert sum(len(text.split()) for text in texts) <= 21_000


@pytest.mark.parametrize("name", PROSE)
def test_pages_have_the_terms_of_the_glossary(name: str) -> None:
    """Prose alone: tables and blocks have names of commands, files and recorded results."""
    patterns = [*PATTERNS, *LANGUAGE["prose"]]
    found = (re.search(p["match"], text, re.I) for text in PROSE[name] for p in patterns)
    matches = [match.group() for match in found if match]
    assert [match for match in matches if (name, match.lower()) not in REPORTED] == []


@pytest.mark.parametrize("package", LANGUAGE["docstrings"]["packages"])
def test_docstrings_of_functions_begin_with_an_imperative(package: str) -> None:
    verbs = LANGUAGE["docstrings"]["imperatives"].split()
    first = {where: text.split()[0].rstrip(",") for where, text in summaries(package)}
    assert {where: word for where, word in first.items() if word not in verbs} == {}


def summaries(package: str) -> Iterator[tuple[str, str]]:
    """Yield place and docstring of each function of a package that is no case and no property."""
    for path in sorted((ROOT / package).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            text = ast.get_docstring(node) if isinstance(node, ast.FunctionDef) else None
            if isinstance(node, ast.FunctionDef) and text:
                marks = " ".join(ast.unparse(mark) for mark in node.decorator_list)
                if not re.search("case|family|property|given|invariant|in_both_tiers", marks):
                    yield f"{path.relative_to(ROOT)}:{node.lineno}", text


def test_a_pattern_is_found_where_it_stands() -> None:
    source = '"""Summary.\n\nThe second line."""\n\nx = 1  # of the load\n\n\ndef _f():\n    "Private."\n'
    assert next(text for _, text in texts(source)) == "# of the load"
    assert re.search(PATTERNS[0]["match"], "x = 1  # of the load")
