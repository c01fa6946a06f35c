"""Argument types of the command line; each raises `argparse.ArgumentTypeError`, which argparse prints."""

from __future__ import annotations

import argparse


def gigabytes(text: str) -> float:
    """Argument type of a memory: GB, returned in bytes.

    >>> gigabytes("1.5")
    1500000000.0
    """
    try:
        return 1e9 * float(text)
    except ValueError as wrong:
        raise argparse.ArgumentTypeError(f"expected a number of GB, not {text!r}") from wrong


def on_or_off(text: str) -> bool:
    """Argument type of a switch.

    >>> on_or_off("off")
    False
    """
    if text not in ("on", "off"):
        raise argparse.ArgumentTypeError(f"{text}: expected on or off")
    return text == "on"


def elements(text: str) -> int | tuple[int, int]:
    """Argument type of a grid: a number, or two.

    >>> elements("128"), elements("128x64")
    (128, (128, 64))
    """
    try:
        numbers = [int(number) for number in text.split("x")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2):
        raise argparse.ArgumentTypeError(f"expected a number of elements, or two like 128x64, not {text!r}")
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])


def lengths(text: str) -> tuple[float, float]:
    """Argument type of a size: two lengths (m).

    >>> lengths("83e-6x204e-6")
    (8.3e-05, 0.000204)
    """
    try:
        x, y = (float(length) for length in text.split("x"))
    except ValueError as wrong:
        raise argparse.ArgumentTypeError(f"expected two lengths in m like 2e-3x1e-3, not {text!r}") from wrong
    return x, y


def grids(text: str) -> list[int]:
    """Argument type of a list of grids, rising.

    >>> grids("128,64")
    [64, 128]
    """
    try:
        numbers = sorted({int(part) for part in text.split(",")})
    except ValueError as wrong:
        raise argparse.ArgumentTypeError(f"{text!r} is no list of grids like 64,128") from wrong
    if numbers[0] < 4:
        raise argparse.ArgumentTypeError(f"{text!r} has a grid of fewer than 4 elements a side")
    return numbers
