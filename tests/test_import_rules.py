"""The house's layers: which package may import which. Read from the source, so lazy imports count as well."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("refimpl", "appendix_a", "verification", "reports")
ALLOWED: dict[str, set[str]] = {
    "refimpl": set(),
    "appendix_a": set(),
    "reports": set(),
    "verification": {"refimpl", "appendix_a", "reports.result_files"},
    "verification/cli": {"refimpl", "appendix_a", "reports"},
}
"""Packages, and single modules of them: writers of result files and the report share the files' form."""


def imported(source: str) -> Iterator[tuple[int, str]]:
    """Line and module of every import of a package of ours, wherever in the file it stands."""
    for node in ast.walk(ast.parse(source)):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = ["a relative import"] if node.level else [node.module or ""]
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module"):
            names = [a.value for a in node.args if isinstance(a, ast.Constant) and isinstance(a.value, str)]
        for name in names:
            top = name.partition(".")[0]
            if top in (*PACKAGES, "tests", "a relative import"):
                yield getattr(node, "lineno", 0), name


def layer(path: Path) -> str:
    """The row of ALLOWED that a file belongs to."""
    parts = path.relative_to(ROOT).parts
    return "verification/cli" if parts[:2] == ("verification", "cli") else parts[0]


def breaches(path: Path, source: str) -> list[str]:
    own = path.relative_to(ROOT).parts[0]
    allowed = ALLOWED[layer(path)] | {own}
    return [
        f"{path.name}:{line} imports {module}"
        for line, module in imported(source)
        if not allowed & {module, module.partition(".")[0]}
    ]


FILES = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))


@pytest.mark.parametrize("package", PACKAGES)
def test_imports_follow_the_layers(package: str) -> None:
    files = [path for path in FILES if path.relative_to(ROOT).parts[0] == package]
    assert files
    assert [b for path in files for b in breaches(path, path.read_text(encoding="utf-8"))] == []


@pytest.mark.parametrize(
    ("place", "source"),
    [
        ("refimpl/x.py", "import verification.framework.case"),
        ("refimpl/x.py", "def f():\n    from appendix_a import wedge"),
        ("appendix_a/x.py", "from refimpl.grid import Grid"),
        ("reports/x.py", "import importlib\nimportlib.import_module('verification.framework.case')"),
        ("reports/x.py", "if TYPE_CHECKING:\n    from refimpl import Solution"),
        ("verification/runner.py", "from reports.generator import render"),
        ("verification/runner.py", "from reports import result_files"),
        ("refimpl/x.py", "from reports.result_files import read_result"),
        ("verification/cases/x.py", "from reports import figures"),
        ("verification/cli/x.py", "from tests import conftest"),
        ("verification/x.py", "from . import case"),
    ],
)
def test_the_rule_sees_a_breach(place: str, source: str) -> None:
    assert breaches(ROOT / place, source)


def test_writers_of_result_files_may_import_their_form() -> None:
    assert not breaches(ROOT / "verification/runner.py", "from reports.result_files import write_result")


def test_the_command_line_may_import_reports() -> None:
    assert not breaches(ROOT / "verification/cli/report.py", "from reports.generator import render")
