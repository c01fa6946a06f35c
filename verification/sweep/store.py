"""Results kept in one SQLite file: a row per finished run, written at once or not at all.

The journal is a write-ahead log, so that a run is either in the table or not after a kill at any moment, and
others may read while a sweep writes. A second sweep is refused by a lock file beside the store, the same for
all links to it, which the system releases when the holder dies, however it dies.

Damage is found before it is used: on opening, the file's structure, its schema and the checksum of every row
are compared with what this module writes.
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

from filelock import FileLock, Timeout

from refimpl.errors import InputError
from verification.sweep.run import COORDINATES, OUTCOMES, Row, Run

APPLICATION_ID = 0x52465357  # "RFSW": says whose file this is
VERSION = 5
COLUMNS = ("key", *COORDINATES, *OUTCOMES)
BUSY_SECONDS = 5.0  # for another program to end its transaction
_OURS = [APPLICATION_ID, VERSION]
_PRIMARY = 0xFF  # primary part of a result code; the other bits give its kind
_UNWRITABLE = (sqlite3.SQLITE_FULL, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_IOERR)
_ALL = (*COLUMNS, "inputs", "seconds", "checksum")
_TABLE = f"""create table runs (
    key text primary key,
    {", ".join((*COORDINATES, *OUTCOMES))},
    inputs text not null, seconds real not null, checksum text not null
) without rowid"""
_INSERT = f"insert into runs values ({', '.join('?' * len(_ALL))})"
_SELECT = f"select {', '.join(_ALL)} from runs"


class Store:
    """The open file of one sweep. Use `open_store`.

    Every method raises InputError where the file is damaged, locked by another program, or no longer at its
    path.
    """

    def __init__(self, connection: sqlite3.Connection, path: Path) -> None:
        self._connection, self._path, self._opened = connection, path, os.stat(path)

    def keys(self) -> set[str]:
        """Keys of the finished runs."""
        with _refused(self._path):
            return {key for (key,) in self._connection.execute("select key from runs")}

    def add(self, run: Run, row: Row, seconds: float) -> None:
        """Keep a finished run; raises sqlite3.IntegrityError for one that is there already."""
        values = [run.key, *run.coordinates.values(), *(row[name] for name in OUTCOMES)]
        every = (*values, run.canonical, seconds)  # SQLite keeps NaN as NULL
        values = [None if isinstance(value, float) and math.isnan(value) else value for value in every]
        with _refused(self._path):
            self.check_place()
            self._connection.execute(_INSERT, [*values, checksum(values)])

    def finished(self, runs: Iterable[Run]) -> Iterator[tuple[Row, float]]:
        """Rows of the finished ones among ``runs``, by the names of `COLUMNS`, with their seconds."""
        for run in runs:
            with _refused(self._path):
                row = self._connection.execute(f"{_SELECT} where key = ?", (run.key,)).fetchone()
            if row is not None:
                found = _checked(row, self._path)
                yield {name: found[name] for name in COLUMNS}, found["seconds"]

    def check_place(self) -> None:
        """Raise InputError unless the opened file is still the one at the path."""
        try:
            there = os.stat(self._path)
        except OSError:
            there = None
        if there is None or not os.path.samestat(there, self._opened):
            found = "deleted" if there is None else "replaced"
            raise InputError("store", str(self._path), f"a file that stays: it was {found} during the sweep")


def _checked(row: Sequence[Any], path: Path) -> Row:
    """The row by column, if its checksum and its key are those of its values."""
    *values, stored = row
    found = dict(zip(_ALL, row, strict=True))
    if checksum(values) != stored or _key(found["inputs"]) != found["key"]:
        raise damaged_row(path, found["key"])
    return found


def damaged_row(path: Path, key: object) -> InputError:
    """Return the refusal of a row whose checksum is another one than that of its values."""
    allowed = f"rows as they were written; that of key {str(key)[:40]!r} is damaged"
    return InputError("store", str(path), allowed)


def checksum(values: Sequence[Any]) -> str:
    """64 bits of the SHA-256 of a row's values; floats by their shortest exact form.

    >>> checksum(["key", 1.0, None]) == checksum(["key", 1, None])
    False
    """
    return hashlib.sha256(json.dumps(values, default=repr).encode()).hexdigest()[:16]


def _key(inputs: object) -> str:
    return hashlib.sha256(str(inputs).encode("utf-8", "replace")).hexdigest()[:32]


def files_of(store: Path) -> tuple[Path, ...]:
    """The store, its lock, and what SQLite keeps beside it."""
    return tuple(store.with_name(store.name + end) for end in ("", ".lock", "-wal", "-shm", "-journal"))


@contextmanager
def open_store(path: Path) -> Iterator[Store]:
    """Open or create a store for one sweep.

    Raises InputError for a file that is not a store, is damaged, cannot be written, has several names, or is
    in use by another sweep or program; and in the block where the disk is full or no longer lets it be
    written. Other faults of the block are raised as they are.
    """
    path = Path(os.path.realpath(path))
    with _locked(path) as is_new:
        kept = not is_new
        try:
            with closing(_connect(path)) as connection:
                store = Store(connection, path)
                try:
                    yield store
                    store.check_place()
                except sqlite3.OperationalError as refused:
                    if refused.sqlite_errorcode & _PRIMARY not in _UNWRITABLE:
                        raise
                    raise _unusable(path, refused) from refused
                finally:
                    kept = kept or _holds_runs(connection)
        except InputError:
            if not kept:  # a refusal leaves no new file, except a store of finished runs
                for file in files_of(path):  # while the store is locked, and so is no other sweep's
                    with suppress(PermissionError):  # Windows keeps the lock's file, which is open
                        file.unlink(missing_ok=True)
            raise


@contextmanager
def _locked(path: Path) -> Iterator[bool]:
    """Lock the store at the path, and yield whether it was made for this."""
    is_new = not os.path.exists(path)  # no error for long names
    for file in files_of(path):
        if os.path.exists(file) and not os.path.isfile(file):
            raise InputError("store", str(file), "a regular file")
    lock = FileLock(f"{path}.lock", timeout=0)
    try:
        path.open("ab").close()
        if (names := os.stat(path).st_nlink) > 1:
            several = f"{path} of {names} names (hard links)"
            raise InputError("store", several, "one name: SQLite keeps its log beside it")
        lock.acquire()
    except Timeout as held:
        raise InputError("store", str(path), "a file that no other sweep is using now") from held
    except OSError as refused:
        raise InputError("store", str(path), f"a file that can be written ({refused.strerror})") from refused
    try:
        yield is_new
    finally:
        with suppress(OSError):
            os.unlink(lock.lock_file)  # before its release: who has opened it meanwhile finds it gone
        lock.release()


def _connect(path: Path) -> sqlite3.Connection:
    """The database, made if it is empty, if its structure and schema are those that this module writes."""
    with _refused(path):
        address = f"{path.as_uri()}?mode=rw"  # never ":memory:"
        connection = sqlite3.connect(address, uri=True, timeout=BUSY_SECONDS, isolation_level=None)
        try:
            connection.execute("pragma trusted_schema = off")
            tables = connection.execute("select count(*) from sqlite_master").fetchone()[0]
            if tables == 0 and _pragma(connection, "application_id") == 0:  # new, or its creation was killed
                connection.execute("begin immediate")
                connection.execute(f"pragma application_id = {APPLICATION_ID}")
                connection.execute(f"pragma user_version = {VERSION}")
                connection.execute(_TABLE)
                connection.execute("commit")
            _check_schema(connection, path)
            for row in connection.execute(_SELECT):
                _checked(row, path)
            connection.execute("pragma journal_mode = wal")
            connection.execute("pragma synchronous = normal")
        except BaseException:
            connection.close()
            raise
    return connection


def _check_schema(connection: sqlite3.Connection, path: Path) -> None:
    """Raise InputError for a file of another program or version, another schema, or a damaged structure."""
    if [_pragma(connection, name) for name in ("application_id", "user_version")] != _OURS:
        raise InputError("store", str(path), f"a file of 'sweep', format version {VERSION}")
    schema = connection.execute("select type, name, tbl_name, sql from sqlite_master").fetchall()
    if schema != [("table", "runs", "runs", _TABLE.replace("create table", "CREATE TABLE", 1))]:
        raise InputError("store", str(path), "a file of 'sweep' with its table and nothing else")
    (found,) = connection.execute("pragma integrity_check(1)").fetchone()
    if found != "ok":
        raise InputError("store", str(path), f"a file that is not damaged ({' '.join(str(found).split())})")


@contextmanager
def _refused(path: Path) -> Iterator[None]:
    """InputError in the place of what SQLite raises for a file; a run that is there twice is no fault."""
    try:
        yield
    except sqlite3.IntegrityError:
        raise
    except sqlite3.OperationalError as refused:
        raise _unusable(path, refused) from refused
    except (sqlite3.DatabaseError, UnicodeDecodeError, OverflowError) as alien:
        raise InputError("store", str(path), f"an SQLite file of 'sweep' ({alien})") from alien


def _unusable(path: Path, refused: sqlite3.OperationalError) -> InputError:
    """The error by its code; Python's own, of texts that are no UTF-8, have none."""
    code = getattr(refused, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & _PRIMARY
    reason = " ".join(str(refused).split())[:100]
    if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return InputError("store", str(path), f"a file that no other program has locked ({reason})")
    if code in (*_UNWRITABLE, sqlite3.SQLITE_CANTOPEN):
        return InputError("store", str(path), f"a file that can be written ({reason})")
    return InputError("store", str(path), f"an undamaged SQLite file of 'sweep' ({reason})")


def _holds_runs(connection: sqlite3.Connection) -> bool:
    """Whether there is any run, or it cannot be told."""
    try:
        return bool(connection.execute("select count(*) from runs").fetchone()[0])
    except sqlite3.Error:
        return True


def _pragma(connection: sqlite3.Connection, name: str) -> int:
    return int(connection.execute(f"pragma {name}").fetchone()[0])
