"""Wedge pressed on both faces (Appendix A, Tranter): its faces, residuals, agreement of four formulations."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, product

import numpy as np

from appendix_a import wedge
from appendix_a.wedge import enclosure, printed, reference, residues
from verification.cases import Measured, Unavailable, case
from verification.exact.wedge_residuals import residuals

SOURCE = "Tranter 1948; paper Eqs (A4)-(A9), derived anew"
SEED = 2001
FLOOR = 1e-12
"""Required digits in the limits towards the faces."""


def random_points(count: int) -> Iterator[tuple[float, float, float]]:
    """Yield (r, theta, gamma): r/a in [1e-4, 1e4], gamma in [1e-6, 1.5], every other logarithmic."""
    rng = np.random.default_rng(SEED)
    for n in range(count):
        gamma = rng.uniform(1e-6, 1.5) if n % 2 else np.exp(rng.uniform(np.log(1e-6), np.log(1.5)))
        yield np.exp(rng.uniform(-1, 1) * np.log(1e4)), rng.uniform(-1, 1) * (np.pi / 2 - gamma), float(gamma)


def departure(r: float, theta: float, gamma: float, expected: tuple[float, ...]) -> float:
    """Return the fast path's largest difference from ``expected``, over the largest component."""
    values = np.array(wedge.stresses(r, theta, gamma))
    return float(np.max(np.abs(values - np.array(expected))) / np.max(np.abs(values)))


@case("appendix-wedge/faces", metric="at_most", tolerance=1e-6, source=SOURCE)
def faces() -> Measured:
    """Wedge: boundary values as limits of the integrals.

    Claim: at 1 - 10^-k of a face, k = 2 ... 8, the transform integrals themselves (nothing subtracted, no
    special case) tend to sigma_theta = -1 on the pressed and 0 on the free part, and to zero shear
    Tolerance: sigma_theta and tau leave their boundary values like the distance from the face, 1e-8 (pi/2 -
    gamma), times an angular derivative of the stresses below 10 at these points
    """
    last = {}
    for gamma in (1e-6, 0.3, 1.5):
        for r, pressed in ((0.3, 1.0), (4.0, 0.0)):
            errors = []
            for k in range(2, 9):
                theta = (1 - 10.0**-k) * (np.pi / 2 - gamma)
                _, sigma_theta, tau = map(float, reference.stresses(r, theta, gamma, digits=12).values)
                errors.append(max(abs(sigma_theta + pressed), abs(tau), FLOOR))
            if any(later > max(0.2 * earlier, FLOOR) for earlier, later in pairwise(errors)):
                raise ArithmeticError(f"gamma {gamma:g}, r {r:g}: ten times nearer, not five times closer")
            last[f"gamma {gamma:g}, r {r:g} a"] = errors[-1]
    return Measured(value=max(last.values()), data=last)


@case("appendix-wedge/residuals", metric="at_most", tolerance=1e-10)
def balance() -> Measured:
    """Wedge: equilibrium and compatibility.

    Claim: r |div sigma| / max |sigma| and the departure of sigma_r + sigma_theta from its mean over a circle,
    over max |sigma|, are at most 1e-10 at 200 random points (gamma 1e-6 ... 1.5, r/a 1e-4 ... 1e4)
    Source: equilibrium and compatibility, by differences of order 16 and the mean value property
    Tolerance: as required; rounding of 1e-15 over a step of at least 1e-4 gives 1e-11
    """
    pairs = [residuals(*point) for point in random_points(200)]
    equilibrium, compatibility = map(list, zip(*pairs, strict=True))
    worst = {"equilibrium": max(equilibrium), "compatibility": max(compatibility)}
    return Measured(value=max(worst.values()), data=worst, note=f"200 points, seed {SEED}")


