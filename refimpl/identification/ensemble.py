"""Friction where surfaces are known by their statistics: the mean over realisations, and their scatter.

The pair that was measured is one realisation, and none of those drawn. Its friction differs from their mean
by as much as theirs does, at neighbouring loads by nearly the same. So the data scatter about the mean with
the covariance of the realisations, ``1 + 1/n`` times as large since the mean is one of n draws.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.stats import t as student

from refimpl.grid import Array
from refimpl.identification.forward import COVERAGE, Forward, Response
from refimpl.scene.scene import Body, Scene
from refimpl.surfaces import SurfaceSum

MIN_REALISATIONS = 3
_SEED_STEP = 1000  # between realisations: far from the seeds of both bodies
_CORRELATED = 0.7  # share of the sampled correlation of loads that is kept: few draws overstate it


def is_random(scene: Scene) -> bool:
    """Return whether the scene has a random surface."""
    return any(hasattr(part, "seed") for body in (scene.upper, scene.lower) for part in body.surface.parts)


def redrawn(scene: Scene, k: int) -> Scene:
    """Return the scene with the seeds of its random surfaces moved, the k-th realisation."""
    if k == 0:
        return scene
    bodies: dict[str, Any] = {}
    for name in ("upper", "lower"):
        body = getattr(scene, name)
        parts: tuple[Any, ...] = tuple(
            replace(part, seed=part.seed + k * _SEED_STEP) if hasattr(part, "seed") else part
            for part in body.surface.parts
        )
        bodies[name] = Body(body.material, parts[0] if len(parts) == 1 else SurfaceSum(parts))
    return replace(scene, **bodies)


def draws(forward: Forward, scene: Scene, theta: Array, realisations: int) -> list[Response]:
    """Return the response of each realisation of a scene at the same parameters."""
    return [forward.respond(redrawn(scene, k), theta) for k in range(realisations)]


def mean_response(responses: Sequence[Response]) -> Response:
    """Return the response of the mean over realisations at one load; its warnings are those of all."""
    if len(responses) == 1:
        return responses[0]

    def mean(name: str) -> float:
        return float(np.mean([getattr(one, name) for one in responses]))

    n = len(responses)
    return replace(
        responses[0],
        mu=mean("mu"),
        slopes=tuple(map(float, np.mean([one.slopes for one in responses], axis=0))),
        numerical=mean("numerical"),
        contact_edge=mean("contact_edge"),
        area_per_load=mean("area_per_load"),
        border=max(one.border for one in responses),
        plastic=max(one.plastic for one in responses),
        pressures=tuple(p for one in responses for p in one.pressures),
        weights=tuple(w / n for one in responses for w in one.weights),
        scatter=float(np.sqrt(scatter(np.array([[one.mu] for one in responses]))[0, 0])),
        solves=sum(one.solves for one in responses),
        warnings=tuple(dict.fromkeys(text for one in responses for text in one.warnings)),
    )


def scatter(mu: Array) -> Array:
    """Return the covariance of one pair's friction about the mean of realisations; ``mu`` is (n, loads).

    Its standard deviations are those that, taken 1.96 times, cover what n draws leave open (Student's t).
    Each load's relative variance is the mean of its own and of all loads': n draws scatter.
    """
    n, loads = mu.shape
    if n == 1:
        return np.zeros((loads, loads))
    covariance = np.atleast_2d(np.cov(mu.T))
    middle, own = mu.mean(axis=0), np.diag(covariance)
    correlation = covariance / np.sqrt(np.outer(own, own))
    relative = own / middle**2
    deviation = middle * np.sqrt(0.5 * (relative + relative.mean()))
    deviation *= np.sqrt(1 + 1 / n) * student.ppf(0.975, n - 1) / COVERAGE
    kept = _CORRELATED * correlation + (1 - _CORRELATED) * np.eye(loads)
    return np.asarray(np.outer(deviation, deviation) * kept)
