"""Twins: scenes whose tau and beta are known, with noisy friction.

Surfaces, materials, friction, loads and noise of a twin follow from its seed alone. The friction of a twin is
solved on a grid about 2.7 times finer than the one of the fit, so that the fit has its grid's error as well
as the noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

import refimpl as rf
from refimpl.identification import Row
from refimpl.identification.forward import COVERAGE

KINDS = ("ball", "rough ball", "capped ball", "capped rough ball", "rough planes")
SIDE = 1e-3  # m; the problem is scale-free
FIT_GRID, TRUE_GRID = 48, 128
SHARP_FIT_GRID, SHARP_TRUE_GRID = 192, 512  # the smallest load's contact is a tenth of the largest one's
SHARP_NOISE = 0.005
YIELDING_FIT_GRID, YIELDING_TRUE_GRID = 64, 192
ENSEMBLE_FIT_GRID, ENSEMBLE_TRUE_GRID = 64, 192
ROUGHNESS_TOLERANCE = 0.3  # relative half-width (95 %) of a measured rms height

Log = Callable[[float, float], float]


@dataclass(frozen=True, eq=False)
class Twin:
    """A scene with its true friction, rows with noise, a new load (N) and its true mu; the grid of a fit.

    ``further`` is the true value of a parameter that is fitted too: then the scene's is a first guess.
    """

    kind: str
    scene: rf.Scene
    rows: tuple[Row, ...]
    new_load: float
    new_mu: float
    noise: float
    grid: int
    further: float | None = None


def twin(seed: int) -> Twin:
    """Return the twin of a seed: 3 to 12 loads over a factor of 2 to 40, noise of 0.5 to 5 %."""
    rng = np.random.default_rng([42, seed])
    log = _log_uniform(rng)
    kind = KINDS[seed % len(KINDS)]
    scene = _scene(kind, seed, log)
    count, span, noise = int(rng.integers(3, 13)), log(2, 40), log(0.005, 0.05)
    loads = [float(load) for load in np.geomspace(scene.load / span, scene.load, count)]
    new_load = scene.load * log(1 / span, 1.2)
    rows = _measured(scene, loads, noise, TRUE_GRID, rng)
    return Twin(kind, scene, rows, new_load, true_friction(scene, new_load, TRUE_GRID), noise, FIT_GRID)


def sharp_twin(seed: int) -> Twin:
    """Return a twin whose tau is well determined: a rough ball, 10 to 12 loads over two to three decades.

    Noise is 0.5 %. A/P of a ball falls with the load by a factor of 5 to 10 over such loads.
    """
    rng = np.random.default_rng([43, seed])
    log = _log_uniform(rng)
    kind = ("rough ball", "capped rough ball")[seed % 2]
    lower, upper, modulus = _materials(log)
    R, a = SIDE * log(5, 100), SIDE * log(0.3, 0.38)
    load, pressure = _hertz(modulus, R, a)
    rough = rf.GaussianRoughness(a**2 / R * log(0.005, 0.03), SIDE * log(0.1, 0.3), 2 * seed)
    if kind.startswith("capped"):
        lower = replace(lower, hardness=pressure * log(1.2, 2.0))
    scene = rf.Scene(
        upper=rf.Body(upper, rf.Sphere(R)),
        lower=rf.Body(lower, rough),
        friction=rf.Friction(tau=pressure * log(0.03, 0.3), beta=log(0.02, 0.2)),
        load=load,
        side=SIDE,
    )
    span, count = log(100, 1000), int(rng.integers(10, 13))
    loads = [float(one) for one in np.geomspace(load / span, load, count)]
    new_load = load * log(1 / span, 1.0)
    rows = _measured(scene, loads, SHARP_NOISE, SHARP_TRUE_GRID, rng)
    new_mu = true_friction(scene, new_load, SHARP_TRUE_GRID)
    return Twin(kind, scene, rows, new_load, new_mu, SHARP_NOISE, SHARP_FIT_GRID)


def yielding_twin(seed: int) -> Twin:
    """Return a twin whose hardness is fitted too: a ball, smooth or rough, that yields at its larger loads.

    Seven to twelve loads over a factor of 30 to 200, noise 0.3 to 1 %. The scene's hardness, the first guess
    of a fit, is off by up to 40 %.
    """
    rng = np.random.default_rng([44, seed])
    log = _log_uniform(rng)
    kind = ("yielding ball", "yielding rough ball")[seed % 2]
    lower, upper, modulus = _materials(log)
    R, a = SIDE * log(5, 100), SIDE * log(0.2, 0.25)
    load, pressure = _hertz(modulus, R, a)
    rms, length = a**2 / R * log(0.005, 0.03), SIDE * log(0.1, 0.3)
    rough = rf.GaussianRoughness(rms, length, 2 * seed) if "rough" in kind else rf.Flat()
    hardness = pressure * log(0.6, 1.0)
    scene = rf.Scene(
        upper=rf.Body(upper, rf.Sphere(R)),
        lower=rf.Body(replace(lower, hardness=hardness), rough),
        friction=rf.Friction(tau=pressure * log(0.05, 0.3), beta=log(0.02, 0.2)),
        load=load,
        side=SIDE,
    )
    span, count, noise = log(30, 200), int(rng.integers(7, 13)), log(0.003, 0.01)
    loads = [float(one) for one in np.geomspace(load / span, load, count)]
    new_load = load * log(1 / span, 1.1)
    rows = _measured(scene, loads, noise, YIELDING_TRUE_GRID, rng)
    new_mu = true_friction(scene, new_load, YIELDING_TRUE_GRID)
    guess = hardness * log(0.7, 1.4)
    guessed = replace(scene, lower=rf.Body(replace(lower, hardness=guess), rough))
    return Twin(kind, guessed, rows, new_load, new_mu, noise, YIELDING_FIT_GRID, hardness)


def ensemble_twin(seed: int) -> Twin:
    """Return a twin whose rough ball is known by statistics alone, its rms height within 30 % (95 %).

    Its friction is of one realisation that no fit draws. Eight to twelve loads over a factor of 100 to 300,
    noise 0.5 to 2 %. The logarithm of the scene's rms is off by a normal deviate. A correlation length is six
    elements of the fit or more: of shorter ones contact patches are too small for the grid's error bars.
    """
    rng = np.random.default_rng([45, seed])
    log = _log_uniform(rng)
    lower, upper, modulus = _materials(log)
    R, a = SIDE * log(5, 100), SIDE * log(0.3, 0.35)
    load, pressure = _hertz(modulus, R, a)
    rms, length = a**2 / R * log(0.03, 0.1), SIDE * log(0.1, 0.2)
    scene = rf.Scene(
        upper=rf.Body(upper, rf.Sphere(R)),
        lower=rf.Body(lower, rf.GaussianRoughness(rms, length, 2 * seed)),
        friction=rf.Friction(tau=pressure * log(0.05, 0.3), beta=log(0.02, 0.2)),
        load=load,
        side=SIDE,
    )
    span, count, noise = log(100, 300), int(rng.integers(8, 13)), log(0.005, 0.02)
    loads = [float(one) for one in np.geomspace(load / span, load, count)]
    new_load = load * log(1 / span, 1.1)
    rows = _measured(scene, loads, noise, ENSEMBLE_TRUE_GRID, rng)
    new_mu = true_friction(scene, new_load, ENSEMBLE_TRUE_GRID)
    error = ROUGHNESS_TOLERANCE / COVERAGE * float(rng.standard_normal())
    drawn = rf.GaussianRoughness(rms * math.exp(error), length, 2 * seed + 1)
    stated = replace(scene, lower=rf.Body(lower, drawn))
    return Twin("rough ball, drawn anew", stated, rows, new_load, new_mu, noise, ENSEMBLE_FIT_GRID)


def _log_uniform(rng: np.random.Generator) -> Log:
    return lambda low, high: float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _materials(log: Log) -> tuple[rf.Material, rf.Material, float]:
    """Materials of the lower and the upper body, and E* (Pa)."""
    lower, upper = (rf.Material(E=log(2e9, 400e9), nu=log(0.15, 0.45)) for _ in range(2))
    return lower, upper, 1 / (1 / lower.plane_strain_modulus + 1 / upper.plane_strain_modulus)


def _hertz(modulus: float, R: float, a: float) -> tuple[float, float]:
    """Load (N) and mean pressure (Pa) of a ball whose contact has the radius a (Hertz 1882)."""
    load = 4 * modulus * a**3 / (3 * R)
    return load, load / (math.pi * a**2)


def _scene(kind: str, seed: int, log: Log) -> rf.Scene:
    shape: rf.Surface
    rough: rf.Surface
    lower, upper, modulus = _materials(log)
    if kind == "rough planes":
        length, slope = SIDE * log(0.06, 0.12), log(0.01, 0.05)
        rough = rf.GaussianRoughness(slope * length, length, 2 * seed)
        pressure = 0.3 * modulus * slope
        load, shape = 0.1 * pressure * SIDE**2, rf.Flat()
    else:
        R, a = SIDE * log(5, 100), SIDE * log(0.2, 0.35)
        (load, pressure), shape = _hertz(modulus, R, a), rf.Sphere(R)
        rms = a**2 / R * log(0.02, 0.2) if "rough" in kind else 0.0
        rough = rf.GaussianRoughness(rms, SIDE * log(0.1, 0.3), 2 * seed) if rms else rf.Flat()
    if kind.startswith("capped"):
        lower = replace(lower, hardness=pressure * log(0.8, 2.0))
    friction = rf.Friction(tau=pressure * log(0.01, 0.3), beta=log(0.02, 0.3))
    return rf.Scene(
        upper=rf.Body(upper, shape),
        lower=rf.Body(lower, rough),
        friction=friction,
        load=load,
        side=SIDE,
        periodic=kind == "rough planes",
    )


def _measured(
    scene: rf.Scene, loads: Sequence[float], noise: float, grid: int, rng: np.random.Generator
) -> tuple[Row, ...]:
    """Rows of true friction with normal noise of a relative standard deviation."""
    rows = []
    for load in loads:
        mu = true_friction(scene, load, grid)
        u = noise * mu
        rows.append(Row(load, max(mu + u * float(rng.standard_normal()), 0.0), u))
    return tuple(rows)


def true_friction(scene: rf.Scene, load: float, grid: int) -> float:
    """Return mu on a fine grid. Raises ArithmeticError where the solve does not converge."""
    solution = rf.solve(replace(scene, load=load), grid)
    if not solution.converged:
        raise ArithmeticError(f"the solve at {load:.4g} N ended as {solution.status.value}")
    return float(solution.friction_coefficient)


def blind(scene: rf.Scene) -> rf.Scene:
    """Return the scene without its friction: a fit starts from its own guess."""
    return replace(scene, friction=rf.Friction())
