"""Loads at which further measurements separate tau from beta, from derivatives at trial loads."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from refimpl.errors import Error
from refimpl.grid import Array
from refimpl.identification.data_table import Row
from refimpl.identification.ensemble import draws, mean_response
from refimpl.identification.forward import COVERAGE, Forward, Response
from refimpl.identification.profile import BOUNDED
from refimpl.scene.scene import Scene

FACTORS = 0.1, 0.3, 3.0, 10.0  # trial loads over the least and the greatest measured load
MAX_BORDER = 0.02  # share of a contact on the domain's border, at most: more is another contact


@dataclass(frozen=True)
class Proposal:
    """Further ``loads`` (N) and the relative half-widths (95 %) of tau and of beta with them."""

    loads: tuple[float, ...]
    widths: tuple[float, float]


def trial_responses(
    scene: Scene, rows: Sequence[Row], forward: Forward, theta: Array
) -> list[tuple[float, Response]]:
    """Return responses at trial loads below and above those measured, where the model is usable."""
    low, high = min(row.load for row in rows), max(row.load for row in rows)
    found = []
    for factor in FACTORS:
        load = factor * (low if factor < 1 else high)
        with suppress(Error):  # a load beyond the hardness, or one whose solve does not converge
            response = mean_response(draws(forward, replace(scene, load=load), theta))
            if response.border <= MAX_BORDER:
                found.append((load, response))
    return found


def propose(
    theta: Array, covariance: Array, trials: Sequence[tuple[float, Response]], relative: float
) -> Proposal | None:
    """Return the one or two trial loads with the least variance of tau; None without trials.

    ``relative`` is the relative standard uncertainty of a further row.
    """
    proposals = []
    for count in (1, 2):
        for chosen in itertools.combinations(trials, count):
            information = np.linalg.inv(covariance)
            for _, response in chosen:
                slopes = np.array(response.slopes)
                measured = relative * response.predict(theta)
                spread = math.hypot(measured, response.numerical / COVERAGE, response.scatter)
                information = information + np.outer(slopes, slopes) / spread**2
            half = COVERAGE * np.sqrt(np.diag(np.linalg.inv(information)))[:BOUNDED]
            tau, beta = (h / t if t > 0 else np.inf for h, t in zip(half, theta[:BOUNDED], strict=True))
            loads = tuple(load for load, _ in chosen)
            proposals.append((half[0], Proposal(loads, (float(tau), float(beta)))))
    return min(proposals, key=lambda item: item[0])[1] if proposals else None
