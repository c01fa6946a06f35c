"""Studies with result files of their own: a module each, named like its file, with a `build` function."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Mapping
from typing import Any

from reports.exhibit import Exhibit, Table
from reports.results import ResultFileError


def exhibit(name: str, document: Mapping[str, Any]) -> Exhibit:
    """The study's exhibit, by the module of its name, or its single numbers where there is none.

    Raises ResultFileError where the file lacks what the module needs.
    """
    module = f"{__name__}.{name}"
    if importlib.util.find_spec(module) is None:
        return _plain(name, document)
    try:
        built: Exhibit = importlib.import_module(module).build(document)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as lacking:
        raise ResultFileError(f"the study {name} lacks {lacking}") from lacking
    return built


def _plain(name: str, document: Mapping[str, Any]) -> Exhibit:
    rows = [(key, value) for key, value in document.items() if isinstance(value, str | float | int | bool)]
    title = name.replace("_", " ").capitalize()
    return Exhibit(title, tables=[Table("Its single numbers.", ("name", "value"), rows)])
