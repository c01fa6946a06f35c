"""Digest of the code behind a result: a module and all modules of this project that it imports.

Comments and docstrings do not count: they change no result.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterator
from pathlib import Path

from verification.framework.provenance import ROOT


def code_digest(*modules: str, root: Path = ROOT) -> str:
    """Return the digest of the modules and of those that they import, directly or not.

    A package's own file counts only where the package is imported, as by ``from refimpl.grid import Array``.
    Raises LookupError for a module that is not in the project.

    >>> code_digest("refimpl.errors") == code_digest("refimpl.grid")
    False
    """
    if unknown := [name for name in modules if _file(root, name) is None]:
        raise LookupError(f"no module of this project: {', '.join(unknown)}")
    found: dict[str, str] = {}
    waiting = list(modules)
    while waiting:
        name = waiting.pop()
        file = _file(root, name)
        if file is not None and name not in found:
            tree = ast.parse(file.read_bytes())
            waiting += _imported(tree)
            found[name] = code_of(tree)
    return hashlib.sha256(repr(sorted(found.items())).encode()).hexdigest()[:12]


def code_of(tree: ast.Module) -> str:
    """Return the syntax tree as text, its docstrings removed in place."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            node.body = [line for line in node.body if not _is_text(line)]
    return ast.dump(tree)


def _is_text(line: ast.stmt) -> bool:
    return (
        isinstance(line, ast.Expr)
        and isinstance(line.value, ast.Constant)
        and isinstance(line.value.value, str)
    )


def _file(root: Path, module: str) -> Path | None:
    path = root.joinpath(*module.split("."))
    return next((file for file in (path.with_suffix(".py"), path / "__init__.py") if file.is_file()), None)


def _imported(tree: ast.Module) -> Iterator[str]:
    """Names that may be modules: of ``from a.b import c`` both ``a.b.c`` and ``a.b``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module is not None and node.level == 0:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
