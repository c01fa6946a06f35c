"""What a machine does to a program: full and read-only disks, broken and hostile files.

The tests may run as root, whom no file mode stops: a folder that refuses is played by the system call's
error, a full disk by /dev/full, a limit on the size of files, or a tiny file system if one mounts.
"""

from __future__ import annotations

import errno
import io
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

import numpy as np
import pytest

import refimpl as rf
from reports.generator import render
from tests.reports.sample import case, results
from tests.verification.children import LONG, STUDY, Ended, forked, one_line, rows, small
from verification import files
from verification.cli import main, plot
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

    monkeypatch.setattr(plot, "check_suffix", turns)
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
    tail = ["--results", str(tmp_path / "r.json"), "--output"]
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


WHOLE = json.dumps(results(case("a/1"), case("a/2", "fail")))
CORRUPTED = {
    "cut": WHOLE[: len(WHOLE) // 2], "empty": "", "null": "null", "list": "[]", "number": "1e400",
    "deep": "[" * 100_000, "binary": "\x00\x01\x02", "wrong counts": WHOLE.replace('"pass": 1', '"pass": 7'),
    "no cases": WHOLE.replace('"cases"', '"kases"'), "cases a number": json.dumps(results() | {"cases": 3}),
    "case a text": json.dumps(results() | {"cases": ["x"]}),
    "counts a list": json.dumps(results() | {"counts": []}),
    "provenance null": json.dumps(results() | {"provenance": None}),
    "errata of numbers": json.dumps(results() | {"errata": [1]}),
}  # fmt: skip


@pytest.mark.parametrize("name", CORRUPTED)
def test_corrupted_results_are_refused(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "r.json").write_text(CORRUPTED[name])
    assert main(["report", "--results", str(tmp_path / "r.json"), "--output", str(tmp_path / "out")]) == 2
    one_line(Ended(2, capsys.readouterr().err), "--results", 2)
    assert not (tmp_path / "out").exists()


STUDY_WITHOUT_DATA = json.dumps({"tail": []})


@pytest.mark.parametrize(
    ("option", "bad"),
    [
        ("--results", CORRUPTED["wrong counts"]),
        ("--against", CORRUPTED["wrong counts"]),
        ("--against", "null"),
        ("--committed", CORRUPTED["wrong counts"]),
        ("--committed", "[]"),
        ("--committed", STUDY_WITHOUT_DATA),
    ],
)
def test_the_file_that_is_refused_is_named_by_its_option(
    option: str,
    bad: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("kept").mkdir()
    files = {"--results": "r.json", "--against": "old.json", "--committed": "kept/coverage.json"}
    for name in files.values():
        Path(name).write_text(bad if name == files[option] else WHOLE)
    command = ["report", "--results", "r.json", "--against", "old.json", "--committed", "kept"]
    assert main([*command, "--output", "out"]) == 2
    where = "kept" if bad == STUDY_WITHOUT_DATA else files[option]
    one_line(Ended(2, capsys.readouterr().err), f"{option} = '{where}'", 2)
    assert not Path("out").exists()


def test_a_corrupted_store_is_refused_and_left_as_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = tmp_path / "s.sqlite"
    engine.sweep(small(3), store, workers=0)
    content = bytearray(store.read_bytes())
    content[100:4000] = b"\xa5" * 3900
    store.write_bytes(content)
    (tmp_path / "study.toml").write_text(STUDY)
    assert main(["sweep", str(tmp_path / "study.toml"), "--store", str(store)]) == 2
    one_line(Ended(2, capsys.readouterr().err), "store", 2)
    assert store.read_bytes() == bytes(content)


def other_than(unread: Path, read: Callable[..., str]) -> Callable[..., str]:
    """The same for all paths but one."""

    def reading(path: Path, *args: str, **options: str) -> str:
        assert path != unread
        return read(path, *args, **options)

    return reading


def test_fifty_megabytes_of_toml_are_refused_unread(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "huge.toml"
    with path.open("wb") as file:
        file.write(b"load = 1.0\n")
        file.truncate(50 * 2**20)
    monkeypatch.setattr(Path, "read_text", other_than(path, Path.read_text))
    for command in (["solve"], ["sweep"]):
        assert main([*command, str(path)]) == 2
        one_line(Ended(2, capsys.readouterr().err), "at most", 2)


def opened_but_for(shut: Path) -> Callable[..., object]:
    """Opens all files but one: a mode would not stop root."""
    real = io.open

    def opens(path: object, *args: object, **options: object) -> object:
        if isinstance(path, Path) and path.name == shut.name:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return real(path, *args, **options)  # type: ignore[call-overload]  # passed on as they are

    return opens


@pytest.mark.parametrize(
    ("shut", "command"),
    [
        ("scene.toml", ["solve", "scene.toml", "--grid", "8"]),
        ("scene.toml", ["tradeoff", "scene.toml"]),
        ("scene.toml", ["sweep", "study.toml"]),
        ("study.toml", ["sweep", "study.toml"]),
        ("heights.dat", ["solve", "scene.toml", "--grid", "8"]),
        ("heights.dat", ["sweep", "study.toml"]),
        ("r.json", ["report", "--results", "r.json"]),
        ("old.json", ["report", "--results", "r.json", "--against", "old.json"]),
        ("long.json", ["report", "--results", "r.json", "--committed", "kept"]),
    ],
)
def test_an_input_that_may_not_be_read_is_named_as_one(
    shut: str,
    command: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    np.savetxt("heights.dat", np.random.default_rng(1).standard_normal((8, 8)) * 1e-9)
    measured = '[[lower.surface]]\nkind = "measured"\npath = "heights.dat"\nunit = "m"\npixel_size = 2.1e-4\n'
    Path("scene.toml").write_text(rf.scene_to_toml(rf.read_scene("table1-rough")) + measured)
    Path("study.toml").write_text('scene = "scene.toml"\n[vary]\ngrid = [8]\n')
    Path("kept").mkdir()
    for name in ("r.json", "old.json", "kept/long.json"):
        Path(name).write_text(WHOLE)
    monkeypatch.setattr(io, "open", opened_but_for(Path(shut)))
    assert main(command) == 2
    err = capsys.readouterr().err
    one_line(Ended(2, err), "a file that can be read", 2)
    assert shut in err
    assert "Permission denied" in err


def test_a_folder_is_no_result_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", "--results", str(tmp_path)]) == 2
    one_line(Ended(2, capsys.readouterr().err), "a file that can be read (Is a directory)", 2)


# --- hostile texts ---

HOSTILE = (
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "javascript:alert(1)",
    "' onmouseover='alert(1)",
    "{{ 7 * 7 }}{% raw %}",
    "</title><svg onload=alert(1)>",
    "\u202etxt.exe",
)


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_texts_are_shown_and_not_run(text: str) -> None:
    names = ("title", "claim", "source", "note", "unit", "tolerance_reason")
    hostile = case(
        "a/1", **dict.fromkeys(names, text), tags=[text], data={text: 1.0, "t": text, "m": {text: text}}
    )
    document = results(hostile)
    document["provenance"] |= {"command": text, "commit": text}
    page = render(document)
    for dangerous in ("<script>alert", "<img src=x", "<svg onload", "onmouseover='alert"):
        assert dangerous not in page
    assert "49" not in page.split("<body>")[1].replace("149", "") or "{{ 7 * 7 }}" in page
    assert "default-src 'none'" in page


def test_a_hostile_scene_name_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = "\x1b]0;owned\x07\nroot# rm -rf"
    assert main(["solve", name]) == 2
    err = capsys.readouterr().err
    one_line(Ended(2, err), "scene", 2)
    assert "\x1b" not in err
    (tmp_path / "<script>.toml").write_text(SCENE)
    assert main(["solve", str(tmp_path / "<script>.toml"), "--grid", "8"]) == 0


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
