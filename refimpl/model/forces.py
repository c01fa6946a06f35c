"""Resultant forces and areas from the contact's tractions: Eqs (2)-(4), Q, and (12)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from refimpl.grid import Array, Grid, Mask
from refimpl.model.slopes import Slopes

EDGE_SHARE = (math.pi - 1 + math.log(2)) / 24  # area per face over dA, in `perimeter_corrected_area`


class Forces(NamedTuple):
    """Normal force N, friction force F and transverse (binormal) force Q (N)."""

    normal: float
    friction: float
    binormal: float


def resultants(pressure: Array, traction: Array, slopes: Slopes, element_area: float) -> Forces:
    """Sum the local tractions ``f`` and ``r`` (Pa) over the contact, with the cosines as printed.

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


def normal_terms(pressure: Array, traction: Array, slopes: Slopes, element_area: float) -> float:
    """Return the sum of the sizes of the terms of Eq. (2) (N), whose difference is N."""
    if slopes.is_flat:
        return float(np.sum(np.abs(pressure))) * element_area
    sizes = np.abs(pressure) * slopes.cos_x + np.abs(traction * slopes.sin_x)
    return float(np.sum(sizes * slopes.cos_y)) * element_area


def facet_resultants(pressure: Array, traction: Array, slopes: Slopes, element_area: float) -> Forces:
    """Sum the exact tractions of a facet per projected area over the contact.

    Down ``f - r tan theta_x``, along ``r + f tan theta_x``, across ``f tan theta_y``. They
    differ from the printed ones at second order in the slope. The transverse sum has the sign of the
    printed one: a pressure on a surface that rises across the sliding direction counts positive.
    """
    return Forces(
        normal=float(np.sum(pressure - traction * slopes.tan_x)) * element_area,
        friction=float(np.sum(traction + pressure * slopes.tan_x)) * element_area,
        binormal=float(np.sum(pressure * slopes.tan_y)) * element_area,
    )


def friction_coefficient(friction_force: float, normal_load: float) -> float:
    """Return Eq. (4), ``mu = F / P``, by N where no load is prescribed; NaN without load."""
    return friction_force / normal_load if normal_load else math.nan


def contact_area(contact: Mask, grid: Grid) -> float:
    """Return the real contact area (m^2): the number of elements in contact times dA."""
    return float(np.count_nonzero(contact)) * grid.element_area


def perimeter_corrected_area(contact: Mask, grid: Grid) -> float:
    """Return the contact area (m^2) less the mean excess that whole elements add along the contact's edge.

    ``A - (pi - 1 + ln 2) / 24 * S dx dy`` with ``S`` the number of element faces between contact and no
    contact (Yastrebov, Anciaux and Molinari 2017, Tribology International 114, 161).
    """
    return contact_area(contact, grid) - EDGE_SHARE * grid.faces(contact) * grid.element_area


def plasticity_index(reduced_modulus: float, hardness: float, rms: float, length: float) -> float:
    """Return Eq. (12): ``psi = 2.2 (E' / H) (sigma_e / length)``, the printed length being epsilon."""
    return 2.2 * reduced_modulus / hardness * rms / length
