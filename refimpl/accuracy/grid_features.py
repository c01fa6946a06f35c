"""What refinement remembers of a solution on one grid: numbers, edge, peak, and its own error parts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.fft as sfft

from refimpl.accuracy.iteration_error import adhesive_share, edge_excess, iteration_parts, merged
from refimpl.accuracy.peak import LEVEL, Summit, deepest, highest
from refimpl.grid import Array, inner
from refimpl.grid.window import Window
from refimpl.model.friction import Mask
from refimpl.model.slopes import Slopes
from refimpl.solution.solution import REPORTED, Solution


@dataclass(frozen=True)
class GridResult:
    """A solution without its arrays.

    ``numbers`` by the names of `Solution`; ``edge`` is the area (m^2) that whole elements are expected
    to add along the contact's edge, ``alike`` how many of its elements come in and out together by
    symmetry, ``peak`` the pressure's summit (Pa), ``touch`` that of the gap turned over (m), from which
    approaches count, ``unevenness`` how far slopes within elements leave mu open, ``slip`` is
    ``d mu / d A = tau / N`` (1/m^2), ``parts`` are the uncertainties that the grid's own solution states
    (iteration, tau support). ``depth`` (m) is how deep tractions pressed the contact in, ``pull`` what tau on
    all of it does to that, as a share. ``loaded`` tells a prescribed load, which knows no discretisation,
    from a prescribed approach; ``periodic`` is the scene's.
    """

    M: int
    spacing: float
    numbers: Mapping[str, float]
    edge: float
    alike: float
    peak: Summit
    touch: Summit
    unevenness: float
    slip: float
    parts: Mapping[str, Mapping[str, float]]
    depth: float = 0.0
    pull: float = 0.0
    loaded: bool = True
    periodic: bool = False

    @property
    def touching(self) -> bool:
        """Whether anything is in contact."""
        return self.numbers["contact_area"] > 0

    @property
    def edge_share(self) -> float:
        """How much of the contact whole elements add along its edge."""
        area = self.numbers["contact_area"]
        return max(self.edge, 0.0) / area if area > 0 else 1.0

    @property
    def pulled(self) -> float:
        """What tau on that edge does to the depth, as a share of it."""
        return self.pull * min(self.edge_share, 1.0)

    @classmethod
    def of(cls, solution: Solution) -> GridResult:
        """What to keep of a solution. Approaches of periodic scenes count from no touch."""
        problem = solution.problem
        return cls(
            M=solution.grid.M,
            spacing=solution.grid.spacing,
            numbers={name: float(getattr(solution, name)) for name in REPORTED},
            edge=edge_excess(solution),
            alike=alike(solution.contact, periodic=problem.periodic),
            peak=highest(solution.pressure, periodic=problem.periodic),
            touch=LEVEL if problem.periodic else deepest(problem.gap),
            unevenness=unevenness(solution.pressure, solution.slopes, periodic=problem.periodic),
            slip=adhesive_share(solution),
            parts=merged(iteration_parts(solution), _own(solution)),
            depth=depth(solution),
            pull=pull(solution),
            loaded=problem.load is not None,
            periodic=problem.periodic,
        )


def depth(solution: Solution) -> float:
    """How deep tractions pressed the contact in (m): ``approach - h`` of Eq. (6), weighted by pressure."""
    problem, pressure = solution.problem, solution.pressure
    total = float(pressure.sum())
    approach = solution.approach + (float(problem.gap.mean()) if problem.periodic else 0.0)
    return approach - inner(pressure, problem.gap) / total if total > 0 else 0.0


def pull(solution: Solution) -> float:
    """``|c / a| tau A / N``: tau's displacement over the pressure's, where shear reaches the gap."""
    problem = solution.problem
    pair, terms = problem.pair, problem.terms
    if not (terms.coupled or terms.slope_correction):
        return 0.0
    return (
        abs(pair.shear_compliance / pair.normal_compliance) * adhesive_share(solution) * solution.contact_area
    )


def alike(contact: Mask, *, periodic: bool = False) -> float:
    """How many edge elements are one another's images: 8 for a square's symmetries, 1 for none.

    A sum over the mirrorings and turns of the contact's bounding box, each by the share of the edge
    that it leaves as it is. Contact that repeats is mirrored where its rows and columns match best.

    >>> disc = np.hypot(*np.mgrid[-7.5:8, -7.5:8]) < 6
    >>> alike(disc), alike(disc | (np.indices((16, 16)).sum(axis=0) < 4))
    (8.0, 2.0)
    >>> alike(np.roll(disc, (5, 9), (0, 1)), periodic=True)
    8.0
    """
    if not contact.any():
        return 1.0
    rows, columns = np.flatnonzero(contact.any(axis=1)), np.flatnonzero(contact.any(axis=0))
    if periodic:
        box, lines = contact, rows.size + columns.size
    else:
        box = contact[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        lines = sum(box.shape)
    flips = [image[::i, ::j] for image in (box, box.T) for i in (1, -1) for j in (1, -1)]
    if periodic:
        flips = [_matched(box, image) for image in flips]
    edge = sum(_steps(box, axis, periodic) for axis in (0, 1)) + 2 * lines
    misfits = [np.count_nonzero(image != box) for image in flips if image.shape == box.shape]
    return float(sum(max(0.0, 1 - 4 * misfit / edge) for misfit in misfits))


def _steps(contact: Mask, axis: int, periodic: bool) -> int:
    """How often contact begins or ends along an axis."""
    if periodic:
        return int(np.count_nonzero(contact != np.roll(contact, 1, axis)))
    return int(np.count_nonzero(np.diff(contact, axis=axis)))


def _matched(contact: Mask, image: Mask) -> Mask:
    """An image of contact that repeats, moved to where its rows and its columns match the contact's best."""
    shifts = []
    for axis in (1, 0):
        counts, found = (sfft.rfft(np.count_nonzero(m, axis=axis)) for m in (contact, image))
        overlaps = np.rint(sfft.irfft(counts * np.conj(found), len(contact)))
        shifts.append(int(np.argmax(overlaps)))
    moved: Mask = np.roll(image, shifts, (0, 1))
    return moved


