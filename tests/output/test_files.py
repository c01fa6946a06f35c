"""Output files that are whole or as they were, JSON that every reader takes, progress for terminals."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from verification.output import files


def test_a_file_is_whole_or_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    files.write_text("old", path)

    def break_off() -> None:
        with files.replacing(path) as temporary:
            temporary.write_text("half of the n")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        break_off()
    assert path.read_text() == "old"
    with files.replacing(path) as first:  # while another writes
        first.write_text("first")
        files.write_text("second", path)
        assert first.read_text() == "first"
    assert path.read_text() == "first"
    assert [p.name for p in tmp_path.iterdir()] == ["results.json"]


def test_a_link_keeps_leading_to_the_file_that_is_written(tmp_path: Path) -> None:
    """/dev/stdout is one. Writers that choose a format by the suffix see that of the name given."""
    target, link = tmp_path / "target.stl", tmp_path / "link.json"
    target.write_text("old")
    link.symlink_to(target)
    with files.replacing(link) as temporary:
        assert temporary.suffix == ".json"
        temporary.write_text("new")
    assert link.is_symlink()
    assert target.read_text() == "new"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.json", "target.stl"]


def test_a_pipe_without_a_reader_is_an_error_and_with_one_gets_the_whole_file(tmp_path: Path) -> None:
    """Writers of pictures and archives go back in their file, which a pipe does not let them."""
    pipe = tmp_path / "pipe.npz"
    os.mkfifo(pipe)
    with pytest.raises(OSError, match="No such device or address"):
        files.write_text("lost", pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    with files.replacing(pipe) as temporary, temporary.open("wb") as file:
        file.write(b"?part")
        file.seek(0)
        file.write(b"!")
    assert os.read(reader, 100) == b"!part"
    os.close(reader)


def test_a_new_file_has_the_mode_of_the_umask_and_a_replaced_one_its_own(
    tmp_path: Path,
) -> None:
    umask, kept = 0o077, 0o664
    path, before = tmp_path / "a.json", os.umask(umask)
    try:
        files.write_text("new", path)
    finally:
        assert os.umask(before) == umask
    assert stat.S_IMODE(path.stat().st_mode) == 0o666 & ~umask
    path.chmod(kept)
    files.write_text("newer", path)
    assert (path.read_text(), stat.S_IMODE(path.stat().st_mode)) == ("newer", kept)
