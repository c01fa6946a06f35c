"""Studies with result files of their own: a module each, named like its file, with a `build` function."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any

from reports.exhibit import Exhibit
from reports.results import OTHER_SHAPE, ResultFileError


def exhibit(name: str, document: Mapping[str, Any]) -> Exhibit:
    """Return the study's exhibit, by the module of its name.

    Raises ResultFileError where the file lacks what the module needs.
    """
    build = importlib.import_module(f"{__name__}.{name}").build
    try:
        built: Exhibit = build(document)
    except OTHER_SHAPE as lacking:
        raise ResultFileError(f"the study {name} lacks {lacking}") from lacking
    return built
