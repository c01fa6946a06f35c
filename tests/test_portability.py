"""What runs on Linux, Windows and macOS: the command line without what only POSIX has, texts in UTF-8."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from refimpl import operating_system
from tests.documents import ROOT
from tests.refimpl.surfaces.measured import ROUGH, write_x3p
from tests.verification.cli.commands import SCENE, STUDY, refused

PACKAGES = ("refimpl", "appendix_a", "verification", "reports", "examples")

# Imported by every Python that the test starts, workers and readers among them. Two libraries that ask other
# systems in other ways keep what they read on Linux.
HIDE = """
import builtins, io, os, signal, sys
import psutil

for name in ("fcntl", "resource", "pwd", "grp", "termios"):
    sys.modules[name] = None
for name in ("fork", "getuid", "geteuid", "nice", "setsid", "killpg", "getpgid", "sched_getaffinity"):
    delattr(os, name)
del os.O_NONBLOCK, os.waitid
for name in ("SIGHUP", "SIGPROF", "SIGXCPU", "setitimer", "pthread_kill", "pthread_sigmask"):
    delattr(signal, name)

def hiding(call):
    def hidden(path, *args, **keywords):
        asks = sys._getframe(1).f_globals.get("__name__", "")
        if str(path).startswith(("/proc", "/sys")) and not asks.startswith(("psutil", "threadpoolctl")):
            raise FileNotFoundError(2, "hidden", str(path))
        return call(path, *args, **keywords)
    return hidden

builtins.open = io.open = hiding(io.open)
for name in ("open", "listdir", "readlink"):
    setattr(os, name, hiding(getattr(os, name)))
"""
WAVE = "--slope-deg 0.5 --wavelength 50 --position 0.25 --nu 0.3 --offsets=-3,3 --json -"
JOBS = {
    "solve scene.toml --grid 16 --plot s.png --patches s.csv --npz s.npz --vtk s.vtu --json s.json": 0,
    "inspect a.x3p --unit m --pixel-size 1e-6 --json i.json": 0,
    "identify scene.toml data.csv --grid 16 --json f.json": 0,
    "verify --only hertz/peak-pressure --jobs 1 --json results.json": 0,
    "report --results results.json --committed committed --output report": 0,
    "verify --solver verification.solver_suite.own:solve --only solver/one-element": 0,
    "verify --exec '{python} silent.py' --only solver/one-element": 1,
    "sweep study.toml --workers 1 --csv t.csv": 0,
    "tradeoff scene.toml --grids 8,16 --reference 32": 0,
    f"appendix-a strip {WAVE}": 0,
    f"appendix-a fem {WAVE}": 0,
    "appendix-a wedge --r 1 --gamma-deg 10 --theta-deg 0": 0,
}
RUN = """
import json, os, shlex, sys, time
from pathlib import Path

from verification.cli import main

if __name__ == "__main__":
    assert not hasattr(os, "fork") and not Path("/proc/meminfo").is_dir()
    found = {}
    for command in json.loads(Path("jobs.json").read_text(encoding="utf-8")):
        before = time.process_time()
        try:
            found[command] = main(shlex.split(command.replace("{python}", Path(sys.executable).as_posix())))
        except SystemExit as usage:
            found[command] = usage.code
        print(f"{time.process_time() - before:5.1f} s  {command}", file=sys.stderr)
    Path("found.json").write_text(json.dumps(found), encoding="utf-8")
"""


@pytest.mark.nightly
def test_every_subcommand_runs_without_what_only_posix_has(tmp_path: Path) -> None:
    rows = "load,mu,u_mu\n5,0.41,0.01\n9,0.33,0.01\n24,0.27,0.01\n"
    files = {"sitecustomize.py": HIDE, "run.py": RUN, "jobs.json": json.dumps(list(JOBS)), "data.csv": rows}
    files |= {"scene.toml": SCENE, "study.toml": STUDY, "silent.py": "print('none')"}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "committed").mkdir()
    if find_spec("SurfaceTopography"):
        write_x3p(tmp_path / "a.x3p", ROUGH)
    else:  # not built for every system
        np.savetxt(tmp_path / "a.x3p", ROUGH)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join((str(tmp_path), str(ROOT)))}
    done = subprocess.run(
        [sys.executable, "run.py"], cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8"
    )
    assert done.returncode == 0, done.stderr
    assert json.loads((tmp_path / "found.json").read_text(encoding="utf-8")) == JOBS, done.stderr
    assert "Traceback" not in done.stderr


def unstated_encodings(source: str) -> Iterator[int]:
    """Lines that read or write a text without a word on its encoding."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call):
            continue
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        words = {word.arg: word.value for word in node.keywords}
        place = 0 if isinstance(node.func, ast.Attribute) and name == "open" else 1
        mode = words.get("mode", [*node.args, *[ast.Constant("r")] * 2][place])
        opened = name in ("open", "fdopen") and isinstance(mode, ast.Constant) and "b" not in str(mode.value)
        least = {"read_text": 0, "write_text": 1}.get(name)  # arguments before the encoding
        moved = isinstance(node.func, ast.Attribute) and len(node.args) == least
        if (opened or moved or "text" in words or "universal_newlines" in words) and "encoding" not in words:
            yield node.lineno


def test_every_text_states_its_encoding() -> None:
    files = [path for package in PACKAGES for path in (ROOT / package).rglob("*.py")]
    lines = [(path, line) for path in files for line in unstated_encodings(path.read_text(encoding="utf-8"))]
    assert [f"{path.relative_to(ROOT)}:{line}" for path, line in lines] == []
    for breach in (
        "p.open()",
        "open(p, 'w')",
        "p.read_text()",
        "subprocess.run(w, text=True)",
        "os.fdopen(2, 'w')",
    ):
        assert list(unstated_encodings(breach)) == [1], breach


def test_names_that_windows_takes_for_devices_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(operating_system.is_device, "__kwdefaults__", {"windows": True})
    refused("solve hertz --grid 8 --json nul.json", "device")


def test_numbers_of_the_machine() -> None:
    assert 1 <= operating_system.cores() <= 4096
    assert 2e7 < operating_system.peak_memory() < 1e11
    assert operating_system.processor_name() or sys.platform != "linux"