@case("appendix-wedge/double-precision", metric="at_most", tolerance=1e-10, source=SOURCE)
def double_precision() -> Measured:
    """Wedge: double precision against 15 digits by another path.

    Claim: the fast path (half-planes and a trapezoidal remainder on a line) is within 1e-10 of the
    unsubtracted polar integrals on a hyperbola, at random points and close to the faces
    Tolerance: as required; expected 1e-13, the rounding 1e-15 times (a/r)^(1/2) <= 100
    """
    errors = []
    for n, (r, theta, gamma) in enumerate(random_points(24)):
        near = np.copysign(np.pi / 2 - gamma, theta) * (1 - 10.0 ** -(2 + n % 7)) if n % 3 == 0 else theta
        exact = reference.stresses(r, near, gamma, digits=15).values
        errors.append(departure(r, near, gamma, tuple(map(float, exact))))
    return Measured(value=max(errors), data={"error": errors}, note=f"24 points, seed {SEED}")


@case("appendix-wedge/two-precisions", metric="at_most", tolerance=1e-19, source=SOURCE)
def two_precisions() -> Measured:
    """Wedge: reference at two precisions and by residues.

    Claim: the hyperbola's integrals to 20 and to 40 digits, and the residue series to 30, agree to 19
    Tolerance: the coarser run has the tolerance 1e-20
    """
    worst = {"20 against 40 digits": 0.0, "residues against 40 digits": 0.0}
    for r, share, gamma in ((0.8, 1.0, 0.7), (3.0, -0.9, 1.2), (20.0, 0.2, 0.05)):
        theta = share * (np.pi / 2 - gamma)
        coarse, fine = (reference.stresses(r, theta, gamma, digits).values for digits in (20, 40))
        summed = residues.stresses(r, theta, gamma, digits=30)
        for name, other in zip(worst, (coarse, summed), strict=True):
            worst[name] = max(worst[name], *(float(abs(o - f)) for o, f in zip(other, fine, strict=True)))
    return Measured(value=max(worst.values()), data=worst)


@case("appendix-wedge/corrected-series", metric="at_most", tolerance=1e-12)
def corrected_series() -> Measured:
    """Wedge: (A4)-(A9) with the sign of (A5) corrected.

    Claim: the paper's integrals, (A5) beginning with a minus and xi inside cosh and sinh, give the stresses
    Source: paper Eqs (A4)-(A9)
    Tolerance: 20-point Gauss panels and the rounding of up to 1e3 oscillations
    """
    errors: list[float] = []
    for gamma, r in product((0.05, 0.6, 1.2, 1.5), (0.01, 0.5, 1.0, 3.0, 100.0)):
        theta = 0.7 * (np.pi / 2 - gamma)
        s = printed.stresses(r, theta, gamma, printed.CORRECT_SIGN)
        errors.append(departure(r, theta, gamma, (s.sigma_r, s.sigma_theta, s.tau)))
    return Measured(value=max(errors), data={"error": errors})


@case("appendix-wedge/enclosures", metric="at_most", tolerance=1e-13)
def enclosures() -> Measured:
    """Wedge: rigorous enclosures.

    Claim: balls of radius below 1e-18 enclose the stresses, and double precision is within 1e-13 of them
    Source: Arb (Johansson 2017), acb.integral with a bounded tail; {SOURCE}
    Tolerance: rounding of the fast path; the enclosure's own radius is part of the value
    """
    errors, radii = [], []
    for r, share, gamma in ((0.5, -0.6, 0.1), (0.9, 0.6, 1.3), (30.0, 0.0, 0.04)):
        theta = share * (np.pi / 2 - gamma)
        try:
            balls = enclosure.stresses(r, theta, gamma)
        except ImportError as missing:
            raise Unavailable("python-flint is not installed") from missing
        values = wedge.stresses(r, theta, gamma)
        scale = max(abs(float(v)) for v in values)
        errors += [float(abs(ball - float(v)).upper()) / scale for ball, v in zip(balls, values, strict=True)]
        radii += [float(ball.rad()) for ball in balls]
    if max(radii) > 1e-18:
        raise ArithmeticError(f"an enclosure of radius {max(radii):.1e} says too little")
    return Measured(value=max(errors), data={"distance over largest stress": errors, "radius": radii})
