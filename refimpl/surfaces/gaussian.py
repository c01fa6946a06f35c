"""Gaussian roughness with the paper's autocorrelation, Eq. (9), as one continuous random field per seed.

Eq. (9), ``R(r) = rms^2 exp(-2.3 r^2 / l^2)``, falls to exp(-2.3) = 0.1003 at r = l (2.3 is the paper's
ln 10). ``exp(-4.6 r^2 / l^2)`` convolved with itself is proportional to R. So independent standard normal
numbers w on the nodes of an infinite square lattice of spacing h, smoothed by that kernel,

    z(x, y) = rms (h k / l) sum_mn exp(-4.6 ((x - m h)^2 + (y - n h)^2) / l^2) w_mn,    k = sqrt(9.2 / pi),

make a Gaussian field, analytic in x and y. Its covariance is R(r) but for two errors, both below rounding:

- The lattice. By Poisson's sum the covariance at the mean position c of two points is R(r) times
  ``1 + 2 exp(-pi^2 l^2 / (9.2 h^2)) cos(2 pi c / h) + ...`` for each axis: with h = l / 6, 3.4e-17 cos(...).
- Cutting the kernel off at 17 nodes, r = 2.83 l: what is dropped is below exp(-4.6 * 2.83^2) = 9e-17 of its
  peak.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.sparse import csr_array

from refimpl.errors import InputError, require_size
from refimpl.grid import Array, Grid
from refimpl.surfaces.surface import Surface, positive
from refimpl.surfaces.white_noise import white_noise

DECAY = 2.3  # exponent of Eq. (9)
NODES_PER_LENGTH = 6
HALF_WIDTH = 17 / NODES_PER_LENGTH  # half-width of the kernel, in correlation lengths
MAX_NODES = 8192  # an axis: 512 MiB of noise
MAX_FAR = 1e6  # lattice spacings from the origin: rounding of x there moves heights by < 1e-9 rms
_ALLOWED_SEED = "a whole number, 0 <= seed < 2^63"
_ALLOWED_FLAG = "true or false"


@dataclass(frozen=True)
class GaussianRoughness(Surface):
    """Isotropic Gaussian roughness, autocorrelation Eq. (9); the same surface on every grid, at every offset.

    ``rms`` height and ``correlation_length`` (autocorrelation 10 %) in m. The seed alone fixes the noise:
    another rms scales the heights, another length stretches the surface; bodies that shall differ need
    different seeds. ``rms`` holds for the ensemble, the mean of which is 0; ``normalise=True`` scales this
    realisation (it does not shift it), so that its standard deviation over the scene's square at offset 0,
    an integral that knows no grid, is ``rms``, as in the paper's section 6.1.

    Periodic scenes get another realisation, one that repeats with ``side``: the noise repeats, on a lattice
    that divides the side. Its covariance is the periodic sum of Eq. (9) scaled to ``rms``; length <= side.
    """

    rms: float
    correlation_length: float
    seed: int
    normalise: bool = False
    kind: ClassVar[str] = "gaussian"

    def __post_init__(self) -> None:
        require_size("rms", self.rms, "a positive rms height in m")
        object.__setattr__(self, "rms", float(self.rms))
        length = positive("correlation_length", self.correlation_length, "a positive length in m")
        object.__setattr__(self, "correlation_length", length)
        whole = isinstance(self.seed, int | np.integer) and not isinstance(self.seed, bool)
        if not whole or not 0 <= self.seed < 2**63:
            raise InputError("seed", self.seed, _ALLOWED_SEED)
        object.__setattr__(self, "seed", int(self.seed))
        if not isinstance(self.normalise, bool):
            raise InputError("normalise", self.normalise, _ALLOWED_FLAG)

    def autocorrelation(self, distance: Array) -> Array:
        """Eq. (9): ``rms^2 exp(-2.3 r^2 / l^2)`` (m^2) at distances r (m)."""
        return np.asarray(self.rms**2 * np.exp(-DECAY * (distance / self.correlation_length) ** 2))

    @property
    def rms_slope(self) -> float:
        """Ensemble rms of dz/dx: ``sqrt(-R''(0)) = rms sqrt(2 * 2.3) / l``."""
        return self.rms * math.sqrt(2.0 * DECAY) / self.correlation_length

    def _sample(self, grid: Grid, offset: tuple[float, float]) -> Array:
        return self._field(grid.x + offset[0], grid.y + offset[1], grid) * self._scale(grid)

    def _field(self, x: Array, y: Array, grid: Grid) -> Array:
        """Ensemble heights (m) at all pairs of ``x``, ``y``."""
        periods = grid.lengths if grid.periodic else (None, None)
        nodes_x, smooth_x = self.smoothing(x, periods[0])
        nodes_y, smooth_y = self.smoothing(y, periods[1])
        noise = white_noise(self.seed, nodes_x, nodes_y)
        return self.rms * np.ascontiguousarray((smooth_y @ (smooth_x @ noise).T).T)

    def smoothing(self, x: Array, period: float | None = None) -> tuple[range, csr_array]:
        """One axis of the sum above: the nodes it needs, and the kernel as a matrix S, ``(len(x), nodes)``.

        Heights are ``rms S_x w S_y^T``: the exact correlation along an axis, in the ensemble, is ``S S^T``.
        """
        length, h = self.correlation_length, self._lattice_spacing(period)
        reach = math.ceil(HALF_WIDTH * length / h)
        self._refuse_too_many(x, h, reach)
        node = np.rint(x / h).astype(np.int64)[:, None] + np.arange(-reach, reach + 1)
        from_node = (x[:, None] - node * h) / length
        peak = math.sqrt(math.sqrt(4.0 * DECAY / math.pi) * h / length)
        weight = peak * np.exp(-2.0 * DECAY * from_node**2)
        if period is not None:
            node %= round(period / h)
            weight /= math.sqrt(_images(period / length))
        nodes = range(int(node.min()), int(node.max()) + 1)
        row = np.repeat(np.arange(len(x)), node.shape[1])
        entries = (weight.ravel(), (row, node.ravel() - nodes.start))
        return nodes, csr_array(entries, shape=(len(x), len(nodes)))  # entries of one node add up

    def _lattice_spacing(self, period: float | None) -> float:
        length = self.correlation_length
        if period is None:
            return length / NODES_PER_LENGTH
        if length > period:
            raise InputError("correlation_length", length, f"at most the period, {period:.6g} m")
        return period / math.ceil(NODES_PER_LENGTH * period / length)

    def _refuse_too_many(self, x: Array, h: float, reach: int) -> None:
        extent, farthest = float(x.max() - x.min()), float(np.abs(x).max())
        if extent / h + 2 * reach + 2 > MAX_NODES:
            least = extent / h / (MAX_NODES - 2 * reach - 2) * self.correlation_length
            need = f"at least {least:.3g} m on this domain ({MAX_NODES} noise nodes an axis)"
            raise InputError("correlation_length", self.correlation_length, need)
        if farthest / h > MAX_FAR:
            raise InputError("offset", farthest, f"within {MAX_FAR:.3g} x {h:.3g} m: beyond, digits are lost")

    def _scale(self, grid: Grid) -> float:
        return self.rms / self._realised_rms(grid) if self.normalise else 1.0

    def _realised_rms(self, grid: Grid) -> float:
        """Standard deviation (m) of the unscaled field over the domain: Gauss-Legendre with 10 points on each
        panel of at most half a correlation length (error < 1e-12, by halving the panels)."""
        if min(grid.lengths) < self.correlation_length:
            least = f"false, or a side of at least one correlation length, {self.correlation_length:.6g} m"
            raise InputError("normalise", True, least)
        (x, along), (y, across) = (self._panels(length) for length in grid.lengths)
        z = self._field(x, y, grid)
        mean = along @ z @ across
        return math.sqrt(along @ (z - mean) ** 2 @ across)

    def _panels(self, length: float) -> tuple[Array, Array]:
        """Quadrature points (m) and weights, which add up to 1, along one side."""
        panels = math.ceil(2.0 * length / self.correlation_length)
        node, weight = np.polynomial.legendre.leggauss(10)
        points = ((np.arange(panels)[:, None] + (node + 1.0) / 2.0) * (length / panels)).ravel()
        return points, np.tile(weight / (2.0 * panels), panels)

    def describe(self, grid: Grid) -> tuple[str, ...]:
        over = f"over the domain of {_by(grid.lengths)} m" if self.normalise else "in the ensemble"
        said = f"rms {self.rms:.6g} m {over}, correlation length {self.correlation_length:.6g} m"
        return (f"Gaussian roughness of seed {self.seed}: {said}", *self.cautions(grid))

    def cautions(self, grid: Grid) -> tuple[str, ...]:
        if max(grid.spacings) <= self.correlation_length / 4.0:
            return ()
        return (
            f"the element, {max(grid.spacings):.3g} m, exceeds a quarter of the roughness's correlation "
            f"length, {self.correlation_length:.3g} m: its slopes are not resolved",
        )


def _images(ratio: float) -> float:
    """``sum over m of exp(-2.3 (m side / l)^2)``, ratio = side / l >= 1: one axis's variance with images."""
    m = np.arange(1, 6)  # the sixth image would add exp(-2.3 * 36) = 1e-36
    return float(1.0 + 2.0 * np.exp(-DECAY * (m * ratio) ** 2).sum())


def _by(lengths: tuple[float, float]) -> str:
    return " x ".join(f"{length:.6g}" for length in lengths)
