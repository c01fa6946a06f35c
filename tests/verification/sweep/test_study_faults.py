"""Study files that fuzzing found: each once let out an exception that was no InputError."""

from __future__ import annotations

from pathlib import Path

import pytest

import refimpl as rf
from verification.sweep.study_file import read_study


@pytest.mark.parametrize("digits", [400, 5000])
def test_a_study_of_numbers_beyond_every_double(tmp_path: Path, digits: int) -> None:
    path = tmp_path / "s.toml"
    path.write_text(f'scene = "hertz"\nrealisations = 1\n[vary]\ngrid = [8]\nload = [{"1" * digits}]\n')
    with pytest.raises(rf.InputError):
        list(read_study(path).runs())


def test_names_longer_than_the_system_takes(tmp_path: Path) -> None:
    long = "x" * 5000
    (tmp_path / "s.toml").write_text(f'scene = "{long}"\nrealisations = 1\n[vary]\ngrid = [8]\n')
    for act in (lambda: read_study(long), lambda: read_study(tmp_path / "s.toml")):
        with pytest.raises(rf.InputError):
            act()


def test_a_study_of_more_runs_than_python_counts(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(
        'scene = "hertz"\nrealisations = 9999999999999999999\n[vary]\ngrid = [8]\n'
    )
    with pytest.raises(rf.InputError, match="runs"):
        read_study(tmp_path / "s.toml")
