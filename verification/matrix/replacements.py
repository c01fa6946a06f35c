"""Replacements of parts of `refimpl` by local faults: each is right except for the named fault."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from refimpl.accuracy import iteration_error
from refimpl.accuracy.bayesian_line import Estimate
from refimpl.grid import Array, Grid, Mask, fields
from refimpl.kernels import cerruti, quadrature
from refimpl.model import forces, friction
from refimpl.model.certificate import State
from refimpl.model.friction import FrictionLaw
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.scene.scene import Scene
from refimpl.solution import bounds, influence_error
from refimpl.solution.solution import Solution
from refimpl.solvers import paper, pivoting
from refimpl.surfaces import white_noise
from verification.exact.dense_influence import DenseInfluence

_normal_symbol = vars(PeriodicInfluence)["_normal_symbol"].func
_fft_across, _dense_along = FFTInfluence.shear_across, DenseInfluence._along
_tractions, _problem_slopes = Problem.tractions, Problem.slopes
_active_set_parts, _coefficient_at = iteration_error.active_set_parts, friction.friction_coefficient_at
_iterate, _differences = paper._Scheme._iterate, fields.differences
_complementarity, _scene_sampled = pivoting.complementarity, Scene.sampled
_perimeter, _departure = forces.perimeter_corrected_area, influence_error._departure
_white_noise, _order_for, _bound = white_noise.white_noise, quadrature.order_for, Estimate.error_bound


def mean_displaces(self: PeriodicInfluence) -> Array:
    symbol = np.array(_normal_symbol(self))
    symbol[0, 0] = self.grid.size
    return symbol


def averaged(self: PeriodicInfluence) -> Array:
    q_x, q_y, _ = self._wavevectors
    h_x, h_y = (edge / (2 * np.pi) for edge in self.grid.spacings)
    return np.asarray(_normal_symbol(self) * np.sinc(q_x * h_x) * np.sinc(q_y * h_y))


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


def flat_border(values: Array, axis: int, *, periodic: bool = False) -> Array:
    d = np.array(_differences(values, axis, periodic=periodic))
    edges = np.moveaxis(d, axis, 0)
    if not periodic:
        edges[0] = edges[-1] = 0.0
    return d


def slid_backwards(self: Scene, grid: Grid) -> Any:
    return _scene_sampled(replace(self, sliding_offset=-self.sliding_offset), grid)


def from_first_contact(found: Solution) -> Solution:
    return replace(found, approach=found.approach + found.problem.datum)


def small_dropped(*args: Any) -> Any:
    found = _complementarity(*args)
    kept = found.pressure > 1e-8 * found.pressure.max(initial=0.0)
    return found._replace(pressure=np.where(kept, found.pressure, 0.0), free=found.free & kept)


def never_corrected(self: Any, u: Array, inside: Any, *, on_circle: bool) -> Any:
    return _iterate(self, u, inside, on_circle=True)


def one_grid(problem: Problem) -> list[Problem]:
    return [problem]


def lattice_from_zero(seed: int, rows: range, columns: range) -> Array:
    return _white_noise(seed, range(len(rows)), range(len(columns)))


def uniform(seed: int, rows: range, columns: range) -> Array:
    from scipy.special import ndtr

    return np.asarray(math.sqrt(12) * (ndtr(_white_noise(seed, rows, columns)) - 0.5))


def forward(z: Array, spacing: float | tuple[float, float]) -> tuple[Array, Array]:
    dx, dy = spacing if isinstance(spacing, tuple) else (spacing, spacing)
    return (np.roll(z, -1, axis=0) - z) / dx, (np.roll(z, -1, axis=1) - z) / dy


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


def half_the_perimeter(contact: Mask, grid: Grid) -> float:
    return 0.5 * (_perimeter(contact, grid) + forces.contact_area(contact, grid))


def larger_beta(law: FrictionLaw, mean_pressure: float) -> float:
    return _coefficient_at(law, mean_pressure) + 0.01 * law.slope


def quarter_of_a_bound(self: Estimate, found: float) -> float:
    return _bound(self, found) / 4


def states_alone(problem: Problem, state: State) -> Any:
    lawful = replace(state.certificate, law_violations=0)
    return _active_set_parts(problem, replace(state, certificate=lawful))


def low_departure(*args: Any) -> Any:
    return 0.9 * _departure(*args)
