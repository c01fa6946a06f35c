"""Inputs that fuzzing found: each once let out an exception that was no InputError."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import require_number
from refimpl.measured import MeasuredSurface

SCENE = rf.scene_to_toml(rf.read_scene("hertz"))


@pytest.mark.parametrize("digits", [400, 5000])
@pytest.mark.parametrize("key", ["load", "side", "radius", "E"])
def test_whole_numbers_beyond_every_double(tmp_path: Path, key: str, digits: int) -> None:
    """400 digits overflow a double; 5000 are more than Python converts."""
    path = tmp_path / "s.toml"
    path.write_text(re.sub(rf"\b{key} = [0-9.e+-]+", f"{key} = {'1' * digits}", SCENE))
    with pytest.raises(rf.InputError) as refused:
        rf.read_scene(path).heights(rf.Grid.square(1e-3, 4))
    assert len(str(refused.value)) < 500


def test_a_number_that_no_double_holds() -> None:
    with pytest.raises(rf.InputError, match="load"):
        require_number("load", 10**400, "a load", above=0)
    with pytest.raises(rf.InputError, match="radius"):
        rf.Sphere(-(10**400))


@pytest.mark.parametrize("old", [b"}", b")"])
def test_a_numpy_header_without_its_end(tmp_path: Path, old: bytes) -> None:
    path = tmp_path / "a.npy"
    np.save(path, np.zeros((9, 9)))
    path.write_bytes(path.read_bytes().replace(old, b" ", 1))
    with pytest.raises(rf.InputError, match="path"):
        MeasuredSurface(path, unit="m", pixel_size=1e-6).heights(rf.Grid.square(8e-6, 4))


def test_names_longer_than_the_system_takes() -> None:
    long = "x" * 5000
    for act in (
        lambda: rf.read_scene(long),
        lambda: MeasuredSurface(long, unit="m", pixel_size=1e-6).heights(rf.Grid.square(8e-6, 4)),
    ):
        with pytest.raises(rf.InputError):
            act()
