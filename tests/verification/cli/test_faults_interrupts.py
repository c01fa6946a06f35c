"""Interrupts and kills: the old result stays whole, no other file is left, and a sweep goes on."""

from __future__ import annotations

import gc
import os
import signal
import time
from itertools import count
from pathlib import Path

import pytest

from refimpl.solvers.production.projected_cg import ProjectedCG
from tests.verification.cli.children import LONG, STUDY, Ended, forked, rows, started
from verification.cli import main
from verification.sweep import engine
from verification.sweep.study_file import study_from_dict


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL, signal.SIGTERM])
def test_an_interrupted_solve_leaves_the_old_result_and_no_other_file(
    tmp_path: Path, how: signal.Signals
) -> None:
    (tmp_path / "s.json").write_text("old")
    act = forked_solve(tmp_path, how)
    assert act.status == (130 if how is signal.SIGINT else -how)
    assert "Traceback" not in act.err
    assert [p.name for p in tmp_path.iterdir()] == ["s.json"]
    assert (tmp_path / "s.json").read_text() == "old"


def forked_solve(folder: Path, how: signal.Signals) -> Ended:
    """A solve that is interrupted in its 20th step, on any machine: no clock is asked."""
    steps, iterate = count(1), ProjectedCG.iterate

    def interrupted(solver: ProjectedCG) -> None:
        if next(steps) == 20:
            os.kill(os.getpid(), how)
        iterate(solver)

    def act() -> int:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in a shell's background job
        ProjectedCG.iterate = interrupted  # type: ignore[method-assign]  # in the child alone
        return main([*LONG, "--json", str(folder / "s.json")])

    return forked(act)


def test_a_child_has_no_callback_of_the_garbage_collector_that_an_interrupt_is_lost_in() -> None:
    def callback(phase: str, information: dict[str, int]) -> None:
        """Takes what is raised while it runs, as hypothesis's does."""

    gc.callbacks.append(callback)
    try:
        assert forked(lambda: len(gc.callbacks)).status == 0
    finally:
        gc.callbacks.remove(callback)


def test_an_interrupted_sweep_keeps_what_it_finished_and_goes_on(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    tail = ["study.toml", "--store", "s.sqlite", "--workers", "1", "--csv", "s.csv"]
    child = started(["sweep", *tail], tmp_path)
    deadline = time.monotonic() + 60
    while rows(tmp_path / "s.sqlite") < 2 and time.monotonic() < deadline:
        time.sleep(0.02)
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=60)
    assert child.returncode == 130
    assert "Traceback" not in err
    assert "runs are kept in s.sqlite; the same command resumes" in err
    kept = rows(tmp_path / "s.sqlite")
    assert 2 <= kept < 80
    assert not (tmp_path / "s.csv").exists()
    done = engine.sweep(study_from_dict(tomllib_of(STUDY)), tmp_path / "s.sqlite", workers=0)
    assert (done.found, done.found + done.finished) == (kept, 80)


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="processes are looked up in /proc")
def test_an_interrupted_map_ends_at_once_with_its_workers(tmp_path: Path) -> None:
    tail = ["--slopes-deg", "2.5,5,10,20", "--wavelengths", "8,16,32,64", "--jobs", "2", "--json", "m.json"]
    child = started(["appendix-a", "map", *tail], tmp_path)
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        workers = children_of(child.pid)
        if len(workers) == 2 and all(map(ignores_interrupts, workers)):
            break
        time.sleep(0.05)
    time.sleep(1.0)  # Python loses an interrupt that comes within a fork
    for process in (*workers, child.pid):  # as a terminal does
        os.kill(process, signal.SIGINT)
    _, err = child.communicate(timeout=20)  # the whole map takes minutes; the workers hold the pipes too
    assert child.returncode == 130
    assert err == ""
    assert not any(Path(f"/proc/{pid}").exists() for pid in workers)
    assert list(tmp_path.iterdir()) == []


def children_of(pid: int) -> list[int]:
    return [int(found) for found in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def ignores_interrupts(pid: int) -> bool:
    status = dict(line.split(":", 1) for line in Path(f"/proc/{pid}/status").read_text().splitlines())
    return bool(int(status["SigIgn"], 16) >> (signal.SIGINT - 1) & 1)


def tomllib_of(text: str) -> dict[str, object]:
    import tomllib

    return tomllib.loads(text)
