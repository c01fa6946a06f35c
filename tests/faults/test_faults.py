"""Faults in copies of the production solver that only the comparison with the one-file reference sees."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.faults.scenes import SEEDS, Record, difference, expected
from tests.layers import ROOT

LEAST = 1e-6  # relative difference that counts
SECONDS = 120  # limit of one process


class Fault(NamedTuple):
    """A replacement of ``old``, once in ``refimpl/file``."""

    id: str
    file: str
    old: str
    new: str


TABLE = tomllib.loads((ROOT / "tests/faults/faults.toml").read_text("utf-8"))
FAULTS = [Fault(**row) for row in TABLE["fault"]]


def solved(folder: Path, fault: Fault | None = None) -> dict[str, Record]:
    """Return the records of the scenes by a copy of `refimpl`, with a fault in it if one is given."""
    shutil.copytree(ROOT / "refimpl", folder / "refimpl")
    if fault:
        path = folder / "refimpl" / fault.file
        path.write_text(path.read_text("utf-8").replace(fault.old, fault.new), "utf-8")
    command = [sys.executable, "-W", "ignore", "-m", "tests.faults.scenes"]
    environment = os.environ | {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}", "OPENBLAS_NUM_THREADS": "1"}
    printed = subprocess.check_output(command, cwd=folder, env=environment, timeout=SECONDS)
    return dict(json.loads(printed))


@cache
def reference(name: str) -> Record:
    return expected(name)


def test_the_source_has_the_text_of_each_fault_once() -> None:
    sources = {fault.file: (ROOT / "refimpl" / fault.file).read_text("utf-8") for fault in FAULTS}
    assert [f.id for f in FAULTS if sources[f.file].count(f.old) != 1 or f.new == f.old] == []


def test_without_a_fault_production_agrees(tmp_path: Path) -> None:
    records = solved(tmp_path)
    for name in SEEDS:
        assert difference(records[name], reference(name)) < 1e-9
        assert records[name]["status"] == reference(name)["status"]


SPECIMENS = ("slope-across-sign", "reach-half")
"""Faults that `make test` tries, of the slopes and of tau: the comparison is the same for all."""


@pytest.mark.parametrize(
    "fault",
    [pytest.param(f, id=f.id, marks=[] if f.id in SPECIMENS else [pytest.mark.nightly]) for f in FAULTS],
)
def test_only_the_comparison_notices(fault: Fault, tmp_path: Path) -> None:
    records = solved(tmp_path, fault)
    assert max(difference(records[name], reference(name)) for name in SEEDS) > LEAST
    assert {record["status"] for record in records.values()} <= {"converged", "cycled"}
