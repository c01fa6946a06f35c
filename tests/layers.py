"""Imports of the project, read from the source: lazy imports and those for type checking count as well."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("refimpl", "appendix_a", "verification", "reports")
FILES = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def modules(package: str) -> dict[str, Path]:
    return {module_name(path): path for path in sorted((ROOT / package).rglob("*.py"))}


def imported_names(source: str) -> Iterator[tuple[int, str]]:
    """Line and full name of every import: module, or module and attribute."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = "a relative import" if node.level else node.module or ""
            yield from ((node.lineno, f"{base}.{alias.name}") for alias in node.names)


@cache
def uses(name: str, package: str) -> frozenset[str]:
    known = modules(package)
    found = set()
    for _, full in imported_names(known[name].read_text(encoding="utf-8")):
        while full and full not in known:
            full = full.rpartition(".")[0]
        found.add(full)
    return frozenset(found - {"", name, package})


@cache
def closure(name: str, package: str = "refimpl") -> frozenset[str]:
    """All modules that a module imports, directly or not, with itself."""
    found, waiting = {name}, [name]
    while waiting:
        new = uses(waiting.pop(), package) - found
        found |= new
        waiting.extend(new)
    return frozenset(found)


def room(name: str) -> str:
    """The room of a module: the folder or file directly below its package."""
    parts = name.split(".")
    return parts[1] if len(parts) > 1 else ""


def attribute_reads(name: str, package: str, attributes: set[str]) -> set[str]:
    """Which of these attributes a module reads or writes, whatever of."""
    tree = ast.parse(modules(package)[name].read_text(encoding="utf-8"))
    return {n.attr for n in ast.walk(tree) if isinstance(n, ast.Attribute) and n.attr in attributes}
