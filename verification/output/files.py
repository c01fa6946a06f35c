"""Output files that are whole or not there, and a progress line for terminals."""

from __future__ import annotations

import json
import os
import re
import secrets
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Self, TextIO

_UNUSUAL = re.compile(r"[^\n -~]")
_SHOWN = 40  # characters of the name of a target in that of its temporary file


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`, of its suffix, to take its place when the block ends well.

    The file appears in one step, with the mode that the umask leaves, or its old one. A device or a pipe is
    not replaced: the finished file is copied to it; of a link, the file that it leads to is replaced. Raises
    OSError where the directory cannot be written to, or nobody reads the pipe.
    """
    if is_stream(path):
        with tempfile.TemporaryDirectory() as folder:
            yield (whole := Path(folder, f"whole{path.suffix}"))
            with whole.open("rb") as source, open(path, "wb", opener=_open_now) as stream:
                shutil.copyfileobj(source, stream)
        return
    with _temporary(path) as (name, target):
        yield name
        with suppress(FileNotFoundError):
            shutil.copymode(target, name)
        os.replace(name, target)


def _open_now(path: str, flags: int) -> int:
    """Open a stream, but raise OSError where that would wait for somebody who reads it."""
    at_once = getattr(os, "O_NONBLOCK", 0)  # absent on Windows, whose pipes have no names in folders
    handle = os.open(path, flags | at_once)
    if at_once:
        os.set_blocking(handle, True)
    return handle


def is_stream(path: Path) -> bool:
    """Return True if writing there appends, as to a device or a pipe, and replaces nothing."""
    return os.path.exists(path) and not os.path.isfile(path)  # no error for long names


def try_out(path: Path) -> None:
    """Raise OSError where `replacing` could not write in the end, by making the file that it would make."""
    with suppress(FileNotFoundError):
        os.stat(path)  # the temporary file's name is a short one, whatever the length of this one
    if not is_stream(path):
        with _temporary(path):
            pass


@contextmanager
def _temporary(path: Path) -> Iterator[tuple[Path, Path]]:
    """Yield the name of a new file, and the file that a link leads to, beside which it is.

    It has the suffix of the path that was given, and is gone afterwards.
    """
    target = Path(os.path.realpath(path))
    name = target.with_name(f".{target.name[:_SHOWN]}.{secrets.token_hex(8)}{path.suffix}")
    try:
        name.open("xb").close()
        yield name, target
    finally:
        name.unlink(missing_ok=True)  # it may be at its place


def write_text(text: str, path: Path) -> None:
    """Write a UTF-8 text file in one step."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


@contextmanager
def appending(path: Path) -> Iterator[TextIO]:
    """Yield a file of lines, open for more; a last one cut short by a kill is ended first."""
    cut = path.exists() and not path.read_bytes().endswith(b"\n")
    with path.open("a", encoding="utf-8") as lines:
        if cut:
            lines.write("\n")
        yield lines


def to_json(document: object, *, ascii_only: bool = False) -> str:
    """Return JSON text with a final newline; NaN and infinity, which JSON does not have, raise ValueError.

    What is not printable, or is a byte of a file name that is no UTF-8, is escaped.

    >>> to_json("caf\\xe9 \\x9b \\udcff")
    '"caf\xe9 \\\\u009b \\\\udcff"\\n'
    """
    text = json.dumps(document, indent=1, allow_nan=False, ensure_ascii=ascii_only)
    return _UNUSUAL.sub(lambda c: c[0] if c[0].isprintable() else json.dumps(c[0])[1:-1], text) + "\n"


def rewrite_line(text: str) -> None:
    """Replace the last line of stderr, within 78 columns: by spaces, as some consoles obey no escapes."""
    sys.stderr.write(f"\r{text[:78]:<78}" if text else f"\r{'':<78}\r")
    sys.stderr.flush()


class StatusLine:
    """One line of a terminal's stderr, rewritten; cleared after a ``with`` block. Nothing on what is none."""

    pause = 0.1
    """Seconds between two texts, at least."""

    def __init__(self) -> None:
        self._shown, self._next = sys.stderr.isatty(), 0.0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def show(self, text: str) -> None:
        """Rewrite the line, unless it is too early."""
        if self._shown and time.monotonic() >= self._next:
            self._next = time.monotonic() + self.pause
            rewrite_line(text)

    def close(self) -> None:
        """Clear the line; the next text is shown at once."""
        self._next = 0.0
        if self._shown:
            rewrite_line("")


class Progress(StatusLine):
    """Status line with a count of steps, every one of which is shown."""

    pause = 0.0

    def __init__(self, total: int) -> None:
        super().__init__()
        self.total, self.done = total, 0

    def tick(self, text: str) -> None:
        """Count a finished step and show its text, cut to the terminal's usual width."""
        self.done += 1
        self.show(text)

    def show(self, text: str) -> None:
        """Show a text beside the count, such as the step that begins."""
        super().show(f"[{self.done}/{self.total}] {text}")
