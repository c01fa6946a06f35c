"""Results kept in one SQLite file: a row per finished run, written at once or not at all.

The journal is a write-ahead log: a run is in the table or not after a kill at any moment, and others may read
meanwhile. Two sweeps may share a store on one machine, not across a network file system; the first row of a
run is kept. On opening, the file's structure, its schema and the checksum of every row are compared with what
this module writes. A refusal deletes nothing.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any

from refimpl.errors import InputError
from verification.sweep.run import COORDINATES, OUTCOMES, Row, Run

COLUMNS = ("key", *COORDINATES, *OUTCOMES, "seconds")
_DATABASE = b"SQLite format 3\0"
_JOURNALS = (b"", b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7", bytes(8))  # begin of what a killed creation leaves
BUSY_SECONDS = 5.0  # for another program to end its transaction
_ALL = (*COLUMNS[:-1], "inputs", "seconds", "checksum")
_TABLE = f"""runs (
    key text primary key,
    {", ".join((*COORDINATES, *OUTCOMES))},
    inputs text not null, seconds real not null, checksum text not null
) without rowid"""
_INSERT = f"insert into runs values ({', '.join('?' * len(_ALL))}) on conflict (key) do nothing"
_SELECT = f"select {', '.join(_ALL)} from runs"


class Store:
    """The open file of one sweep. Use `open_store`."""

    def __init__(self, connection: sqlite3.Connection, path: Path) -> None:
        self._connection, self._path, self._opened = connection, path, os.stat(path)

    def keys(self) -> set[str]:
        """Return the keys of the finished runs."""
        return {key for (key,) in self._connection.execute("select key from runs")}

    def add(self, run: Run, row: Row) -> None:
        """Keep a finished run, unless it is there already."""
        values = [run.key, *run.coordinates.values(), *(row[name] for name in OUTCOMES)]
        every = (*values, run.canonical, row["seconds"])  # SQLite keeps NaN as NULL
        values = [None if isinstance(value, float) and math.isnan(value) else value for value in every]
        self.check_place()
        self._connection.execute(_INSERT, [*values, checksum(values)])

    def finished(self, runs: Iterable[Run]) -> Iterator[Row]:
        """Yield rows of the finished ones among ``runs``, by the names of `COLUMNS`."""
        for run in runs:
            row = self._connection.execute(f"{_SELECT} where key = ?", (run.key,)).fetchone()
            if row is not None:
                found = dict(zip(_ALL, row, strict=True))
                yield {name: found[name] for name in COLUMNS}

    def check_place(self) -> None:
        """Raise InputError unless the opened file is still the one at the path."""
        try:
            there = os.stat(self._path)
        except OSError:
            there = None
        if there is None or not os.path.samestat(there, self._opened):
            found = "deleted" if there is None else "replaced"
            raise _refusal(self._path, f"a file that stays: it was {found} during the sweep")


def checksum(values: Sequence[Any]) -> str:
    """Return 64 bits of the SHA-256 of a row's values; floats by their shortest exact form."""
    return hashlib.sha256(json.dumps(values, default=repr).encode()).hexdigest()[:16]


def damaged_row(path: Path, key: object) -> InputError:
    """Return the refusal of a row whose checksum is another one than that of its values."""
    return _refusal(path, f"rows as they were written; that of key {str(key)[:40]!r} is damaged")


def files_of(store: Path) -> tuple[Path, ...]:
    """Return the store, and what SQLite keeps beside it."""
    return tuple(store.with_name(store.name + end) for end in ("", "-wal", "-shm", "-journal"))


@contextmanager
def open_store(path: Path) -> Iterator[Store]:
    """Open or create a store for one sweep.

    Raises InputError for a file that is not a store, is damaged, cannot be written, has several names, or is
    locked; and in the block where SQLite cannot read or write it any more, or it is no longer at its path.
    """
    path = Path(os.path.realpath(path))
    _make(path)
    with closing(_connect(path)) as connection:
        store = Store(connection, path)
        try:
            yield store
        except sqlite3.IntegrityError:  # a row of ours is wrong, not the file
            raise
        except sqlite3.Error as refused:
            raise _unusable(path, refused) from refused
        store.check_place()


def _make(path: Path) -> None:
    _check_places(path)
    try:
        path.open("ab").close()
        names = os.stat(path).st_nlink
    except OSError as refused:
        raise _refusal(path, f"a file that can be written ({refused.strerror})") from refused
    if names > 1:
        several = f"{path} of {names} names (hard links)"
        raise InputError("store", several, "one name: SQLite keeps its log beside it")


def _check_places(path: Path) -> None:
    """Raise InputError for what is no file, or a file of somebody else that a sweep would overwrite."""
    store, *kept = files_of(path)
    for file in (store, *kept):
        if os.path.exists(file) and not os.path.isfile(file):  # no error for long names
            raise _refusal(file, "a regular file")
    head = _begin(store)
    if head not in (b"", _DATABASE):
        raise _refusal(store, "an SQLite file of 'sweep', or a new file")
    for file in () if head else kept:
        if _begin(file)[:8] not in _JOURNALS:
            raise _refusal(file, "no file beside the store that is none of its own")


def _begin(path: Path) -> bytes:
    with suppress(OSError), open(path, "rb") as file:
        return file.read(len(_DATABASE))
    return b""


def _connect(path: Path) -> sqlite3.Connection:
    address = f"{path.as_uri()}?mode=rw"  # never ":memory:"
    try:
        connection = sqlite3.connect(address, uri=True, timeout=BUSY_SECONDS, isolation_level=None)
    except sqlite3.Error as refused:
        raise _unusable(path, refused) from refused
    try:
        if not _schema(connection) and not path.stat().st_size:  # new, or its creation was killed
            connection.execute(f"create table if not exists {_TABLE}")
        _check(connection, path)
        connection.execute("pragma journal_mode = wal")
        connection.execute("pragma synchronous = normal")
    except BaseException as refused:
        connection.close()
        if isinstance(refused, sqlite3.Error | UnicodeDecodeError | OverflowError):
            raise _unusable(path, refused) from refused
        raise
    return connection


def _check(connection: sqlite3.Connection, path: Path) -> None:
    if _schema(connection) != [("table", "runs", "runs", f"CREATE TABLE {_TABLE}")]:
        raise _refusal(path, "a file of 'sweep' with its table and nothing else")
    (found,) = connection.execute("pragma integrity_check(1)").fetchone()
    if found != "ok":
        raise _refusal(path, f"a file that is not damaged ({' '.join(str(found).split())})")
    for key, *values, inputs, seconds, stored in connection.execute(_SELECT):
        digest = hashlib.sha256(str(inputs).encode("utf-8", "replace")).hexdigest()[:32]
        if digest != key or checksum([key, *values, inputs, seconds]) != stored:
            raise damaged_row(path, key)


def _schema(connection: sqlite3.Connection) -> list[tuple[str, ...]]:
    return connection.execute("select type, name, tbl_name, sql from sqlite_master").fetchall()


def _unusable(path: Path, refused: Exception) -> InputError:
    reason = " ".join(str(refused).split())[:100]
    return _refusal(path, f"an SQLite file of 'sweep' that can be read and written ({reason})")


def _refusal(path: Path, allowed: str) -> InputError:
    return InputError("store", str(path), allowed)
