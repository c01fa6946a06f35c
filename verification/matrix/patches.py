"""How a local fault is described: by what it replaces, found among the modules imported so far."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from typing import Any

from verification.faults import Fault, Patch

LocalFault = tuple[str, Callable[[], Iterable[Patch]]]
"""What is wrong, and its patches once all checks are imported."""

OURS = ("refimpl", "appendix_a", "verification")


def everywhere(right: Any, wrong: Any) -> tuple[Patch, ...]:
    """Patches of every module that holds this function, under whatever name."""
    found = []
    for name, module in sorted(sys.modules.items()):
        if (
            name.partition(".")[0] in OURS
            and module is not None
            and not name.startswith("verification.matrix")
        ):
            found += [(module, key, wrong) for key, value in vars(module).items() if value is right]
    return tuple(found)


def wrapped(right: Callable[..., Any], change: Callable[[Any], Any]) -> tuple[Patch, ...]:
    """Patches that change what the function returns."""
    return everywhere(right, lambda *args, **kwargs: change(right(*args, **kwargs)))


def fault(local: LocalFault) -> Fault:
    """The fault with its patches."""
    what, patches = local
    return Fault(what, tuple(patches()), seen_by="")
