"""Friction where surfaces are known by their statistics: the mean over realisations, and their scatter.

The pair that was measured is one realisation, and none of those drawn. Its friction differs from their mean
by as much as theirs does, and at neighbouring loads by nearly the same share. Few draws give that covariance
poorly: of n draws it has rank n - 1, and weights taken from it lead to intervals that are too short. So the
two uses of the scatter stand apart:

- Rows are weighed by a model of it with one factor (`working_variances`). A poor model widens intervals and
  leaves them right.
- The variance of a fitted parameter is that of the draws' own deviations taken through the fit
  (`deviations`): one number per draw, so Student's t of n - 1 degrees of freedom holds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from refimpl.grid import Array
from refimpl.identification.forward import Forward, Response
from refimpl.scene.scene import Body, Scene
from refimpl.surfaces import SurfaceSum

MIN_REALISATIONS = 3
_SEED_STEP = 1000  # between realisations: far from the seeds of both bodies


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


def draws(
    forward: Forward,
    scene: Scene,
    theta: Array,
    realisations: int,
    tolerances: Mapping[str, float] | None = None,
) -> list[Response]:
    """Return the response of each realisation of a scene at the same parameters."""
    return [forward.respond(redrawn(scene, k), theta, tolerances) for k in range(realisations)]


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
        inputs={
            name: float(np.mean([one.inputs[name] for one in responses])) for name in responses[0].inputs
        },
        scatter=float(np.linalg.norm(deviations(np.array([[one.mu] for one in responses])))),
        solves=sum(one.solves for one in responses),
        warnings=tuple(dict.fromkeys(text for one in responses for text in one.warnings)),
    )


def deviations(mu: Array) -> Array:
    """Return the draws' deviations from their mean, (n, loads), scaled for a pair that is none of them.

    ``mu`` is (n, loads). The sum of squares of a column is the variance of one pair about the mean of n
    draws, ``1 + 1/n`` times the sample variance; one draw has no row.
    """
    n, loads = mu.shape
    if n == 1:
        return np.zeros((0, loads))
    return np.asarray((mu - mu.mean(axis=0)) * np.sqrt((1 + 1 / n) / (n - 1)))


def working_variances(mu: Array, loads: Array) -> Array:
    """Return variances of one pair's friction about the mean of realisations, (loads,), to weigh rows by.

    ``mu`` is (n, loads), loads in N. Contact patches grow in number in proportion to the load (Greenwood
    and Williamson 1966), so the relative standard deviation is modelled as ``P^(-1/2)`` times one factor.
    """
    middle = mu.mean(axis=0)
    relative = np.sum(deviations(mu) ** 2, axis=0) / middle**2
    return np.asarray(np.mean(relative * loads) / loads * middle**2)
