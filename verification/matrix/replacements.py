"""What local faults put in place of parts of `refimpl`: each one right but for what its name says."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from refimpl.accuracy.bayesian_line import Estimate
from refimpl.grid import Array, Grid
from refimpl.kernels import cerruti, quadrature
from refimpl.model import forces, slopes
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.scene.scene import Scene
from refimpl.solution import bounds, gathered, influence_error
from refimpl.solvers import paper, pivoting
from refimpl.surfaces import white_noise

_normal_symbol = vars(PeriodicInfluence)["_normal_symbol"].func
_fft_across, _dense_along = FFTInfluence.shear_across, DenseInfluence._along
_tractions, _problem_slopes = Problem.tractions, Problem.slopes
_spread_by_support = gathered._spread_by_support
_iterate, _gathered, _difference = paper._Scheme._iterate, gathered.gathered, slopes._difference
_complementarity, _scene_sampled = pivoting.complementarity, Scene.sampled
_perimeter, _departure = forces.perimeter_corrected_area, influence_error._departure
_white_noise, _order_for, _bar = white_noise.white_noise, quadrature.order_for, Estimate.bar


def mean_displaces(self: PeriodicInfluence) -> Array:
    symbol = np.array(_normal_symbol(self))
    symbol[0, 0] = self.grid.side
    return symbol


def averaged(self: PeriodicInfluence) -> Array:
    q_x, q_y, _ = self._wavevectors
    h = self.grid.spacing / (2 * np.pi)
    return np.asarray(_normal_symbol(self) * np.sinc(q_x * h) * np.sinc(q_y * h))


def nyquist_kept(self: PeriodicInfluence, angle: float) -> Any:
    q_x, q_y, squared = self._wavevectors
    return np.complex128(-2j * np.pi) * (math.cos(angle) * q_x + math.sin(angle) * q_y) / squared


def across_reversed(self: DenseInfluence, angle: float) -> Array:
    return -_dense_along(self, angle) if angle != self.direction else _dense_along(self, angle)


def facet_across_reversed(self: Problem, *args: Any) -> Any:
    down, along, across = _tractions(self, *args)
    return down, along, None if across is None else -across


def lower_surface_only(self: Problem, lower: Array, upper: Array) -> Slopes:
    return _problem_slopes(self, 2 * lower, np.zeros_like(upper))


def flat_border(heights: Array, axis: int, periodic: bool) -> Array:
    d = np.array(_difference(heights, axis, periodic))
    edges = np.moveaxis(d, axis, 0)
    if not periodic:
        edges[0] = edges[-1] = 0.0
    return d


def slid_backwards(self: Scene, grid: Grid) -> Any:
    return _scene_sampled(replace(self, sliding_offset=-self.sliding_offset), grid)


def from_first_touch(posed: Problem, *args: Any) -> Any:
    found = _gathered(posed, *args)
    return replace(found, approach=found.approach + float(posed.gap.mean())) if posed.periodic else found


def small_dropped(*args: Any) -> Any:
    found = _complementarity(*args)
    kept = found.pressure > 1e-8 * found.pressure.max(initial=0.0)
    return found._replace(pressure=np.where(kept, found.pressure, 0.0), active=found.active & kept)


def never_corrected(self: Any, u: Array, inside: Any, *, periodic: bool) -> Any:
    return _iterate(self, u, inside, periodic=True)


def one_grid(posed: Problem) -> list[Problem]:
    return [posed]


def lattice_from_zero(seed: int, rows: range, columns: range) -> Array:
    return _white_noise(seed, range(len(rows)), range(len(columns)))


def uniform(seed: int, rows: range, columns: range) -> Array:
    from scipy.special import ndtr

    return np.asarray(math.sqrt(12) * (ndtr(_white_noise(seed, rows, columns)) - 0.5))


def forward(z: Array, spacing: float) -> tuple[Array, Array]:
    return (np.roll(z, -1, axis=0) - z) / spacing, (np.roll(z, -1, axis=1) - z) / spacing


def quartered(found: bounds.Bounds) -> bounds.Bounds:
    numbers = ("energy", "pressure", "pressure_l2", "approach", "normal_force", "friction_force")
    return replace(found, **{name: getattr(found, name) / 4 for name in numbers})


def apart_everywhere(x: Array, y: Array, dx: float, dy: float) -> Array:
    """Cerruti's closed form without the one for x < a/2: it cancels there."""
    half = dx / 2
    far, near = x + half, np.abs(x - half)
    below, above = y - dy / 2, y + dy / 2
    logs = cerruti._weighted_log(above, x, dx) - cerruti._weighted_log(below, x, dx)
    return np.asarray(logs + far * cerruti.over_x(far, y, dy) - near * cerruti.over_x(near, y, dy))


def fewer_points(q: float) -> int:
    return max(2, _order_for(q) - 1)


def literal(value: Any) -> property:
    return property(lambda self: value(self))


CANCELLING = cerruti.CERRUTI._replace(closed_form=apart_everywhere)


def fft_across_reversed(self: FFTInfluence, traction: Array) -> Array:
    return -_fft_across(self, traction)


def half_the_perimeter(contact: Any, spacing: float, *, periodic: bool = False) -> float:
    corrected = _perimeter(contact, spacing, periodic=periodic)
    return 0.5 * (corrected + float(contact.sum()) * spacing**2)


def quarter_of_a_bar(self: Estimate, found: float) -> float:
    return _bar(self, found) / 4


def states_alone(outcome: Any, found: Any, unlawful: float, load: float) -> Any:
    return _spread_by_support(outcome, found, 0.0, load)


def low_departure(*args: Any) -> Any:
    return 0.9 * _departure(*args)
