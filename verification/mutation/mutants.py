"""All mutants of a module: cosmic-ray's operators, exchanges, and removed statements.

Excluded, since such mutants never survive or never differ: bit operations on floats and dropped decorators
(the import already fails), and changes in annotations and docstrings.
"""

from __future__ import annotations

import ast
import difflib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice, permutations
from typing import Any

from verification.framework.case import Unavailable
from verification.mutation import exchanges

ARITHMETIC = ("Add", "Sub", "Mul", "Div", "FloorDiv", "Mod", "Pow")
NEW_ARITHMETIC = ("Add", "Sub", "Mul", "Div", "Pow")
BITS = ("BitOr", "BitAnd", "BitXor")
REMOVED = "RemoveStatement"
ORDER = ("Eq", "NotEq", "Lt", "LtE", "Gt", "GtE")
WORDS = (("Is", "IsNot"), ("IsNot", "Is"))

OPERATORS: dict[str, tuple[str, ...]] = {
    "arithmetic": tuple(
        f"ReplaceBinaryOperator_{old}_{new}" for old in ARITHMETIC for new in NEW_ARITHMETIC if old != new
    )
    + tuple(f"ReplaceBinaryOperator_{old}_{new}" for old, new in permutations(BITS, 2)),
    "comparison": tuple(
        f"ReplaceComparisonOperator_{old}_{new}" for old, new in (*permutations(ORDER, 2), *WORDS)
    ),
    "sign": tuple(f"ReplaceUnaryOperator_Delete_{old}" for old in ("USub", "Invert", "Not")),
    "number": ("NumberReplacer",),
    "logic": (
        "AddNot",
        "ReplaceAndWithOr",
        "ReplaceOrWithAnd",
        "ReplaceTrueWithFalse",
        "ReplaceFalseWithTrue",
    ),
    "flow": (
        "ReplaceBreakWithContinue",
        "ReplaceContinueWithBreak",
        "ZeroIterationForLoop",
        "ExceptionReplacer",
    ),
}
"""Strata of the sample, and cosmic-ray's operators in each; removed statements are another one."""


@dataclass(frozen=True)
class Candidate:
    """The ``occurrence``-th place of ``module`` (a path) where an operator applies."""

    module: str
    stratum: str
    operator: str
    occurrence: int


@dataclass(frozen=True)
class Mutant:
    """A candidate's changed source; ``before`` and ``after`` are the lines that differ, from ``line`` on."""

    candidate: Candidate
    line: int
    before: str
    after: str
    source: str


def candidates(module: str, source: str) -> list[Candidate]:
    """Every place where an operator applies to the module's source. Raises Unavailable without cosmic-ray."""
    ast_nodes, get_ast, operator_named, _ = cosmic_ray()
    nodes = list(ast_nodes(get_ast(source)))
    found = [
        Candidate(module, stratum, name, occurrence)
        for stratum, names in OPERATORS.items()
        for name in names
        for occurrence in range(sum(len(list(operator_named(name).mutation_positions(n))) for n in nodes))
    ]
    removed = len(list(without_statements(source)))
    found += [
        Candidate(module, exchanges.STRATUM, name, occurrence)
        for name in exchanges.OPERATORS
        for occurrence in range(len(list(exchanges.exchanged(source, name))))
    ]
    return found + [Candidate(module, "statement", REMOVED, occurrence) for occurrence in range(removed)]


def mutant(candidate: Candidate, source: str) -> Mutant | None:
    """The candidate applied to its module's source; None when no Python comes of it, or no other meaning."""
    if candidate.operator == REMOVED:
        changed = next(islice(without_statements(source), candidate.occurrence, None))
    elif candidate.operator in exchanges.OPERATORS:
        changed = next(islice(exchanges.exchanged(source, candidate.operator), candidate.occurrence, None))
    else:
        *_, operator_named, mutate_code = cosmic_ray()
        changed = mutate_code(source, operator_named(candidate.operator), candidate.occurrence)
    if _meaning(changed) in (None, _meaning(source)):
        return None
    return Mutant(candidate, *_difference(source, changed), changed)


def cosmic_ray() -> tuple[Callable[..., Any], Callable[..., Any], Callable[[str], Any], Callable[..., str]]:
    """cosmic-ray's nodes of a tree, tree of a source, operator of a name, and source that it changes."""
    try:
        from cosmic_ray.ast import ast_nodes, get_ast
        from cosmic_ray.mutating import mutate_code
        from cosmic_ray.plugins import get_operator
    except ImportError as missing:
        raise Unavailable("cosmic-ray is not installed: pip install '.[mutation]' in a checkout") from missing
    return ast_nodes, get_ast, lambda name: get_operator(f"core/{name}")(), mutate_code


def without_statements(source: str) -> Iterator[str]:
    """The source with one statement of a function replaced by ``pass``, for each that may go unmissed.

    These are calls, in-place changes, and assignments to something that exists before; without any other
    assignment, or a return, the function fails at once.

    >>> changed = without_statements("def f(a):\\n    b = a\\n    b += 1\\n    return b")
    >>> [text.splitlines()[2] for text in changed]
    ['    pass']
    """
    lines = source.splitlines(keepends=True)
    for function in ast.walk(ast.parse(source)):
        if isinstance(function, ast.FunctionDef):
            known = {argument.arg for argument in ast.walk(function.args) if isinstance(argument, ast.arg)}
            for statement in _statements(function.body):
                if _removable(statement, known):
                    first, last = statement.lineno - 1, (statement.end_lineno or statement.lineno) - 1
                    gap = lines[first][: statement.col_offset] + "pass\n"
                    yield "".join([*lines[:first], gap, *lines[last + 1 :]])


def _statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Simple statements in the order they are written, those of nested blocks included, but no functions'."""
    for statement in body:
        if isinstance(statement, ast.FunctionDef):
            continue
        inner = [getattr(statement, name, []) for name in ("body", "orelse", "finalbody")]
        if any(inner):
            for block in inner:
                yield from _statements(block)
        else:
            yield statement


def _removable(statement: ast.stmt, known: set[str]) -> bool:
    """Whether the function may go on without it; names that it assigns are added to ``known``."""
    if isinstance(statement, ast.Expr):
        return not isinstance(statement.value, ast.Constant)
    if isinstance(statement, ast.AugAssign):
        return True
    if not isinstance(statement, ast.Assign):
        return False
    nodes = [node for target in statement.targets for node in ast.walk(target)]
    names = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    missed = names - known
    known |= names
    return not missed


def _meaning(source: str) -> str | None:
    """The source's syntax tree without annotations and docstrings; None when it is no Python."""
    try:
        tree = ast.parse(source)
    except SyntaxError:
        return None
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            node.returns = None
        elif isinstance(node, ast.arg):
            node.annotation = None
        elif isinstance(node, ast.AnnAssign):
            node.annotation = ast.Constant(None)
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            node.value = ast.Constant(None)
    return ast.dump(tree)


def _difference(old: str, new: str) -> tuple[int, str, str]:
    """Number of the first changed line, and the changed lines before and after, on one line each."""
    a, b = old.splitlines(), new.splitlines()
    first = next(i for i, (x, y) in enumerate(zip([*a, ""], [*b, ""], strict=False)) if x != y)
    pieces: tuple[list[str], list[str]] = ([], [])
    for tag, i, j, k, m in difflib.SequenceMatcher(None, a, b, autojunk=False).get_opcodes():
        if tag != "equal":
            pieces[0].extend(a[i:j])
            pieces[1].extend(b[k:m])
    before, after = (" ".join(" ".join(lines).split()) for lines in pieces)
    return first + 1, before, after
