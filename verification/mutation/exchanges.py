"""Mutants beside cosmic-ray's: exchanged arguments, columns and keys, and wrong units."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise

OPERATORS = ("ExchangeArguments", "ExchangeColumns", "ExchangeKeys", "ChangeUnit")
STRATUM = "exchange"
_UNITS = (1e-9, 1e-6, 1e-3, 100, 1e3, 1e6, 1e9)  # factors between units that people read
_WRONG = 1e3


def exchanged(source: str, operator: str) -> Iterator[str]:
    """Return the source with one exchange of the operator, for each place where it applies.

    Neighbours in a call, in a tuple or list, or among the values of a dictionary change places; a factor
    between units is a thousand times larger.

    >>> list(exchanged("f(a, b)", "ExchangeArguments")), list(exchanged("[x, y]", "ExchangeColumns"))
    (['f(b, a)'], ['[y, x]'])
    >>> list(exchanged("{'N': n, 'F': f}", "ExchangeKeys")), list(exchanged("1e6 * A", "ChangeUnit"))
    (["{'N': f, 'F': n}"], ['1000000000.0 * A'])
    """
    tree, raw = ast.parse(source), source.encode()
    starts = [0]
    for line in raw.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def place(node: ast.expr) -> slice:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return slice(
            starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset
        )

    for one, other in _pairs(tree, operator):
        first, second = place(one), place(other)
        if raw[first] != raw[second]:
            changed = raw[: first.start] + raw[second] + raw[first.stop : second.start] + raw[first]
            yield (changed + raw[second.stop :]).decode()
    if operator == "ChangeUnit":
        for number in _factors(tree):
            at = place(number)
            wrong = repr(float(number.value) * _WRONG)  # type: ignore[arg-type]  # a number of _UNITS
            yield (raw[: at.start] + wrong.encode() + raw[at.stop :]).decode()


def _pairs(tree: ast.Module, operator: str) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Neighbours that may change places."""
    for node in ast.walk(tree):
        several: list[list[ast.expr]] = []
        if operator == "ExchangeArguments" and isinstance(node, ast.Call):
            several = [node.args, [keyword.value for keyword in node.keywords if keyword.arg]]
        elif operator == "ExchangeColumns" and isinstance(node, ast.Tuple | ast.List):
            several = [node.elts] if isinstance(node.ctx, ast.Load) else []
        elif operator == "ExchangeKeys" and isinstance(node, ast.Dict):
            several = [[value for key, value in zip(node.keys, node.values, strict=True) if key]]
        for members in several:
            if not any(isinstance(member, ast.Starred) for member in members):
                yield from pairwise(members)


def _factors(tree: ast.Module) -> Iterator[ast.Constant]:
    """Numbers of `_UNITS` in products and quotients."""
    for node in ast.walk(tree):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
            sides = [side for side in (node.left, node.right) if isinstance(side, ast.Constant)]
            yield from (side for side in sides if type(side.value) in (int, float) and side.value in _UNITS)
