"""Exceptions with one base: of input that is refused, and of solves that find no answer."""

from __future__ import annotations

import importlib
import math
import numbers
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

LEAST, MOST = 1e-30, 1e30  # lengths, moduli and loads in SI: their squares and products are doubles


class Error(Exception):
    """Base of what `refimpl` raises."""


class NotConverged(Error, ArithmeticError):
    """A solve, or what needs one, did not converge."""


class InputError(Error, ValueError):
    """Input refused at the border: names the field, the value and what is allowed.

    >>> raise InputError("load", -1.0, "a positive force in N")
    Traceback (most recent call last):
    ...
    refimpl.errors.InputError: load = -1.0: expected a positive force in N
    """

    def __init__(self, field: str, value: object, allowed: str) -> None:
        self.field, self.value, self.allowed = field, value, allowed
        try:
            shown = repr(value)
        except ValueError:  # Python writes no whole number of more than 4300 digits
            shown = "a number of thousands of digits"
        except RecursionError:
            shown = "tables in tables"
        if len(shown) > 120:
            shown = shown[:117] + "..."
        super().__init__(printable(f"{field} = {shown}: expected {' '.join(allowed.split())}"))

    def __reduce__(self) -> tuple[type[InputError], tuple[str, object, str]]:
        return type(self), (self.field, self.value, self.allowed)  # so that it crosses process borders


def printable(text: str) -> str:
    """Return the text with what a terminal would obey, or could not show, escaped.

    >>> print(printable("key \x1b[2J"))
    key \\x1b[2J
    """
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


@contextmanager
def within(place: str) -> Iterator[None]:
    """Make refusals from inside name the part of the scene that they are about.

    >>> with within("lower.material"):
    ...     require_number("E", -5, "a positive number", above=0)
    Traceback (most recent call last):
    ...
    refimpl.errors.InputError: lower.material.E = -5: expected a positive number
    """
    try:
        yield
    except InputError as refused:
        raise InputError(f"{place}.{refused.field}", refused.value, refused.allowed) from refused.__cause__


def as_double(value: Any) -> float:
    """Return the number as a double; infinite where it is a whole number that no double holds.

    >>> as_double(10**400)
    inf
    """
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def require_number(
    field: str,
    value: object,
    allowed: str,
    *,
    above: float | None = None,
    at_least: float | None = None,
    below: float | None = None,
    at_most: float | None = None,
) -> float:
    """Return ``value`` as a double; raise `InputError` unless it is finite, real and within the bounds."""
    if not isinstance(value, bool) and isinstance(value, numbers.Real):
        number = as_double(value)
        if (
            math.isfinite(number)
            and (above is None or number > above)
            and (at_least is None or number >= at_least)
            and (below is None or number < below)
            and (at_most is None or number <= at_most)
        ):
            return number
    raise InputError(field, value, allowed)


def is_whole(value: object) -> bool:
    """Return whether this is a whole number, Python's or NumPy's, and no truth value."""
    return not isinstance(value, bool) and isinstance(value, numbers.Integral)


def keep_doubles(parameters: object, *names: str) -> None:
    """Store what `require_number` let pass of a frozen dataclass as doubles; None stays."""
    for name in names:
        value = getattr(parameters, name)
        if value is not None:
            object.__setattr__(parameters, name, float(value))


def require_size(field: str, value: object, allowed: str) -> float:
    """Return ``value`` as a double; raise `InputError` unless it is a positive size that arithmetic can bear.

    >>> require_size("side", 1e-200, "a positive length in m")
    Traceback (most recent call last):
    ...
    refimpl.errors.InputError: side = 1e-200: expected a positive length in m, 1e-30 to 1e+30
    """
    return require_number(field, value, f"{allowed}, {LEAST} to {MOST}", at_least=LEAST, at_most=MOST)


def require_one_of(field: str, value: object, allowed: Iterable[str]) -> None:
    """Raise `InputError` unless ``value`` is one of these texts.

    >>> require_one_of("method", ["fft"], ("fft", "dense"))
    Traceback (most recent call last):
    ...
    refimpl.errors.InputError: method = ['fft']: expected one of fft, dense
    """
    known = tuple(allowed)
    if not isinstance(value, str) or value not in known:
        raise InputError(field, value, f"one of {', '.join(known)}")


def require_regular(field: str, path: Path, most: int) -> None:
    """Raise `InputError` for a device or a pipe, which may have no end, and for a file of more bytes."""
    found = os.path.exists(path) and not os.path.isdir(path)  # no error for long names
    if found and not (os.path.isfile(path) and os.path.getsize(path) <= most):
        raise InputError(field, str(path), f"a regular file of at most {most} bytes")


def require_installed(field: str, value: object, allowed: str, *modules: str) -> None:
    """Raise `InputError` unless all modules of an optional library can be imported."""
    try:
        for module in modules:
            importlib.import_module(module)
    except ModuleNotFoundError as missing:
        raise InputError(field, value, allowed) from missing


def size_text(lengths: Iterable[float]) -> str:
    """Return lengths or counts as they stand in messages: ``a x b``, six digits each.

    >>> size_text((1.61e-3, 0.5)), size_text((64, 32))
    ('0.00161 x 0.5', '64 x 32')
    """
    return " x ".join(f"{length:.6g}" for length in lengths)
