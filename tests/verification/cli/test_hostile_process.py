"""Names that no terminal shows, writers that are killed, interrupts of the whole group."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.verification.cli.children import STUDY, rows
from verification.cli import main
from verification.framework import files

START = "from verification.start import run; raise SystemExit(run())"


def test_what_a_killed_writer_left_goes_with_the_next_write(tmp_path: Path) -> None:
    target = tmp_path / "s.json"
    target.write_text("old")
    for _ in range(2):
        child = os.fork()
        if child == 0:
            with files.replacing(target) as temporary:
                temporary.write_text("half")
                os.kill(os.getpid(), signal.SIGKILL)
        os.waitpid(child, 0)
        assert target.read_text() == "old"
        assert len(list(tmp_path.iterdir())) == 2  # the second attempt has removed what the first left
    files.write_text("new", target)
    assert [path.name for path in tmp_path.iterdir()] == ["s.json"]


def test_files_that_are_being_written_stay(tmp_path: Path) -> None:
    target = tmp_path / "s.json"
    with files.replacing(target) as first:
        first.write_text("first")
        files.write_text("second", target)
        assert first.read_text() == "first"
    assert target.read_text() == "first"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
def test_a_store_whose_name_standard_output_cannot_encode(encoding: str, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('scene = "hertz"\n[vary]\ngrid = [4]\n')
    name = os.fsdecode(b"s\xff\x1b\xc3\xa9.sqlite")
    tail = ["sweep", "study.toml", "--store", name, "--workers", "1", "--json"]
    for out in ("-", "r.json"):
        done = subprocess.run(
            [sys.executable, "-c", START, *tail, out], cwd=tmp_path, capture_output=True,
            env=os.environ | {"PYTHONIOENCODING": encoding},
        )  # fmt: skip
        assert (done.returncode, done.stderr) == (0, b"")
        assert b"\x1b" not in done.stdout
        text = done.stdout.decode() if out == "-" else (tmp_path / out).read_text()
        assert json.loads(text)["store"] == name


def test_unknown_arguments_do_not_reach_the_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["solve", "hertz", "\x1b]0;owned\x07"])
    err = capsys.readouterr().err
    assert "\x1b" not in err
    assert "\x07" not in err


@pytest.mark.parametrize("delay", [0.05, 0.2, 0.5])
def test_an_interrupt_during_the_start_shows_no_traceback(delay: float, tmp_path: Path) -> None:
    reset = f"import signal; signal.signal(signal.SIGINT, signal.default_int_handler); {START}"
    command = [sys.executable, "-c", reset, "solve", "table1-rough", "--grid", "1024", "--tolerance", "1e-12"]
    child = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE)
    time.sleep(0.1 + delay)  # Python itself starts in less
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=60)
    assert child.returncode in (130, -signal.SIGINT)
    assert err == b""


@pytest.mark.parametrize("delay", [0.7, 1.2, 3.0])
def test_an_interrupted_verification_ends_at_once(delay: float, tmp_path: Path) -> None:
    """Its workers may be starting."""
    reset = f"import signal; signal.signal(signal.SIGINT, signal.default_int_handler); {START}"
    child = subprocess.Popen(
        [sys.executable, "-c", reset, "verify", "--only", "*s*/*"], cwd=tmp_path, start_new_session=True,
        stderr=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    time.sleep(delay)
    os.killpg(child.pid, signal.SIGINT)
    begun = time.monotonic()
    _, err = child.communicate(timeout=60)
    assert (child.returncode in (130, -signal.SIGINT), err) == (True, b"")
    assert time.monotonic() - begun < 15


def test_an_interrupt_of_the_whole_group_shows_no_traceback(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    reset = f"import signal; signal.signal(signal.SIGINT, signal.default_int_handler); {START}"
    tail = ["sweep", "study.toml", "--store", "s.sqlite", "--workers", "2"]
    child = subprocess.Popen(
        [sys.executable, "-c", reset, *tail], cwd=tmp_path, start_new_session=True,
        stderr=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    deadline = time.monotonic() + 60
    while rows(tmp_path / "s.sqlite") < 2 and time.monotonic() < deadline:
        time.sleep(0.01)
    os.killpg(child.pid, signal.SIGINT)
    _, err = child.communicate(timeout=60)
    assert child.returncode == 130
    assert err.count(b"\n") == 1
    assert b"the same command resumes" in err
