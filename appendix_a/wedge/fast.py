"""Wedge stresses and displacements in double precision: elementary part plus trapezoidal sums.

On the line z = c + i xi the remainder integrals of ``transform`` become, by the trapezoidal rule,
polynomials in ``exp(-i h log zeta)``, which Horner's scheme evaluates for all points at once. The integrand
is analytic between the poles z = -1 and z = 0, so the rule's error is exp(-2 pi d / h) for the distance d
from the line to the nearer pole (Trefethen & Weideman 2014).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from appendix_a.errors import InputError
from appendix_a.wedge.transform import Complex, remainders

Real = NDArray[np.float64]

CUTOFF = 44.0
"""exp(-44) = 8e-20: size, on the faces, of the neglected part (times a factor below 2 CUTOFF)."""
ALIASING = 42.0
"""exp(-42) = 6e-19: size of the trapezoidal rule's aliasing error at r = 1; 1e4 times that at r = 1e+-4."""
DAMPED_RANGE = 20.0
"""Up to this |log r| the line is Re z = -1/2; beyond, it moves to keep the weight r^(-1-c) below exp(10)."""
POINTS_PER_SWEEP = 2048
"""Points in one Horner sweep: 3 x 2048 complex numbers stay in the second-level cache."""
HALF_PI_TAIL = 6.123233995736766e-17
"""pi/2 minus its double."""
FACE_ULP = 2.3e-16
MOST_NODES = 500_000
"""Two seconds for one point: narrower wedges, or points further out, are refused."""
NARROW, FAR = 0.1, 17.0
"""Half-opening (rad) up to which only the limit field is left where abs(log r) exceeds ``FAR`` half-openings:
the slowest mode has fallen to exp(-17 (2.1 - 0.1)) = 2e-15 there (zeros of ``residues``: Re w / 2 = 2.1)."""
HORNER_RUN = 64
"""Terms between two restarts: the power's rounding error stays below 64 units in the last place."""


@dataclass(frozen=True)
class Line:
    """Trapezoidal nodes z = c + i h k, k = -n..n, of the vertical integration line."""

    c: float
    h: float
    n: int

    def nodes(self) -> Complex:
        """Return the upper half, k = 0..n; the lower one is its complex conjugate."""
        return np.asarray(self.c + 1j * self.h * np.arange(self.n + 1), dtype=np.complex128)


def line_for(log_r: Real, gamma: float) -> Line:
    """Return the line that serves all given log(r) at once; they have one sign where |log r| > DAMPED_RANGE.

    Raises InputError for a wedge so narrow that the sum would take more than MOST_NODES.
    """
    extreme = float(np.max(np.abs(log_r), initial=0.0))
    distance = min(0.5, 0.5 * DAMPED_RANGE / max(extreme, 1.0))
    c = -distance if log_r.size and log_r.flat[0] > 0 else distance - 1.0
    h = 2 * np.pi * distance / ALIASING
    n = np.ceil(CUTOFF / (2 * (np.pi / 2 - gamma)) / h)
    if n > MOST_NODES:
        least = f"a wedge of at least {CUTOFF / h / MOST_NODES:.2g} rad at this r: its cost has no bound"
        raise InputError("gamma", gamma, least)
    return Line(c, h, int(n))


def laurent_sums(line: Line, upper: Complex, log_zeta: Complex) -> Complex:
    """Return (1/2 pi i) int g(z) zeta^(-z) dz for each row g of ``upper`` (m, n + 1); result (m, points).

    ``g(conj z) = conj g(z)``, so the upper half of the line holds all values. Horner's scheme alone would
    raise the rounding error of ``exp(-i h log zeta)`` to the power n (4e-13 at gamma = 1.5); after
    HORNER_RUN terms it restarts from an exponential of its own.
    """
    coefficients = np.concatenate([np.conj(upper[:, :0:-1]), upper], axis=1) * (line.h / (2 * np.pi))
    log_step = -1j * line.h * log_zeta
    total = np.zeros((upper.shape[0], log_zeta.size), dtype=np.complex128)
    for first in range(0, log_zeta.size, POINTS_PER_SWEEP):
        sweep = slice(first, first + POINTS_PER_SWEEP)
        step = np.exp(log_step[sweep])
        for start in range(0, coefficients.shape[1], HORNER_RUN):
            run = np.zeros((upper.shape[0], step.size), dtype=np.complex128)
            for g in coefficients[:, start : start + HORNER_RUN].T[::-1]:
                run *= step
                run += g[:, None]
            total[:, sweep] += run * np.exp((start - line.n) * log_step[sweep])
    return total * np.exp(-line.c * log_zeta)


def groups(log_r: Real) -> list[NDArray[np.bool_]]:
    """Return masks of the points that share a line: near the tip, in between, far away."""
    near, far = log_r < -DAMPED_RANGE, log_r > DAMPED_RANGE
    return [mask for mask in (near, ~(near | far), far) if mask.any()]


Rows = Callable[[Complex, Complex, Complex], list[Complex]]


def stress_rows(z: Complex, r_s: Complex, r_t: Complex) -> list[Complex]:
    """Return the contributions of R_S and R_T to phi', zeta phi'', psi'."""
    return [r_s / (1 + z), -r_s, -r_t]


def displacement_rows(z: Complex, r_s: Complex, r_t: Complex) -> list[Complex]:
    """Return the contributions of R_S and R_T to phi/zeta, phi', psi/zeta."""
    return [-r_s / (z * (1 + z)), r_s / (1 + z), r_t / z]


