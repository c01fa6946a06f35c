"""Friction where surfaces are known by their statistics: the mean over realisations, and their scatter.

The pair that was measured is one realisation, and none of those drawn. Its friction differs from their mean
by as much as theirs does, and at neighbouring loads by nearly the same share. Few draws give that covariance
poorly: of n draws it has rank n - 1, and weights taken from it lead to intervals that are too short. So the
two uses of the scatter stand apart:

- Rows are weighed by a model of it with one factor (`working_variances`). A poor model widens intervals and
  leaves them right.
- The variance of a fitted parameter is that of the draws' own deviations taken through the fit (`Scatter`):
  one number per draw, so Student's t of n - 1 degrees of freedom holds.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from refimpl.grid import Array
from refimpl.identification.forward import Forward, Response
from refimpl.scene.scene import Body, Scene

MIN_REALISATIONS = 3
_AVERAGED = "mu", "numerical", "shared", "contact_edge", "contact_fraction"  # fields of a response
_SEED_STEP = 1000  # between realisations: far from the seeds of both bodies


def is_random(scene: Scene) -> bool:
    """Return whether the scene has a random surface."""
    return any(hasattr(part, "seed") for body in (scene.upper, scene.lower) for part in body.surface.parts)


def redrawn(scene: Scene, k: int) -> Scene:
    """Return the scene with the seeds of its random surfaces moved, the k-th realisation."""
    if k == 0:
        return scene

    def drawn(body: Body) -> Body:
        parts: tuple[Any, ...] = body.surface.parts
        return body.with_parts(
            [replace(p, seed=p.seed + k * _SEED_STEP) if hasattr(p, "seed") else p for p in parts]
        )

    return replace(scene, upper=drawn(scene.upper), lower=drawn(scene.lower))


def draws(
    forward: Forward, scene: Scene, theta: Array, tolerances: Mapping[str, float] | None = None
) -> list[Response]:
    """Return the response of each realisation of a scene at the same parameters."""
    return [forward.respond(redrawn(scene, k), theta, tolerances) for k in range(forward.realisations)]


def mean_response(responses: Sequence[Response]) -> Response:
    """Return the response of the mean over realisations at one load; its warnings are those of all."""
    if len(responses) == 1:
        return responses[0]

    n = len(responses)
    means: dict[str, Any] = {
        name: float(np.mean([getattr(one, name) for one in responses])) for name in _AVERAGED
    }
    return replace(
        responses[0],
        **means,
        slopes=tuple(map(float, np.mean([one.slopes for one in responses], axis=0))),
        border=max(one.border for one in responses),
        plastic=max(one.plastic for one in responses),
        pressures=tuple(p for one in responses for p in one.pressures),
        weights=tuple(w / n for one in responses for w in one.weights),
        inputs={
            name: float(np.mean([one.inputs[name] for one in responses])) for name in responses[0].inputs
        },
        scatter=float(np.linalg.norm(scatter([responses]).deviations)),
        solves=sum(one.solves for one in responses),
        warnings=tuple(dict.fromkeys(text for one in responses for text in one.warnings)),
    )


@dataclass(frozen=True, eq=False)
class Scatter:
    """Deviations of n draws from their mean, scaled for a pair that is none of them, linear about ``at``.

    deviations : (n, loads); the sum of squares of a column is the variance of one pair about the mean of n
    draws, ``1 + 1/n`` times the sample variance. One draw has no row
    slopes : (n, loads, parameters), of the deviations by the parameters
    """

    at: Array
    deviations: Array
    slopes: Array

    @property
    def degrees(self) -> float:
        """Degrees of freedom of the variances; infinite without scatter."""
        return len(self.deviations) - 1 if len(self.deviations) else math.inf

    def variance(self, gain: Array, theta: Array) -> Array:
        """Return the covariance (parameters, parameters) of ``gain mu`` at parameters ``theta``."""
        moved = (self.deviations + self.slopes @ (theta - self.at)) @ gain.T
        return np.asarray(moved.T @ moved)


def scatter(drawn: Sequence[Sequence[Response]]) -> Scatter:
    """Return the scatter of the responses of n draws at each load, in the order of `draws`."""
    mu = np.array([[one.mu for one in row] for row in drawn]).T
    slopes = np.array([[one.slopes for one in row] for row in drawn]).transpose(1, 0, 2)
    n = len(mu)
    scale = math.sqrt((1 + 1 / n) / (n - 1)) if n > 1 else 0.0
    rows = n if n > 1 else 0
    return Scatter(
        np.array(drawn[0][0].at),
        scale * (mu - mu.mean(axis=0))[:rows],
        scale * (slopes - slopes.mean(axis=0))[:rows],
    )


def working_variances(drawn: Sequence[Sequence[Response]], loads: Array) -> Array:
    """Return variances of one pair's friction about the mean of realisations, (loads,), to weigh rows by.

    The relative scatter of ``d mu / d tau``, the area over the load, bounds that of mu from above and does
    not change with the fitted tau. Contact patches grow in number in proportion to the load (Greenwood and
    Williamson 1966), so its standard deviation is modelled as ``P^(-1/2)`` times one factor.
    """
    found = scatter(drawn)
    area = np.array([np.mean([one.slopes[0] for one in row]) for row in drawn])
    mu = np.array([np.mean([one.mu for one in row]) for row in drawn])
    relative = np.sum(found.slopes[:, :, 0] ** 2, axis=0) / area**2
    return np.asarray(np.mean(relative * loads) / loads * mu**2)
