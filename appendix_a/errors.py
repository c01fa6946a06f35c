"""The exception that people's input can raise in this package (it imports none of the others)."""

from __future__ import annotations

import math
import numbers
from typing import Any

import numpy as np
from numpy.typing import NDArray


class InputError(ValueError):
    """Input refused at the border: names the field, the value and what is allowed.

    >>> raise InputError("gamma", 2.0, "a slope angle in [0, pi/2) rad")
    Traceback (most recent call last):
    ...
    appendix_a.errors.InputError: gamma = 2.0: expected a slope angle in [0, pi/2) rad
    """

    def __init__(self, field: str, value: object, allowed: str) -> None:
        self.field, self.value, self.allowed = field, value, allowed
        super().__init__(f"{field} = {value!r:.120}: expected {allowed}")

    def __reduce__(self) -> tuple[type[InputError], tuple[str, object, str]]:
        return type(self), (self.field, self.value, self.allowed)  # so that it crosses process borders


def real(value: object) -> float:
    """Return the number as a double; NaN, which no range holds, for anything that is no real number.

    >>> real(3), real("3"), real(True), real(None)
    (3.0, nan, nan, nan)
    """
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return math.nan
    number: Any = value
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


def reals(field: str, values: object, allowed: str) -> NDArray[np.float64]:
    """Return numbers of any shape as doubles. Raises InputError for texts, truths, ragged lists and the like.

    >>> reals("offsets", [1, 2.5], "a list of numbers")
    array([1. , 2.5])
    >>> reals("offsets", ["1"], "a list of numbers")
    Traceback (most recent call last):
    ...
    appendix_a.errors.InputError: offsets = ['1']: expected a list of numbers
    """
    try:
        found = np.asarray(values)
    except ValueError:  # ragged
        found = np.asarray(None)
    if found.dtype.kind not in "iuf" and any(math.isnan(real(value)) for value in found.ravel().tolist()):
        raise InputError(field, values, allowed)
    return found.astype(np.float64)
