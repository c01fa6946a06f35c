"""Influence coefficients of a wavy body in 3-D: finite elements against exact and first-order values."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files
from itertools import product

import numpy as np

from appendix_a.fem3d.coefficients import LABELS, Coefficients3D, coefficients, corrected
from appendix_a.fem3d.leading_order import first_order
from appendix_a.fem3d.patch import normal_coefficient, tilted_plane
from appendix_a.fem3d.surface import X, Y, flat_sample, sample
from appendix_a.fem3d.table import Series, Table3D
from appendix_a.fem3d.wavy import Kind, Waviness
from refimpl.grid import Array
from verification.cases import Measured, case

NU, WAVELENGTH, SLOPE = 0.3, 20.0, 10.0
FLANK = 0.25
LEVELS = (1, 2, 3)
NEAR = 1.5 * WAVELENGTH  # the smallest outer boundary
SOURCE = "paper Appendix A, 'the maximum error ... is less than 2 %'; own first-order theory"


@cache
def shipped() -> Table3D:
    """Return the table that comes with the solver."""
    with as_file(files("refimpl") / "data" / "coefficient_error_3d.json") as path:
        return Table3D.read(path)


@cache
def flank(nu: float) -> Coefficients3D:
    """Return the middle of a flank of 10 degrees, wavelength 20 a."""
    return coefficients(SLOPE, WAVELENGTH, FLANK, nu)


def flat_error(level: int) -> Array:
    """Return finite element over exact minus one (10,) on one mesh."""
    sampled = flat_sample(WAVELENGTH, Kind.RIDGE, NU, NEAR, level).down
    return np.asarray(sampled / normal_coefficient(X, Y, NU) - 1)


@case("fem3d/flat", metric="at_most", tolerance=2e-3)
def flat_boundary() -> Measured:
    """Flat boundary in three dimensions.

    Claim: on a flat surface the finite elements give Love's coefficients of self and neighbours
    Source: Love 1929; Johnson 1985, 3.2
    Tolerance: required of the flat boundary in 3-D; this middle mesh leaves 1.4e-3, the finest 2e-4
    """
    error = flat_error(LEVELS[1])
    return Measured(value=float(np.abs(error).max()), data=dict(zip(LABELS, error.tolist(), strict=True)))


@case("fem3d/one-point", metric="at_most", tolerance=2e-3)
def one_point() -> Measured:
    """One point of the shipped three-dimensional table, solved afresh.

    Claim: on a flank of 10 degrees one mesh gives the table's errors of self and neighbour coefficients
    Source: refimpl/data/coefficient_error_3d.json
    Tolerance: 0.2 percentage points of flat, as required in 3-D; one mesh and boundary leave 6e-4
    """
    tabulated = shipped().error(Series(WAVELENGTH, FLANK, NU), SLOPE)
    wavy = sample(ridge(SLOPE), NU, NEAR, 2).down
    fresh = (wavy - flat_sample(WAVELENGTH, Kind.RIDGE, NU, NEAR, 2).down) / normal_coefficient(X, Y, NU)
    return Measured(value=float(np.abs(fresh - tabulated).max()))


@case("fem3d/flat-order", metric="at_least", tolerance=3.0, tier="full")
def flat_order() -> Measured:
    """Order of convergence on a flat boundary in three dimensions.

    Claim: the self coefficient converges at the third order at least that extrapolation assumes
    Source: refinement by 2 and 3 of one mesh
    Tolerance: the order used to extrapolate; the jump of pressure limits it; measured 3.8 and 5.1
    """
    errors = np.abs([flat_error(level)[0] for level in LEVELS])
    orders = np.log(errors[:-1] / errors[1:]) / np.log([2.0, 1.5])
    return Measured(value=float(orders.min()), data={"orders": orders.tolist()})


@case("fem3d/flank-uncertainty", metric="at_most", tolerance=2e-3, tier="full", source=SOURCE)
def flank_uncertainty() -> Measured:
    """Stated error of a wavy result in three dimensions.

    Claim: at 10 degrees on a flank, three meshes and three outer radii bound every coefficient's error
    Tolerance: 0.2 percentage points of the flat coefficient, as asked in 3-D; measured 3e-4
    """
    result = flank(NU)
    data = {name: getattr(result, name).tolist() for name in ("error", "discretisation", "truncation")}
    return Measured(value=float(result.uncertainty.max()), data={"coefficient": list(LABELS), **data})


@case("fem3d/correction", metric="at_least", tolerance=5.0, tier="full")
def correction() -> Measured:
    """Facet tractions remove the antisymmetric error, in three dimensions.

    Claim: with [c_s] f tan(theta) the antisymmetric error at 10 degrees falls at least five times
    Source: exact tractions of a facet; {SOURCE}
    Tolerance: required of the correction; measured 33, 11 and 8 at 1, 2 and 3 elements
    """
    plain, left = flank(NU).antisymmetric, corrected(flank(NU), ridge(SLOPE), NU).antisymmetric
    data = {"elements away": [1, 2, 3], "without": plain.tolist(), "with": left.tolist()}
    return Measured(value=float(np.abs(plain / left).min()), data=data)


def ridge(slope: float, position: float = FLANK) -> Waviness:
    """Return the ridge of these cases."""
    return Waviness(slope, WAVELENGTH, position)


def odd_part(surface: Waviness, nu: float) -> Array:
    """Return half the difference (10,) between a slope and its opposite, over flat, less 1/R^2; level 2."""
    opposite = Waviness(-surface.slope_deg, surface.wavelength, surface.position, surface.kind)
    near, far = (
        0.5 * (sample(surface, nu, radius, 2).down - sample(opposite, nu, radius, 2).down)
        for radius in (30.0, 60.0)
    )
    return (far + (far - near) / 3) / normal_coefficient(X, Y, nu)


@case("fem3d/first-order", metric="at_most", tolerance=6e-5, tier="full")
def first_order_theory() -> Measured:
    """First-order theory in three dimensions.

    Claim: at 1 degree the odd part is the facet's part plus the part that grows with the offset
    Source: appendix_a.fem3d.leading_order
    Tolerance: fraction of flat: mesh level 2 leaves 4e-5 at the next neighbours, third order 3e-6
    """
    off = {}
    for kind, position in product(Kind, (0.0, 0.1, FLANK)):
        surface = Waviness(1.0, WAVELENGTH, position, kind)
        theory = first_order(surface, X, Y, NU) / normal_coefficient(X, Y, NU)
        off[f"{kind} at {position}"] = float(np.abs(odd_part(surface, NU) - theory).max())
    return Measured(value=max(off.values()), data={"largest difference": off})


@case("fem3d/tilt", metric="at_most", tolerance=2e-3, tier="full")
def tilted() -> Measured:
    """Long waves: the exact tilted plane.

    Claim: on a flank of 10 degrees and 100 a, self and next coefficients are those of a tilted plane
    Source: the flat solution in the plane's own frame
    Tolerance: fraction of flat: curvature leaves (k a)^2 times the slope, 7e-4, and the meshes 5e-4
    """
    result = coefficients(SLOPE, 100.0, FLANK, NU)
    plane = tilted_plane(X, Y, NU, SLOPE, projected=True) / result.flat - 1
    near = [0, 1, 4, 7]
    return Measured(value=float(np.abs(result.error - plane)[near].max()))


@case("fem3d/stated-error", metric="at_most", tolerance=1.0, tier="full")
def stated_error() -> Measured:
    """Stated errors are honest.

    Claim: finer meshes and wider boxes move no coefficient by more than the quick result's stated error
    Source: meshes (1, 2, 3) against (2, 3, 4); boxes to 3 against 4 wavelengths
    Tolerance: change over stated error; beyond 1 the statement would be wrong
    """
    quick, full = flank(NU), coefficients(SLOPE, WAVELENGTH, FLANK, NU, quality="full")
    change = np.abs(quick.error - full.error) / quick.uncertainty
    return Measured(value=float(change.max()), data=dict(zip(LABELS, change.tolist(), strict=True)))
