"""Register of cases: every module below `verification.cases` is imported, none can hide."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Iterable, Mapping
from fnmatch import fnmatchcase
from functools import wraps
from inspect import cleandoc, signature, unwrap
from typing import Any

from verification.framework.case import Case, Measured, Metric, Tier

CASES_PACKAGE = "verification.cases"

Function = Callable[[], Measured]

LABELS = {"Claim": "claim", "Source": "source", "Tolerance": "tolerance_reason"}
"""Labels of a case's texts in its docstring, and the names of these texts."""
DECLARED = ("title", *LABELS.values(), "metric", "tolerance", "tier")
"""What a row of a family may declare for its case."""
NOTHING: Mapping[str, Any] = {}

_declared: dict[str, Case] = {}


def case(
    id: str, *, metric: str, tolerance: float, tier: str = "quick", **texts: str
) -> Callable[[Function], Function]:
    """Declare the decorated function, which is returned unchanged, as a verification case.

    `metric` is a value of `Metric`, `tier` one of `Tier`. Title, claim, source and reason of the tolerance
    stand in the function's docstring (see `described`); `texts` replaces them by name. Raises ValueError, at
    import, for a second case of the same id and for whatever `Case` refuses.
    """

    def declare(function: Function) -> Function:
        new = Case(
            id=id,
            **{**described(function), **texts},
            metric=Metric(metric),
            tolerance=tolerance,
            function=function,
            tier=Tier(tier),
        )
        old = _declared.get(id)
        if old is not None:
            # one line compiled again, as by `importlib.reload`, is no second declaration; a loop's is
            same_line = (old.module, old.line) == (new.module, new.line)
            if not same_line or old.code is new.code:
                places = f"{old.module}:{old.line} and {new.module}:{new.line}"
                raise ValueError(f"case {id!r} is declared twice: {places}")
        _declared[id] = new
        return function

    return declare


def described(function: Callable[..., Measured], row: Mapping[str, Any] = NOTHING) -> dict[str, str]:
    """Return the texts of a case from its docstring: the title, then a paragraph of ``Label: text``.

    Labels are Claim, Source and Tolerance. A line without a label continues the text before it; a text
    that is missing is empty. Braces hold an entry of the row, or a constant of the function's module.
    """
    title, labelled, *_ = *cleandoc(function.__doc__ or "").split("\n\n"), ""
    name = "title"
    texts = {name: " ".join(title.split("\n")).removesuffix("."), **dict.fromkeys(LABELS.values(), "")}
    for line in labelled.splitlines():
        label, _, text = line.partition(": ")
        if label in LABELS:
            name = LABELS[label]
            texts[name] = text
        elif name != "title":
            texts[name] += f" {line}"
    words = {**unwrap(function).__globals__, **row}
    return {name: text.format_map(words) for name, text in texts.items()}


def family(
    columns: str, rows: Mapping[str, tuple[Any, ...]], **declared: Any
) -> Callable[[Callable[..., Measured]], Callable[..., Measured]]:
    """Declare one case for each of `rows`, by id; the decorated function computes all of them.

    The columns, named "a, b, c", are the function's arguments, what a case alone declares (`title`,
    `tolerance`, ...), and words of the docstring, which holds for all rows and names columns in braces.
    """

    def declare(function: Callable[..., Measured]) -> Callable[..., Measured]:
        for id, entries in rows.items():
            row = dict(zip(columns.split(", "), entries, strict=True))
            arguments = {name: row[name] for name in signature(function).parameters}

            @wraps(function, assigned=("__module__", "__name__"))  # where the runner's workers look for it
            def run(arguments: Mapping[str, Any] = arguments) -> Measured:
                return function(**arguments)

            own = {name: entry for name, entry in row.items() if name in DECLARED}
            case(id, **{**described(function, row), **declared, **own})(run)
        return function

    return declare


def load(package: str = CASES_PACKAGE) -> tuple[Case, ...]:
    """Return all cases below `package`, by module and line; a module that does not import stops the run."""
    root = importlib.import_module(package)
    for module in pkgutil.walk_packages(root.__path__, prefix=f"{package}."):
        importlib.import_module(module.name)
    inside = [c for c in _declared.values() if c.module.startswith(f"{package}.")]
    return tuple(sorted(inside, key=lambda c: (c.module, c.line, c.id)))


def select(cases: Iterable[Case], tier: Tier, globs: Iterable[str] = ()) -> tuple[Case, ...]:
    """Return a tier's cases by `globs` (or all), in order. LookupError where one, or all, match none."""
    patterns = tuple(globs)
    in_tier = [c for c in cases if tier is Tier.FULL or c.tier is Tier.QUICK]
    chosen = tuple(c for c in in_tier if not patterns or any(fnmatchcase(c.id, p) for p in patterns))
    idle = [p for p in patterns if not any(fnmatchcase(c.id, p) for c in chosen)]
    if idle or not chosen:
        raise LookupError(f"no case of the {tier.value} tier matches {', '.join(idle) or 'anything'}")
    return chosen


def find(id: str) -> Case:
    """Return the declared case of this id; KeyError when no module imported so far declares it."""
    return _declared[id]
