"""Subcommands declared by tables of options, and the types of their arguments.

A type raises `argparse.ArgumentTypeError`, which argparse prints.
"""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from verification.framework.files import try_out

Parsers: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"
Options: TypeAlias = dict[str, Mapping[str, Any]]
"""Keywords of `argparse.ArgumentParser.add_argument` by an option's name."""
Value = TypeVar("Value")


def subcommand(
    commands: Parsers,
    name: str,
    run: Callable[[argparse.Namespace], int],
    options: Options,
    one_of: Sequence[str] = (),
    **texts: Any,
) -> argparse.ArgumentParser:
    """Declare a subcommand with its options and ``--json``; ``texts`` are its help, description, epilog."""
    parser = commands.add_parser(name, formatter_class=argparse.RawDescriptionHelpFormatter, **texts)
    declare(parser, options | {"--json": JSON}, one_of)
    parser.set_defaults(run=run)
    return parser


def declare(parser: argparse._ActionsContainer, options: Options, one_of: Sequence[str] = ()) -> None:
    """Declare the options of a table, of which those in ``one_of`` exclude each other."""
    group = parser.add_mutually_exclusive_group() if one_of else parser
    for name, keywords in options.items():
        (group if name in one_of else parser).add_argument(name, **keywords)


def option(help: str, **keywords: Any) -> Mapping[str, Any]:
    """Return a row of a table of options."""
    return {"help": help, **keywords}


def output_file(text: str) -> Path:
    """A file to write: refused at once where it could not be written in the end."""
    path = Path(text)
    if not text:  # it would be the working directory
        raise argparse.ArgumentTypeError("expected a file's name, not ''")
    if text == "-":
        raise argparse.ArgumentTypeError("'-' is no file, and this is no text for standard output")
    if os.path.isdir(path):  # no error for long names
        raise argparse.ArgumentTypeError(f"{text!r} is a directory, not a file")
    try:
        try_out(path)
    except OSError as refused:
        raise argparse.ArgumentTypeError(f"cannot write {text!r}: {refused.strerror}") from refused
    return path


def output_text(text: str) -> Path:
    """A text to write: a file, or '-' for standard output."""
    if not text:
        raise argparse.ArgumentTypeError("expected a file's name, or '-' for standard output, not ''")
    return Path(text) if text == "-" else output_file(text)


def gigabytes(text: str) -> float:
    """A memory: GB, returned in bytes.

    >>> gigabytes("1.5")
    1500000000.0
    """
    return 1e9 * _split(text, float, f"expected a number of GB, not {text!r}")[0]


def on_or_off(text: str) -> bool:
    """A switch.

    >>> on_or_off("off")
    False
    """
    if text not in ("on", "off"):
        raise argparse.ArgumentTypeError(f"{text}: expected on or off")
    return text == "on"


def elements(text: str) -> int | tuple[int, int]:
    """A grid: a number of elements, or two.

    >>> elements("128"), elements("128x64")
    (128, (128, 64))
    """
    expected = f"expected a number of elements, or two like 128x64, not {text!r}"
    numbers = _split(text, int, expected, "x", (1, 2))
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])


def grids(text: str) -> list[int]:
    """A list of grids, rising.

    >>> grids("128,64")
    [64, 128]
    """
    found = sorted(set(_split(text, int, f"{text!r} is no list of grids like 64,128", ",", None)))
    if found[0] < 4:
        raise argparse.ArgumentTypeError(f"{text!r} has a grid of fewer than 4 elements a side")
    return found


def lengths(text: str) -> tuple[float, float]:
    """A size: two lengths (m).

    >>> lengths("83e-6x204e-6")
    (8.3e-05, 0.000204)
    """
    x, y = _split(text, float, f"expected two lengths in m like 2e-3x1e-3, not {text!r}", "x", (2,))
    return x, y


def one_or_two_lengths(text: str) -> tuple[float, float]:
    """One length (m) for both axes, or two.

    >>> one_or_two_lengths("1e-6"), one_or_two_lengths("1e-6,2e-6")
    ((1e-06, 1e-06), (1e-06, 2e-06))
    """
    expected = f"expected a length in m, or two with a comma between, not {text!r}"
    found = _split(text, float, expected, ",", (1, 2))
    return found[0], found[-1]


def number(text: str) -> float:
    """A finite number."""
    return _split(text, _finite, f"{text!r} is not a finite number")[0]


def numbers(text: str) -> list[float]:
    """Finite numbers with commas between them.

    >>> numbers("-10,3.5")
    [-10.0, 3.5]
    """
    return _split(text, _finite, f"{text!r} is not a list of numbers like -3,0,3", ",", None)


def loads(text: str) -> tuple[float, ...]:
    """Loads (N) with commas between them.

    >>> loads("5,80")
    (5.0, 80.0)
    """
    return tuple(_split(text, float, f"{text!r} is no list of numbers like 5,80", ",", None))


def names(text: str) -> tuple[str, ...]:
    """Names with commas between them.

    >>> names("hardness, lower.material.hardness")
    ('hardness', 'lower.material.hardness')
    """
    return tuple(name.strip() for name in text.split(","))


def name_or_number(text: str) -> str | int:
    """A name, or a whole number.

    >>> name_or_number("sphere"), name_or_number("2")
    ('sphere', 2)
    """
    return int(text) if text.isdecimal() else text


def _split(
    text: str,
    kind: Callable[[str], Value],
    expected: str,
    separator: str | None = None,
    counts: Sequence[int] | None = (1,),
) -> list[Value]:
    """The parts of a text as values, as many as one of ``counts``; ``expected`` is the refusal."""
    try:
        found = [kind(part) for part in ([text] if separator is None else text.split(separator))]
    except ValueError as wrong:
        raise argparse.ArgumentTypeError(expected) from wrong
    if counts is not None and len(found) not in counts:
        raise argparse.ArgumentTypeError(expected)
    return found


def _finite(text: str) -> float:
    found = float(text)
    if not math.isfinite(found):
        raise ValueError(text)
    return found


SCENE = option("a TOML file, or the name of a shipped scene", metavar="SCENE")
JSON = option("write the result as JSON ('-' for standard output)", metavar="FILE", type=output_text)
