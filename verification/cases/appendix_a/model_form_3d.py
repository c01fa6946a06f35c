"""The whole model against finite elements in three dimensions: one pair of asperities, Coulomb friction.

Absolute values carry half a percent of discretisation error. Relative to a vanishing slope most of that error
is common and goes; what remains of it is read off three meshes.
"""

from __future__ import annotations

import numpy as np

import refimpl as rf
from appendix_a.contact_fem.scene import WavyPair
from appendix_a.contact_fem.sequence import Estimate
from verification.cases import Measured, case, certified
from verification.cases.appendix_a.solid_half_space import (
    BETA,
    COPPER,
    SHARE,
    SLIGHT,
    STEEL,
    by_elements,
    distance_of,
    scene_of,
)

SHIFT, SLOPE = -0.25, 6.5
MESHES, GRIDS = (3, 4, 5), (64, 128, 256)


def pair_of(slope: float) -> WavyPair:
    """Return steel climbing copper at a steepest slope (degrees)."""
    return WavyPair(slope, SHIFT, COPPER, STEEL, beta=BETA)


def by_model(
    slope: float, M: int, *, correction: bool = False, approach: float | None = None
) -> tuple[float, float, float]:
    """Return (approach / amplitude, mu, N / load) of the pair; `approach` / amplitude replaces the load."""
    pair = pair_of(slope)
    distance, load = distance_of(pair), SHARE * pair.full_contact_pressure
    depth = None if approach is None else approach * pair.amplitude - distance
    solved = rf.solve(scene_of(pair, M), grid=M, slope_correction=correction, approach=depth, tolerance=1e-6)
    sunk = (certified(solved, cycled=False).approach + distance) / pair.amplitude
    return sunk, solved.friction_coefficient, solved.normal_force / load


def over_meshes(values: list[float]) -> Estimate:
    """Return the finest mesh's value; refined by 5/4, so first order leaves four times the change."""
    change = float(np.abs(np.diff(values)).max())
    return Estimate(values[-1], change / (MESHES[-1] / MESHES[-2] - 1.0), None)


def differences(
    approach: Estimate, friction: Estimate, *, correction: bool
) -> dict[str, tuple[float, float]]:
    """Return the model against finite elements, and the uncertainty, as fractions of a vanishing slope's."""
    steep, slight = ([by_model(s, M, correction=correction) for M in GRIDS] for s in (SLOPE, SLIGHT))
    sunk = Estimate.of(*(a[0] / b[0] for a, b in zip(steep, slight, strict=True)))
    mu = Estimate.of(*(a[1] / b[1] for a, b in zip(steep, slight, strict=True)))
    asked = [(M, b[0] * approach.value) for M, b in zip(GRIDS, slight, strict=True)]
    load = Estimate.of(*(by_model(SLOPE, M, correction=correction, approach=d)[2] for M, d in asked))
    # an error of the approach moves N by the contact's stiffness, d ln N / d ln approach < 2 (1.8 measured)
    moved = 2.0 * approach.error / approach.value
    return {
        "approach": (sunk.value / approach.value - 1, (sunk.error + approach.error) / approach.value),
        "mu": (mu.value / friction.value - 1, (mu.error + friction.error) / friction.value),
        "normal": (load.value - 1, load.error + moved),
    }


@case("model-form/asperities-3d", metric="at_most", tolerance=2.0, tier="full")
def asperities() -> Measured:
    """Model-form error of a pair of asperities in three dimensions.

    Claim: Steel climbing copper at 6.5 degrees: approach, N and mu are within 2 % of finite elements
    Source: scikit-fem, triquadratic hexahedra, contact on the deformed facets
    Tolerance: percent: the paper's 'less than 2 %' for its coefficients, applied to the results
    """
    steep, slight = ([by_elements(pair_of(slope), n) for n in MESHES] for slope in (SLOPE, SLIGHT))
    quotients = np.array(steep) / np.array(slight)
    approach, friction = over_meshes(quotients[:, 0].tolist()), over_meshes(quotients[:, 1].tolist())
    data: dict[str, object] = {
        "FEM approach / that at 0.1 degrees": [approach.value, approach.error],
        "FEM mu / that at 0.1 degrees": [friction.value, friction.error],
    }
    for name, correction in (("as printed", False), ("slope correction", True)):
        for quantity, (difference, error) in differences(approach, friction, correction=correction).items():
            data[f"{quantity}, {name}"] = [100 * difference, 100 * error]
    printed = [v for k, v in data.items() if k.endswith("as printed")]
    worst = max(abs(v[0]) for v in printed if isinstance(v, list))
    note = "data: percent and its uncertainty; area not judged"
    return Measured(value=worst, unit="%", data=data, note=note)
