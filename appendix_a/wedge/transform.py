"""Mellin transform of the symmetric wedge problem: the kernels all other modules of this package integrate.

Wedge |theta| < alpha = pi/2 - gamma, unit pressure on 0 < r < 1 of both faces, zeta = r exp(i theta). The
Airy function ``r^(1-z) {A cos (1-z)theta + B cos (1+z)theta}`` is written with Kolosov-Muskhelishvili
potentials (sigma_r + sigma_theta = 4 Re phi', sigma_theta - sigma_r + 2i tau = 2 exp(2i theta) (conj(zeta)
phi'' + psi')). Zero shear and the Mellin transform ``-1/(1+z)`` of the pressure on both faces fix A and B,
and leave

    phi'       =  (1/2 pi i) int S(z)/(1+z) zeta^(-1-z) dz      S = sin((1-z) alpha) / D
    zeta phi'' = -(1/2 pi i) int S(z)       zeta^(-1-z) dz      T = sin((1+z) alpha) / D
    psi'       = -(1/2 pi i) int T(z)       zeta^(-1-z) dz      D = sin(2 alpha z) + z sin(2 alpha)

on any line -1 < Re z < 0: the poles z = -1 (uniform pressure at the tip) and z = 0 (radial field at infinity)
bound the strip, and no zero of D lies inside it for alpha <= pi/2.

S and T fall off only like exp(-alpha |Im z|), so on the faces the integrals do not converge absolutely. Their
asymptotic parts are those of two half-planes, one along each face, whose integrals are elementary:

    S = sin(alpha (1+z) - pi z) / sin(pi z) + R_S,     T = sin(alpha (1-z) + pi z) / sin(pi z) + R_T

and the remainders, combined by hand so that nothing cancels, fall off like exp(-3 alpha |Im z|).
"""

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complex128]


def remainders(z: Complex, gamma: float) -> tuple[Complex, Complex]:
    """Return the remainder kernels (R_S, R_T) of the module's head at points z with Im z >= 0.

        R_S = {sin(alpha (1+z)) sin(2 gamma z) - z sin(2 gamma) sin(alpha (1+z) - pi z)} / (D sin(pi z))
        R_T = {sin(alpha (1-z)) sin(2 gamma z) - z sin(2 gamma) sin(alpha (1-z) + pi z)} / (D sin(pi z))

    Every sine is written with its growing exponential taken out (they multiply to exp(3i alpha z)), so
    nothing overflows; expm1 keeps the error proportional to gamma for gamma -> 0 and small for gamma -> pi/2.
    """
    alpha = np.pi / 2 - gamma
    iz = 1j * z
    bend = 2 * iz * np.sin(2 * gamma)
    decay_wedge = -np.expm1(4 * alpha * iz) - bend * np.exp(2 * alpha * iz)
    decay_plane = -np.expm1(2 * np.pi * iz)
    opening = -np.expm1(4 * gamma * iz)
    common = np.exp(3 * alpha * iz) / (decay_wedge * decay_plane)
    turn = np.exp(1j * alpha)
    far = np.exp(2 * (np.pi - alpha) * iz)
    r_s = common * (-np.expm1(2 * alpha * (1j + iz)) * opening / turn - bend * turn * (1 - far / turn**2))
    r_t = common * (np.expm1(2 * alpha * (iz - 1j)) * opening * turn + bend / turn * (1 - far * turn**2))
    return r_s, r_t
