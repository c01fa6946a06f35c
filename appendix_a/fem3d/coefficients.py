"""Influence coefficients on a wavy surface against the flat ones, each with a bound on its error."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from appendix_a.errors import InputError, real
from appendix_a.fem3d.patch import facet_prediction, normal_coefficient
from appendix_a.fem3d.surface import Sample, X, Y, flat_sample, sample
from appendix_a.fem3d.wavy import Kind, Waviness

Array = NDArray[np.float64]

LABELS = ("self", "+x 1", "+x 2", "+x 3", "-x 1", "-x 2", "-x 3", "across 1", "across 2", "across 3")
RADIUS_LEVEL = 2  # the mesh on which they are compared: four quadratic elements a wave
# Maximum-norm order of quadratics where the solution is smooth; observed: 3 at the neighbours, 3 to 5 under
# the load. At the edges of the load strains are logarithmic; no point is there, and their part is h^4
MESH_ORDER = 3
# A displacement prescribed at R is wrong by a dipole, 1/R^2, and moves the origin by as much
RADIUS_ORDER = 2
SAFETY = 1.25  # Roache's factor for three grids (1998, section 5.9)


class Quality(StrEnum):
    """Which three meshes and which three outer boundaries."""

    QUICK = "quick"
    FULL = "full"

    @property
    def levels(self) -> tuple[int, int, int]:
        """Elements along half the loaded element's edge."""
        return (1, 2, 3) if self is Quality.QUICK else (2, 3, 4)

    @property
    def radii(self) -> tuple[float, float, float]:
        """Outer radii in wavelengths; the meshes are compared at the first."""
        return (1.5, 2.0, 3.0) if self is Quality.QUICK else (1.5, 2.5, 4.0)


class Width(StrEnum):
    """Meaning of 2a: the loaded element's edge in projection (the contact grid's), or along the facet."""

    PROJECTED = "projected"
    FACET = "facet"


@dataclass(frozen=True)
class Coefficients3D:
    """Vertical displacements at the loaded element's centre and at its neighbours' 1, 2 and 3 elements away.

    Arrays (10,) in the order of LABELS: self, +x (downhill on the flank 0.25), -x, across. `flat`: exact
    flat coefficients in units of p a / E; `error`: wavy / flat - 1; `discretisation`, `truncation`: bounds
    on the parts of its error from the mesh and from the outer boundary, as fractions of flat; `flat_error`:
    finest mesh against exact on the flat surface; `residual`: the largest of the linear solutions';
    `elements`: of the finest mesh.
    """

    flat: Array
    error: Array
    discretisation: Array
    truncation: Array
    flat_error: Array
    residual: float
    elements: int

    @property
    def uncertainty(self) -> Array:
        """Discretisation plus truncation (10,), fractions of flat."""
        return self.discretisation + self.truncation

    @property
    def self_error(self) -> float:
        """Error of the self coefficient."""
        return float(self.error[0])

    @property
    def forward(self) -> Array:
        """Errors (3,) at +x."""
        return self.error[1:4]

    @property
    def backward(self) -> Array:
        """Errors (3,) at -x."""
        return self.error[4:7]

    @property
    def across(self) -> Array:
        """Errors (3,) at +-y."""
        return self.error[7:]

    @property
    def antisymmetric(self) -> Array:
        """(3,) half the difference of the +x and -x errors: the first-order part on a flank."""
        return 0.5 * (self.forward - self.backward)


def corrected(result: Coefficients3D, surface: Waviness, nu: float) -> Coefficients3D:
    """Return the error of `[a] f + [c_s] f tan(theta)`, slope under the centre, over flat."""
    downhill = -np.degrees(np.arctan(surface.local_slope))
    predicted = facet_prediction(X, Y, nu, downhill) / result.flat - 1
    return Coefficients3D(**{**vars(result), "error": result.error - predicted})


