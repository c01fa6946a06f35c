"""The score of a mutation run with its confidence bound, and the survivors with their explanations."""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from verification.mutation.session import Record
from verification.mutation.targets import TARGETS, Target

GOAL = 0.95
CONFIDENCE = 0.95
EXPLAINED = Path(__file__).with_name("explained.toml")
Change = tuple[str, str, str]
"""Module, and the changed lines before and after."""


def explanations(path: Path = EXPLAINED) -> dict[Change, str]:
    """Reasons for equivalence of mutants with the original, by their change; each once.

    Raises ValueError for an empty reason, and for a second one.
    """
    modules = tomllib.loads(path.read_text(encoding="utf-8")).get("equivalent", {})
    entries = [
        ((module, before, after), reason)
        for module, reasons in modules.items()
        for reason, changes in reasons.items()
        for before, after in changes
    ]
    if not all(reason.strip() for _, reason in entries):
        raise ValueError(f"{path.name}: an explanation is empty")
    if len(dict(entries)) < len(entries):
        raise ValueError(f"{path.name}: a mutant is explained twice")
    return dict(entries)


def lower_bound(killed: int, tried: int) -> float:
    """Clopper and Pearson's one-sided lower bound of the share, at `CONFIDENCE`.

    >>> round(lower_bound(299, 300), 4)    # 1 survivor of 300
    0.9843
    """
    from scipy.stats import beta

    return float(beta.ppf(1 - CONFIDENCE, killed, tried - killed + 1)) if killed else 0.0


def summary(
    records: Sequence[Record],
    population: int,
    seed: int,
    *,
    of: str = "numerics",
    targets: Sequence[Target] = TARGETS,
) -> dict[str, Any]:
    """Published results: scores in all, by subject and by operator, and every survivor.

    A mutant that needs more than its processor time counts as killed (``timeout``); equivalent ones, each
    with its reason, count neither way in ``score``, and as survivors in ``score_raw``.
    """
    subjects = {target.module: target.subject for target in targets}
    reasons = explanations()
    tried = [record for record in records if record["outcome"] != "void"]
    survivors = [record for record in tried if record["outcome"] == "survived"]
    return {
        **_score(tried, reasons),
        "of": of,
        "goal": GOAL,
        "confidence": CONFIDENCE,
        "candidates": population,
        "sample": len(records),
        "void": len(records) - len(tried),
        "seed": seed,
        "processor_seconds": round(sum(record["seconds"] for record in tried), 1),
        "by_subject": _table(tried, reasons, (subjects[record["module"]] for record in tried)),
        "by_module": _table(tried, reasons, (record["module"] for record in tried)),
        "by_operator": _table(tried, reasons, (record["stratum"] for record in tried)),
        "survivors": [
            {name: record[name] for name in ("module", "line", "operator", "before", "after")}
            | {"explained": reasons.get(_change(record))}
            for record in survivors
        ],
    }


def passes(found: dict[str, Any]) -> bool:
    """True if any mutant was tried, the score meets the goal, and every survivor is explained."""
    score = found["score"]
    return score is not None and score >= GOAL and all(s["explained"] for s in found["survivors"])


def _score(tried: Sequence[Record], reasons: dict[Change, str]) -> dict[str, object]:
    outcomes = Counter(record["outcome"] for record in tried)
    equivalent = sum(r["outcome"] == "survived" and _change(r) in reasons for r in tried)
    killed, judged = outcomes["killed"] + outcomes["timeout"], len(tried) - equivalent
    return {
        "score": killed / judged if judged else None,
        "score_lower_bound": lower_bound(killed, judged),
        "score_raw": killed / len(tried) if tried else None,
        "tried": len(tried),
        "killed": outcomes["killed"],
        "timeout": outcomes["timeout"],
        "survived": outcomes["survived"] - equivalent,
        "equivalent": equivalent,
    }


def _table(
    tried: Sequence[Record], reasons: dict[Change, str], names: Iterable[str]
) -> dict[str, dict[str, object]]:
    groups: dict[str, list[Record]] = {}
    for record, name in zip(tried, names, strict=True):
        groups.setdefault(name, []).append(record)
    return {name: _score(group, reasons) for name, group in groups.items()}


def _change(record: Record) -> Change:
    return record["module"], record["before"], record["after"]