def unevenness(pressure: Array, slopes: Slopes, *, periodic: bool = False) -> float:
    """Standard error of mu, or of Q/N, if each element's slope were known to its bend only.

    That is ``sqrt(sum (f s)^2) / sum f`` with ``s^2 = (b_x^2 + b_y^2) / 6`` for a tangent that differs by
    b / 2 from the mean of its neighbours' along x and y; the mean square of both tangents is taken. Where a
    surface is resolved it falls as h^3; where slopes know nothing of their neighbours' it is 1.4 times the
    standard error of their mean.

    >>> bump = Slopes(np.pad([[1.0]], 1), np.zeros((3, 3)))
    >>> round(12 * unevenness(np.pad([[7.0]], 1), bump) ** 2, 9)  # bends of 2 along both
    8.0
    """
    total = float(pressure.sum())
    if slopes.is_flat or not total > 0:
        return 0.0
    tans = [slopes.tan_x, slopes.tan_y]
    if periodic:
        tans, pressure = [np.pad(tan, 1, mode="wrap") for tan in tans], np.pad(pressure, 1)
    box = Window.around(pressure > 0, margin=1).slices
    loads = [pressure[box] * _bend(tan[box], axis) for tan in tans for axis in (0, 1)]
    return math.sqrt(sum(inner(load, load) for load in loads) / 12) / total


def _bend(values: Array, axis: int) -> Array:
    """Second differences, at the border those beside it; zero where there are no three elements."""
    if values.shape[axis] < 3:
        return np.zeros_like(values)
    found = np.empty_like(values)
    z, bend = (values, found) if axis == 0 else (values.T, found.T)
    np.add(z[2:], z[:-2], out=bend[1:-1])
    bend[1:-1] -= 2 * z[1:-1]
    bend[0], bend[-1] = bend[1], bend[-2]
    return found


def _own(solution: Solution) -> dict[str, dict[str, float]]:
    """What the solution states beside its discretisation, which is for the sequence of grids to tell."""
    return {
        name: {part: value for part, value in parts.items() if part != "discretisation"}
        for name, parts in solution.uncertainty.items()
    }
