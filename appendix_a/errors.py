"""The exception that people's input can raise in this package (it imports none of the others)."""

from __future__ import annotations


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
