"""Why ``a + beta c`` is positive definite for any beta, and so has one contact state; and where that ends.

**a.** Its matrix holds the values at the centres of unit elements, ``a(i, j) = I[1/rho]``: a collocation
matrix, for which it does not suffice that 1/rho has a positive Fourier transform. With
``1/rho = 2/sqrt(pi) int_0^inf exp(-rho^2 u^2) du`` the element's integral separates,

    a(i, j) = 2/sqrt(pi) int_0^inf G_u(i) G_u(j) du,    G_u(i) = int_{-1/2}^{1/2} exp(-u^2 (i - s)^2) ds > 0,

and so does its symbol ``sum a(i, j) exp(-i (p i + q j))``, with the factors, by Poisson's sum,

    gamma_u(q) = sum_i G_u(i) exp(-i q i) = (2 sqrt(pi) / u) sin(q/2) sum_k (-1)^k w(q + 2 pi k),
    w(x) = exp(-x^2 / 4 u^2) / x.

w is odd and falls for x > 0. For 0 < q <= pi the sum is therefore that of two alternating series,
``w(q) - w(2 pi + q) + w(4 pi + q) - ...`` and ``w(2 pi - q) - w(4 pi - q) + ...``, both of falling terms that
begin with a positive one: gamma_u(q) > 0. At q = 0 it is a sum of positive numbers, and it is even. So the
symbol is positive, and f.a f = (2 pi)^-2 int symbol |f^|^2 > 0 for every pressure f != 0 on any finite set of
elements, square or oblong.

**c.** ``I[s/rho^2]`` is odd in s, so c is skew: f.c f = 0, and f.(a + beta c) f = f.a f > 0 for every beta.
Every principal submatrix has that property too, so a + beta c is a P-matrix, and the complementarity
problem of Eqs (6) and (7) at a given approach has exactly one solution, slopes and tau's active set being
held (Samelson, Thrall and Wesler 1958). Two approaches d1 < d2 with solutions f1, f2 give, since each
pressure meets only gaps that are not negative,

    (f2 - f1).(a + beta c)(f2 - f1) <= (d2 - d1) K.(f2 - f1),

so that K.f grows with the approach, and without slopes (K = 1, N = sum f dA) each load has one state too.

**Where it ends.** (1) tau's active set: it follows the contact; `lawful_states` counts states. (2) Slopes:
K, the weights of the load and the mean surface follow the pressure. (3) The slope correction: the matrix
is ``a (1 - beta tan theta_x) + ...``, whose symmetric part may vanish where beta tan theta_x reaches 1.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array
from verification.exact.exact_operators import normal, tangential


def symmetric_part(M: int, beta: float, ratio: float, slope: float = 0.0) -> Array:
    """Return the symmetric part's eigenvalues of ``a (1 - beta t) + ratio beta c``, M x M.

    ``ratio`` is the shear over the normal compliance; ``slope`` is t = tan theta_x of alternate rows of
    elements, of either sign, as the slope correction sees it (0 without it). Entries are the exact ones,
    rounded once.
    """
    a, c = normal(M, False).astype(float), tangential(M, False)[0].astype(float)
    t = np.where(np.arange(M * M) // M % 2, slope, -slope)
    G = a * (1 - beta * t) + ratio * beta * c
    return np.asarray(np.linalg.eigvalsh((G + G.T) / 2))


def least_symbol() -> float:
    """Return the symbol's least value, at p = q = pi: the limit of the least eigenvalue on growing grids.

    Sums the coefficients out to 64 elements with alternating signs, whose tail is below the last term.
    """
    from refimpl.kernels import normal_table

    M = 64
    table = normal_table(M, M, 1.0)
    signs = (-1.0) ** np.arange(M) * np.where(np.arange(M) == 0, 1.0, 2.0)
    signs[-1] /= 2  # half of the last term: Euler's acceleration of an alternating series
    return float(signs @ table @ signs)
