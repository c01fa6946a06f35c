"""Processes that a solver leaves: which are ended, by what, and what is said of the others."""

from __future__ import annotations

import os
import signal

import pytest

from verification.solver_suite import orphans


def test_marked_processes_are_killed_and_others_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """7 is marked and leaves 8 when it dies, marked too; 9 is not; 5 is expected. No process may refuse."""
    marked, sent, alive = {7, 8}, list[tuple[int, int]](), {5, 7, 9}

    def kill(pid: int, number: int) -> None:
        sent.append((pid, number))
        alive.discard(pid)
        if pid == 7:
            alive.add(8)

    monkeypatch.setattr(orphans, "children", lambda: set(alive))
    monkeypatch.setattr(orphans, "_marked", lambda pid, mark: mark == "run 1" and pid in marked)
    monkeypatch.setattr(orphans, "_name", lambda pid: f"solver {pid}")
    monkeypatch.setattr(orphans, "_bury", lambda pid: None)
    monkeypatch.setattr(os, "kill", kill)
    found = orphans.end({5}, "run 1")
    assert sent == [(7, signal.SIGKILL), (8, signal.SIGKILL)]
    assert found == [
        "solver 7 (process 7): ended",
        "solver 8 (process 8): ended",
        "solver 9 (process 9): still running",
    ]
