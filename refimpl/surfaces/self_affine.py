"""Self-affine roughness: a power-law PSD with roll-off and cut-offs, as one continuous surface per seed.

The two-dimensional PSD, ``<h^2> = (2 pi)^-2 int C d^2q``, is zero below ``q(long_cut)``, constant to
``q(roll_off)``, ``q^(-2-2H)`` to ``q(short_cut)`` and zero beyond, with ``q(lambda) = 2 pi / lambda``
(Persson, Albohr, Tartaglino, Volokitin and Tosatti 2005; Jacobs, Junge and Pastewka 2017). A lay makes it a
function of ``sqrt(g^2 q_along^2 + q_across^2)``: the surface is stretched by g along the lay.

Heights are a sum of waves of a lattice with a normal number each (`refimpl.surfaces.waves`), so they are
Gaussian. ``C dq_x dq_y / (2 pi)^2`` is a wave's mean square, up to one factor by which the given rms height
or rms gradient holds exactly in the ensemble of the waves there are. The other one then differs from the
integral's (`SelfAffineRoughness.rms`, `rms_gradient`) by the share of waves at the spectrum's ends.

- Free surfaces: the lattice is square in the sheared coordinates of the lay (`refimpl.surfaces.lay`), where
  the spectrum is isotropic: another lay or anisotropy deforms the same realisation. Its period is
  ``long_cut`` times the least power of 2, at least 8, that makes it 4 times as long as the domain: far
  from the domain's.
- Periodic surfaces: the lattice is the domain.

The noise belongs to wave numbers. Another Hurst exponent or roll-off changes amplitudes, a shorter
``short_cut`` adds waves to those there are, and another ``long_cut`` has another lattice.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, ClassVar, NoReturn

import numpy as np
import scipy

from refimpl.errors import InputError, keep_doubles, require_number, require_size
from refimpl.grid import Array, Grid
from refimpl.surfaces.lay import Lay
from refimpl.surfaces.surface import Detail, Surface, require_seed
from refimpl.surfaces.waves import ROUNDING, PeriodicLattice, rotated

RESOLVED = 4.0  # elements per shortest wave from which slopes count as resolved
_PERIODS = 8  # long_cuts in the period of a free surface, at least: waves of all directions at the long end
_FAR = 4.0  # domains in that period, at least
_WAVELENGTH = "a positive wavelength in m"


@dataclass(frozen=True, kw_only=True)
class SelfAffineRoughness(Surface):
    """Self-affine Gaussian roughness; the same surface on every grid, at every offset.

    hurst : Hurst exponent H, ``0 < H <= 1``
    roll_off, long_cut, short_cut : wavelengths (m), ``long_cut >= roll_off > short_cut``
    seed : fixes the noise of the waves
    rms, rms_gradient : rms height (m) or rms of |grad z| (Sdq), one of them given; the ensemble's. The other
        follows from the integral of the PSD
    anisotropy : g, the factor by which the surface is stretched along the lay; wavelengths hold across it
    lay : angle from x to the direction along the lay (rad)

    A grid samples the surface as it is: waves shorter than two elements are not filtered out. Domains that
    differ in their longer side by more than a factor of two may see another realisation. Periodic scenes get
    a realisation that repeats with the domain; ``long_cut`` is at most the period.
    """

    hurst: float
    roll_off: float
    long_cut: float
    short_cut: float
    seed: int
    rms: float = None  # type: ignore[assignment]  # follows in __post_init__ where it is not given
    rms_gradient: float = None  # type: ignore[assignment]  # likewise
    anisotropy: float = 1.0
    lay: float = 0.0
    given: str = field(init=False, repr=False)
    kind: ClassVar[str] = "self_affine"

    def __post_init__(self) -> None:
        require_number("hurst", self.hurst, "a Hurst exponent, 0 < H <= 1", above=0, at_most=1)
        for name in ("long_cut", "roll_off", "short_cut"):
            require_size(name, getattr(self, name), _WAVELENGTH)
        if not self.long_cut >= self.roll_off:
            raise InputError("long_cut", self.long_cut, f"at least roll_off, {self.roll_off:.6g} m")
        if not self.roll_off > self.short_cut:
            raise InputError("short_cut", self.short_cut, f"less than roll_off, {self.roll_off:.6g} m")
        require_size("anisotropy", self.anisotropy, "a positive ratio of lengths along and across the lay")
        require_number("lay", self.lay, "a finite angle in rad")
        keep_doubles(self, "hurst", "roll_off", "long_cut", "short_cut", "anisotropy", "lay")
        object.__setattr__(self, "seed", require_seed(self.seed))
        self._fix_size()

    def _fix_size(self) -> None:
        """Check the one size that is given, and derive the other from the PSD's integrals."""
        sizes: dict[str, Any] = {"rms": self.rms, "rms_gradient": self.rms_gradient}
        present = [name for name, value in sizes.items() if value is not None]
        if len(present) != 1:
            what = "both" if present else "neither"
            raise InputError("rms, rms_gradient", what, "one of rms (m) and rms_gradient")
        (given,) = present
        allowed = (
            "a positive rms height in m" if given == "rms" else "a positive rms of the gradient's length"
        )
        require_size(given, sizes[given], allowed)
        stretched = 0.5 * ((1.0 / self.anisotropy) ** 2 + 1.0)
        size, ratio = float(sizes[given]), math.sqrt(self.moment(2) / self.moment(0) * stretched)
        object.__setattr__(self, "given", given)
        object.__setattr__(self, "rms", size if given == "rms" else size / ratio)
        object.__setattr__(self, "rms_gradient", size * ratio if given == "rms" else size)

    @cached_property
    def ellipse(self) -> Lay:
        """Stretch along the lay and across it."""
        return Lay(self.anisotropy, 1.0, self.lay)

    def moment(self, order: int, shortest: float | None = None) -> float:
        """Return ``(2 pi)^-2 int q^n C d^2q``, C = 1 m^2 on the plateau, to the ``shortest`` wave (m)."""
        short = min(self.short_cut if shortest is None else shortest, self.long_cut)
        low, high = 2.0 * math.pi / self.long_cut, 2.0 * math.pi / short
        roll = min(2.0 * math.pi / self.roll_off, high)
        n, exponent = order + 2, order - 2.0 * self.hurst
        octaves = math.log(high / roll)
        tail = math.expm1(exponent * octaves) / exponent if exponent else octaves
        return ((roll**n - low**n) / n + roll**n * tail) / (2.0 * math.pi)

    @property
    def rms_slope(self) -> float:
        """Ensemble rms of dz/dx."""
        isotropic = self.rms * math.sqrt(0.5 * self.moment(2) / self.moment(0))
        return isotropic / self.ellipse.on_axes[0]

    @property
    def nayak(self) -> float:
        """Nayak's parameter of the isotropic PSD: ``m0 m4 / m2^2`` of a profile, ``3/2 M0 M4 / M2^2``."""
        return 1.5 * self.moment(0) * self.moment(4) / self.moment(2) ** 2

    def psd(self, q: Array) -> Array:
        """Return the PSD C (m^4) at wave numbers across the lay (rad/m)."""
        plateau = self.rms**2 * self.anisotropy / self.moment(0)
        return np.asarray(plateau * self._shape(np.asarray(q, dtype=float)))

    def _shape(self, q: Array) -> Array:
        """Return the PSD over its plateau."""
        low, roll, high = (2.0 * math.pi / wave for wave in (self.long_cut, self.roll_off, self.short_cut))
        inside = (q >= low * (1.0 - ROUNDING)) & (q <= high * (1.0 + ROUNDING))
        return np.where(inside, (np.maximum(q, roll) / roll) ** (-2.0 - 2.0 * self.hurst), 0.0)

    def parameters(self) -> dict[str, float]:
        names = (self.given, "hurst", "roll_off", "long_cut", "short_cut", "anisotropy", "lay", "seed")
        return {name: getattr(self, name) for name in names}

    def with_parameter(self, name: str, value: float) -> SelfAffineRoughness:
        table = self.to_dict() | {name: int(value) if name == "seed" and value % 1 == 0 else value}
        return SelfAffineRoughness.from_table({key: v for key, v in table.items() if key != "kind"}, Path())

    def same_realisation(self, periodic: bool) -> tuple[str, ...]:
        return (self.given, "hurst") if periodic else (self.given, "hurst", "anisotropy", "lay")

    def to_dict(self) -> dict[str, Any]:
        return {"kind": self.kind, **self.parameters()}

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        if self.long_cut < 2.0 * max(grid.spacings):
            need = f"at least two elements, {2.0 * max(grid.spacings):.3g} m: the grid holds no wave of it"
            raise InputError("long_cut", self.long_cut, need)
        lattice = self._wave_lattice(grid)
        height, gradient = lattice.mean_squares(self._amplitude)
        if not height:
            need = "a spectrum that holds a wave of the periodic domain"
            raise InputError("short_cut", self.short_cut, need)
        present = math.sqrt(height if self.given == "rms" else gradient)
        size = self.rms if self.given == "rms" else self.rms_gradient
        z = lattice.field(self._amplitude, self.seed, grid.x + offset[0], grid.y + offset[1])
        return np.asarray(z * (size / present))

    def _wave_lattice(self, grid: Grid) -> PeriodicLattice:
        if grid.periodic:
            if self.long_cut > min(grid.lengths):
                raise InputError("long_cut", self.long_cut, f"at most the period, {min(grid.lengths):.6g} m")
            along_x, along_y = self.ellipse.on_axes
            shortest = (along_x * self.short_cut, along_y * self.short_cut)
            return PeriodicLattice.holding(grid.lengths, shortest, self._refused)
        far = _FAR * max(grid.lengths) / min(self.anisotropy, 1.0)
        doublings = math.ceil(math.log2(max(_PERIODS, far / self.long_cut * (1.0 - ROUNDING))))
        period = self.long_cut * 2.0**doublings
        a, shear, b = self.ellipse.sheared
        shortest = (a * self.short_cut, b * self.short_cut)
        return PeriodicLattice.holding((a * period, b * period), shortest, self._refused, shear)

    def _amplitude(self, qx: Array, qy: Array) -> Array:
        """Return the root of the PSD over its plateau."""
        along, across = rotated(qx, qy, self.lay)
        return np.sqrt(self._shape(np.hypot(self.anisotropy * along, across)))

    def _refused(self, factor: float, limit: str) -> NoReturn:
        need = f"at least {factor * self.short_cut:.3g} m on this domain ({limit})"
        raise InputError("short_cut", self.short_cut, need)

    def missed(self, spacing: float) -> tuple[float, float]:
        """Return the shares of rms slope and rms curvature that differences over ``spacing`` (m) miss.

        These have ``(1 - J0(2qh)) / (2 h^2)`` and ``(6 - 8 J0(qh) + 2 J0(2qh)) / h^4`` of a wave in place of
        ``q^2 / 2`` and ``3 q^4 / 8``, averaged over angles. Across the lay.
        """
        q, weight = self._quadrature(spacing)
        power, qh = weight * self._shape(q) * q**2, q * spacing
        slope, curvature = 0.5 * float(power @ q**2), 0.375 * float(power @ q**4)
        seen = float(power @ (1.0 - scipy.special.j0(2.0 * qh))) / (2.0 * spacing**2)
        bent = (
            float(power @ (6.0 - 8.0 * scipy.special.j0(qh) + 2.0 * scipy.special.j0(2.0 * qh))) / spacing**4
        )
        return 1.0 - math.sqrt(seen / slope), 1.0 - math.sqrt(bent / curvature)

    def _quadrature(self, spacing: float) -> tuple[Array, Array]:
        """Return points q (rad/m) and weights over log q: ten Gauss points per panel.

        A panel is at most an eighth of an octave and half an oscillation of the Bessel functions wide.
        """
        ends = [2.0 * math.pi / wave for wave in (self.long_cut, self.roll_off, self.short_cut)]
        node, weight = np.polynomial.legendre.leggauss(10)
        points, weights = [], []
        for low, high in pairwise(ends):
            length = math.log(high / low)
            panels = 1 + math.ceil(length * (12.0 + high * spacing))
            middle = math.log(low) + (np.arange(panels)[:, None] + (node + 1.0) / 2.0) * (length / panels)
            points.append(np.exp(middle).ravel())
            weights.append(np.tile(weight * (length / panels / 2.0), panels))
        return np.concatenate(points), np.concatenate(weights)

    def detail(self, spacing: float) -> Detail:
        slope, curvature = self.missed(spacing)
        said = f"{slope:.0%} of the rms slope and {curvature:.0%} of the rms curvature"
        curvature = self.short_cut * math.sqrt(self.moment(4) / self.moment(2))
        unresolved = 1.0 - self.moment(2, max(self.short_cut, 2.0 * spacing)) / self.moment(2)
        return Detail(
            "shortest wave", self.short_cut, RESOLVED, curvature, self.rms_gradient, unresolved, said
        )

    def describe(self, grid: Grid) -> tuple[str, ...]:
        lay = f", stretched {self.anisotropy:.4g} times along a lay of {math.degrees(self.lay):.4g} degrees"
        stretched = "" if self.ellipse.is_isotropic else lay
        return (
            f"self-affine roughness of seed {self.seed}: Hurst exponent {self.hurst:.4g}, waves from "
            f"{self.long_cut:.6g} m (roll-off {self.roll_off:.6g} m) to {self.short_cut:.6g} m{stretched}; "
            f"rms height {self.rms:.6g} m, rms gradient {self.rms_gradient:.6g} ({self.given} given)",
            *self.notes(grid),
        )

    def notes(self, grid: Grid) -> tuple[str, ...]:
        spacing = max(grid.spacings)
        elements = self.short_cut / spacing
        if elements >= RESOLVED:
            return ()
        return (
            f"{elements:.2g} elements per shortest wave, {self.short_cut:.3g} m: the grid misses "
            f"{self.detail(spacing).missed}; slopes are resolved from {RESOLVED:.0f}",
        )
