"""One verification case: what is claimed, how it is judged, and the verdict. Everything here fails closed.

A case passes only if its function returned, its numbers are finite, its reference is at least as certain as
its tolerance, and its error is within that tolerance. Whatever else happens is named: `fail`, `error` (could
not be judged) or `unavailable` (an optional dependency is missing), and none of these is a pass.
"""

from __future__ import annotations

import math
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from inspect import unwrap
from types import CodeType
from typing import Any

import numpy as np

LONGEST_NOTE = 1000
"""Characters of somebody else's message that a note keeps."""
SERIES_DIGITS = 6
MAP_DIGITS = 3
"""Digits of recorded numbers; for a map as many as 256 colours show."""
MAP_SIZE = 1000
"""Fewest numbers of a map."""


class Unavailable(Exception):
    """Raised by a case whose optional dependency is missing; the message says which."""


class Reported(Exception):
    """Raised for a failure in another process; the message is the whole note, with the failure's place."""


class Disproved(Exception):
    """Raised by a case whose subject is wrong before any error is measured; the message says how. A fail."""


class Metric(StrEnum):
    """Definition of a case's error from its value; a closed list."""

    RELATIVE = "relative"  # |value - reference| / |reference|
    ABSOLUTE = "absolute"  # |value - reference|
    AT_MOST = "at_most"  # the value is itself an error, and has no reference
    AT_LEAST = "at_least"  # the value is a figure of merit, and has no reference
    EQUAL = "equal"  # exact


class Tier(StrEnum):
    """`full` runs the quick cases as well."""

    QUICK = "quick"
    FULL = "full"


class Status(StrEnum):
    """The verdict on a case; only PASS is a pass."""

    PASS = "pass"
    FAIL = "fail"
    ERROR = "error"
    UNAVAILABLE = "unavailable"


@dataclass(frozen=True)
class Measured:
    """Result of a case's function.

    `value`, `reference` and `reference_uncertainty` share one `unit`. `data` maps labels to numbers, strings
    or (nested) series, for figures; `note` is for the reader.
    """

    value: float
    reference: float | None = None
    reference_uncertainty: float = 0.0
    unit: str = ""
    data: Mapping[str, object] = field(default_factory=dict)
    note: str = ""


@dataclass(frozen=True)
class Result:
    """A judged case, ready for JSON: strings, finite numbers, lists and None only."""

    id: str
    title: str
    claim: str
    source: str
    metric: str
    value: float | None
    reference: float | None
    reference_uncertainty: float | None
    error: float | None
    tolerance: float
    tolerance_reason: str
    status: str
    seconds: float
    unit: str
    note: str
    tier: str
    data: dict[str, object]


@dataclass(frozen=True)
class Case:
    """A declared check. `function` takes nothing and returns a `Measured`; `tolerance_reason` is never empty.

    Raises ValueError for an unknown metric or tier, an empty text, or a tolerance no error could be held to.
    """

    id: str
    title: str
    claim: str
    source: str
    metric: Metric
    tolerance: float
    tolerance_reason: str
    function: Callable[[], Measured]
    tier: Tier = Tier.QUICK

    def __post_init__(self) -> None:
        object.__setattr__(self, "metric", Metric(self.metric))
        object.__setattr__(self, "tier", Tier(self.tier))
        for name in ("title", "claim", "source", "tolerance_reason"):
            if not getattr(self, name).strip():
                raise ValueError(f"case {self.id!r}: {name} is empty")
        subject, _, slug = self.id.partition("/")
        if not subject or not slug or any(c.isspace() for c in self.id):
            raise ValueError(f"case {self.id!r}: an id is 'subject/slug', without blanks")
        if not math.isfinite(self.tolerance) or (self.tolerance < 0 and self.metric is not Metric.AT_LEAST):
            raise ValueError(f"case {self.id!r}: tolerance {self.tolerance!r} is not finite and >= 0")
        if self.metric is Metric.EQUAL and self.tolerance != 0:
            raise ValueError(f"case {self.id!r}: 'equal' is exact; its tolerance is 0")

    @property
    def module(self) -> str:
        """Dotted name of the module that declares the case."""
        return self.function.__module__

    @property
    def code(self) -> CodeType:
        """Compiled function, beneath what wraps it."""
        code: CodeType = unwrap(self.function).__code__
        return code

    @property
    def line(self) -> int:
        """Line of the function in its module; orders the cases of one module."""
        return self.code.co_firstlineno

    def run(self) -> Result:
        """Run the function and judge what it returned; never raises for what the function does."""
        start = time.perf_counter()
        measured, error, status, note = None, None, Status.ERROR, ""
        try:
            measured = self.function()
            data = jsonable(dict(measured.data))
            error = error_of(self.metric, self.tolerance, measured)
        except Unavailable as missing:
            status, note = Status.UNAVAILABLE, readable(str(missing)) or "an optional dependency is missing"
        except Disproved as wrong:
            status, note = Status.FAIL, readable(str(wrong))
        except Reported as elsewhere:
            note = readable(str(elsewhere))
        # The one place that takes any failure: a case that breaks, or asks to exit, gets its verdict as well.
        except (Exception, SystemExit) as failure:
            note = f"{type(failure).__name__}: {readable(str(failure))} [{_place(failure)}]"
        if measured is None or error is None:
            return self.result(status, note, time.perf_counter() - start)
        within = error >= self.tolerance if self.metric is Metric.AT_LEAST else error <= self.tolerance
        verdict = Status.PASS if within else Status.FAIL
        return self.result(verdict, measured.note, time.perf_counter() - start, measured, error, data)

    def result(
        self,
        status: Status,
        note: str,
        seconds: float,
        measured: Measured | None = None,
        error: float | None = None,
        data: object = None,
    ) -> Result:
        """Return the case with a verdict; the numbers stay None where nothing was measured."""
        reference = None if measured is None or measured.reference is None else float(measured.reference)
        return Result(
            id=self.id,
            title=self.title,
            claim=self.claim,
            source=self.source,
            metric=self.metric.value,
            value=None if measured is None else float(measured.value),
            reference=reference,
            reference_uncertainty=None if measured is None else float(measured.reference_uncertainty),
            error=error,
            tolerance=float(self.tolerance),
            tolerance_reason=self.tolerance_reason,
            status=status.value,
            seconds=round(seconds, 3),
            unit="" if measured is None else measured.unit,
            note=note,
            tier=self.tier.value,
            data=data if isinstance(data, dict) else {},
        )


