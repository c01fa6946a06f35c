"""The one exception that people's input can raise."""

from __future__ import annotations


class InputError(ValueError):
    """Input refused at the border: names the field, the value and what is allowed.

    >>> raise InputError("load", -1.0, "a positive force in N")
    Traceback (most recent call last):
    ...
    refimpl.errors.InputError: load = -1.0: expected a positive force in N
    """

    def __init__(self, field: str, value: object, allowed: str) -> None:
        self.field, self.value, self.allowed = field, value, allowed
        shown = repr(value)
        if len(shown) > 120:
            shown = shown[:117] + "..."
        super().__init__(f"{field} = {shown}: expected {allowed}")