def remainder_sums(rows: Rows, r: Real, theta: Real, gamma: float) -> Complex:
    """Return the integrals of ``rows`` over the line, shape (3, n), at points r, theta of shape (n,)."""
    log_zeta = np.log(r) + 1j * theta
    sums = np.empty((3, r.size), dtype=np.complex128)
    for mask in groups(log_zeta.real):
        line = line_for(log_zeta.real[mask], gamma)
        z = line.nodes()
        upper = np.stack(rows(z, *remainders(z, gamma)))
        sums[:, mask] = laurent_sums(line, upper, log_zeta[mask]) / np.exp(log_zeta[mask])
    return sums


def angle_from_face(theta: Real, gamma: float) -> tuple[Real, Real]:
    """Return ``delta = pi/2 - gamma - theta``, not less than zero, and its sine, both to relative rounding.

    pi/2 is taken in two parts; a theta that rounds to the face (within one unit in the last place) is on it.
    Beyond pi/2 the sine is that of ``pi - delta``, which for small gamma is small too.
    """
    complement = np.pi / 2 - theta
    lost = (np.pi / 2 - complement) - theta
    delta = (complement - gamma) + (HALF_PI_TAIL + lost)
    delta = np.where(delta < FACE_ULP, 0.0, delta)
    supplement = (np.pi / 2 + theta + gamma) + HALF_PI_TAIL
    return delta, np.sin(np.minimum(delta, supplement))


def half_plane(r: Real, delta: Real, sine: Real) -> tuple[Real, Complex]:
    """Return (sigma_r + sigma_theta, sigma_theta - sigma_r + 2i tau) of a half-plane pressed on 0 < r < 1.

    ``delta`` is the angle from that edge, 0 <= delta <= pi, ``sine`` its sine; the shear is counted with
    the angle growing towards it. These are the integrals of the subtracted kernels: ``(2/pi) Im log(1 -
    exp(i delta)/r)`` and ``2 sin(delta) exp(-i delta) / (pi (r exp(-i delta) - 1))``. At the load's end, r
    = 1 on the face, both take the mean of their one-sided limits along the face.
    """
    versine = 2 * np.sin(delta / 2) ** 2
    edge = (delta == 0) & (r == 1)
    angle = np.arctan2(sine, np.where(edge, np.nan, r - 1) + versine)
    from_end = np.where(edge, 1, r - 1) - r * versine - 1j * r * sine
    shift = 2 * sine * np.exp(-1j * delta) / (np.pi * from_end)
    return np.where(edge, -1.0, -2 * angle / np.pi), shift


def unit_stresses(r: Real, theta: Real, gamma: float) -> tuple[Real, Real, Real]:
    """Return (sigma_r, sigma_theta, tau_rtheta) at points (n,), unit pressure on 0 < r < 1."""
    alpha = np.pi / 2 - gamma
    limit = np.abs(np.log(r)) > (FAR * alpha if alpha <= NARROW else np.inf)
    if limit.any():
        found = np.array(limit_stresses(r, theta, alpha))
        if not limit.all():
            found[:, ~limit] = unit_stresses(r[~limit], theta[~limit], gamma)
        return found[0], found[1], found[2]
    phi1, phi2, psi1 = remainder_sums(stress_rows, r, theta, gamma)
    mean = 4 * phi1.real
    deviator = 2 * (phi2 + np.exp(2j * theta) * psi1)
    for side in (1, -1):
        pressed, turned = half_plane(r, *angle_from_face(side * theta, gamma))
        mean = mean + pressed
        deviator = deviator + (turned if side == 1 else np.conj(turned))
    return (mean - deviator.real) / 2, (mean + deviator.real) / 2, deviator.imag / 2


def limit_stresses(r: Real, theta: Real, alpha: float) -> tuple[Real, Real, Real]:
    """Return uniform pressure near the tip, and far away the resultant's radial field (Michell 1900)."""
    radial = -4 * np.sin(alpha) * np.cos(theta) / ((2 * alpha + np.sin(2 * alpha)) * r)
    return np.where(r < 1, -1.0, radial), np.where(r < 1, -1.0, 0.0), np.zeros(r.shape)


def unit_displacements(r: Real, theta: Real, gamma: float, nu: float) -> tuple[Real, Real]:
    """Return u along and across the bisector at points (n,), from the tip, unit pressure over E.

    ``E u = (1 + nu) {kappa phi - zeta conj(phi') - conj(psi)}``, kappa = 3 - 4 nu. The elementary parts of
    phi and psi are ``zeta log(1 - b/zeta) - b log(1 - zeta/b)`` and ``-conj(b) log(1 - zeta/b)`` over 2 pi
    i, b the end of the load, minus the same for the other face; log r cancels between the faces, which
    leaves the sum below.
    """
    alpha, kappa = np.pi / 2 - gamma, 3 - 4 * nu
    zeta = r * np.exp(1j * theta)
    phi, phi1, psi = remainder_sums(displacement_rows, r, theta, gamma)
    u = zeta * (kappa * phi - np.conj(phi1)) - np.conj(zeta * psi)
    for side in (1, -1):
        end = np.exp(1j * side * alpha)
        delta, sine = angle_from_face(side * theta, gamma)
        away = 1 - r * np.exp(-1j * side * delta)
        size = np.abs(away)
        angle = np.arctan2(r * sine, 1 - r * np.cos(delta))
        log = np.log(np.where(size == 0, 1, size)) + 1j * side * angle
        turn = 1j * side * (delta - np.pi)
        u += side / (2j * np.pi) * ((kappa - 1) * zeta * turn - end * away * (kappa * log + np.conj(log)))
    return (1 + nu) * u.real, (1 + nu) * u.imag
