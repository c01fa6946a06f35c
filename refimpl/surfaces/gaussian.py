"""Gaussian roughness with the paper's autocorrelation, Eq. (9), as one continuous random field per seed.

Isotropic, Eq. (9), ``R(r) = rms^2 exp(-2.3 r^2 / l^2)``, falls to exp(-2.3) = 0.1003 at r = l (2.3 is the
paper's ln 10). A lattice of white noise realises it (`refimpl.surfaces.noise_lattice`).

Two lengths and a lay: the isotropic field of unit length in sheared coordinates (`refimpl.surfaces.lay`),
``((x + s y) / a, y / b)``, so that Eq. (9) holds to rounding for any lengths and lay.

Periodic: isotropic noise repeats on a lattice that divides the period. A sheared lattice does not close over
both periods, so two lengths are summed as waves of the period (`refimpl.surfaces.waves`). The power of a wave
is Eq. (9)'s transform, ``exp(-(lx^2 q'_x^2 + ly^2 q'_y^2) / 9.2)``; by Poisson's sum that is the periodic sum
of Eq. (9). Waves below 2e-17 of the largest amplitude are dropped.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, NoReturn

import numpy as np
import scipy

from refimpl.errors import InputError, keep_doubles, require_number, require_size, size_text
from refimpl.grid import Array, Grid
from refimpl.surfaces.lay import Lay
from refimpl.surfaces.noise_lattice import DECAY, NoiseLattice
from refimpl.surfaces.surface import Detail, Surface, require_seed
from refimpl.surfaces.waves import PeriodicLattice, rotated

RESOLVED = 4.0  # elements per correlation length from which slopes count as resolved
_REACH = 26.6  # l q of the highest wave: exp(-26.6^2 / 18.4) = 2e-17
_POINTS = 10  # quadrature points on a panel of half a correlation length
_MOST_POINTS = 10**8  # quadrature points on the domain: 500 x 500 lengths, 3 to 30 seconds
_BLOCK = 2**22  # points evaluated at once: 34 MB an array
_ALLOWED_FLAG = "true or false"
_ALLOWED_LENGTH = "a positive length in m, or two: along the lay and across it"


@dataclass(frozen=True)
class GaussianRoughness(Surface):
    """Gaussian roughness, autocorrelation Eq. (9); the same surface on every grid, at every offset.

    rms : rms height (m) in the ensemble, the mean of which is 0
    correlation_length : the length (m) at which the autocorrelation falls to ``acf_level``; or two,
        ``(lx, ly)``, along and across the lay
    seed : fixes the noise alone. Another rms scales the heights, other lengths and lays deform the surface;
        bodies that shall differ need different seeds
    normalise : scale this realisation (without a shift), so that its standard deviation over the domain at
        offset 0, an integral that knows no grid, is ``rms``, as in the paper's section 6.1
    lay : angle from x to the axis of lx (rad)
    acf_level : 0.1 as in the paper: ``l of (9) = given * sqrt(ln 10 / ln(1 / level))``. ISO 25178's Sal has
        the level 0.2 (of a lay it is the shorter length), other definitions have 1/e

    Periodic scenes get another realisation, one that repeats with the domain. Its covariance is the periodic
    sum of Eq. (9) scaled to ``rms``; lengths are at most the periods.
    """

    rms: float
    correlation_length: float | tuple[float, float]
    seed: int
    normalise: bool = False
    lay: float = 0.0
    acf_level: float = 0.1
    kind: ClassVar[str] = "gaussian"

    def __post_init__(self) -> None:
        require_size("rms", self.rms, "a positive rms height in m")
        object.__setattr__(self, "correlation_length", _lengths(self.correlation_length))
        object.__setattr__(self, "seed", require_seed(self.seed))
        if not isinstance(self.normalise, bool):
            raise InputError("normalise", self.normalise, _ALLOWED_FLAG)
        require_number("lay", self.lay, "a finite angle in rad")
        level = "a level of the autocorrelation between 0 and 1"
        require_number("acf_level", self.acf_level, level, above=0, below=1)
        keep_doubles(self, "rms", "lay", "acf_level")

    @cached_property
    def ellipse(self) -> Lay:
        """The lengths of Eq. (9) (m), ``along`` the lay lx and ``across`` ly."""
        given = self.correlation_length
        lx, ly = given if isinstance(given, tuple) else (given, given)
        factor = math.sqrt(math.log(10.0) / -math.log(self.acf_level))
        return Lay(lx * factor, ly * factor, self.lay)

    @np.errstate(under="ignore")  # far lags end as zeros
    def autocorrelation(self, x: Array, y: Array | float = 0.0) -> Array:
        """Return Eq. (9) at lags (x, y) (m): ``rms^2 exp(-2.3 (x'^2 / lx^2 + y'^2 / ly^2))`` (m^2)."""
        a, s, b = self.ellipse.sheared
        return np.asarray(self.rms**2 * np.exp(-DECAY * (((x + s * y) / a) ** 2 + (y / b) ** 2)))

    @property
    def rms_slope(self) -> float:
        """Ensemble rms of dz/dx: ``rms sqrt(2 * 2.3) / l``, l the length along x."""
        return self.rms * math.sqrt(2.0 * DECAY) / self.ellipse.on_axes[0]

    @property
    def rms_gradient(self) -> float:
        """Ensemble rms of |grad z| (Sdq): ``rms sqrt(2 * 2.3) sqrt(1 / lx^2 + 1 / ly^2)``."""
        return self.rms * math.sqrt(2.0 * DECAY) * math.hypot(1 / self.ellipse.along, 1 / self.ellipse.across)

    def parameters(self) -> dict[str, float]:
        given = self.correlation_length
        lengths = {"correlation_length": given}
        if isinstance(given, tuple):
            lengths = {f"correlation_length[{k}]": length for k, length in enumerate(given)}
        return {"rms": self.rms, **lengths, "lay": self.lay, "seed": self.seed}  # type: ignore[dict-item]  # a float

    def with_parameter(self, name: str, value: float) -> GaussianRoughness:
        if name.endswith("]"):
            assert isinstance(self.correlation_length, tuple)
            lx, ly = self.correlation_length
            return replace(self, correlation_length=(value, ly) if "[0]" in name else (lx, value))
        return super().with_parameter(name, value)

    def same_realisation(self, periodic: bool) -> tuple[str, ...]:
        lattice = periodic and self.ellipse.is_isotropic  # another length has another lattice
        return ("rms",) if lattice else tuple(name for name in self.parameters() if name != "seed")

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        scale = self.rms / self._realised_rms(grid) if self.normalise else 1.0
        return self._field(grid.x + offset[0], grid.y + offset[1], grid) * scale

    def _field(self, x: Array, y: Array, grid: Grid) -> Array:
        """Return the ensemble heights (m) at all pairs of ``x``, ``y``."""
        if grid.periodic:
            self._refuse_longer(grid.lengths)
            if not self.ellipse.is_isotropic:
                return self._waves(x, y, grid)
        return self.rms * self._lattice.field(self.seed, x, y, grid.lengths if grid.periodic else None)

    def smoothing(self, x: Array, period: float | None = None) -> tuple[range, scipy.sparse.csr_array]:
        """Return the lattice's nodes and matrix along x (`NoiseLattice.smoothing`)."""
        return self._lattice.smoothing(x, 0, period)

    @cached_property
    def _lattice(self) -> NoiseLattice:
        return NoiseLattice(self.ellipse, self._refused)

    def _waves(self, x: Array, y: Array, grid: Grid) -> Array:
        shortest = [2.0 * math.pi / _REACH * length for length in self.ellipse.on_axes]
        lattice = PeriodicLattice.holding(grid.lengths, shortest, self._refused)
        scale = self.rms / math.sqrt(lattice.mean_squares(self._amplitude)[0])
        return scale * lattice.field(self._amplitude, self.seed, x, y)

    def _amplitude(self, qx: Array, qy: Array) -> Array:
        """Return the root of Eq. (9)'s transform over its peak."""
        along, across = rotated(qx, qy, self.lay)
        lx, ly = self.ellipse.along, self.ellipse.across
        return np.asarray(np.exp(-((lx * along) ** 2 + (ly * across) ** 2) / (8.0 * DECAY)))

    def _refuse_longer(self, periods: tuple[float, float]) -> None:
        for extent, period in zip(self.ellipse.extents, periods, strict=True):
            if extent > period:
                allowed = f"at most the period, {period:.6g} m"
                raise InputError("correlation_length", self.correlation_length, allowed)

    def _refused(self, factor: float, limit: str) -> NoReturn:
        """Refuse lengths that are too short for the domain by a factor; of two, the shorter is named."""
        least = factor * float(np.min(self.correlation_length))
        need = f"at least {least:.3g} m on this domain ({limit})"
        raise InputError("correlation_length", self.correlation_length, need)

    def _realised_rms(self, grid: Grid) -> float:
        """Return the domain's standard deviation (m): 10 Gauss points per half length (error < 1e-12)."""
        lengths = self.ellipse.on_axes
        for side, length in zip(grid.lengths, lengths, strict=True):
            if side < length:
                least = f"false, or a side of at least one correlation length, {length:.6g} m"
                raise InputError("normalise", True, least)
        points = math.prod(_POINTS * _panels(*pair) for pair in zip(grid.lengths, lengths, strict=True))
        if points > _MOST_POINTS:
            self._refused(math.sqrt(points / _MOST_POINTS), "normalise = true: 500 x 500 lengths")
        (x, along), (y, across) = map(_quadrature, grid.lengths, lengths)
        columns = max(1, _BLOCK // len(x))
        first = second = shift = 0.0
        for j in range(0, len(y), columns):
            z, weights = self._field(x, y[j : j + columns], grid), across[j : j + columns]
            mean = float(along @ z @ weights)
            if j == 0:
                shift = mean * len(y) / len(weights)  # near the mean, so that no digits cancel
            first += mean
            second += float(along @ (z - shift) ** 2 @ weights)
        return math.sqrt(second - (first - shift) ** 2)

    def detail(self, spacing: float) -> Detail:
        # mean squares of the Laplacian and the gradient of Eq. (9): 32 c^2 and 4 c, c = 2.3 / l^2.
        # With exp(-q^2 / (4 c)) the gradient's square beyond q is (1 + s) exp(-s), s = q^2 / (4 c)
        length = min(self.ellipse.along, self.ellipse.across)
        beyond = (math.pi / spacing * length) ** 2 / (4.0 * DECAY)
        unresolved = (1.0 + beyond) * math.exp(-beyond)
        curvature = math.sqrt(8.0 * DECAY)
        return Detail("correlation length", length, RESOLVED, curvature, self.rms_gradient, unresolved)

    def describe(self, grid: Grid) -> tuple[str, ...]:
        over = f"over the domain of {size_text(grid.lengths)} m" if self.normalise else "in the ensemble"
        return (
            f"Gaussian roughness of seed {self.seed}: rms {self.rms:.6g} m {over}, {self._said_lengths}",
            *self.notes(grid),
        )

    @property
    def _said_lengths(self) -> str:
        given, level = self.correlation_length, self.acf_level
        at = "" if level == 0.1 else f" (autocorrelation {level:.3g})"
        if isinstance(given, tuple):
            turned = f"lay {math.degrees(self.lay):.4g} degrees"
            return f"correlation lengths {given[0]:.6g} m along and {given[1]:.6g} m across{at}, {turned}"
        return f"correlation length {given:.6g} m{at}"

    def notes(self, grid: Grid) -> tuple[str, ...]:
        length = self.detail(max(grid.spacings)).length
        if max(grid.spacings) <= length / RESOLVED:
            return ()
        return (
            f"the element, {max(grid.spacings):.3g} m, exceeds a quarter of the roughness's correlation "
            f"length, {length:.3g} m: its slopes are not resolved",
        )


def _lengths(given: object) -> float | tuple[float, float]:
    if isinstance(given, list | tuple):
        if len(given) != 2:
            raise InputError("correlation_length", given, _ALLOWED_LENGTH)
        along, across = (require_size("correlation_length", length, _ALLOWED_LENGTH) for length in given)
        return along, across
    return require_size("correlation_length", given, _ALLOWED_LENGTH)


def _panels(side: float, length: float) -> int:
    """Return the number of panels, of at most half a length, along one side."""
    return math.ceil(2.0 * side / length)


def _quadrature(side: float, length: float) -> tuple[Array, Array]:
    """Return the quadrature points (m) and weights, which add up to 1, along one side."""
    panels = _panels(side, length)
    node, weight = np.polynomial.legendre.leggauss(_POINTS)
    points = ((np.arange(panels)[:, None] + (node + 1.0) / 2.0) * (side / panels)).ravel()
    return points, np.tile(weight / (2.0 * panels), panels)
