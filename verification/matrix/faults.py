"""Faults to inject into `refimpl`: checks that stay silent with one of them check nothing.

A fault replaces functions while its context lasts, in every module that uses them. ``seen_by`` names a check
that must fail meanwhile: an invariant of `verification.properties`, a manufactured state, or a comparison of
both solvers.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Collection, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import Any
from unittest import mock

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array, fields
from refimpl.kernels import normal_integral, tangential_integral
from refimpl.model import certificate, forces
from refimpl.model.friction import Friction
from refimpl.model.materials import Material, Pair
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators import dense, fft, kernel_tables
from refimpl.operators.fft import FFTInfluence
from refimpl.scene import discretise
from refimpl.solvers.production import constants

Patch = tuple[Any, str, Any]
"""Owner, name, replacement."""


@dataclass(frozen=True)
class Fault:
    """What is wrong within `injected`, and the check that must see it."""

    what: str
    patches: tuple[Patch, ...]
    seen_by: str

    @contextmanager
    def injected(self) -> Iterator[None]:
        """`refimpl` has the fault within this context; coefficients are tabulated anew."""
        with ExitStack() as stack:
            stack.enter_context(mock.patch.dict(kernel_tables._cache, clear=True))
            for owner, name, wrong in self.patches:
                stack.enter_context(mock.patch.object(owner, name, wrong))
            yield


def _scaled(function: Callable[..., Any], factor: float) -> Callable[..., Any]:
    return lambda *args, **kwargs: factor * function(*args, **kwargs)


def _tables_of(kind: str, factor: float) -> Patch:
    right = kernel_tables._TABLES[kind]
    wrong = {**kernel_tables._TABLES, kind: lambda n, m, dx, dy, known: factor * right(n, m, dx, dy)}
    return kernel_tables, "_TABLES", wrong


def everywhere(right: Any, wrong: Any, packages: Collection[str] = ("refimpl",)) -> tuple[Patch, ...]:
    """Patches of every module of those packages that holds this function by now, under whatever name."""
    holders = [
        module
        for name, module in sorted(sys.modules.items())
        if module is not None and name.partition(".")[0] in packages
    ]
    return tuple(
        (module, key, wrong) for module in holders for key, value in vars(module).items() if value is right
    )


def _circle_off_by_one(n: int, lowest: int, highest: int) -> NDArray[np.int_]:
    """The farthest positive offset falls on the far side of the circle."""
    steps = np.arange(n)
    return np.where(steps < highest, steps, steps - n)


def _periodic_images(self: FFTInfluence) -> Any:
    """Padding left out: the circle is the domain, and offsets beyond its half are those of an image."""
    circles = zip(_offsets(self), self.grid.shape, strict=True)
    return tuple(circle - n * np.rint(circle / n).astype(int) for circle, n in circles)


def _discretised(change: Callable[[Array], Array]) -> tuple[Patch, ...]:
    def wrong(*args: Any, **kwargs: Any) -> Problem:
        right = _discretise(*args, **kwargs)
        return replace(right, gap=change(right.gap), mean_surface=change(right.mean_surface))

    return everywhere(_discretise, wrong)


def _law(tau_on: Callable[[NDArray[np.bool_]], Any]) -> tuple[Patch, ...]:
    """Patches of the friction law: tau where a function of the active set says."""
    return (
        (Friction, "traction", lambda law, f, active: law.tau * tau_on(active) + law.beta * f),
        (Friction, "held_traction", lambda law, f, active: law.tau * tau_on(active).astype(np.float64)),
    )


def _resultants(change: Callable[[forces.Forces], forces.Forces]) -> tuple[Patch, ...]:
    return everywhere(_right_resultants, lambda *args: change(_right_resultants(*args)))


def _in_single_precision(self: FFTInfluence, source: Array, hat: Any) -> Array:
    return _convolve(self, source, hat).astype(np.float32).astype(np.float64)


def _forward_differences(values: Array, axis: int, *, periodic: bool = False) -> Array:
    """Forward differences in place of central ones; they wrap around at the border."""
    return np.roll(values, -1, axis) - values


def _weights_of_other_sign(self: Problem, at: Slopes, held_traction: Array) -> tuple[Array, float]:
    weights, offset = _load_weights(self, at, held_traction)
    return 2 * at.cos_x * at.cos_y - weights, -offset


def _certified_blindly(*args: Any) -> Any:
    """Whatever the state is, its certificate says that it is exact."""
    state = _certify(*args)
    clean = certificate.Certificate(0.0, 0.0, 0.0, 0.0, 0.0, 0)
    return replace(state, certificate=clean)


_discretise, _right_resultants, _certify = discretise.discretise, forces.resultants, certificate.certify
_load_weights, _convolve = Problem.load_weights, FFTInfluence._convolve
_offsets: Callable[[FFTInfluence], Any] = vars(FFTInfluence)["_offsets"].func
_negative_shear = property(lambda m: -(1 + m.nu) * (1 - 2 * m.nu) / (2 * math.pi * m.E))
_shear_added = property(lambda pair: pair.lower.shear_compliance + pair.upper.shear_compliance)
_lower_body_only = property(lambda pair: pair.lower.normal_compliance)
_young_for_plane_strain = property(lambda m: 1 / (math.pi * m.E))
_ones = property(lambda at: np.ones_like(at.tan_x))
_only_cos_x = property(lambda at: at.cos_x)

FAULTS = {
    "shear-sign": Fault(
        "c with the other sign in both bodies",
        ((Material, "shear_compliance", _negative_shear),),
        "manufactured-friction",
    ),
    "shear-added": Fault(
        "c of the bodies added in the pair",
        ((Pair, "shear_compliance", _shear_added),),
        "cross-check",
    ),
    "cosine-dropped": Fault(
        "cos theta_y left out of Eq. (6)",
        ((Slopes, "obliqueness", _only_cos_x),),
        "manufactured-oblique",
    ),
    "cosine-dropped-in-forces": Fault(
        "cos theta_y left out of Eqs (2), (3)", ((Slopes, "cos_y", _ones),), "load_balance"
    ),
    "normal-kernel": Fault(
        "a times 1 + 1e-6 in both solvers",
        (
            _tables_of("normal", 1 + 1e-6),
            (dense, "normal_integral", _scaled(normal_integral, 1 + 1e-6)),
        ),
        "manufactured-friction",
    ),
    "normal-kernel-fft": Fault(
        "a times 1 + 1e-6 in the FFT", (_tables_of("normal", 1 + 1e-6),), "cross-check"
    ),
    "shear-kernel": Fault(
        "c times 1 + 1e-6 in both solvers",
        (
            _tables_of("tangential", 1 + 1e-6),
            (dense, "tangential_integral", _scaled(tangential_integral, 1 + 1e-6)),
        ),
        "manufactured-friction",
    ),
    "padding": Fault("one padding row too few", ((fft, "_circle", _circle_off_by_one),), "displacements"),
    "periodic": Fault(
        "periodic images instead of a free half-space",
        ((FFTInfluence, "_offsets", property(_periodic_images)), (fft, "_is_even", lambda circle: False)),
        "displacements",
    ),
    "tau-missing": Fault(
        "friction without tau",
        _law(np.zeros_like),
        "local_friction_law",
    ),
    "tau-everywhere": Fault(
        "tau outside the contact as well",
        _law(np.ones_like),
        "local_friction_law",
    ),
    "transposed": Fault("x and y exchanged in the gap", _discretised(lambda z: z.T.copy()), "displacements"),
    "half-element": Fault(
        "heights half an element off",
        _discretised(lambda z: 0.5 * (z + np.roll(z, 1, axis=0))),
        "displacements",
    ),
    "modulus": Fault(
        "E in place of E / (1 - nu^2)",
        ((Material, "normal_compliance", _young_for_plane_strain),),
        "displacements",
    ),
    "one-body": Fault(
        "the upper body taken as rigid in a",
        ((Pair, "normal_compliance", _lower_body_only),),
        "displacements",
    ),
    "force-scale": Fault(
        "N, F and Q times 1 + 1e-6",
        _resultants(lambda f: forces.Forces(*((1 + 1e-6) * x for x in f))),
        "load_balance",
    ),
    "friction-sign": Fault(
        "F against the sliding direction",
        _resultants(lambda f: f._replace(friction=-f.friction)),
        "load_balance",
    ),
    "binormal-sign": Fault(
        "Q with the other sign", _resultants(lambda f: f._replace(binormal=-f.binormal)), "load_balance"
    ),
    "differences": Fault(
        "forward differences for slopes",
        everywhere(fields.differences, _forward_differences),
        "complementarity",
    ),
    "load-weights": Fault(
        "r sin theta_x added to N in the balance",
        ((Problem, "load_weights", _weights_of_other_sign),),
        "load_balance",
    ),
    "single-precision": Fault(
        "convolution in single precision", ((FFTInfluence, "_convolve", _in_single_precision),), "cross-check"
    ),
    "stuck": Fault(
        "three CG steps and a certificate that is always clean",
        ((constants, "CG_LIMIT", 3), *everywhere(_certify, _certified_blindly)),
        "complementarity",
    ),
}