def coefficients(
    slope_deg: float,
    wavelength: float,
    position: float,
    nu: float,
    *,
    kind: str = "ridge",
    width: str = "projected",
    quality: str = "quick",
) -> Coefficients3D:
    """Return the error of the flat coefficients for one square element on a wavy elastic body.

    slope_deg: the surface's maximum slope, 0 to 35 degrees. wavelength: 16 to 400, in units of a, half the
    element's edge. position: of the element's centre, x / lambda in [0, 1]: crest 0, flank 0.25 (+x
    downhill), valley 0.5; on an
        egg-box, along a crest line.
    nu: Poisson's ratio, 0 to 0.45.
    kind, width, quality: the values of `Kind`, `Width`, `Quality`.
    Raises InputError.
    """
    _check(slope_deg, wavelength, position, nu, kind, width, quality)
    surface = Waviness(slope_deg, wavelength, position, Kind(kind))
    levels, radii = Quality(quality).levels, Quality(quality).radii
    near = radii[0] * wavelength
    edges = surface.facet_edges() if Width(width) is Width.FACET else (-1.0, 1.0)
    exact = normal_coefficient(X, Y, nu)

    def pair(radius: float, level: int) -> tuple[Sample, Sample]:
        flat = flat_sample(wavelength, surface.kind, nu, radius, level)
        return sample(surface, nu, radius, level, edges), flat

    meshes = {level: pair(near, level) for level in {*levels, RADIUS_LEVEL}}
    beyond = {r * wavelength: pair(r * wavelength, RADIUS_LEVEL) for r in radii[1:]}
    boxes = {near: meshes[RADIUS_LEVEL], **beyond}
    by_mesh = [(meshes[level][0].down - meshes[level][1].down) / exact for level in levels]
    by_box = [(wavy.down - flat.down) / exact for wavy, flat in boxes.values()]
    refined, discretisation = extrapolated(by_mesh, [1 / level for level in levels], MESH_ORDER)
    opened, truncation = extrapolated(by_box, [1 / radius for radius in boxes], RADIUS_ORDER)
    wavy, flat = meshes[levels[-1]]
    return Coefficients3D(
        flat=exact,
        error=refined + (opened - by_box[0]),
        discretisation=discretisation,
        truncation=truncation,
        flat_error=flat.down / exact - 1,
        residual=max(s.residual for p in (*meshes.values(), *boxes.values()) for s in p),
        elements=wavy.elements,
    )


def extrapolated(values: list[Array], steps: list[float], order: int) -> tuple[Array, Array]:
    """Limit of three values at falling `steps`, as of order `order`, and a bound on its error.

    With `last` the limit from the second and the third value, the bound is `SAFETY` times the larger of
    |last - third value| (Roache's grid convergence index) and |last - limit of the first and second value|.
    For `values = L + a step^p + b step^q` with any a and b it is a bound where p >= 2.5 and q >= p + 0.25,
    and on outer boundaries (order 2) where p >= 2 (tests/appendix_a/test_fem3d_bound.py).

    >>> series = [np.array([1.0 + step**2]) for step in (1.0, 0.5, 0.25)]
    >>> limit, error = extrapolated(series, [1.0, 0.5, 0.25], order=2)
    >>> float(limit[0]), float(error[0])
    (1.0, 0.078125)
    """

    def limit(coarse: int, fine: int) -> Array:
        ratio = (steps[coarse] / steps[fine]) ** order
        result: Array = values[fine] + (values[fine] - values[coarse]) / (ratio - 1)
        return result

    last = limit(1, 2)
    return last, SAFETY * np.maximum(np.abs(last - values[2]), np.abs(last - limit(0, 1)))


def _check(
    slope_deg: float, wavelength: float, position: float, nu: float, kind: str, width: str, quality: str
) -> None:
    """Refuse what has not been verified, first of all NaN."""
    for field, value, low, high in (
        ("slope_deg", slope_deg, 0.0, 35.0),
        ("wavelength", wavelength, 16.0, 400.0),
        ("position", position, 0.0, 1.0),
        ("nu", nu, 0.0, 0.45),
    ):
        if not low <= real(value) <= high:
            raise InputError(field, value, f"a number from {low:g} to {high:g}")
    for field, word, known in (("kind", kind, Kind), ("width", width, Width), ("quality", quality, Quality)):
        if word not in [member.value for member in known]:
            raise InputError(field, word, "one of " + ", ".join(member.value for member in known))
