"""Studies with result files of their own: a module each, named like its file, with a `build` function."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any

from reports.exhibit import Exhibit
from reports.results import shaped


def exhibit(name: str, document: Mapping[str, Any]) -> Exhibit:
    """Return the exhibit of the study's module. ResultFileError where the file lacks what it needs."""
    build = importlib.import_module(f"{__name__}.{name}").build
    with shaped(f"the study {name}"):
        built: Exhibit = build(document)
    return built
