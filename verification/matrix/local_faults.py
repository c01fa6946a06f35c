"""Faults in one part of `refimpl` each, beside those of `verification.faults` that go through every solve.

Most of them leave most results untouched: they show what only a few checks, or a single one, can see.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from refimpl import coefficient_error, discretisation, forces, gathered, paper, slopes, summit
from refimpl.contact import active_set, bounds, certificate, energy_norm
from refimpl.estimate import Estimate
from refimpl.grid import Array, Grid
from refimpl.kernels import cerruti, far_field, points, tables
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.outcome import Status
from refimpl.problem import Problem
from refimpl.scene import Scene
from refimpl.slopes import Slopes
from refimpl.surfaces import gaussian, noise, statistics
from refimpl.surfaces.gaussian import GaussianRoughness
from verification.faults import Patch
from verification.matrix.patches import LocalFault, everywhere, wrapped


def _method(owner: type, name: str, wrong: Any) -> Iterator[Patch]:
    yield owner, name, wrong


_normal_symbol = vars(PeriodicInfluence)["_normal_symbol"].func
_fft_across, _dense_along = FFTInfluence.shear_across, DenseInfluence._along
_tractions, _problem_slopes = Problem.tractions, Problem.slopes
_iterate, _gathered, _difference = paper._Scheme._iterate, gathered.gathered, slopes._difference
_complementarity, _scene_heights = active_set.complementarity, Scene.heights
_perimeter, _departure = forces.perimeter_corrected_area, coefficient_error._departure
_white_noise, _order_for, _bar = noise.white_noise, far_field.order_for, Estimate.bar


def _mean_displaces(self: PeriodicInfluence) -> Array:
    symbol = np.array(_normal_symbol(self))
    symbol[0, 0] = self.grid.side
    return symbol


def _averaged(self: PeriodicInfluence) -> Array:
    q_x, q_y, _ = self._wavevectors
    h = self.grid.spacing / (2 * np.pi)
    return np.asarray(_normal_symbol(self) * np.sinc(q_x * h) * np.sinc(q_y * h))


def _nyquist_kept(self: PeriodicInfluence, angle: float) -> Any:
    q_x, q_y, squared = self._wavevectors
    return np.complex128(-2j * np.pi) * (math.cos(angle) * q_x + math.sin(angle) * q_y) / squared


def _across_reversed(self: DenseInfluence, angle: float) -> Array:
    return -_dense_along(self, angle) if angle != self.direction else _dense_along(self, angle)


def _facet_across_reversed(self: Problem, *args: Any) -> Any:
    down, along, across = _tractions(self, *args)
    return down, along, None if across is None else -across


def _lower_surface_only(self: Problem, lower: Array, upper: Array) -> Slopes:
    return _problem_slopes(self, 2 * lower, np.zeros_like(upper))


def _flat_border(heights: Array, axis: int, periodic: bool) -> Array:
    d = np.array(_difference(heights, axis, periodic))
    edges = np.moveaxis(d, axis, 0)
    if not periodic:
        edges[0] = edges[-1] = 0.0
    return d


def _slid_backwards(self: Scene, grid: Grid) -> Any:
    return _scene_heights(replace(self, sliding_offset=-self.sliding_offset), grid)


def _from_first_touch(posed: Problem, *args: Any) -> Any:
    found = _gathered(posed, *args)
    return replace(found, approach=found.approach + float(posed.gap.mean())) if posed.periodic else found


def _small_dropped(*args: Any) -> Any:
    found = _complementarity(*args)
    kept = found.pressure > 1e-8 * found.pressure.max(initial=0.0)
    return found._replace(pressure=np.where(kept, found.pressure, 0.0), active=found.active & kept)


def _never_corrected(self: Any, u: Array, inside: Any, *, periodic: bool) -> Any:
    return _iterate(self, u, inside, periodic=True)


def _one_grid(posed: Problem) -> list[Problem]:
    return [posed]


def _lattice_from_zero(seed: int, rows: range, columns: range) -> Array:
    return _white_noise(seed, range(len(rows)), range(len(columns)))


def _uniform(seed: int, rows: range, columns: range) -> Array:
    from scipy.special import ndtr

    return np.asarray(math.sqrt(12) * (ndtr(_white_noise(seed, rows, columns)) - 0.5))


def _forward(z: Array, spacing: float) -> tuple[Array, Array]:
    return (np.roll(z, -1, axis=0) - z) / spacing, (np.roll(z, -1, axis=1) - z) / spacing


def _quartered(found: bounds.Bounds) -> bounds.Bounds:
    numbers = ("energy", "pressure", "pressure_l2", "approach", "normal_force", "friction_force")
    return replace(found, **{name: getattr(found, name) / 4 for name in numbers})


def _apart_everywhere(x: Array, y: Array, dx: float, dy: float) -> Array:
    """Cerruti's closed form without the one for x < a/2: it cancels there."""
    half = dx / 2
    far, near = x + half, np.abs(x - half)
    below, above = y - dy / 2, y + dy / 2
    logs = cerruti._weighted_log(above, x, dx) - cerruti._weighted_log(below, x, dx)
    return np.asarray(logs + far * cerruti.over_x(far, y, dy) - near * cerruti.over_x(near, y, dy))


def _fewer_points(q: float) -> int:
    return max(2, _order_for(q) - 1)


def _literal(value: Any) -> property:
    return property(lambda self: value(self))


_CANCELLING = cerruti.CERRUTI._replace(closed_form=_apart_everywhere)

