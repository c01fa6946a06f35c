"""The digest of code follows imports, and leaves comments and docstrings out."""

from __future__ import annotations

from pathlib import Path

import pytest

from verification.framework.code_digest import code_digest


def test_what_is_imported_counts_and_what_is_said_does_not(tmp_path: Path) -> None:
    room = tmp_path / "room"
    room.mkdir()
    (room / "one.py").write_text("from room import two\n")
    (room / "two.py").write_text("import room.three\nimport json\n")
    (room / "three.py").write_text("a = 1\n")
    (room / "other.py").write_text("b = 1\n")
    first = code_digest("room.one", root=tmp_path)
    (room / "three.py").write_text('"""Docstring."""\n\na = 1  # comment\n')
    (room / "other.py").write_text("b = 2\n")
    assert code_digest("room.one", root=tmp_path) == first
    (room / "three.py").write_text("a = 2\n")
    assert code_digest("room.one", root=tmp_path) != first


def test_a_module_that_is_not_there_has_no_digest() -> None:
    with pytest.raises(LookupError, match="no module of this project"):
        code_digest("verification.nowhere")
