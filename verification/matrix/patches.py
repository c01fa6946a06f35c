"""Description of a local fault: by the replaced object, found among the modules imported so far."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from verification.matrix import faults
from verification.matrix.faults import Fault, Patch

LocalFault = tuple[str, Callable[[], Iterable[Patch]]]
"""What is wrong, and its patches once all checks are imported."""

OURS = ("refimpl", "appendix_a", "verification")


def everywhere(right: Any, wrong: Any) -> tuple[Patch, ...]:
    """Patches of every module that holds this function by now, but for those that describe faults."""
    found = faults.everywhere(right, wrong, OURS)
    return tuple(patch for patch in found if not patch[0].__name__.startswith("verification.matrix"))


def wrapped(right: Callable[..., Any], change: Callable[[Any], Any]) -> tuple[Patch, ...]:
    """Patches that change what the function returns."""
    return everywhere(right, lambda *args, **kwargs: change(right(*args, **kwargs)))


def fault(local: LocalFault) -> Fault:
    """The fault with its patches."""
    what, patches = local
    return Fault(what, tuple(patches()), seen_by="")