IN_REFIMPL: dict[str, LocalFault] = {
    "kernel-quadrature": (
        "one Gauss point too few far from the load",
        lambda: everywhere(_order_for, _fewer_points),
    ),
    "kernel-cancels": (
        "Cerruti's closed form cancels close to x = 0",
        lambda: ((points, "CERRUTI", _CANCELLING), (tables, "CERRUTI", _CANCELLING)),
    ),
    "periodic-mean": (
        "a mean pressure displaces the periodic half-space",
        lambda: _method(PeriodicInfluence, "_normal_symbol", _literal(_mean_displaces)),
    ),
    "periodic-averaged": (
        "periodic symbol of pressures constant on elements",
        lambda: _method(PeriodicInfluence, "_normal_symbol", _literal(_averaged)),
    ),
    "periodic-nyquist": (
        "sine at the Nyquist frequency of an even periodic grid",
        lambda: _method(PeriodicInfluence, "_tangential_symbol", _nyquist_kept),
    ),
    "periodic-datum": (
        "periodic approach counted from first touch",
        lambda: everywhere(_gathered, _from_first_touch),
    ),
    "across-sign": (
        "shear across the sliding direction with the other sign, in both operators",
        lambda: (
            (FFTInfluence, "shear_across", lambda self, t: -_fft_across(self, t)),
            (DenseInfluence, "_along", _across_reversed),
        ),
    ),
    "facet-across": (
        "slope correction's traction across with the other sign",
        lambda: _method(Problem, "tractions", _facet_across_reversed),
    ),
    "common-surface": (
        "slopes of the deformed lower surface's own displacement, not of the common surface",
        lambda: _method(Problem, "slopes", _lower_surface_only),
    ),
    "border-slopes": ("slopes zero at the border", lambda: ((slopes, "_difference", _flat_border),)),
    "slide-sign": ("the lower surface slides backwards", lambda: _method(Scene, "heights", _slid_backwards)),
    "small-pressures-dropped": (
        "the dense reference drops pressures below 1e-8 of the peak",
        lambda: everywhere(_complementarity, _small_dropped),
    ),
    "perimeter": (
        "the perimeter's correction halved",
        lambda: everywhere(
            forces.perimeter_corrected_area,
            lambda contact, spacing, *, periodic=False: (
                0.5 * _perimeter(contact, spacing, periodic=periodic) + 0.5 * contact.sum() * spacing**2
            ),
        ),
    ),
    "facet-forces": (
        "the facets' friction force times 0.999",
        lambda: wrapped(forces.facet_resultants, lambda f: f._replace(friction=0.999 * f.friction)),
    ),
    "eq-10": (
        "beta 1 % too large in Eq. (10)",
        lambda: everywhere(
            forces.smooth_friction_coefficient, lambda tau, beta, pressure: tau / pressure + 1.01 * beta
        ),
    ),
    "plasticity-index": (
        "2.0 in place of 2.2 in Eq. (12)",
        lambda: wrapped(forces.plasticity_index, lambda x: x / 1.1),
    ),
    "decay": ("ln 10 in place of 2.3 in Eq. (9)", lambda: ((gaussian, "DECAY", math.log(10)),)),
    "noise-lattice": (
        "three noise nodes per correlation length",
        lambda: ((gaussian, "NODES_PER_LENGTH", 3),),
    ),
    "noise-origin": (
        "noise numbered from the grid's corner",
        lambda: ((gaussian, "white_noise", _lattice_from_zero),),
    ),
    "noise-uniform": ("uniform noise of the same variance", lambda: ((gaussian, "white_noise", _uniform),)),
    "not-normalised": (
        "normalise=True ignored",
        lambda: _method(GaussianRoughness, "_scale", lambda self, side, period: 1.0),
    ),
    "forward-slopes": (
        "forward differences in the statistics",
        lambda: everywhere(statistics.slopes, _forward),
    ),
    "skewness-sign": ("skewness with the other sign", lambda: wrapped(statistics.skewness, lambda x: -x)),
    "gap-ignored": (
        "the certificate's complementarity gap is always 0",
        lambda: ((certificate, "relative_gap", lambda duality, energy: 0.0),),
    ),
    "always-converged": (
        "status CONVERGED whatever the certificate says",
        lambda: ((gathered, "_final_status", lambda *a: Status.CONVERGED),),
    ),
    "bounds-quartered": ("proven bounds divided by four", lambda: wrapped(bounds.proven_bounds, _quartered)),
    "least-eigenvalue": (
        "the least eigenvalue 2 % too large",
        lambda: ((energy_norm, "SMALLEST_SYMBOL", 1.02 * energy_norm.SMALLEST_SYMBOL),),
    ),
    "never-corrected": (
        "the paper's scheme without its residual correction",
        lambda: _method(paper._Scheme, "_iterate", _never_corrected),
    ),
    "no-nesting": ("the paper's scheme without coarser grids", lambda: ((paper, "_refinements", _one_grid),)),
    "bars-quartered": (
        "error bars divided by four",
        lambda: _method(Estimate, "bar", lambda self, found: _bar(self, found) / 4),
    ),
    "touch-of-elements": (
        "approaches counted from the highest elements",
        lambda: everywhere(summit.deepest, lambda field: summit.LEVEL),
    ),
    "edge-not-expected": (
        "error bars that know of no edge's excess",
        lambda: ((discretisation, "EDGE_SIZE", 0.0),),
    ),
    "error-table": (
        "Appendix A's table read 10 % too low",
        lambda: ((coefficient_error, "_departure", lambda *args: 0.9 * _departure(*args)),),
    ),
}
