"""Determinism: what was compared is named, whether or not ducc0 is there."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.operators import transforms
from verification.cases.solvers import determinism


@pytest.mark.parametrize(("library", "note"), [("SciPy", determinism.WITHOUT_DUCC0), ("Ducc", "")])
def test_threads_of_a_library_that_is_not_there_are_unavailable(
    library: str, note: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    same = {name: (1.0).hex() for name in determinism.NUMBERS} | {"pressure": np.ones(1).tobytes().hex()}
    monkeypatch.setattr(determinism, "in_a_process", lambda *given, **threads: same)
    kind = getattr(transforms, library)
    monkeypatch.setattr(determinism, "fourier", object.__new__(kind))
    found = determinism.threads()
    assert (found.value, found.note) == (0.0, note)
    name = {"SciPy": "SciPy", "Ducc": "ducc0"}[library]
    assert list(found.data) == ["BLAS alone", f"BLAS and {name}'s transforms"]
