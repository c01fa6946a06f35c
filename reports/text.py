"""Numbers and symbols as the report prints them."""

from __future__ import annotations

import math
import re

from reports.results import Case

_UNITS = {"Pa": ("MPa", 1e-6), "m": ("µm", 1e6)}
_SYMBOLS = (
    (re.compile(r"\bsigma_e\b"), "σ_e"),
    (re.compile(r"\bmu\b"), "μ"),
    (re.compile(r"\b(f_max|f_\{max\})\b"), "p_max"),
    (re.compile(r"\btau\b"), "τ"),
    (re.compile(r"\bbeta\b"), "β"),
    (re.compile(r"\bpsi\b"), "ψ"),
    (re.compile(r"(?<=[\d (])u(?=[mN]\b)"), "µ"),
    (re.compile(r"\bmm\^2"), "mm²"),
    (re.compile(r"\+-"), "±"),
    (re.compile(r"(?<=[ (])>="), "≥"),
    (re.compile(r"(?<=[ (])<="), "≤"),
)


def quoted(text: str) -> str:
    """Return a text of the paper with symbols, and its f_max as it is printed.

    >>> quoted("mu and f_{max} at sigma_e = 0.5 um")
    'μ and f_max at σ_e = 0.5 µm'
    """
    return symbols(text.replace("f_{max}", "f_max").replace("f_max", "f_\0max")).replace("f_\0max", "f_max")


def symbols(text: str) -> str:
    """Return the text with Greek letters and units as symbols.

    >>> symbols("mu = 0.11 +- 0.01 at 0.5 um")
    'μ = 0.11 ± 0.01 at 0.5 µm'
    """
    for pattern, symbol in _SYMBOLS:
        text = pattern.sub(symbol, text)
    return text


def number(value: float | None, digits: int = 4) -> str:
    """Return a number for a table; what was not measured is "n/a", never 0.

    >>> number(None), number(0.25), number(171.0512, 6)
    ('n/a', '0.25', '171.051')
    """
    return "n/a" if value is None else f"{value:.{digits}g}"


def interval(value: float, half_width: float) -> str:
    """Return the value with the decimals of its interval's two digits; four digits where there is none.

    >>> interval(0.10729513, 0.00042692), interval(12.345, 3.0), interval(0.21550513, 0.0)
    ('0.10730 ± 0.00043', '12.3 ± 3.0', '0.2155')
    """
    if half_width == 0:
        return f"{value:.4g}"
    places = decimals(half_width)
    return f"{value:.{places}f} ± {half_width:.{places}f}"


def decimals(uncertainty: float) -> int:
    """Return the decimals of an uncertainty's first two digits, by which numbers beside it are rounded.

    >>> decimals(0.137), decimals(25.4)
    (2, 0)
    """
    return max(0, 1 - math.floor(math.log10(uncertainty)))


def unit_of(case: Case) -> tuple[str, float]:
    """Return the unit in which a case's value is printed, and the factor to it.

    >>> unit_of({"unit": "m"}), unit_of({"unit": "N"})
    (('µm', 1000000.0), ('N', 1.0))
    """
    return _UNITS.get(case["unit"], (case["unit"], 1.0))


def percent(share: float) -> str:
    """Return a share in per cent, to whole ones.

    >>> percent(0.9776)
    '98 %'
    """
    return f"{100 * share:.0f} %"


def judgement(case: Case) -> str:
    """Return the error against tolerance, as the status was found."""
    if case["error"] is None:
        return "not judged"
    if case["error"] == 0 == case["tolerance"]:
        return "no difference; none allowed"
    sign = "≥" if case["metric"] == "at_least" else "≤"
    sign = sign if case["status"] == "pass" else {"≥": "<", "≤": ">"}[sign]
    return f"{number(case['error'], 3)} {sign} {number(case['tolerance'], 3)}"


def cell(value: object) -> str:
    """Return a table's cell: numbers to four digits, whole numbers and texts as they are.

    >>> cell(0.123456), cell(512), cell(True), cell(None)
    ('0.1235', '512', 'yes', 'n/a')
    """
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number(value) if value is None or isinstance(value, float) else str(value)
