"""Resultant forces and areas from the contact's tractions: Eqs (2)-(4), Q, and (10)-(12)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.model.slopes import Slopes

EDGE_SHARE = (math.pi - 1 + math.log(2)) / 24  # of an edge element, in `perimeter_corrected_area`


class Forces(NamedTuple):
    """Normal force N, friction force F and binormal force Q (N)."""

    normal: float
    friction: float
    binormal: float


def resultants(pressure: Array, traction: Array, slopes: Slopes, element_area: float) -> Forces:
    """Sums of the local tractions ``f`` and ``r`` over the contact, with the cosines as printed.

    ``N = sum (f cos theta_x - r sin theta_x) cos theta_y dA``, Eq. (2);
    ``F = sum (f sin theta_x + r cos theta_x) cos theta_y dA``, Eq. (3);
    ``Q = sum (f cos theta_x - r sin theta_x) sin theta_y dA`` (the paper plots it undefined).
    """
    if slopes.is_flat:
        return Forces(float(np.sum(pressure)) * element_area, float(np.sum(traction)) * element_area, 0.0)
    down = pressure * slopes.cos_x - traction * slopes.sin_x
    along = pressure * slopes.sin_x + traction * slopes.cos_x
    return Forces(
        normal=float(np.sum(down * slopes.cos_y)) * element_area,
        friction=float(np.sum(along * slopes.cos_y)) * element_area,
        binormal=float(np.sum(down * slopes.sin_y)) * element_area,
    )


def facet_resultants(pressure: Array, traction: Array, slopes: Slopes, element_area: float) -> Forces:
    """The same sums with the exact tractions of a facet per projected area.

    Down ``f - r tan theta_x``, along ``r + f tan theta_x``, across ``f tan theta_y``. They
    differ from the printed ones at second order in the slope. The binormal sum has the printed one's
    sign: a pressure on a surface that rises across the sliding direction counts positive.
    """
    return Forces(
        normal=float(np.sum(pressure - traction * slopes.tan_x)) * element_area,
        friction=float(np.sum(traction + pressure * slopes.tan_x)) * element_area,
        binormal=float(np.sum(pressure * slopes.tan_y)) * element_area,
    )


def perimeter_corrected_area(contact: NDArray[np.bool_], spacing: float, *, periodic: bool = False) -> float:
    """Contact area (m^2) less the mean excess that whole elements add along the contact's edge.

    ``A - (pi - 1 + ln 2) / 24 * S * spacing`` with ``S`` the length of the element edges between
    contact and no contact (Yastrebov, Anciaux and Molinari 2017, Tribology International 114, 161). The
    border of a square that does not repeat is none: where contact ends there it ends exactly.
    """
    edges = 0
    for rows in (contact, contact.T):
        edges += int(np.count_nonzero(rows[1:] != rows[:-1]))
        edges += int(np.count_nonzero(rows[0] != rows[-1])) if periodic else 0
    perimeter = edges * spacing
    raw = int(np.count_nonzero(contact)) * spacing**2
    return raw - EDGE_SHARE * perimeter * spacing


def smooth_friction_coefficient(tau: float, beta: float, mean_pressure: float) -> float:
    """Eq. (10): ``mu = tau / f_m + beta`` for contact at flat tips; Eq. (11) with ``f_m = H``.

    >>> smooth_friction_coefficient(15e6, 0.08, 800e6)    # the paper's H of copper
    0.09875
    """
    return tau / mean_pressure + beta


def plasticity_index(reduced_modulus: float, hardness: float, rms: float, length: float) -> float:
    """Eq. (12): ``psi = 2.2 (E' / H) (sigma_e / length)``, the printed length being epsilon."""
    return 2.2 * reduced_modulus / hardness * rms / length
