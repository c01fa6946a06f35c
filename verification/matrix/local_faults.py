"""Faults in one part of `refimpl` each, beside those of `faults` that go through every solve.

Most of them leave most results untouched: they show what only a few checks, or a single one, can see.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from refimpl.accuracy import discretisation_error, iteration_error, peak
from refimpl.accuracy.bayesian_line import Estimate
from refimpl.grid import fields
from refimpl.kernels import points, quadrature, tables
from refimpl.model import certificate, forces, friction
from refimpl.model.problem import Problem
from refimpl.model.state import Status
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.scene.scene import Scene
from refimpl.sensitivities.budget import Budget
from refimpl.solution import bounds, energy_norm, influence_error, solution
from refimpl.solution.solved import Solved
from refimpl.solvers import paper, pivoting
from refimpl.surfaces import gaussian, noise_lattice, statistics
from refimpl.surfaces.gaussian import GaussianRoughness
from verification.exact.dense_influence import DenseInfluence
from verification.matrix import replacements as wrong
from verification.matrix.faults import Patch
from verification.matrix.patches import LocalFault, everywhere, wrapped


def _method(owner: type, name: str, replacement: Any) -> Iterator[Patch]:
    yield owner, name, replacement


IN_REFIMPL: dict[str, LocalFault] = {
    "kernel-quadrature": (
        "one Gauss point too few far from the load",
        lambda: everywhere(quadrature.order_for, wrong.fewer_points),
    ),
    "kernel-cancels": (
        "Cerruti's closed form cancels close to x = 0",
        lambda: ((points, "CERRUTI", wrong.CANCELLING), (tables, "CERRUTI", wrong.CANCELLING)),
    ),
    "periodic-mean": (
        "a mean pressure displaces the periodic half-space",
        lambda: _method(PeriodicInfluence, "_normal_symbol", wrong.literal(wrong.mean_displaces)),
    ),
    "periodic-averaged": (
        "periodic symbol of pressures constant on elements",
        lambda: _method(PeriodicInfluence, "_normal_symbol", wrong.literal(wrong.averaged)),
    ),
    "periodic-nyquist": (
        "sine at the Nyquist frequency of an even periodic grid",
        lambda: _method(PeriodicInfluence, "_tangential_symbol", wrong.nyquist_kept),
    ),
    "periodic-datum": (
        "periodic approach counted from first contact",
        lambda: wrapped(solution.assemble, wrong.from_first_contact),
    ),
    "across-sign": (
        "shear across the sliding direction with the other sign, in both operators",
        lambda: (
            (FFTInfluence, "shear_across", wrong.fft_across_reversed),
            (DenseInfluence, "_along", wrong.across_reversed),
        ),
    ),
    "facet-across": (
        "slope correction's traction across with the other sign",
        lambda: _method(Problem, "tractions", wrong.facet_across_reversed),
    ),
    "common-surface": (
        "slopes of the deformed lower surface's own displacement, not of the common surface",
        lambda: _method(Problem, "slopes", wrong.lower_surface_only),
    ),
    "border-slopes": ("slopes zero at the border", lambda: everywhere(fields.differences, wrong.flat_border)),
    "slide-sign": (
        "the lower surface slides backwards",
        lambda: _method(Scene, "sampled", wrong.slid_backwards),
    ),
    "small-pressures-dropped": (
        "the dense reference drops pressures below 1e-8 of the peak",
        lambda: everywhere(pivoting.complementarity, wrong.small_dropped),
    ),
    "perimeter": (
        "the perimeter's correction halved",
        lambda: everywhere(forces.perimeter_corrected_area, wrong.half_the_perimeter),
    ),
    "facet-forces": (
        "the facets' friction force times 0.999",
        lambda: wrapped(forces.facet_resultants, lambda f: f._replace(friction=0.999 * f.friction)),
    ),
    "eq-10": (
        "beta 1 % too large in Eq. (10)",
        lambda: everywhere(friction.friction_coefficient_at, wrong.larger_beta),
    ),
    "plasticity-index": (
        "2.0 in place of 2.2 in Eq. (12)",
        lambda: wrapped(forces.plasticity_index, lambda x: x / 1.1),
    ),
    "decay": (
        "ln 10 in place of 2.3 in Eq. (9)",
        lambda: tuple((module, "DECAY", math.log(10)) for module in (gaussian, noise_lattice)),
    ),
    "noise-lattice": (
        "three noise nodes per correlation length",
        lambda: ((noise_lattice, "NODES_PER_LENGTH", 3),),
    ),
    "noise-origin": (
        "noise numbered from the grid's corner",
        lambda: ((noise_lattice, "white_noise", wrong.lattice_from_zero),),
    ),
    "noise-uniform": (
        "uniform noise of the same variance",
        lambda: ((noise_lattice, "white_noise", wrong.uniform),),
    ),
    "not-normalised": (
        "normalise=True ignored",
        lambda: _method(GaussianRoughness, "_scale", lambda self, grid: 1.0),
    ),
    "forward-slopes": (
        "forward differences in the statistics",
        lambda: everywhere(statistics.slopes, wrong.forward),
    ),
    "skewness-sign": ("skewness with the other sign", lambda: wrapped(statistics.skewness, lambda x: -x)),
    "gap-ignored": (
        "the certificate's complementarity gap is always 0",
        lambda: ((certificate, "relative_gap", lambda duality, energy: 0.0),),
    ),
    "always-converged": (
        "status CONVERGED whatever the certificate says",
        lambda: _method(Solved, "status", property(lambda self: Status.CONVERGED)),
    ),
    "bounds-quartered": (
        "proven bounds divided by four",
        lambda: wrapped(bounds.proven_bounds, wrong.quartered),
    ),
    "least-eigenvalue": (
        "the least eigenvalue 2 % too large",
        lambda: wrapped(energy_norm.smallest_symbol, lambda x: 1.02 * x),
    ),
    "never-corrected": (
        "the paper's scheme without its residual correction",
        lambda: _method(paper._Scheme, "_iterate", wrong.never_corrected),
    ),
    "no-nesting": (
        "the paper's scheme without coarser grids",
        lambda: ((paper, "_refinements", wrong.one_grid),),
    ),
    "bars-quartered": (
        "error bars divided by four",
        lambda: _method(Estimate, "error_bound", wrong.quarter_of_a_bound),
    ),
    "tau-bar": (
        "the error bar of tau's active set contains a cycle's states alone",
        lambda: everywhere(iteration_error.active_set_parts, wrong.states_alone),
    ),
    "touch-of-elements": (
        "approaches counted from the highest elements",
        lambda: everywhere(peak.deepest, lambda field: peak.NO_PEAK),
    ),
    "edge-not-expected": (
        "error bars that know of no edge's excess",
        lambda: ((discretisation_error, "EDGE_SIZE", 0.0),),
    ),
    "coupling-gone": (
        "derivatives without the coupling that cancels in the scene itself",
        lambda: (
            (
                import_module("refimpl.sensitivities.sensitivity"),
                "_terms",
                lambda solution: solution.problem.terms,
            ),
        ),
    ),
    "inputs-added": (
        "tolerances of inputs added as they are, not in squares",
        lambda: _method(Budget, "input", property(lambda budget: sum(budget.inputs.values()))),
    ),
    "error-table": (
        "Appendix A's table read 10 % too low",
        lambda: ((influence_error, "_departure", wrong.low_departure),),
    ),
}
