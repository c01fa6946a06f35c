"""Results kept in one SQLite file: a row per finished run, written at once or not at all.

The journal is a write-ahead log, so that a run is either in the table or not after a kill at any moment, and
others may read while a sweep writes. A second sweep on the file is refused by an exclusive transaction held
on a small file beside it, which the system releases when the holder dies, however it dies.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from refimpl.errors import InputError
from verification.sweep.run import COORDINATES, OUTCOMES, Row, Run

APPLICATION_ID = 0x52465357  # "RFSW": says whose file this is
VERSION = 2
COLUMNS = ("key", *COORDINATES, *OUTCOMES)
_OURS = [APPLICATION_ID, VERSION]
_PRIMARY = 0xFF  # primary part of a result code; the other bits give its kind
_UNWRITABLE = (sqlite3.SQLITE_FULL, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_IOERR)
_TABLE = f"""create table runs (
    key text primary key,
    {", ".join((*COORDINATES, *OUTCOMES))},
    inputs text not null, seconds real not null
) without rowid"""
_INSERT = f"insert into runs values ({', '.join('?' * (len(COLUMNS) + 2))})"


class Store:
    """The open file of one sweep. Use `open_store`."""

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection

    def keys(self) -> set[str]:
        """Keys of the finished runs."""
        return {key for (key,) in self._connection.execute("select key from runs")}

    def add(self, run: Run, row: Row, seconds: float) -> None:
        """Keep a finished run; raises sqlite3.IntegrityError for one that is there already."""
        values = [run.key, *run.coordinates.values(), *(row[name] for name in OUTCOMES)]
        self._connection.execute(_INSERT, [*values, run.canonical, seconds])

    def rows(self, runs: Iterable[Run]) -> Iterator[Row]:
        """Rows of the finished ones among ``runs``, in that order, by the names of `COLUMNS`."""
        query = f"select {', '.join(COLUMNS)} from runs where key = ?"
        for run in runs:
            found = self._connection.execute(query, (run.key,)).fetchone()
            if found is not None:
                yield dict(zip(COLUMNS, found, strict=True))

    def seconds(self, runs: Iterable[Run]) -> Iterator[float]:
        """Processor seconds of the finished ones among ``runs``, in that order."""
        for run in runs:
            yield from (
                self._connection.execute("select seconds from runs where key = ?", (run.key,)).fetchone()
                or ()
            )


def files_of(store: Path) -> tuple[Path, ...]:
    """The store, and what SQLite and the lock keep beside it."""
    return tuple(store.with_name(store.name + end) for end in ("", "-wal", "-shm", "-journal", ".lock"))


@contextmanager
def open_store(path: Path) -> Iterator[Store]:
    """Open or create a store for one sweep.

    Raises InputError for a file that is not a store, cannot be written, or is in use by another sweep; and
    in the block where the disk is full or no longer lets it be written. Other faults are raised as they are.
    """
    with _opened(path) as connection:
        try:
            yield Store(connection)
        except sqlite3.OperationalError as refused:
            if refused.sqlite_errorcode & _PRIMARY not in _UNWRITABLE:
                raise
            raise InputError("store", str(path), f"a file that can be written ({refused})") from refused


@contextmanager
def _opened(path: Path) -> Iterator[sqlite3.Connection]:
    """The locked store's connection; of what is refused no new file stays, but a store of finished runs."""
    new = [file for file in (path, _lock_file(path)) if not os.path.exists(file)]  # no error for long names
    kept = False
    with closing(_lock(path)):
        try:
            with closing(_connect(path)) as connection:
                try:
                    yield connection
                except InputError:
                    kept = bool(connection.execute("select count(*) from runs").fetchone()[0])
                    raise
        except InputError:
            for file in [] if kept else new:
                file.unlink(missing_ok=True)  # while it is held, and so is no other sweep's
            raise


def _lock_file(path: Path) -> Path:
    return path.with_name(path.name + ".lock")


def _lock(path: Path) -> sqlite3.Connection:
    """A connection that holds the exclusive transaction on the file beside ``path`` until it is closed."""
    holder = None
    try:
        holder = sqlite3.connect(_lock_file(path), timeout=0.0, isolation_level=None)
        holder.execute("begin exclusive")
    except sqlite3.OperationalError as refused:
        if holder is not None:
            holder.close()
        if "locked" in str(refused):
            raise InputError("store", str(path), "a file that no other sweep is using now") from refused
        raise InputError("store", str(path), f"a file that can be written ({refused})") from refused
    return holder


def _connect(path: Path) -> sqlite3.Connection:
    connection = sqlite3.connect(path, timeout=10.0, isolation_level=None)
    try:
        if _is_empty(connection):
            connection.execute("begin immediate")
            connection.execute(f"pragma application_id = {APPLICATION_ID}")
            connection.execute(f"pragma user_version = {VERSION}")
            connection.execute(_TABLE)
            connection.execute("commit")
        if [_pragma(connection, name) for name in ("application_id", "user_version")] != _OURS:
            raise InputError("store", str(path), f"a file of 'sweep', format version {VERSION}")
        connection.execute("pragma journal_mode = wal")
        connection.execute("pragma synchronous = normal")
    except sqlite3.DatabaseError as alien:
        connection.close()
        raise InputError("store", str(path), f"an SQLite file of 'sweep' ({alien})") from alien
    except InputError:
        connection.close()
        raise
    return connection


def _is_empty(connection: sqlite3.Connection) -> bool:
    """Whether nothing was ever committed: a new file, or one whose creation was killed."""
    tables = connection.execute("select count(*) from sqlite_master").fetchone()[0]
    return tables == 0 and _pragma(connection, "application_id") == 0


def _pragma(connection: sqlite3.Connection, name: str) -> int:
    return int(connection.execute(f"pragma {name}").fetchone()[0])
