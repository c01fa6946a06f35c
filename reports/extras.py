"""Exhibits that modules of their own add to a chapter.

A module ``reports/NAME_figures.py`` takes part by defining ``CHAPTER``, the anchor of a chapter in
`reports.chapters` (or a new one), and ``exhibits(evidence)``. No other file names it.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping, Sequence
from types import ModuleType

import reports
from reports.evidence import Evidence
from reports.exhibit import Exhibit


def modules() -> list[ModuleType]:
    """The modules that take part, by name."""
    names = sorted(m.name for m in pkgutil.iter_modules(reports.__path__) if m.name.endswith("_figures"))
    found = [importlib.import_module(f"reports.{name}") for name in names]
    return [module for module in found if hasattr(module, "CHAPTER") and hasattr(module, "exhibits")]


def extra_exhibits(evidence: Evidence) -> Mapping[str, Sequence[Exhibit]]:
    """Exhibits by the anchor of their chapter."""
    found: dict[str, list[Exhibit]] = {}
    for module in modules():
        found.setdefault(module.CHAPTER, []).extend(module.exhibits(evidence))
    return found
