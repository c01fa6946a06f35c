"""Readers of docs/reference-data.md, in every language that is installed, on a rectangle; and its recipe for
pytest, on a right code and on wrong ones."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.documents import ROOT, blocks
from verification.cli import main
from verification.solver_suite.reference import agreement

FILES = {b.file: b.text for b in blocks((ROOT / "docs/reference-data.md").read_text("utf-8")) if b.file}
FILES |= {path.name: path.read_text("utf-8") for path in (ROOT / "examples/readers").iterdir()}
CALLS = {
    "reader.py": [[sys.executable, "reader.py", "data", "{name}"]],
    "reader.c": [
        ["cc", "-O2", "-Wall", "-o", "reader", "reader.c"],
        ["./reader", "data", "{name}"],
    ],
    "reader.m": [["octave", "--norc", "--eval", "reader('data', '{name}')"]],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("readers")
    only = ("design-oblong-0*", "pins", "hertz-load")
    words = [word for name in only for word in ("--only", f"solver/{name}")]
    assert main(["verify", "--export", str(path / "data"), *words]) == 0
    for name, text in FILES.items():
        (path / name).write_text(text, encoding="utf-8")
    return path


def stated(folder: Path) -> tuple[str, str]:
    """Name of a rectangular problem whose peak is off the diagonal, and what a reader should print of it."""
    index = agreement.index_of(folder / "data")
    for entry in index["problems"]:
        pressure = agreement.array_of(folder / "data", entry, "pressure")
        (nx, ny), (i, j) = pressure.shape, np.argwhere(pressure == pressure.max())[0]
        if nx != ny and i != j:
            load, peak = entry["answer"]["load"], pressure.max()
            text = f"{entry['name']}: {nx} x {ny}, load {load:.9g} N, peak {peak:.9g} Pa at {i}, {j}"
            return entry["name"], text
    raise AssertionError("no rectangular problem in the export")


@pytest.mark.parametrize("reader", CALLS)
def test_a_reader_prints_what_the_index_says(folder: Path, reader: str) -> None:
    program = CALLS[reader][0][0]
    if shutil.which(program) is None:
        pytest.skip(f"{program} is not installed")
    name, expected = stated(folder)
    for call in CALLS[reader]:
        words = [word.replace("{name}", name) for word in call]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == expected


def recipe(folder: Path, factor: str) -> str:
    """What pytest prints of the recipe, the modulus of its code multiplied by a factor."""
    code, found = re.subn(r"\bnp\.pi \*", f"{factor} * np.pi *", FILES["my_code.py"])
    assert found == 1
    (folder / "my_code.py").write_text(code)
    (folder / "reference-data").unlink(missing_ok=True)
    (folder / "reference-data").symlink_to("data")
    words = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", str(folder), "test_my_code.py"]
    alone = {
        name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTEST_ADDOPTS")
    }
    return subprocess.run(
        [sys.executable, *words], cwd=folder, env=alone, capture_output=True, text=True, check=False
    ).stdout


def test_the_recipe_passes_a_right_code(folder: Path) -> None:
    printed = recipe(folder, "1.0")
    assert "2 passed" in printed, printed
