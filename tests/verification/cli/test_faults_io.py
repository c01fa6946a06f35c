"""What a machine does to a program: full and read-only disks, files that others hold.

The tests may run as root, whom no file mode stops: a folder that refuses is played by the system call's
error, a full disk by /dev/full, a limit on the size of files, or a tiny file system if one mounts.
"""

from __future__ import annotations

import errno
import json
import os
import resource
import shutil
import signal
import sqlite3
import stat
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

import refimpl as rf
from tests.reports.sample import case, results
from tests.verification.cli.children import LONG, STUDY, Ended, forked, one_line, rows, small
from verification.cli import main, solve
from verification.framework import files
from verification.sweep import engine
from verification.sweep.store import open_store

SCENE = rf.scene_to_toml(rf.read_scene("hertz"))


def limited(size: int) -> Callable[[], None]:
    """No file may grow beyond ``size`` bytes; the signal for it is ignored, so that the write says EFBIG."""

    def act() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return act


@pytest.fixture
def tiny_disk(tmp_path: Path) -> Iterator[Path | None]:
    """A mounted file system of 64 kB with 12 kB left, or None where none may be mounted."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(folder)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode != 0:
        yield None
        return
    try:
        (folder / "ballast").write_bytes(bytes(52_000))
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=True)


# --- disks ---


@pytest.mark.parametrize("option", ["--json", "--vtk"])
def test_a_full_disk_costs_the_new_file_and_not_the_old(tmp_path: Path, option: str) -> None:
    path = tmp_path / {"--json": "s.json", "--vtk": "s.vtu"}[option]
    path.write_text("old")
    command = ["solve", "hertz", "--grid", "16", option, str(path)]
    one_line(forked(lambda: main(command), before=limited(500)), "File too large")
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_disk_that_is_really_full(tmp_path: Path, tiny_disk: Path | None) -> None:
    if tiny_disk is None:
        command = ["solve", "hertz", "--grid", "8", "--json", "/dev/full"]
    else:
        (tiny_disk / "more").write_bytes(bytes(65536 - 52000 - 4096))
        command = ["solve", "hertz", "--grid", "8", "--json", str(tiny_disk / "s.json")]
    one_line(forked(lambda: main(command)), "No space left")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
def test_devices_are_written_to_and_never_replaced() -> None:
    for name, status in (("/dev/full", 1), ("/dev/null", 0)):
        command = ["solve", "hertz", "--grid", "8", "--json", name]
        assert forked(partial(main, command)).status == status
        assert Path(name).is_char_device()
        assert not Path(name).is_file()


def test_a_full_disk_stops_a_sweep_that_goes_on_when_there_is_room(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    store = tmp_path / "s.sqlite"
    engine.sweep(small(2), store, workers=0)
    command = ["sweep", str(tmp_path / "study.toml"), "--store", str(store), "--workers", "1"]
    # above SQLite's shared memory of 32 kB, below what the log of 80 runs takes
    ended = forked(lambda: main(command), before=limited(50_000))
    one_line(ended, "disk I/O error", 2)
    kept = rows(store)
    assert kept >= 2
    assert sqlite3.connect(store).execute("pragma integrity_check").fetchone() == ("ok",)
    again = engine.sweep(small(3), store, workers=0)
    assert len(again.rows) == 3


@pytest.mark.parametrize("refusal", [errno.EROFS, errno.EACCES])
def test_a_read_only_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], refusal: int
) -> None:
    """Played by the error of the system call: the tests may run as root, whom no mode stops."""

    def refuses(*_: object, **__: object) -> None:
        raise OSError(refusal, os.strerror(refusal), str(tmp_path))

    def turns(*_: object, **__: object) -> None:  # read-only once the solve has begun
        monkeypatch.setattr(files.tempfile, "mkstemp", refuses)

    monkeypatch.setattr(solve, "check_suffix", turns)
    assert main(["solve", "hertz", "--grid", "8", "--json", str(tmp_path / "s.json")]) == 1
    ended = capsys.readouterr()
    one_line(Ended(1, ended.err), os.strerror(refusal))
    assert "status: CONVERGED" in ended.out
    with pytest.raises(SystemExit) as at_once:
        main([*LONG, "--json", str(tmp_path / "s.json")])
    assert at_once.value.code == 2
    assert os.strerror(refusal) in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_closed_pipe_ends_quietly_and_costs_no_file(tmp_path: Path) -> None:
    command = "import sys; from verification.cli import main; sys.exit(main())"
    arguments = [sys.executable, "-c", command, "solve", "hertz", "--grid", "8", "--json"]
    for name in ("s.json", "-"):
        reader, writer = os.pipe()
        os.close(reader)
        ended = subprocess.run([*arguments, name], cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE)
        os.close(writer)
        assert (ended.returncode, ended.stderr) == (0, b"")
    assert json.loads((tmp_path / "s.json").read_text())["status"] == "converged"


def test_an_unwritable_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "r.json").write_text(json.dumps(results(case("a/1"))))
    (none := tmp_path / "committed").mkdir()
    tail = ["--results", str(tmp_path / "r.json"), "--committed", str(none), "--output"]
    (tmp_path / "file").write_text("no folder")
    assert main(["report", *tail, str(tmp_path / "file")]) == 2
    one_line(Ended(2, capsys.readouterr().err), "--output", 2)

    def refuses(*_: object, **__: object) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), "report")

    monkeypatch.setattr(files.tempfile, "mkstemp", refuses)
    assert main(["report", *tail, str(tmp_path / "report")]) == 1
    one_line(Ended(1, capsys.readouterr().err), "Read-only")


def test_an_unwritable_folder_is_refused_before_any_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    places = [tmp_path / "none" / "s.json", tmp_path, tmp_path / (300 * "a"), tmp_path / f"a.{250 * 'b'}"]
    if Path("/proc/self").exists():
        places.append(Path("/proc/s.json"))
    for path in places:
        with pytest.raises(SystemExit) as refused:
            main([*LONG, "--json", str(path)])
        assert refused.value.code == 2
        err = capsys.readouterr().err
        assert err.count("\n") == 1
        assert "--json" in err
    assert list(tmp_path.iterdir()) == []


# --- two at once, broken files ---


def test_two_sweeps_on_one_file_by_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    with open_store(tmp_path / "s.sqlite"):
        command = ["sweep", str(tmp_path / "study.toml"), "--store", str(tmp_path / "s.sqlite")]
        assert main(command) == 2
    one_line(Ended(2, capsys.readouterr().err), "no other sweep", 2)


def test_a_scene_without_a_solution_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def hopeless(*_: object, **__: object) -> None:
        raise ArithmeticError("no approach balances the load")

    monkeypatch.setattr(rf, "solve", hopeless)
    assert main(["solve", "hertz", "--grid", "8"]) == 1
    one_line(Ended(1, capsys.readouterr().err), "no approach balances the load")


def test_a_division_by_zero_is_a_bug_and_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rf, "solve", lambda *_, **__: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        main(["solve", "hertz", "--grid", "8"])


def test_a_link_keeps_leading_to_the_file_that_is_written(tmp_path: Path) -> None:
    """/dev/stdout is one: root replaced it by a file."""
    target, link = tmp_path / "target.json", tmp_path / "link.json"
    target.write_text("old")
    link.symlink_to(target)
    files.write_text("new", link)
    assert link.is_symlink()
    assert target.read_text() == "new"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.json", "target.json"]


@pytest.mark.parametrize("umask", [0o022, 0o077, 0o002])
def test_who_may_read_a_file_is_up_to_the_umask(tmp_path: Path, umask: int) -> None:
    before = os.umask(umask)
    try:
        files.write_text("new", tmp_path / "a.json")
    finally:
        found = os.umask(before)
    assert found == umask
    assert stat.S_IMODE((tmp_path / "a.json").stat().st_mode) == 0o666 & ~umask


@pytest.mark.parametrize("mode", [0o600, 0o664])
def test_a_file_that_is_replaced_keeps_its_mode(tmp_path: Path, mode: int) -> None:
    path = tmp_path / "a.json"
    path.write_text("old")
    path.chmod(mode)
    files.write_text("new", path)
    assert path.read_text() == "new"
    assert stat.S_IMODE(path.stat().st_mode) == mode
