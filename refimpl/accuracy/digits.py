"""Digits and verdict of a number with an error bar: as many digits as the bar leaves, or "not usable"."""

from __future__ import annotations

import math

LARGEST_SHARE = 0.5  # largest usable bar over the value: beyond, the number is known to a factor of 3 at best
MOST_DIGITS = 6  # significant digits of a number whose bar is shorter than they show, or zero
UNKNOWN_DIGITS = 3  # significant digits of a number whose bar is not known
_FIXED = 1e-4, 1e6  # magnitudes that are printed without an exponent


def usable(error: float, scale: float) -> bool:
    """Return whether a bar leaves a number with a meaning: at most half of ``scale``, the number's magnitude.

    >>> usable(0.05, 0.11), usable(0.2, 0.112913), usable(math.inf, 1.0), usable(0.0, 0.0)
    (True, False, False, True)
    """
    return error <= LARGEST_SHARE * abs(scale)


def digits_beside(value: float, limit: float) -> str:
    """Return a number with two significant digits, or as many as show on which side of a limit it is.

    >>> digits_beside(2.97, 3.0), digits_beside(2.7134, 3.0), digits_beside(2.9996, 3.0)
    ('2.97', '2.7', '2.9996')
    """
    texts = (f"{value:.{digits}g}" for digits in range(2, 18))
    return next((text for text in texts if (float(text) - limit) * (value - limit) > 0), f"{value:.2g}")


def digits_of(value: float, error: float | None) -> str:
    """Return a number rounded to the last digit of its bar: at most six digits, two if the bar is longer.

    Three digits without a bar that is known.

    >>> digits_of(0.112913, 0.00213), digits_of(1234.4, 30.0), digits_of(0.0996, 0.001), digits_of(2.0, 0.0)
    ('0.113', '1230', '0.0996', '2')
    >>> digits_of(0.112913, 0.2), digits_of(222802.0, 3e7), digits_of(0.1, math.inf), digits_of(math.nan, 1.0)
    ('0.11', '220000', '0.10', 'n/a')
    >>> digits_of(4.5671, None)
    '4.57'
    """
    if not math.isfinite(value):
        return "n/a"
    if error is None and value:
        return _printed(value, _leading(value) - UNKNOWN_DIGITS + 1)
    if not error or value == 0:
        return f"{value:.{MOST_DIGITS}g}"
    if not error < abs(value):
        return _printed(value, _leading(value) - 1)
    return _printed(value, max(_last_place(error), _leading(value) - MOST_DIGITS + 1))


def bar_of(error: float | None) -> str:
    """Return a bar with one digit, two where the first is a 1; nothing for a number that is exact.

    "-" for a bar that is not known.

    >>> bar_of(0.00213), bar_of(0.00136), bar_of(0.0096), bar_of(3e7), bar_of(0.0)
    ('+- 0.002', '+- 0.0014', '+- 0.010', '+- 3e+07', '')
    >>> bar_of(math.inf)
    'unbounded'
    """
    if error is None:
        return "-"
    if math.isinf(error):
        return "unbounded"
    return f"+- {_printed(error, _last_place(error))}" if error > 0 else ""


def verdict(error: float | None, scale: float) -> str:
    """Return "(not usable)" for a bar above half of the number's magnitude, nothing otherwise."""
    return "" if error is None or usable(error, scale) else "(not usable)"


def _leading(value: float) -> int:
    """Return the exponent of ten of the first digit."""
    return math.floor(math.log10(abs(value)))


def _last_place(error: float) -> int:
    """Return the exponent of ten of the last digit that a bar is printed with."""
    rounded = float(f"{error:.1e}")  # 0.00996 is 0.010
    place = _leading(rounded)
    return place - 1 if rounded < 1.95 * 10.0**place else place


def _printed(value: float, place: int) -> str:
    shown = round(value, -place)
    if shown == 0 or _FIXED[0] <= abs(shown) < _FIXED[1]:
        return f"{shown:.{max(-place, 0)}f}"
    return f"{shown:.{max(_leading(shown) - place, 0)}e}"
