"""Both sheared rough contacts of the reference data are what the fast solver finds, too."""

from __future__ import annotations

import numpy as np
import pytest

from verification.output.result_files import read_result
from verification.solver_suite.reference.sheared_rough import FIELDS, FILE, NUMBERS, SCENES, entry

KEPT = read_result(FILE)["contacts"]


@pytest.mark.parametrize("name", SCENES)
def test_the_fast_solver_finds_the_fields_and_the_active_set(name: str) -> None:
    kept, found = KEPT[name], entry(SCENES[name], "fft")
    assert found["status"] == kept["status"]
    assert found["active set of tau"] == kept["active set of tau"]
    for field in FIELDS:
        off = np.abs(np.subtract(found[field], kept[field])).max()
        assert off <= 1e-8 * np.max(kept[field])  # tolerance of the certificate
    for number in NUMBERS:
        assert found[number] == pytest.approx(kept[number], rel=1e-8)
