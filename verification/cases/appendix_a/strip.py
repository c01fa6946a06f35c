"""Strip on a wavy boundary (Appendix A, (A1)-(A3)): the half-plane's stresses, first order, Fig. 12."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np

from appendix_a import wedge
from appendix_a.strip import field, first_order, printed
from verification.cases import Measured, Verdict, case, judged

SOURCE = "boundary perturbation to first order in the slope, derived in appendix_a.strip.perturbation"
DIGITS = 40


def printed_stresses(x: Any, y: Any) -> tuple[Any, Any, Any]:
    """Return (A1) in mpmath, p = a = 1: (sigma_x, sigma_y, tau)."""
    first, second = mp.atan2(y, x - 1), mp.atan2(y, x + 1)
    angle, sines = 2 * (first - second), mp.sin(2 * first) - mp.sin(2 * second)
    tau = (mp.cos(2 * first) - mp.cos(2 * second)) / (2 * mp.pi)
    return -(angle + sines) / (2 * mp.pi), -(angle - sines) / (2 * mp.pi), tau


def component(n: int) -> Callable[[Any, Any], Any]:
    """Return the n-th of (A1) as a function of (x, y)."""
    return lambda x, y: printed_stresses(x, y)[n]


def trace(x: Any, y: Any) -> Any:
    """Return sigma_x + sigma_y."""
    return sum(printed_stresses(x, y)[:2])


@case("appendix-strip/a1-field", metric="at_most", tolerance=1e-30)
def a1_field() -> Measured:
    """(A1) is a stress field.

    Claim: (A1) satisfies both equations of equilibrium and compatibility at random points of the half-plane
    Source: paper Eq. (A1); Johnson 1985, section 2.5
    Tolerance: mpmath raises its precision for differences: rounding at 40 digits is expected
    """
    rng = np.random.default_rng(2001)
    worst = mp.mpf(0)
    with mp.workdps(DIGITS):
        for _ in range(20):
            x, y = mp.mpf(rng.uniform(-4, 4)), mp.mpf(rng.uniform(0.05, 4))
            sigma_x, sigma_y, tau = component(0), component(1), component(2)
            along = mp.diff(sigma_x, (x, y), (1, 0)) + mp.diff(tau, (x, y), (0, 1))
            down = mp.diff(tau, (x, y), (1, 0)) + mp.diff(sigma_y, (x, y), (0, 1))
            harmonic = mp.diff(trace, (x, y), (2, 0)) + mp.diff(trace, (x, y), (0, 2))
            worst = max(worst, abs(along), abs(down), abs(harmonic))
    return Measured(value=float(worst))


@case("appendix-strip/a1-tractions", metric="at_most", tolerance=1e-14)
def a1_tractions() -> Measured:
    """(A1) carries the strip's load.

    Claim: towards the boundary (A1) tends to sigma_y = -p under the strip, 0 beside it, and to no shear
    Source: paper Eq. (A1)
    Tolerance: shear goes like the square of the depth, 1e-9 a, over 0.1 a from the ends
    """
    x = np.array([-30.0, -1.1, -0.9, -0.3, 0.0, 0.6, 0.9, 1.1, 2.0])
    _, sigma_y, tau = field.stresses(x, 1e-9)
    return Measured(float(np.max(np.abs(np.concatenate([sigma_y + (np.abs(x) < 1), tau])))))


@case("appendix-strip/first-order-wedge", metric="at_most", tolerance=1e-3)
def first_order_wedge() -> Measured:
    """First-order theory against the exact wedge.

    Claim: the faces of a wedge of slope gamma -> 0 move as the first-order theory says for |x| tan(gamma):
    -(1+nu)(1-2nu) (p/E) gamma x up to the strip's end, and constant beyond
    Source: {SOURCE}; wedge displacements from the Mellin transform
    Tolerance: what is left is of second order: gamma = 1e-5 times a coefficient below 100
    """
    x, gamma, off = np.array([0.05, 0.3, 0.7, 1.0, 1.5, 3.0, 10.0]), 1e-5, {}
    for nu in (0.0, 0.3, 0.45):
        # the pressed length lies along the face, the offset is horizontal
        along, _ = wedge.displacements(x / np.cos(gamma), np.full_like(x, np.pi / 2 - gamma), gamma, nu)
        change = (along - field.flat_displacement(x, nu)) / gamma
        expected = -(1 + nu) * (1 - 2 * nu) * np.minimum(x, 1.0)
        off[f"nu {nu:g}"] = float(np.max(np.abs(change - expected)))
    return Measured(value=max(off.values()), data=off)


@case("appendix-strip/superposition", metric="at_most", tolerance=2e-3)
def superposition() -> Measured:
    """Pseudo tractions of (A3) against the first-order theory.

    Claim: with theta the direction of the normal and the load added, (A1)-(A3) and Flamant's superposition
    give the first-order change of the displacement beside the strip, on a crest
    Source: paper Eqs (A1)-(A3); {SOURCE}
    Tolerance: second order: the slope of 1.7e-4 rad over the first order's pi a/lambda = 0.16
    """
    offsets, slope = np.array([-5.0, -2.0, -1.2, 1.2, 2.0, 5.0]), 0.01
    by_paper, flat = printed(slope, 20.0, 0.3, offsets=offsets)
    expanded, _ = first_order(slope, 20.0, 0.0, 0.3, offsets=offsets)
    return Measured(float(np.max(np.abs((by_paper - flat) / (expanded - flat) - 1))))


@case("appendix-strip/crest-small", metric="at_most", tolerance=0.02)
def fig12() -> Measured:
    """Fig. 12: a strip on a crest.

    Claim: on a crest (6.5 degrees, lambda = 100 a, nu = 0.3) strip theory moves the surface between a and 15
    a by less than 2 % of the flat boundary's displacement relative to the centre
    Source: paper Fig. 12 and its 2 %
    Tolerance: the paper's own bound
    """
    x = np.linspace(-15.0, 15.0, 61)
    by_paper, flat = printed(6.5, 100.0, 0.3, offsets=x)
    expanded, _ = first_order(6.5, 100.0, 0.0, 0.3, offsets=x)
    change = np.maximum(np.abs(by_paper - flat), np.abs(expanded - flat))
    away = np.abs(x) >= 1
    value = float(np.max(change[away] / np.abs(field.flat_displacement(x[away], 0.3))))
    sentence = (
        f"on the crest, where the paper puts its strip, {value:.2%} at 6.5 degrees beyond a; on a flank the "
        "change is larger and does not fall (flank-first-order)"
    )
    return judged(Verdict.CONDITIONAL, sentence, value, data={})


@case("appendix-strip/flank-first-order", metric="at_least", tolerance=0.02, source=SOURCE)
def flank() -> Measured:
    """A strip on a flank, to first order.

    Claim: on a flank the neighbours change by (1+nu)(1-2nu) tan(slope) p a / E relative to the centre, those
    downhill rise, those uphill sink: at 6.5 degrees, nu = 0.3 by over 2 % of their coefficient
    Tolerance: the paper's bound for the maximum slope, which first-order theory exceeds here
    """
    offsets = np.array([-6.0, -4.0, -2.0, 2.0, 4.0, 6.0])
    wavy, flat = first_order(6.5, 100.0, 0.25, 0.3, offsets=offsets)
    return Measured(float(np.max(np.abs((wavy - flat) / flat))))
