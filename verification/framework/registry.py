"""Register of cases: every module below `verification.cases` is imported, none can hide."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Iterable
from fnmatch import fnmatchcase

from verification.framework.case import Case, Measured, Metric, Tier

CASES_PACKAGE = "verification.cases"

Function = Callable[[], Measured]

_declared: dict[str, Case] = {}


def case(
    id: str,
    *,
    title: str,
    claim: str,
    source: str,
    metric: str,
    tolerance: float,
    tolerance_reason: str,
    tier: str = "quick",
    tags: Iterable[str] = (),
) -> Callable[[Function], Function]:
    """Declare the decorated function as a verification case; the function itself is returned unchanged.

    `metric` is one of "relative", "absolute", "at_most", "at_least", "equal" (see `Metric`), `tier` "quick"
    or "full". Raises ValueError, at import, for a second case of the same id and for whatever `Case` refuses.
    """

    def declare(function: Function) -> Function:
        new = Case(
            id=id,
            title=title,
            claim=claim,
            source=source,
            metric=Metric(metric),
            tolerance=tolerance,
            tolerance_reason=tolerance_reason,
            function=function,
            tier=Tier(tier),
            tags=tuple(tags),
        )
        old = _declared.get(id)
        if old is not None and not _imported_anew(old, new):
            places = f"{old.module}:{old.line} and {new.module}:{new.line}"
            raise ValueError(f"case {id!r} is declared twice: {places}")
        _declared[id] = new
        return function

    return declare


def _imported_anew(old: Case, new: Case) -> bool:
    """Whether the same line of the same module was compiled again, as `importlib.reload` does.

    One compiled line that declares twice is a loop whose ids are not all different.
    """
    same_line = (old.module, old.line) == (new.module, new.line)
    return same_line and old.function.__code__ is not new.function.__code__


def load(package: str = CASES_PACKAGE) -> tuple[Case, ...]:
    """All cases declared below `package`, by module and line, whatever was imported before.

    A module that cannot be imported stops the run: its cases would otherwise be missing without a word.
    """
    root = importlib.import_module(package)
    for module in pkgutil.walk_packages(root.__path__, prefix=f"{package}."):
        importlib.import_module(module.name)
    inside = [c for c in _declared.values() if c.module.startswith(f"{package}.")]
    return tuple(sorted(inside, key=lambda c: (c.module, c.line, c.id)))


def select(cases: Iterable[Case], tier: Tier, globs: Iterable[str] = ()) -> tuple[Case, ...]:
    """The cases of a tier whose id matches any of `globs` (all, when there are none); order kept.

    Raises LookupError when nothing is left, or when one of the globs matches no case: an empty selection must
    not look like a run without failures.
    """
    patterns = tuple(globs)
    in_tier = [c for c in cases if tier is Tier.FULL or c.tier is Tier.QUICK]
    chosen = tuple(c for c in in_tier if not patterns or any(fnmatchcase(c.id, p) for p in patterns))
    idle = [p for p in patterns if not any(fnmatchcase(c.id, p) for c in chosen)]
    if idle or not chosen:
        raise LookupError(f"no case of the {tier.value} tier matches {', '.join(idle) or 'anything'}")
    return chosen


def find(id: str) -> Case:
    """The declared case of this id; KeyError when no module imported so far declares it."""
    return _declared[id]