def error_of(metric: Metric, tolerance: float, measured: Measured) -> float:
    """Return the error of a measurement under a metric.

    Raises ValueError when the numbers cannot be judged: not finite, no reference where one is needed (or one
    where it would be ignored), a relative error against zero, or a reference less certain than the tolerance.

    >>> error_of(Metric.RELATIVE, 0.1, Measured(value=1.02, reference=1.0))
    0.020000000000000018
    """
    value, reference = _finite("value", measured.value), measured.reference
    uncertainty = _finite("reference_uncertainty", measured.reference_uncertainty)
    if uncertainty < 0:
        raise ValueError(f"reference_uncertainty {uncertainty!r} is negative")
    if metric in (Metric.AT_LEAST, Metric.AT_MOST):
        if reference is not None:
            raise ValueError(f"{metric.value!r} judges the value itself; a reference would be ignored")
        if value < 0 and metric is Metric.AT_MOST:
            raise ValueError(f"value {value!r} is negative, so it is no error measure")
        return value
    if reference is None:
        raise ValueError(f"metric {metric.value!r} needs a reference")
    reference = _finite("reference", reference)
    scale = abs(reference) if metric is Metric.RELATIVE else 1.0
    if scale == 0:
        raise ValueError("a relative error against a reference of zero")
    if uncertainty / scale > tolerance:
        raise ValueError(f"the reference is uncertain by {uncertainty / scale:.3g}, more than the tolerance")
    return _finite("error", abs(value - reference) / scale)


def jsonable(item: object) -> object:
    """Return `item` as JSON can hold it: arrays to lists, NaN and inf to None; series have 6 digits, maps 3.

    A map is a list of lists with at least `MAP_SIZE` numbers.
    Raises TypeError for anything that is not a number, a text, a mapping or a series of such.
    """
    return _jsonable(item, SERIES_DIGITS)


def _jsonable(item: object, digits: int) -> object:
    if item is None or isinstance(item, bool | str):
        return item
    if isinstance(item, np.ndarray | np.generic):
        return _jsonable(item.tolist(), digits)
    if isinstance(item, int):
        return item
    if isinstance(item, float):
        return float(f"{item:.{digits}g}") if math.isfinite(item) else None
    if isinstance(item, Mapping):
        return {str(key): _jsonable(value, digits) for key, value in item.items()}
    if isinstance(item, list | tuple):
        inner = MAP_DIGITS if _is_map(item) else digits
        return [_jsonable(value, inner) for value in item]
    raise TypeError(f"data holds a {type(item).__name__}, which JSON cannot")


def _is_map(item: Sequence[object]) -> bool:
    rows = [row for row in item if isinstance(row, list | tuple)]
    return len(rows) == len(item) and sum(map(len, rows)) >= MAP_SIZE


def readable(text: str) -> str:
    """Return foreign text as any UTF-8 file takes it, without its middle where it is long.

    >>> readable("no licence in caf\\udce9")
    'no licence in caf?'
    """
    if len(text) > LONGEST_NOTE:
        text = f"{text[: LONGEST_NOTE // 2]} ... {text[-LONGEST_NOTE // 2 :]}"
    return text.encode("utf-8", "replace").decode()


def _finite(name: str, number: Any) -> float:
    if isinstance(number, str) or not math.isfinite(number):
        raise ValueError(f"{name} {number!r} is not a finite number")
    return float(number)


def _place(failure: BaseException) -> str:
    """Return file name and line where it was raised; no directories, which differ by machine."""
    frames = traceback.extract_tb(failure.__traceback__)
    return f"{frames[-1].filename.rsplit('/', 1)[-1]}:{frames[-1].lineno}" if frames else "no traceback"
