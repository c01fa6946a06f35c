"""Limits of the implementation as a reference: the states that are not solved, of what kind, and why.

Each row names its states by a glob over their ids; a test keeps them true.
"""

from __future__ import annotations

from enum import StrEnum
from fnmatch import fnmatchcase
from typing import NamedTuple


class Kind(StrEnum):
    """Kind of a state that is not solved: what stands behind it."""

    NO_PROBLEM = "no such problem, or no digits"
    EXCLUDED = "only a state with more than half of the contact without tau"
    NONE_FOUND = "no state found, and none proved impossible"
    BEYOND = "beyond the half-space model"
    MISSED = "a state exists"


class Limit(NamedTuple):
    """One limit: its ``kind``, the ``states`` that show it, ``what`` happens there, and ``why``."""

    kind: Kind
    states: str
    what: str
    why: str


LIMITS = (
    Limit(
        Kind.NO_PROBLEM,
        "material/nu of the lower body, */[-0]*[01]",
        "Poisson's ratios of -1, and just above 1/2, are refused",
        "no elastic body has them",
    ),
    Limit(
        Kind.NO_PROBLEM,
        "wedge/*/gamma = 1.5707963267948966",
        "a wedge without an opening is refused",
        "no body is left",
    ),
    Limit(
        Kind.NO_PROBLEM,
        "finite elements/nu, direct/0.5",
        "the direct form is not defined for an incompressible body",
        "Lame's lambda is infinite; the mixed form takes it",
    ),
    Limit(
        Kind.NO_PROBLEM,
        "contact set/approach*, */4.94066e-324 m",
        "the least approach is STAGNATED, or ends at the limit of iterations",
        "the least number has no digits for pressures to agree in",
    ),
    Limit(
        Kind.EXCLUDED,
        "friction/tau*/tau/f = *",
        "tau of six to a hundred times the pressure ends at the limit of iterations",
        "tau drags most elements out of contact; the last state leaves more than half without tau",
    ),
    Limit(
        Kind.NONE_FOUND,
        "friction/tau*/tau/f = 1e+0[36]",
        "tau of a thousand times the pressure has no settled state",
        "on slopes tau carries the load by itself",
    ),
    Limit(
        Kind.NONE_FOUND,
        "friction/tau, *dense/tau/f = 100",
        "tau of a hundred times the pressure has no settled state by the plain reference, with slopes",
        "its slopes and its contact do not settle together",
    ),
    Limit(
        Kind.NONE_FOUND,
        "grid/ridge of 24 elements, fft/16 across",
        "the dense reference reaches its limit of iterations on the ridge that it judges",
        "its exchange of elements does not settle",
    ),
    Limit(
        Kind.BEYOND,
        "load/*/p/E[*] = 1e+0[12]",
        "mean pressures of ten times E* are STAGNATED",
        "slopes of a surface displaced by many element widths run off; the solver stops at 1e6",
    ),
    Limit(
        Kind.BEYOND,
        "load/atoms, fft/1e-06 N",
        "a tip of ten nanometres under a micronewton is STAGNATED",
        "the mean pressure is beyond the modulus",
    ),
    Limit(
        Kind.BEYOND,
        "friction/beta*/beta = 1*",
        "beta of 100 and more is STAGNATED, for sigma = beta c / a above about 4",
        "lagged coupling contracts by sigma / sqrt(1 + sigma^2) an update; on slopes no solver settles",
    ),
    Limit(
        Kind.MISSED,
        "friction/beta without slopes, dense/beta = 1e+06",
        "the plain reference does not settle at beta = 1e6, although every digit is right",
        "rounding of terms that cancel changes the sign of an element's gap",
    ),
    Limit(
        Kind.MISSED,
        "contact set/approach with tau, */1e-*",
        "approaches up to 1e-18 m with tau are STAGNATED, or end at the limit of iterations",
        "shear by tau moves surfaces by 1e-8 m; its rounding exceeds the approach",
    ),
    Limit(
        Kind.MISSED,
        "wedge/r = 1/gamma = 1.5707963257948965",
        "a wedge of 1e-9 rad is refused beside the end of the pressure",
        "the integrand decays like exp(-2 (pi/2 - gamma) xi): nodes grow like 1/(pi/2 - gamma)",
    ),
)


def limit_of(unique: str) -> Limit | None:
    """Return the limit that a state shows; of several the last, which is the more special one."""
    found = [limit for limit in LIMITS if fnmatchcase(unique, limit.states)]
    return found[-1] if found else None
