"""Faults that only the comparison with the one-page reference sees; `make nightly` runs the whole table."""

from __future__ import annotations

import pytest

from tests.faults.run import FAULTS, LEAST, TABLE, judged, references
from tests.faults.scenes import difference
from tests.layers import ROOT

SCENES = ("periodic approach", "cap of the upper body", "steep", "cycled")
ALONE = (
    "tilt-exchanged",
    "surface-half",
    "F-percent",
    "shear-compliance-half",
    "share-exchanged",
    "slope-across-sign",
    "F-traction-cosine",
    "mean-surface",
    "softer-exchanged",
    "symbol-shear-sign",
    "approach-datum",
    "reach-half",
)


def test_the_source_has_the_text_of_each_fault_once() -> None:
    assert len(FAULTS) == len(TABLE) >= 60
    sources = {fault.file: (ROOT / "refimpl" / fault.file).read_text("utf-8") for fault in FAULTS.values()}
    assert [f.id for f in FAULTS.values() if sources[f.file].count(f.old) != 1 or f.new == f.old] == []


def test_without_a_fault_production_agrees() -> None:
    plain, unpatched = references(SCENES)
    for name in SCENES:
        assert difference(unpatched[name], plain[name])[0] < 1e-9
        assert unpatched[name]["status"] == plain[name]["status"]


@pytest.mark.parametrize("name", ALONE)
def test_only_the_comparison_notices(name: str) -> None:
    verdict = judged(FAULTS[name], SCENES)
    assert verdict.differs > LEAST
    assert verdict.silent
