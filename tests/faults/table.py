"""The table of single faults in code that the production solver uses."""

from __future__ import annotations

import tomllib
from typing import NamedTuple

from tests.layers import ROOT


class Fault(NamedTuple):
    """A replacement of ``old``, once in ``refimpl/file``; ``unseen``: why it changes no number."""

    id: str
    area: str
    file: str
    old: str
    new: str
    unseen: str = ""


TABLE = tomllib.loads((ROOT / "tests/faults/faults.toml").read_text("utf-8"))["fault"]
FAULTS = {table["id"]: Fault(**table) for table in TABLE}
