"""Digits of numbers with error bars: what is printed differs from the number by half a digit of the bar."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.accuracy.digits import bar_of, digits_of, usable, verdict


@pytest.mark.parametrize(
    ("value", "error", "printed", "bar"),
    [
        (0.112913, 0.2, "0.11", "+- 0.2"),  # the three numbers once printed with six digits
        (222802.0, 3e7, "220000", "+- 3e+07"),
        (5.84, 3.0, "6", "+- 3"),
        (0.0992525, 0.00104, "0.0993", "+- 0.0010"),
        (0.9996, 0.02, "1.00", "+- 0.02"),
        (1.61e-7, 3e-9, "1.61e-07", "+- 3e-09"),
        (-0.5567, 0.01, "-0.557", "+- 0.010"),
        (0.0, 0.003, "0", "+- 0.003"),
        (1234567.0, 0.0, "1.23457e+06", ""),
    ],
)
def test_a_number_has_the_digits_that_its_bar_leaves(
    value: float, error: float, printed: str, bar: str
) -> None:
    assert (digits_of(value, error), bar_of(error)) == (printed, bar)


@pytest.mark.parametrize(("error", "named"), [(0.0, ""), (0.5, ""), (0.51, "(not usable)")])
def test_half_of_the_value_is_the_largest_usable_bar(error: float, named: str) -> None:
    assert verdict(error, -1.0) == named
    assert usable(error, 1.0) is not bool(named)


@given(st.floats(1e-12, 1e12), st.floats(1e-7, 0.999))
def test_rounding_is_within_half_a_digit_of_the_bar(value: float, share: float) -> None:
    """The first digit of a bar is 2 or more, or there are two: the bar is off by a fourth, the value by
    another of it; six digits of the value are enough for any bar.
    """
    error = value * share
    assert abs(float(digits_of(value, error)) - value) <= max(0.2565 * error, 5.001e-6 * value)
    assert abs(float(bar_of(error)[3:]) - error) <= 0.2565 * error


@given(st.floats(1e-9, 1e9), st.floats(1.0, 1e6))
def test_a_number_without_a_meaning_has_two_digits(value: float, share: float) -> None:
    digits = digits_of(value, value * share).partition("e")[0].replace(".", "").strip("0")
    assert re.fullmatch(r"\d{1,2}", digits)
