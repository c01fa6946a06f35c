"""Names in committed results of earlier versions, and what they are called now.

Results are recorded once and read for years: this table renames what they call otherwise, so that figures and
tables need to know one name only.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

RENAMED = {
    "shear coupling": "normal-tangential coupling",
    "shear tilt": "slope change by shear",
    "obliqueness": "slope terms",
    "tau support": "active set of tau",
    "left out": "neglected",
    "withheld": "excluded",
    "flat tips": "no slopes",
}
"""Parts of keys in a case's data."""


def renamed(data: Any) -> Any:
    """Return a case's data with today's names in the keys of all its tables.

    >>> renamed({"scene": [2031], "difference / bar": {"2031: 1 withheld": 0.5}})
    {'scene': [2031], 'difference / bar': {'2031: 1 excluded': 0.5}}
    """
    if isinstance(data, Mapping):
        return {_name(key): renamed(value) for key, value in data.items()}
    return data


def _name(key: str) -> str:
    for old, new in RENAMED.items():
        key = key.replace(old, new)
    return key
