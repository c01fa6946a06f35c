"""Sweeps: kept once each, whatever is killed, however many workers; refused where two would meet."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import pytest

from refimpl.errors import InputError
from tests.verification.cli.children import rows
from verification.cli import main
from verification.sweep import engine
from verification.sweep.export import to_csv
from verification.sweep.run import Run, execute
from verification.sweep.store import open_store
from verification.sweep.study import Study
from verification.sweep.study_file import study_from_dict

STUDY = """scene = "table1-rough"
realisations = 10
[vary]
grid = [12, 16]
lower_rms = [0.5e-6, 1.5e-6]
"""
ONE_THREAD = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def small(realisations: int = 2, grid: tuple[int, ...] = (12, 16)) -> Study:
    return study_from_dict(
        {"scene": "table1-rough", "realisations": realisations, "vary": {"grid": list(grid)}}
    )


def test_a_second_sweep_finds_everything_and_runs_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = tmp_path / "s.sqlite"
    first = engine.sweep(small(), store, workers=0)
    assert (first.found, first.finished, first.failures) == (0, 4, {})
    monkeypatch.setattr(engine, "execute", None)
    second = engine.sweep(small(), store, workers=0)
    assert (second.found, second.finished) == (4, 0)
    assert to_csv(second.rows) == to_csv(first.rows)


def test_a_larger_study_adds_to_the_store(tmp_path: Path) -> None:
    store = tmp_path / "s.sqlite"
    engine.sweep(small(1), store, workers=0)
    assert engine.sweep(small(3), store, workers=0).found == 2
    last = engine.sweep(small(2), store, workers=0)  # the store holds six
    assert (len(last.rows), last.found, last.finished) == (4, 4, 0)


def test_nothing_can_be_kept_twice(tmp_path: Path) -> None:
    done = engine.sweep(small(1), tmp_path / "s.sqlite", workers=0)
    run = next(iter(small(1).runs()))
    with open_store(tmp_path / "s.sqlite") as store, pytest.raises(sqlite3.IntegrityError):
        store.add(run, done.rows[0], 0.0)


def test_a_fault_of_the_callers_own_sql_is_no_bad_input(tmp_path: Path) -> None:
    path = tmp_path / "s.sqlite"
    with pytest.raises(sqlite3.OperationalError, match="no such table"), open_store(path) as store:
        store._connection.execute("select 1 from nowhere")
    with open_store(path):  # and the lock is given back
        pass


@pytest.mark.parametrize(
    ("stop", "said"),
    [("pragma query_only = on", "readonly"), ("pragma max_page_count = 1", "full")],
    ids=["read-only", "full"],
)
def test_a_store_that_can_no_longer_be_written_is_refused(tmp_path: Path, stop: str, said: str) -> None:
    stopped = f"{stop}; create table t as select zeroblob(100000)"
    with pytest.raises(InputError, match=said), open_store(tmp_path / "s.sqlite") as store:
        store._connection.executescript(stopped)


def test_a_point_without_roughness_is_one_run_of_all_its_realisations(tmp_path: Path) -> None:
    axes = {"grid": [8], "upper_rms": [0.0], "lower_rms": [0.0, 1e-6], "correlation_length": [1e-4, 2e-4]}
    study = study_from_dict({"scene": "table1-rough", "realisations": 2, "vary": axes})
    done = engine.sweep(study, tmp_path / "s.sqlite", workers=0)
    assert (done.found, done.finished) == (0, 1 + 2 * 2)
    assert [row["lower_rms"] for row in done.rows] == [0.0, 1e-6, 1e-6, 1e-6, 1e-6]


def test_a_grid_of_one_element_takes_time_too(tmp_path: Path) -> None:
    ticks: list[engine.Progress] = []
    done = engine.sweep(small(1, (1, 2)), tmp_path / "s.sqlite", workers=0, tick=ticks.append)
    assert (done.finished, done.failures) == (2, {})
    before, first, last = (tick.seconds_left for tick in ticks)
    assert before is None
    assert first is not None
    assert first > 0.0
    assert last == 0.0


def test_a_failed_run_is_told_not_kept_and_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = engine.execute

    def breaks(inputs: dict[str, int]) -> object:
        if inputs["grid"] == 16:
            raise ValueError("no luck")
        return real(inputs)

    monkeypatch.setattr(engine, "execute", breaks)
    ticks: list[engine.Progress] = []
    broken = engine.sweep(small(1), tmp_path / "s.sqlite", workers=0, tick=ticks.append)
    assert list(broken.failures.values()) == ["ValueError: no luck"]
    assert len(broken.rows) == broken.finished == 1
    assert (ticks[-1].done, ticks[-1].failed, ticks[-1].seconds_left) == (1, 1, 0.0)
    assert ticks[0].seconds_left is None
    monkeypatch.undo()
    mended = engine.sweep(small(1), tmp_path / "s.sqlite", workers=0)
    assert (mended.found, mended.finished, mended.failures) == (1, 1, {})


def test_two_sweeps_on_one_file_are_refused_and_readers_are_not(tmp_path: Path) -> None:
    path = tmp_path / "s.sqlite"
    engine.sweep(small(1), path, workers=0)
    with open_store(path):
        with pytest.raises(InputError, match="no other sweep"):
            engine.sweep(small(1), path, workers=0)
        assert sqlite3.connect(path).execute("select count(*) from runs").fetchone() == (2,)


@pytest.mark.parametrize("content", [b"not a database, but long enough to be looked at" * 50, None])
def test_alien_files_are_refused(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "alien.sqlite"
    if content is None:
        sqlite3.connect(path).execute("create table t (x)").connection.close()
    else:
        path.write_bytes(content)
    with pytest.raises(InputError, match="store"), open_store(path):
        pass
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="store"), open_store(tmp_path / "none" / "s.sqlite"):
        pass


def test_a_file_whose_creation_was_killed_is_new(tmp_path: Path) -> None:
    (tmp_path / "s.sqlite").touch()
    connection = sqlite3.connect(tmp_path / "s.sqlite")
    connection.execute("pragma journal_mode = wal")
    connection.close()
    assert engine.sweep(small(1, (12,)), tmp_path / "s.sqlite", workers=0).finished == 1


# Forks an interpreter that has everything imported, so that kills hit the sweep and not the start of Python.
KILLER = """
import os, random, signal, sys, time
from pathlib import Path
from verification.sweep import engine
from verification.sweep.export import to_csv
from verification.sweep.study_file import read_study

