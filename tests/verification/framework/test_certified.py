"""The guard of cases: only solutions that ended well are compared."""

from __future__ import annotations

from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import pytest

from refimpl import Status
from verification.framework.certified import certified


@pytest.mark.parametrize("cycled", [False, True])
@pytest.mark.parametrize("status", Status)
def test_only_what_ended_well_is_certified(status: Status, cycled: bool) -> None:
    good = (Status.CONVERGED, Status.CYCLED)
    found: Any = SimpleNamespace(status=status, converged=status in good, grid=SimpleNamespace(shape=(2, 2)))
    passes = status in good[: 1 + cycled]
    with nullcontext() if passes else pytest.raises(RuntimeError, match=f"ended {status.value}"):
        assert certified(found, cycled=cycled) is found
