"""Subcommands declared by tables of options, and the types of their arguments.

A type raises `argparse.ArgumentTypeError`, which argparse prints.

>>> gigabytes("1.5"), elements("128"), elements("128x64"), lengths("83e-6x204e-6")
(1500000000.0, 128, (128, 64), (8.3e-05, 0.000204))
>>> one_or_two_lengths("1e-6"), one_or_two_lengths("1e-6,2e-6"), numbers("-10,3.5"), loads("5,80")
((1e-06, 1e-06), (1e-06, 2e-06), [-10.0, 3.5], (5.0, 80.0))
"""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from verification.output.files import try_out

Parsers: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"
Options: TypeAlias = dict[str, Mapping[str, Any]]
"""Keywords of `argparse.ArgumentParser.add_argument` by an option's name."""
DEFAULT_GRID = "default 256; of a measured map its own points, up to 512"  # `refimpl.Scene.default_grid`
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


def output_file(text: str, suffixes: Sequence[str] = ()) -> Path:
    """Parse the name of a file to write, and refuse it where it could not be written in the end."""
    path = Path(text)
    if not text:  # it would be the working directory
        raise argparse.ArgumentTypeError("expected a file's name, not ''")
    if text == "-":
        raise argparse.ArgumentTypeError("'-' is no file, and this is no text for standard output")
    from refimpl.operating_system import is_device  # here and not above: --help is quick

    if is_device(path.name) and path.suffix:
        raise argparse.ArgumentTypeError(f"{text!r} is a device on Windows, not a file")
    if suffixes and path.suffix not in suffixes:
        *others, last = suffixes
        ends = f"{', '.join(others)} or {last}" if others else last
        raise argparse.ArgumentTypeError(f"expected a file name that ends in {ends}, not {text!r}")
    if os.path.isdir(path):  # no error for long names
        raise argparse.ArgumentTypeError(f"{text!r} is a directory, not a file")
    try:
        try_out(path)
    except OSError as refused:
        raise argparse.ArgumentTypeError(f"cannot write {text!r}: {refused.strerror}") from refused
    return path


def file_of(*suffixes: str) -> Callable[[str], Path]:
    """Return the type of a file to write whose name ends in one of the suffixes."""
    return partial(output_file, suffixes=suffixes)


picture = file_of(".png", ".svg", ".pdf")
"""A picture to write."""


def output_text(text: str) -> Path:
    """Parse the name of a text to write: a file, or '-' for standard output."""
    if not text:
        raise argparse.ArgumentTypeError("expected a file's name, or '-' for standard output, not ''")
    return Path(text) if text == "-" else output_file(text)


def on_or_off(text: str) -> bool:
    """Parse a switch.

    >>> on_or_off("off")
    False
    """
    if text not in ("on", "off"):
        raise argparse.ArgumentTypeError(f"{text}: expected on or off")
    return text == "on"


def grids(text: str) -> list[int]:
    """Parse a list of grids, rising.

    >>> grids("128,64")
    [64, 128]
    """
    found: list[int] = _grids(text)
    if found[0] < 4:
        raise argparse.ArgumentTypeError(f"{text!r} has a grid of fewer than 4 elements a side")
    return found


def names(text: str) -> tuple[str, ...]:
    """Parse names with commas between them.

    >>> names("hardness, lower.material.hardness")
    ('hardness', 'lower.material.hardness')
    """
    return tuple(name.strip() for name in text.split(","))


def name_or_number(text: str) -> str | int:
    """Parse a name, or a whole number.

    >>> name_or_number("sphere"), name_or_number("2")
    ('sphere', 2)
    """
    return int(text) if text.isdecimal() else text


def _parts(
    expected: str,
    kind: Callable[[str], Value],
    made: Callable[[list[Value]], Any],
    separator: str | None = None,
    counts: Sequence[int] | None = (1,),
) -> Callable[[str], Any]:
    """Return the type of a text of as many values as one of ``counts``; ``expected`` is its refusal."""

    def parts(text: str) -> Any:
        try:
            found = [kind(part) for part in ([text] if separator is None else text.split(separator))]
        except ValueError as wrong:
            raise argparse.ArgumentTypeError(expected.format(text)) from wrong
        if counts is not None and len(found) not in counts:
            raise argparse.ArgumentTypeError(expected.format(text))
        return made(found)

    return parts


def _finite(text: str) -> float:
    found = float(text)
    if not math.isfinite(found):
        raise ValueError(text)
    return found


gigabytes = _parts("expected a number of GB, not {!r}", float, lambda found: 1e9 * found[0])
"""A memory: GB, returned in bytes."""
elements = _parts(
    "expected a number of elements, or two like 128x64, not {!r}",
    int,
    lambda found: found[0] if len(found) == 1 else tuple(found),
    "x",
    (1, 2),
)
"""A grid: a number of elements, or two."""
lengths = _parts("expected two lengths in m like 2e-3x1e-3, not {!r}", float, tuple, "x", (2,))
"""A size: two lengths (m)."""
three_numbers = _parts("expected three numbers like 210e9,0.3,10, not {!r}", float, tuple, ",", (3,))
"""A modulus (Pa), Poisson's ratio and a load (N)."""
one_or_two_lengths = _parts(
    "expected a length in m, or two with a comma between, not {!r}",
    float,
    lambda found: (found[0], found[-1]),
    ",",
    (1, 2),
)
"""One length (m) for both axes, or two."""
number = _parts("{!r} is not a finite number", _finite, lambda found: found[0])
"""A finite number."""
numbers = _parts("{!r} is not a list of numbers like -3,0,3", _finite, list, ",", None)
"""Finite numbers with commas between them."""
loads = _parts("{!r} is no list of numbers like 5,80", float, tuple, ",", None)
"""Loads (N) with commas between them."""
_grids = _parts("{!r} is no list of grids like 64,128", int, lambda found: sorted(set(found)), ",", None)

SCENE = option("a TOML file, or the name of a shipped scene", metavar="SCENE")
JSON = option("write the result as JSON ('-' for standard output)", metavar="FILE", type=output_text)
