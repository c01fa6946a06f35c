"""Interrupts, kills and full disks: the old file stays whole, no other is left, and no traceback is shown.

One of each kind runs in CI; interrupts and kills of sweeps are in `tests/test_jobs.py` and in
`tests/verification/sweep`.
"""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
import time
from itertools import count
from pathlib import Path

import pytest

from refimpl.solvers.production.projected_cg import ProjectedCG
from tests.verification.cli.children import LONG, Ended, forked, one_line
from tests.verification.cli.commands import run
from verification.cli import main, solve
from verification.output import files

resource = pytest.importorskip("resource", reason="signals and limits of POSIX")
START = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    "from verification.start import run; raise SystemExit(run())"
)


def interrupted_solve(folder: Path, how: signal.Signals) -> Ended:
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


@pytest.mark.parametrize(
    "how",
    [signal.SIGINT, *(pytest.param(s, marks=pytest.mark.nightly) for s in (signal.SIGKILL, signal.SIGTERM))],
)
def test_an_interrupted_solve_leaves_the_old_result_and_no_other_file(
    tmp_path: Path, how: signal.Signals
) -> None:
    (tmp_path / "s.json").write_text("old")
    ended = interrupted_solve(tmp_path, how)
    assert ended.status == (130 if how is signal.SIGINT else -how)
    assert "Traceback" not in ended.err
    assert [p.name for p in tmp_path.iterdir()] == ["s.json"]
    assert (tmp_path / "s.json").read_text() == "old"


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("words", "delay"),
    [(LONG, 0.15), (LONG, 0.6), (["verify", "--only", "*s*/*"], 3.0)],
)
def test_an_interrupt_ends_the_start_and_a_verification_at_once(
    words: list[str], delay: float, tmp_path: Path
) -> None:
    """The whole group is interrupted, as by a terminal; workers may be starting."""
    child = subprocess.Popen(
        [sys.executable, "-c", START, *words], cwd=tmp_path, start_new_session=True,
        stderr=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    time.sleep(delay)
    os.killpg(child.pid, signal.SIGINT)
    begun = time.monotonic()
    _, err = child.communicate(timeout=60)
    assert (child.returncode in (130, -signal.SIGINT), err) == (True, b"")
    assert time.monotonic() - begun < 15


def full_disk() -> None:
    """No file may grow beyond 500 bytes; the signal for it is ignored, so that the write says EFBIG.

    Bytecode of a module imported here would be cut off at 500 bytes too, and stay for all later runs.
    """
    sys.dont_write_bytecode = True
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))


def test_a_full_disk_costs_the_new_file_and_not_the_old(tmp_path: Path) -> None:
    path = tmp_path / "s.json"
    path.write_text("old")
    command = ["solve", "hertz", "--grid", "8", "--json", str(path)]
    one_line(forked(lambda: main(command), before=full_disk), "File too large")
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
def test_devices_are_written_to_and_never_replaced() -> None:
    for name, status in (("/dev/full", 1), ("/dev/null", 0)):
        assert run(f"solve hertz --grid 8 --json {name}").status == status
        assert Path(name).is_char_device()


def test_a_folder_that_refuses(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Played by the error of the system call, as no mode stops root: at once, or after the solve."""

    def refuses(*_: object, **__: object) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(tmp_path))

    def turns(*_: object, **__: object) -> None:  # read-only once the solve has begun
        monkeypatch.setattr(files, "_temporary", refuses)

    monkeypatch.setattr(solve, "check_outputs", turns)
    late = run(f"solve hertz --grid 8 --json {tmp_path}/s.json")
    assert (late.status, late.err.count("\n")) == (1, 1)
    assert "Read-only" in late.err
    assert "status: CONVERGED" in late.out
    early = run(f"{' '.join(LONG)} --json {tmp_path}/s.json")
    assert (early.status, early.out, early.err.count("\n")) == (2, "", 1)
    assert "Read-only" in early.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["none/s.json", ".", 300 * "a", "/proc/s.json"])
def test_an_unwritable_place_is_refused_before_any_work(name: str, tmp_path: Path) -> None:
    done = run(f"{' '.join(LONG)} --json {tmp_path / name}")
    assert (done.status, done.out, done.err.count("\n")) == (2, "", 1)
    assert "--json" in done.err
    assert list(tmp_path.iterdir()) == []


def test_a_closed_pipe_ends_quietly_and_costs_no_file(tmp_path: Path) -> None:
    arguments = [sys.executable, "-c", START, "solve", "hertz", "--grid", "8", "--json", "s.json"]
    reader, writer = os.pipe()
    os.close(reader)
    ended = subprocess.run(arguments, cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    assert (ended.returncode, ended.stderr) == (0, b"")
    assert json.loads((tmp_path / "s.json").read_text())["status"] == "converged"


@pytest.mark.parametrize(
    "command",
    [
        "solve hertz --grid 8",
        pytest.param("sweep study.toml", marks=pytest.mark.nightly),
        pytest.param("verify --only kernels/normal-50-digits", marks=pytest.mark.nightly),
    ],
)
def test_a_closed_standard_error_changes_nothing(command: str, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('scene = "hertz"\n[vary]\ngrid = [4]\n')
    done = subprocess.run(
        ["sh", "-c", f'exec "$@" {command} 2>&-', "sh", sys.executable, "-c", START],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
    )
    assert done.returncode == 0
    assert done.stdout


@pytest.mark.nightly
def test_a_store_whose_name_standard_output_cannot_encode(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('scene = "hertz"\n[vary]\ngrid = [4]\n')
    name = os.fsdecode(b"s\xff\x1b\xc3\xa9.sqlite")
    tail = ["sweep", "study.toml", "--store", name, "--workers", "1", "--json", "-"]
    done = subprocess.run(
        [sys.executable, "-c", START, *tail], cwd=tmp_path, capture_output=True,
        env=os.environ | {"PYTHONIOENCODING": "ascii"},
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"\x1b" not in done.stdout
    assert json.loads(done.stdout)["store"] == name
