"""Solutions with other numbers or arrays than their own, which only a test can make."""

from __future__ import annotations

from typing import Any, TypeVar

Kept = TypeVar("Kept")


def changed(found: Kept, **attributes: Any) -> Kept:
    """Return a record that reads as the one found but for these attributes; ``details`` of a solution too.

    Those that the record has not are changes of its details.
    """
    kind = type(found)
    if unknown := [name for name in attributes if not hasattr(found, name)]:
        own = {name: attributes.pop(name) for name in unknown}
        attributes["details"] = changed(found.details, **own)  # type: ignore[attr-defined]
    made = object.__new__(type(kind.__name__, (kind,), attributes))
    vars(made).update({name: value for name, value in vars(found).items() if name not in attributes})
    return made