study, folder = read_study(sys.argv[1]), Path(sys.argv[2])
started = time.perf_counter()
undisturbed = to_csv(engine.sweep(study, folder / "undisturbed.sqlite", workers=0).rows)
seconds = time.perf_counter() - started
moments = random.Random(20010101)
progress = []
for _ in range(20):
    child = os.fork()
    if child == 0:
        engine.sweep(study, folder / "killed.sqlite", workers=0, tick=lambda p: None)
        os._exit(0)
    time.sleep(moments.uniform(0, seconds / 10))
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    if (folder / "killed.sqlite").exists():
        import sqlite3
        try:
            n = sqlite3.connect(folder / "killed.sqlite").execute("select count(*) from runs").fetchone()[0]
        except sqlite3.OperationalError:  # killed before the table was made
            n = 0
        progress.append(n)
done = engine.sweep(study, folder / "killed.sqlite", workers=0)
print(progress, done.found, done.finished, len(study))
assert progress == sorted(progress) and len(set(progress)) > 5, progress
assert done.found == progress[-1] and done.found + done.finished == len(study)
assert to_csv(done.rows) == undisturbed
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills by SIGKILL need a POSIX system")
def test_killed_twenty_times_gives_the_undisturbed_table(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY.replace("10", "20"))
    command = [sys.executable, "-c", KILLER, str(tmp_path / "study.toml"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, env=ONE_THREAD, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr


def children(pid: int) -> set[int]:
    """Processes whose parent is ``pid``, from /proc."""
    found = set()
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = entry.read_text().rpartition(")")[2].split()
        except (FileNotFoundError, ProcessLookupError):  # ended meanwhile
            continue
        if int(fields[1]) == pid:
            found.add(int(entry.parent.name))
    return found


def running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def test_the_killed_command_leaves_no_workers_and_resumes(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    tail = ["sweep", "study.toml", "--store", "s.sqlite", "--csv", "s.csv"]
    command = [sys.executable, "-c", "from verification.cli import main; raise SystemExit(main())", *tail]
    killed = subprocess.Popen(command, cwd=tmp_path, env=ONE_THREAD, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    while rows(tmp_path / "s.sqlite") < 3 and time.monotonic() < deadline:
        time.sleep(0.02)
    workers = children(killed.pid)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    assert len(workers) >= 2
    while any(map(running, workers)) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not any(map(running, workers))
    kept = rows(tmp_path / "s.sqlite")
    assert 3 <= kept < 40
    again = subprocess.run([*command, "--json", "s.json"], cwd=tmp_path, env=ONE_THREAD, capture_output=True)
    assert again.returncode == 0
    assert again.stderr == b""  # no progress line where stderr is no terminal
    assert json.loads((tmp_path / "s.json").read_text())["found"] == kept
    undisturbed = engine.sweep(study_from_toml(tmp_path), tmp_path / "other.sqlite", workers=0)
    assert numbers((tmp_path / "s.csv").read_text()) == numbers(to_csv(undisturbed.rows))


def numbers(table: str) -> list[str]:
    """Lines of a CSV without its last column, the seconds: all else is the same however often it is run."""
    return [line.rpartition(",")[0] for line in table.splitlines()]


def study_from_toml(folder: Path) -> Study:
    from verification.sweep.study_file import read_study

    return read_study(folder / "study.toml")


def killed(_: object) -> None:
    """In a worker: what the system does to it when memory runs out."""
    os.kill(os.getpid(), signal.SIGKILL)


def test_a_dead_worker_stops_the_sweep(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "execute", killed)
    study = small(1)
    with pytest.raises(engine.WorkersLost):
        engine.sweep(study, tmp_path / "d.sqlite", workers=1)


def test_cluster_gives_the_same_bytes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import distributed

    (tmp_path / "study.toml").write_text(STUDY.replace("10", "2"))
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        address = ["--scheduler", cluster.scheduler_address]
        files = ["--store", str(tmp_path / "c.sqlite"), "--csv", str(tmp_path / "c.csv")]
        assert main(["sweep", str(tmp_path / "study.toml"), *address, *files]) == 0
    here = engine.sweep(study_from_toml(tmp_path), tmp_path / "h.sqlite", workers=0)
    assert numbers((tmp_path / "c.csv").read_text()) == numbers(to_csv(here.rows))
    assert "finished now        8" in capsys.readouterr().out


def test_a_scheduler_that_is_not_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engine, "CONNECT_SECONDS", 0.5)
    (tmp_path / "study.toml").write_text(STUDY)
    for address in ("tcp://127.0.0.1:9", "nonsense://x"):
        arguments = ["sweep", str(tmp_path / "study.toml"), "--scheduler", address]
        assert main([*arguments, "--store", str(tmp_path / "s.sqlite")]) == 2
        assert "--scheduler" in capsys.readouterr().err
        assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


@pytest.mark.parametrize("kept", [0, 1])
def test_a_refusal_leaves_a_store_that_holds_something(tmp_path: Path, kept: int) -> None:
    path, study = tmp_path / "s.sqlite", small(1, (12,))

    def refused_after(runs: list[Run]) -> None:
        with open_store(path) as store:
            for run in runs:
                store.add(run, *execute(run.inputs))
            raise InputError("anything", 1, "something else")

    with pytest.raises(InputError, match="anything"):
        refused_after(list(study.runs())[:kept])
    assert sorted(file.name for file in tmp_path.iterdir()) == ["s.sqlite"][:kept]
    assert engine.sweep(study, path, workers=0).found == kept
    with pytest.raises(InputError, match="anything"):
        refused_after([])
    assert engine.sweep(study, path, workers=0).found == 1
