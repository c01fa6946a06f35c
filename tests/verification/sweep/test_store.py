"""Stores that are damaged, replaced, linked or held by others: refused by name, or the right table."""

from __future__ import annotations

import os
import random
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from refimpl.errors import InputError
from tests.verification.cli.children import small
from verification.sweep import engine, store
from verification.sweep.export import to_csv
from verification.sweep.run import execute
from verification.sweep.store import COLUMNS, checksum, files_of, open_store

STORES = small(4)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of four runs, closed: everything is in the one file."""
    path = tmp_path_factory.mktemp("whole") / "s.sqlite"
    engine.sweep(STORES, path, workers=0)
    assert [file for file in files_of(path) if file.exists()] == [path]
    return path


@pytest.fixture(scope="module")
def table(whole: Path) -> str:
    return to_csv(engine.sweep(STORES, whole, workers=0).rows)


def by_sql(*statements: str) -> Callable[[Path], object]:
    def act(path: Path) -> None:
        connection = sqlite3.connect(path, isolation_level=None)
        for statement in ("pragma journal_mode = delete", "pragma writable_schema = on", *statements):
            connection.execute(statement)
        connection.close()

    return act


def garbled(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[4096:8192] = random.Random(1).randbytes(4096)
    path.write_bytes(content)


DAMAGE: dict[str, Callable[[Path], object]] = {
    "garbled page": garbled,
    "renamed column": by_sql("alter table runs rename column tau to tan"),
    "another number": by_sql("update runs set contact_area = contact_area * (1 + 1e-15)"),
    "another key": by_sql("update runs set key = 'a' where realisation = 0"),
    "trigger": by_sql("create trigger t after insert on runs begin delete from runs; end"),
    "another program's": by_sql("create table other (x)"),
    "not a database": lambda path: path.write_bytes(b"no database" * 1000),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_a_damaged_store_is_refused_and_left_as_it_is(name: str, whole: Path, tmp_path: Path) -> None:
    path = tmp_path / "s.sqlite"
    shutil.copy(whole, path)
    DAMAGE[name](path)
    before = path.read_bytes()
    with pytest.raises(InputError) as refused:
        engine.sweep(STORES, path, workers=0)
    assert (refused.value.field, refused.value.value) == ("store", str(path))
    assert path.read_bytes() == before


@settings(max_examples=30, deadline=None)
@given(where=st.floats(0, 1, exclude_max=True), bit=st.integers(0, 7))
@example(where=0.0, bit=0)
def test_a_flipped_bit_never_changes_the_table(
    where: float, bit: int, whole: Path, table: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("flip") / "s.sqlite"
    content = bytearray(whole.read_bytes())
    content[int(where * len(content))] ^= 1 << bit
    path.write_bytes(content)
    with suppress(InputError):  # and nothing else
        assert to_csv(engine.sweep(STORES, path, workers=0).rows) == table


def test_checksums_tell_values_that_look_alike() -> None:
    values: list[object] = [1, 1.0, True, "1", "1.0", None, "", b"", 0.0, -0.0, "null"]
    assert len({checksum([value]) for value in values}) == len(values)


# --- what is no regular file, or held by others ---


@pytest.mark.parametrize(("end", "make"), [("", os.mkfifo), ("-wal", os.mkfifo), ("-journal", os.mkdir)])
def test_pipes_and_folders_are_refused(end: str, make: Callable[[Path], None], tmp_path: Path) -> None:
    path = tmp_path / "s.sqlite"
    make(path.with_name(path.name + end))
    with pytest.raises(InputError, match="regular file"), open_store(path):
        pass


def test_a_store_that_can_no_longer_be_written_is_refused(tmp_path: Path) -> None:
    stopped = "pragma max_page_count = 1; create table t as select zeroblob(100000)"
    with pytest.raises(InputError, match="full"), open_store(tmp_path / "s.sqlite") as kept:
        kept._connection.executescript(stopped)


def test_a_file_whose_creation_was_killed_is_new(tmp_path: Path) -> None:
    other = sqlite3.connect(tmp_path / "other", isolation_level=None)
    for statement in ("begin immediate", "create table runs (key)"):
        other.execute(statement)
    for end in ("", "-journal"):  # as a kill leaves them here
        shutil.copy(tmp_path / f"other{end}", tmp_path / f"s.sqlite{end}")
    assert engine.sweep(small(1), tmp_path / "s.sqlite", workers=0).finished == 1


def test_a_store_that_another_program_has_locked(
    whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store, "BUSY_SECONDS", 0.1)
    path = tmp_path / "s.sqlite"
    shutil.copy(whole, path)
    by_sql()(path)
    other = sqlite3.connect(path, isolation_level=None)
    other.execute("begin immediate")
    with pytest.raises(InputError, match="locked"):
        engine.sweep(small(5), path, workers=0)
    other.close()
    assert engine.sweep(small(5), path, workers=0).found == 4


def test_links_lead_to_one_store_and_hard_links_are_refused(tmp_path: Path) -> None:
    path, link, hard = (tmp_path / name for name in ("s.sqlite", "link.sqlite", "hard.sqlite"))
    engine.sweep(small(1), path, workers=0)
    os.symlink(path, link)
    assert engine.sweep(small(2), link, workers=0).found == 1
    os.link(path, hard)
    with pytest.raises(InputError, match="hard links"):
        engine.sweep(small(2), hard, workers=0)


def test_two_sweeps_share_a_store_and_keep_each_run_once(tmp_path: Path) -> None:
    path, inner = tmp_path / "s.sqlite", list[engine.Sweep]()

    def start_another(progress: engine.Progress) -> None:
        if progress.done == 1:
            inner.append(engine.sweep(small(3), path, workers=0))

    outer = engine.sweep(small(2), path, workers=0, tick=start_another)
    assert (outer.finished, inner[0].found, inner[0].finished) == (2, 1, 2)
    assert to_csv(inner[0].rows[:2]) == to_csv(outer.rows)
    assert sqlite3.connect(path).execute("select count(*) from runs").fetchone() == (3,)


@pytest.mark.parametrize(
    ("after", "again"),
    [(0, b""), (1, b"of somebody else"), (2, b"")],
    ids=["deleted", "replaced", "at the end"],
)
def test_a_store_that_vanishes_during_a_sweep_is_noticed(after: int, again: bytes, tmp_path: Path) -> None:
    """What is there instead stays as it is."""
    path = tmp_path / "s.sqlite"

    def vanish(progress: engine.Progress) -> None:
        if progress.done == after:
            path.unlink()
            if again:
                path.write_bytes(again)

    with pytest.raises(InputError, match="replaced" if again else "deleted"):
        engine.sweep(small(2), path, workers=0, tick=vanish)
    assert [file.read_bytes() for file in (path,) if file.exists()] == [again] * bool(again)


@pytest.mark.parametrize("ends", [["-wal"], ["", "-journal"]])
def test_files_of_somebody_else_stay(ends: list[str], tmp_path: Path) -> None:
    for end in ends:
        (tmp_path / f"s.sqlite{end}").write_text("of somebody else")
    with pytest.raises(InputError), open_store(tmp_path / "s.sqlite"):
        pass
    assert sorted(file.name for file in tmp_path.iterdir()) == [f"s.sqlite{end}" for end in ends]
    assert {file.read_text() for file in tmp_path.iterdir()} == {"of somebody else"}


def test_memory_is_a_name_like_any_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in (":memory:", "a b%20c#d?e"):
        assert engine.sweep(small(1), Path(name), workers=0).finished == 1
        assert (tmp_path / name).stat().st_size > 0
        assert engine.sweep(small(1), Path(name), workers=0).found == 1


def test_numbers_that_do_not_exist_are_kept_as_none(tmp_path: Path) -> None:
    (run,) = small(1).runs()
    with open_store(tmp_path / "s.sqlite") as kept:
        kept.add(run, execute(run.inputs) | {"friction_coefficient": float("nan")})
    with open_store(tmp_path / "s.sqlite") as kept:
        (found,) = kept.finished([run])
    assert found["friction_coefficient"] is None
    assert tuple(found) == COLUMNS
