"""The fuzzing campaign in small, and proof that it sees what it is there for."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from refimpl.errors import InputError
from verification.fuzz.__main__ import main
from verification.fuzz.campaign import campaign, outcome
from verification.fuzz.mutations import mutated
from verification.fuzz.targets import Target, targets


@pytest.mark.parametrize("target", targets(), ids=lambda t: t.name)
def test_the_files_that_mutations_start_from_are_accepted(target: Target, tmp_path: Path) -> None:
    for valid in target.valid:
        assert outcome(target, valid, tmp_path) == "accepted"


def test_a_thousand_inputs_without_a_traceback_or_a_hang() -> None:
    found = campaign(1000, seed=9)
    assert found["inputs"] >= 1000
    assert (found["tracebacks"], found["hangs"], found["faults"]) == (0, 0, [])


def test_shares_add_up_and_seeds_repeat() -> None:
    assert sum(t.share for t in targets()) == pytest.approx(1.0)
    first, again = (mutated(b"load = 1.0\n" * 20, (b"side = 2",), random.Random(3)) for _ in range(2))
    assert first == again


def breaks(path: Path) -> None:
    if b"x" in path.read_bytes():
        raise KeyError("no such thing")
    raise InputError("path", str(path), "an x")


def never_ends(_: Path) -> None:
    while True:
        pass


def test_tracebacks_and_hangs_are_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    broken = Target("broken", ".bin", (b"x",), breaks, 1.0)
    assert outcome(broken, b"x", tmp_path).startswith("KeyError at test_fuzz.py:")
    assert outcome(broken, b"y", tmp_path) == "refused"
    monkeypatch.setattr("verification.fuzz.campaign.SECONDS", 0.2)
    assert outcome(Target("endless", ".bin", (b"x",), never_ends, 1.0), b"x", tmp_path) == "hang"
    monkeypatch.setattr("verification.fuzz.campaign.targets", lambda: (broken,))
    assert main(["--inputs", "30", "--json", str(tmp_path / "log.json")]) == 1
