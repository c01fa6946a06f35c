"""Chaos in small: every kind of disturbance once; another table is seen."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from reports.result_files import read_result
from reports.studies import exhibit
from verification.chaos import campaign as module
from verification.chaos.__main__ import main


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tenth of the study."""
    monkeypatch.setattr(module, "STUDY", module.STUDY.replace("= 60", "= 6"))
    monkeypatch.setattr(module, "RUNS", module.RUNS // 10)


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize("fault", [fault for fault in module.FAULTS if fault != "scheduler"])
def test_a_disturbed_sweep_ends_with_the_undisturbed_table(fault: str, tmp_path: Path) -> None:
    expected = module.undisturbed(tmp_path)
    disturbed = module.Disturbed(tmp_path, random.Random(3), False, tmp_path / "s.sqlite")
    disturbed.disturb(fault)
    assert disturbed.finish() == expected
    (attempt,) = disturbed.log
    assert not attempt["traceback"]
    assert attempt["lines"] <= 1 or attempt["status"] < 0  # Python's own word on a killed parent's semaphores


@pytest.mark.usefixtures("small")
def test_another_table_is_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CLUSTERS", 0.0)
    monkeypatch.setattr(module, "undisturbed", lambda folder: "another")
    path = tmp_path / "c.json"
    assert main(["--sweeps", "1", "--json", str(path)]) == 1
    found = read_result(path)
    assert (found["sweeps"], found["different"]) == (1, 1)
    assert "1 sweeps" in exhibit("chaos", found).paragraphs[0]
