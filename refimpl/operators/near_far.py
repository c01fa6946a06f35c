"""Products by near and far parts of the kernels: two small circles instead of one of twice the window.

A pressure acts on a window through ``K = I[1/rho]``, which reaches from end to end, so one circle holds twice
the window (`refimpl.operators.fft`). Ewald (1921, Ann. Phys. 369, 253) splits such a kernel by a bell ``b``
that vanishes beyond a radius R:

    1/r = Phi(r)/r + (1 - Phi(r))/r,    Phi(r) = integral of b from 0 to r, 1 from R on.

Near part. The second term vanishes beyond R. Its circle holds the window and R elements.

Far part. With ``B`` the transform of the bell, that of the first term is
``4 integral_q^inf B(k) / (k sqrt(k^2 - q^2)) dk``: it ends where ``B`` ends. The bell of Kaiser and Bessel,
``I0(beta sqrt(1 - (s/R)^2))``, has all of B below ``beta / R`` but for ``exp(-beta)`` of its peak. With no
shorter waves, the far part needs points only every four elements. ``R = 8 beta / pi`` ends the band at half
the highest frequency of that grid. The far part's mean over an element is its product with two sines in
frequency; they go into the filter below.

Shear. For ``s/rho^2``, the gradient of a logarithm, Gauss's law in the plane does the same: ``s Psi(r)/r^2``,
``Psi(r)`` the mass within r of a plane bell ``sinh(beta sqrt(1 - (s/R)^2))``. ``Psi`` is elementary.

Between the grids. An element's pressure goes to the 12 x 12 coarse points about it, weighted by a window
``w(x) w(y)``, and displacements come back by the same weights: the product stays symmetric. In frequency this
multiplies by ``w^(q)^2`` twice, once along each axis. The coarse kernel is divided by that, with a filter of
49 terms along each axis that is one over it in the band, and anything beyond. What the coarse grid cannot
tell from the band, its images from 3/2 of the highest frequency on, enters by ``w^`` there over ``w^`` in
the band, which is ``exp(-2 pi 6 sqrt(1 - 1/2))`` for the best window of this width (Barnett, Magland and af
Klinteberg 2019, SIAM J. Sci. Comput. 41, C479). Weights of 8 cells form a dense matrix of 32 x 19: their
products take a tenth of the time.

Error. Of the largest displacement by random pressures, 12 points leave 5e-12, 11 leave 3e-11, 13 leave 1e-12.
The bell leaves 4e-13 of that by one element's pressure, 8e-12 of that by its shear. `ERROR` bounds them (a
test) over what tractions of these sizes and one sign displace. White noise of both signs hardly displaces
anything: over that the error of its shear is 4e-11. beta and the width are the least for `ERROR`, which is a
hundredth of `TOLERANCE`, from which a solve may use these products. Its certificate is by the whole kernel.

Cost. For n elements per side the circles have ``n + 56`` and ``n / 2 + 22`` points per side instead of 2 n:
a product takes 0.75 of the time for 256, 0.55 for 512, 0.48 for 1024.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from refimpl.grid import Array, Grid, Shape, Window
from refimpl.grid.window import padded_length
from refimpl.operators.coarse_grid import CoarseGrid
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.split_kernels import REACH, WIDTH, far_quarter, near_quarter, window
from refimpl.operators.transforms import fourier, threads

Quarter = Callable[[str, Shape], Array]
"""A kernel at the offsets from 0 to half of each circle, in elements of edge one."""

ERROR = 1e-11  # share of the largest displacement, at most (a test)
TOLERANCE = 1e-9  # least tolerance of a solve that such products serve
_LEAST = 240  # elements per side of a window from which they are quicker


def is_quicker(grid: Grid, window: Window, tolerance: float) -> bool:
    """Return whether near and far parts serve a window's products, and are quicker than the whole kernel."""
    return tolerance >= TOLERANCE and grid.aspect == 1 and min(window.shape) >= _LEAST


class NearFarInfluence(FFTInfluence):
    """Products on a window of square elements, to 1e-11 of the largest displacement."""

    def __init__(
        self, grid: Grid, direction: float, *, source: Window | None = None, counter: Counter | None = None
    ) -> None:
        super().__init__(grid, direction, source=source, counter=counter)
        self._coarse = CoarseGrid.under(self.source.shape, window, 1 - WIDTH // 2, WIDTH - 1)
        (n, m), (rows, columns) = self.source.shape, self._coarse.shape
        near = padded_length(n + REACH), padded_length(m + REACH)
        far = padded_length(2 * rows), padded_length(2 * columns)
        self._near = _Part(self, "near", self.source, near, near_quarter)
        self._far = _Part(self, "far", Window.full(self._coarse.shape), far, far_quarter)

    @property
    def symbol(self) -> Array:
        """See `FFTInfluence`: every second frequency is that of the kernel laid twice around half of it."""
        points = math.prod(self.circle)
        self.counter.add("normal kernel", points // 2)
        table = self._quarter("normal")
        table = table[:-1] + table[:0:-1]
        table = table[:, :-1] + table[:, :0:-1]
        return fourier.plane(table, self.circle, threads(points)).real

    def normal(self, pressure: Array) -> Array:
        return self._sum(pressure, self._near.normal, self._far.normal)

    def shear(self, traction: Array) -> Array:
        return self._sum(traction, self._near.shear, self._far.shear)

    def shear_across(self, traction: Array) -> Array:
        return self._sum(traction, self._near.shear_across, self._far.shear_across)

    def coupled(self, ratio: float) -> Callable[[Array], Array]:
        near, far = self._near.coupled(ratio), self._far.coupled(ratio)
        return lambda pressure: self._sum(pressure, near, far)

    def _sum(self, source: Array, near: Callable[[Array], Array], far: Callable[[Array], Array]) -> Array:
        found = near(source)
        found += self._coarse.interpolate(far(self._coarse.spread(source)), source.shape)
        return found


class _Part(FFTInfluence):
    """One part of the kernels on a circle that holds all offsets that count, and their opposites."""

    _is_even = _is_odd = True

    def __init__(
        self, whole: FFTInfluence, name: str, window: Window, padded: tuple[int, int], quarter: Quarter
    ) -> None:
        counter = _PartCounter(whole.counter, name)
        super().__init__(whole.grid, whole.direction, source=window, counter=counter, padded=padded)
        self._of_part = quarter

    def _unit_quarter(self, kind: str, shape: Shape, aspect: float) -> Array:
        return self._of_part(kind, shape)


class _PartCounter(Counter):
    """Counts for another counter, under a part's name."""

    def __init__(self, whole: Counter, name: str) -> None:
        super().__init__()
        self._whole, self._name = whole, name

    def add(self, what: str, points: int) -> None:
        self._whole.add(f"{self._name} {what}", points)
