"""Pages that tell the truth: every block of a Markdown page is run in order, and what it prints is compared.

- ``python`` is run, all such blocks of a page in one namespace; a ``text`` block after it is its output.
- ``console`` holds commands after ``$ `` and, where any is shown, the output of each below it.
- A block with a name after its language (``toml rough.toml``) is a file, written before what follows is run.

Numbers agree within one unit of their last printed digit, whole numbers exactly; blanks agree with blanks;
``...`` stands for any text.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from importlib.metadata import entry_points
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FENCE = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```$", flags=re.M | re.S)
NUMBER = r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
PIECES = re.compile(rf"({NUMBER})|(\.\.\.)|(\s+)|(.)", flags=re.S)
STATUS = ' || echo "status $?"'
LANGUAGES = ("python", "text", "console", "toml", "json", "bibtex")


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, the file that it is (or ""), its text."""

    language: str
    file: str
    text: str


def blocks(page: str) -> list[Block]:
    """The fenced blocks of a page, in order."""
    return [Block(*match) for match in FENCE.findall(page)]


def commands(block: Block) -> Iterator[tuple[str, str]]:
    """Each command of a console block with the output stated below it."""
    for part in re.split(r"^\$ ", block.text, flags=re.M)[1:]:
        command, _, stated = part.partition("\n")
        yield command, stated


def agree(printed: str, stated: str) -> bool:
    """Whether a stated output is the printed one, by the rules above."""
    pattern, numbers = "", []
    for number, gap, blank, other in PIECES.findall(stated.strip()):
        numbers += [number] if number else []
        pattern += f"({NUMBER})" if number else ".*?" if gap else r"\s+" if blank else re.escape(other)
    found = re.fullmatch(pattern, printed.strip(), flags=re.S)
    return found is not None and all(map(_close, found.groups(), numbers))


def _close(printed: str, stated: str) -> bool:
    found, said = Decimal(printed), Decimal(stated)
    exact = re.fullmatch(r"[-+]?\d+", stated) is not None
    return found == said if exact else abs(found - said) <= Decimal(1).scaleb(int(said.as_tuple().exponent))


def run(page: str, folder: Path) -> int:
    """Run a page's blocks in a folder; how many outputs were compared. AssertionError names what differs."""
    compared, names, printed = 0, {"__name__": "__main__"}, ""
    with contextlib.chdir(folder):
        for block in blocks(page):
            assert block.language in LANGUAGES, f"a {block.language} block is not run by anything"
            if block.file:
                Path(block.file).write_text(block.text, encoding="utf-8")
            elif block.language == "python":
                printed = _evaluated(block.text, names)
            elif block.language == "text":
                assert agree(printed, block.text), f"printed:\n{printed}\nstated:\n{block.text}"
                compared += 1
            else:
                assert block.language == "console", f"a {block.language} block is neither a file nor run"
                compared += sum(_held(command, stated) for command, stated in commands(block))
    return compared


def _evaluated(source: str, names: dict[str, object]) -> str:
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(compile(source, "page.md", "exec"), names)
    return printed.getvalue()


def _held(command: str, stated: str) -> bool:
    printed = shell(command)
    assert not stated.strip() or agree(printed, stated), f"$ {command}\n{printed}\nstated:\n{stated}"
    return bool(stated.strip())


def shell(command: str) -> str:
    """What a command prints on stdout; its status must be 0, or be asked for by an ``echo`` after it.

    `rough-friction` is called in this process, by its entry point; `python` is this interpreter.
    """
    line, asked, _ = command.partition(STATUS)
    name, *arguments = shlex.split(line)
    if Path(name).name == "rough-friction":
        status, printed = _console_script(arguments)
    else:
        built = name.startswith("./") and Path(name).is_file()  # by a command before it
        assert name in ("cc", "python") or built, f"not run: {command}"
        words = [sys.executable if name == "python" else name, *arguments]
        quiet = {**os.environ, "MPLBACKEND": "agg"}
        done = subprocess.run(words, capture_output=True, text=True, env=quiet, check=False)
        status, printed = done.returncode, done.stdout
        assert status == 0 or asked, f"$ {command}\n{done.stderr}"
    assert status == 0 or asked, f"$ {command}: status {status}\n{printed}"
    return printed + (f"status {status}\n" if asked and status else "")


def _console_script(arguments: list[str]) -> tuple[int, str]:
    (script,) = entry_points(group="console_scripts", name="rough-friction")
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        status: int = script.load()(arguments)
    return status, printed.getvalue()
