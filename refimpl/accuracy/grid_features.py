"""Features of a state on one grid for error bars: numbers, contact edge, peaks, the grid's own parts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from refimpl.accuracy.constants import constant, table
from refimpl.accuracy.contact_edge import NO_FACES, edge_faces, rim_faces, wall_pressure
from refimpl.accuracy.iteration_error import CORRECTED, merged, reported_numbers
from refimpl.accuracy.peak import NO_PEAK, Peak, deepest, highest, on_crest
from refimpl.grid import Array, Grid, inner, second_differences
from refimpl.grid.straight_edges import NO_STRAIGHT_EDGES, StraightEdges, straight_edges
from refimpl.grid.symmetry import symmetry_multiplicity
from refimpl.model.certificate import State
from refimpl.model.forces import perimeter_corrected_area
from refimpl.model.friction import friction_per_area
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes

EXCESS = np.array([*table("face_excess").ravel(), constant("straight_excess"), constant("border_excess")])
"""Elements by which a counted area exceeds, of each of `GridFeatures.excess_terms`."""
_LEVELS = 16  # pressures in `highest_areas`
_TROUGH_ERROR = constant("trough_error")
_WALL_RIVAL = constant("wall_rival")  # share of the maximum, from which a wall's pressure may exceed it


@dataclass(frozen=True)
class GridFeatures:
    """Features of a state on one grid.

    grid : its shape and lengths
    numbers : the reported numbers by name
    edge : area that whole elements are expected to add along the contact's edge (m^2)
    symmetry_multiplicity : how many edge elements come in and out together by symmetry
    peak : of the pressure (Pa)
    first_contact : peak of the gap turned over (m), from which approaches count
    slope_sampling_error : error of mu by slopes within elements
    slope_line_error : the like of elements in phase along straight walls and crests
    dmu_dA : ``tau / N`` (1/m^2)
    parts : uncertainties that the grid's own solution states (iteration, active set, neglected terms)
    faces : of the contact's edge by kind (`contact_edge`)
    rim_faces : number of them just before elements at the hardness
    depth : how far tractions pressed the contact in (m)
    shear_to_normal_ratio : ``|c / a| tau A / N``: tau's displacement over the pressure's; of a law that is
        not linear all shear's
    plastic_edge : the like along the edge of the elements at the hardness (m^2)
    straight : edges of the contact along the grid
    plastic_straight : the like of the elements at the hardness
    border_fraction : share of the contact's elements that lie on a free border
    rms_slope : root mean square slope, weighted by pressure
    slope_displacement_error : how far differenced slopes leave displacements along the vertical open (m)
    highest_areas : contact area (m^2) of at least k/16 of the maximum pressure, k = 0 to 16
    waviness : sum of the pressure's second differences along an axis over that of the pressure
    undecided : area within the contact whose pressure a wave between the elements may take to zero (m^2)
    hardness : Pa, None without one
    unfilled : contact area less that which carries its pressure at the hardness (m^2), None without a cap
    loaded : whether the load is prescribed, which then has no discretisation error, or the approach
    mean_gap : of the deformed surfaces over the domain (m)
    hidden_gap : the like where the pressure's troughs between elements reach zero (m)
    """

    grid: Grid
    numbers: Mapping[str, float]
    edge: float
    symmetry_multiplicity: float
    peak: Peak
    first_contact: Peak
    slope_sampling_error: float
    dmu_dA: float
    parts: Mapping[str, Mapping[str, float]]
    slope_line_error: float = 0.0
    faces: tuple[float, ...] = NO_FACES
    rim_faces: int = 0
    depth: float = 0.0
    shear_to_normal_ratio: float = 0.0
    plastic_edge: float = 0.0
    straight: StraightEdges = NO_STRAIGHT_EDGES
    plastic_straight: StraightEdges = NO_STRAIGHT_EDGES
    border_fraction: float = 0.0
    rms_slope: float = 0.0
    slope_displacement_error: float = 0.0
    highest_areas: tuple[float, ...] = ()
    waviness: float = 0.0
    undecided: float = 0.0
    hardness: float | None = None
    unfilled: float | None = None
    loaded: bool = True
    mean_gap: float = 0.0
    hidden_gap: float = 0.0

    @property
    def touching(self) -> bool:
        """True if anything is in contact."""
        return self.numbers["contact_area"] > 0

    @property
    def yields(self) -> bool:
        """True if the maximum pressure is the hardness, and known."""
        return self.numbers.get("plastic_area", 0.0) > 0

    @property
    def missed_share(self) -> float:
        """Share of the rms gradient in waves that the grid does not hold."""
        area = self.numbers["contact_area"]
        return self.parts.get("contact_area", {}).get("short waves", 0.0) / area if area > 0 else 0.0

    @property
    def edge_fraction(self) -> float:
        """Share of the contact area that whole elements add along its edge."""
        area = self.numbers["contact_area"]
        return max(self.edge, 0.0) / area if area > 0 else 1.0

    @property
    def excess(self) -> float:
        """Mean excess of the counted contact area along its edge (m^2), which may be negative.

        Under a cap it is at most `unfilled`: the load needs the rest of the area.
        """
        if not self.touching:
            return 0.0
        found = float(EXCESS @ self.excess_terms) * self.grid.element_area
        return found if self.unfilled is None else min(found, self.unfilled)

    @property
    def excess_terms(self) -> Array:
        """Faces by kind, faces beyond the second of a run along an axis, elements at a free border."""
        area = self.numbers["contact_area"]
        border = self.border_fraction * area * (1 - area / self.grid.nominal_area) / self.grid.element_area
        return np.array([*self.faces, self.straight.faces, border])

    @property
    def corrected(self) -> dict[str, float]:
        """The contact area without its mean excess along its edge, and friction without tau on that."""
        mu, force = self.numbers["friction_coefficient"], self.numbers["friction_force"]
        share = self.dmu_dA * self.excess
        return {
            "contact_area_corrected": self.numbers["contact_area"] - self.excess,
            "friction_coefficient_corrected": mu - share,
            "friction_force_corrected": force - share * self.numbers["normal_force"],
        }

    @property
    def shear_by_edge(self) -> float:
        """Change of the depth by tau on that edge, as a share of it."""
        return self.shear_to_normal_ratio * min(self.edge_fraction, 1.0)

    @classmethod
    def of(cls, problem: Problem, state: State, *stated: Mapping[str, Mapping[str, float]]) -> GridFeatures:
        """Return the features of a state; ``stated`` are the error parts of its own grid."""
        grid, per_area = problem.grid, friction_per_area(problem.friction, state.forces.normal)
        by_tau = per_area * state.contact_area
        sheared = by_tau if problem.friction.is_linear else abs(state.friction_coefficient)
        parts, total = merged(*stated), float(state.pressure.sum()) * grid.element_area
        slopes_apart, slopes_in_phase = slope_sampling_error(state.pressure, state.slopes, grid)
        features = cls(
            grid=grid,
            numbers=reported_numbers(problem, state),
            edge=state.contact_area - state.contact_area_corrected,
            faces=edge_faces(state.pressure, state.clearance, grid),
            rim_faces=rim_faces(state.pressure, state.plastic, grid),
            symmetry_multiplicity=symmetry_multiplicity(state.contact, grid),
            peak=pressure_peak(problem, state),
            first_contact=first_contact(problem),
            slope_sampling_error=slopes_apart,
            slope_line_error=slopes_in_phase,
            dmu_dA=per_area,
            parts=parts | {name: parts[raw] for name, raw in CORRECTED.items() if raw in parts},
            depth=depth(problem, state),
            shear_to_normal_ratio=abs(problem.elasticity.coupling_ratio) * sheared,
            plastic_edge=state.plastic_area - perimeter_corrected_area(state.plastic, grid),
            straight=straight_edges(state.contact, grid),
            plastic_straight=straight_edges(state.plastic, grid),
            border_fraction=grid.on_border(state.contact) / max(int(state.contact.sum()), 1),
            rms_slope=math.sqrt(state.slopes.mean_square(state.pressure)),
            slope_displacement_error=slope_displacement_error(problem, state),
            highest_areas=highest_areas(state.pressure, grid),
            waviness=waviness(state.pressure, grid),
            undecided=undecided_area(state.pressure, grid),
            hardness=problem.pair.softer_hardness,
            unfilled=None if math.isinf(problem.cap) else state.contact_area - total / problem.cap,
            loaded=problem.load is not None,
            mean_gap=float(state.clearance.mean()),
            hidden_gap=hidden_gap(problem, state),
        )
        return replace(features, numbers=dict(features.numbers) | features.corrected)


def pressure_peak(problem: Problem, state: State) -> Peak:
    """Return the pressure's peak: not smooth on a sharp crest, nor where a wall's pressure may exceed it."""
    pressure, grid = state.pressure, problem.grid
    peak = highest(pressure, grid)
    walls = wall_pressure(pressure, state.clearance, grid) >= _WALL_RIVAL * state.max_pressure > 0
    return replace(peak, smooth=peak.smooth and not walls and not on_crest(pressure, problem.gap, grid))


def first_contact(problem: Problem) -> Peak:
    """Return the peak of the gap turned over; `NO_PEAK` where approaches do not count from there."""
    if not problem.counts_from_first_contact:
        return NO_PEAK
    height = problem.gap.max() - problem.gap
    sharp = on_crest(height, problem.gap, problem.grid, share=1.0)
    return replace(deepest(problem.gap), smooth=not sharp)


def depth(problem: Problem, state: State) -> float:
    """Return ``approach - h`` of Eq. (6), weighted by pressure (m)."""
    total = float(state.pressure.sum())
    return state.approach - inner(state.pressure, problem.gap) / total if total > 0 else 0.0


def highest_areas(pressure: Array, grid: Grid) -> tuple[float, ...]:
    """Return the contact area (m^2) whose pressure is at least k/16 of the maximum, for k from 0 to 16.

    >>> highest_areas(np.array([[0.0, 1.0], [4.0, 3.9]]), Grid.square(2.0, 2))[::4]
    (3.0, 3.0, 2.0, 2.0, 1.0)
    """
    loaded = np.sort(pressure[pressure > 0])
    if not loaded.size:
        return ()
    levels = loaded[-1] * np.arange(_LEVELS + 1) / _LEVELS
    return tuple(float(n) * grid.element_area for n in loaded.size - np.searchsorted(loaded, levels))


def waviness(pressure: Array, grid: Grid) -> float:
    """Return ``sum |second differences| / sum f`` of the contact along the axis where it is more.

    It falls as h^2 where waves of the pressure are resolved, and is 2 of single elements.

    >>> waviness(np.pad([[2.0]], 2), Grid.square(1.0, 5)), waviness(np.ones((4, 4)), Grid.square(1.0, 4))
    (2.0, 0.0)
    """
    total = float(pressure.sum())
    if not 0 < total < math.inf:
        return 0.0
    box = grid.window_around(pressure > 0, margin=1).slices
    bends = (second_differences(pressure[box], axis, periodic=grid.periodic) for axis in (0, 1))
    return max(float(np.abs(bend[pressure[box] > 0]).sum()) for bend in bends) / total


def undecided_area(pressure: Array, grid: Grid) -> float:
    """Return the area (m^2) of elements amid the contact with a pressure below half its second difference.

    Beside such an element the pressure may reach zero, and a finer grid may open a gap.

    >>> pressure = 1.0 - np.cos(np.pi * np.arange(8) / 4 + 0.1)[:, None] * np.ones(8)
    >>> undecided_area(pressure, Grid.square(8.0, 8, periodic=True))
    16.0
    """
    return float(_undecided(pressure, grid).shape[1]) * grid.element_area


def hidden_gap(problem: Problem, state: State) -> float:
    """Return the mean gap (m) of elements amid the contact where the pressure's trough reaches zero.

    The pressure missing in the trough of a parabola opens one element against its neighbours.
    """
    grid, pressure = problem.grid, state.pressure
    here, *near = _undecided(pressure, grid)
    lacking = -here
    for ahead, back in (near[:2], near[2:]):
        bend = np.maximum(ahead + back - 2 * here, 0)
        rise = np.minimum(np.abs(ahead - back), bend)
        gain = rise * np.divide(rise, 8 * bend, out=np.zeros_like(bend), where=bend > 0)
        lacking = lacking + _TROUGH_ERROR * bend + gain
    opened = float(np.maximum(lacking, 0).sum()) / pressure.size
    return problem.elasticity.element_compliance(grid) * opened


def _undecided(pressure: Array, grid: Grid) -> Array:
    """Return the pressures ``(5, n)`` of elements of `undecided_area` and their neighbours along x and y."""
    p = grid.padded(pressure[grid.window_around(pressure > 0, margin=1).slices], 1)
    five = p[1:-1, 1:-1], p[2:, 1:-1], p[:-2, 1:-1], p[1:-1, 2:], p[1:-1, :-2]
    amid = np.logical_and.reduce([field > 0 for field in five])
    found = amid & (6 * five[0] < sum(five[1:]))
    return np.array([field[found] for field in five])


def slope_displacement_error(problem: Problem, state: State) -> float:
    """Return how far differenced slopes leave ``u / (cos theta_x cos theta_y)`` open, but for a factor (m).

    It is a sixth of the product of three root mean squares by pressure: of u, of the tangents and of their
    second differences. Central differences of a wave q lack the share ``(q h)^2 / 6`` of its tangent, and the
    second differences of a tangent are ``(q h)^2`` of it.
    """
    pressure, slopes = state.pressure, state.slopes
    total = float(pressure.sum())
    if slopes.is_flat or not 0 < total < math.inf:
        return 0.0
    tangents = slopes.tan_x, slopes.tan_y
    periodic = problem.grid.periodic
    bends = [second_differences(tan, axis, periodic=periodic) for tan in tangents for axis in (0, 1)]
    squares = (
        sum(inner(pressure * field, field) for field in fields) / total
        for fields in (tangents, bends, [state.approach - problem.gap])
    )
    return math.prod(map(math.sqrt, squares)) / 6


def slope_sampling_error(pressure: Array, slopes: Slopes, grid: Grid) -> tuple[float, float]:
    """Return the standard error of mu, or of Q/N, if slopes within elements vary as much as between them.

    That is ``sqrt(sum (f s)^2) / sum f`` with ``s^2 = (b_x^2 + b_y^2) / 6``, for a tangent that differs by b
    / 2 from the mean of its neighbours along x and y; the mean square of both tangents is taken. Where a
    surface is resolved it falls as h^3. Where slopes are uncorrelated between elements it is 1.4 times the
    standard error of their mean. The second number is of errors that add before they are squared, as along a
    straight wall or crest, where all elements meet the surface in the same phase (`_in_phase`).

    >>> bump = Slopes(np.pad([[1.0]], 1), np.zeros((3, 3)))
    >>> found = slope_sampling_error(np.pad([[7.0]], 1), bump, Grid.square(1.0, 3))
    >>> [round(12 * error**2, 9) for error in found]  # bends of 2
    [8.0, 8.0]
    """
    total = float(pressure.sum())
    if slopes.is_flat or not total > 0:
        return 0.0, 0.0
    box = grid.window_around(pressure > 0, margin=1).slices
    loads = [
        pressure[box] * second_differences(tan[box], axis, periodic=grid.periodic)
        for tan in (slopes.tan_x, slopes.tan_y)
        for axis in (0, 1)
    ]
    apart = sum(inner(load, load) for load in loads)
    together = float(np.max(sum(_in_phase(load) for load in loads)))
    return math.sqrt(apart / 12) / total, math.sqrt(together / 12) / total


def _in_phase(load: Array) -> Array:
    """Return squared sums along lines of each axis and diagonal, by the squared share of equal loads.

    >>> _in_phase(np.eye(3))  # rows, columns and one diagonal hold one load a line, the other all three
    array([3., 3., 3., 9.])
    """
    found = []
    for lines in (load.T, load, _sheared(load), _sheared(load[:, ::-1])):
        sums, equal = lines.sum(axis=0), np.count_nonzero(lines, axis=0) * (lines**2).sum(axis=0)
        share = np.divide(sums**2, equal, out=np.zeros_like(sums), where=equal > 0)
        found.append(float(np.sum(sums**2 * share**2)))
    return np.array(found)


def _sheared(field: Array) -> Array:
    """Return a field (m, n) with row i moved by i, (m, m + n - 1): columns are diagonals of equal i + j."""
    rows, columns = field.shape
    return np.pad(field, ((0, 0), (0, rows))).ravel()[:-rows].reshape(rows, rows + columns - 1)
