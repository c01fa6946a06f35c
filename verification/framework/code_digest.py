"""Code without what changes no result: comments and docstrings."""

from __future__ import annotations

import ast


def code_of(tree: ast.Module) -> str:
    """Return the syntax tree as text, its docstrings removed in place.

    >>> code_of(ast.parse("a = 1  # one")) == code_of(ast.parse("'Docstring.'\\na = 1"))
    True
    """
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
