"""A folder to work in, with the files that commands are tried on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.verification.cli.commands import MEASURED, OBLONG, SCENE, STUDY


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working directory: scenes (square, oblong, on a measured surface), its heights, a study."""
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(SCENE)
    Path("oblong.toml").write_text(OBLONG)
    Path("measured.toml").write_text(SCENE.replace("[friction]", f"{MEASURED}[friction]"))
    np.save("heights.npy", np.random.default_rng(1).standard_normal((8, 8)) * 1e-9)
    Path("study.toml").write_text(STUDY)
    return tmp_path
