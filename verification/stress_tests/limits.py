"""Limits of the implementation as a reference: place, message, and possible remedy.

Each names the states of the study that reproduce it (a glob over their ids); a test keeps them true.
"""

from __future__ import annotations

from typing import NamedTuple


class Limit(NamedTuple):
    """One limit: ``states`` that show it, ``what`` happens there, ``why``, and the ``remedy`` if any."""

    states: str
    what: str
    why: str
    remedy: str


LIMITS = (
    Limit(
        "friction/beta*, fft/beta = 1e+06",
        "the production solver is STAGNATED, for sigma = beta c / a above about 4",
        "lagged coupling contracts by sigma / sqrt(1 + sigma^2) an update, and 600 updates are the limit",
        "none needed below beta = 10: the dense solver does not lag the coupling",
    ),
    Limit(
        "load/[bp][al]*, fft/p/E[*] = 1e+0[12]",
        "mean pressures of ten times E* are STAGNATED",
        "slopes of a surface displaced by many element widths run off; the solver stops at 1e6",
        "none: no elastic half-space is meant to be loaded like this",
    ),
    Limit(
        "load/periodic plane, */p/E[*] = 1e+0[012]",
        "full periodic contact above p = E* is STAGNATED although every digit is right",
        "the certificate's gap is divided by the elastic energy, which a mean pressure does not add "
        "to, while its rounding grows with that pressure",
        "state the gap's rounding floor, eps N h, beside it",
    ),
    Limit(
        "contact set/flat on flat, periodic, dense/*",
        "periodic flats are STAGNATED by the dense solver although every digit is right",
        "the approach from first contact is nearly zero and scales the certificate's penetration",
        "scale by max(|approach|, compliance x peak x spacing)",
    ),
    Limit(
        "contact set/approach*, */4.94066e-324 m",
        "approaches below 1e-160 m end as STAGNATED or ITERATION_LIMIT, the least number by either solver",
        "the energies of CG are products of two such lengths and underflow; the least number has no digits",
        "none needed: an approach of 1e-30 m still converges to 10 digits",
    ),
    Limit(
        "load/ball with tau, */p/E[*] = 1e-1[3456]",
        "a fixed tau of 1e8 times the pressure and more costs the balance its digits: STAGNATED",
        "N is the difference of tau's tilt on slopes and of pressure; it cancels by tau tan(theta) / f",
        "none: the printed Eq. (2) is ill-conditioned there",
    ),
    Limit(
        "friction/tau*, fft/tau/f = 1e+0[36]",
        "tau above some ten times the pressure has no settled state, or the solvers find none",
        "tau drags elements out of contact and lets them back in; on slopes it carries the load by itself",
        "none: see the table of lawful states",
    ),
    Limit(
        "friction/beta, slope correction, */beta = 1*0*",
        "beta of 10 and more with the slope correction: no P-matrix, refused by the dense solver",
        "f - beta f tan(theta) changes sign where beta tan(theta) > 1: a rough facet's friction lifts it",
        "none: this is where uniqueness ends",
    ),
    Limit(
        "wedge/*/gamma = 1.570796325*",
        "wedges narrower than a thousandth of a radian are refused, and 0.04 rad at r of 1e-300 or 1e300",
        "the integrand decays like exp(-2 (pi/2 - gamma) xi): nodes grow like 1/(pi/2 - gamma)",
        "a quadrature graded towards the imaginary axis, or the wire's limit",
    ),
    Limit(
        "wedge/r = 1e[-+]08/gamma = 1.5",
        "wedge stresses keep 10 digits between r = 1e4 and 5e8, where they keep 13 elsewhere",
        "the weight r^(-1/2) on the line of integration multiplies rounding by exp(|log r| / 2)",
        "move the line from |log r| = 10 on",
    ),
)
