"""Two wavy bodies in sliding contact, plane strain: the model's numbers beside those of finite elements.

`refimpl.solve` on periodic surfaces that are constant along y, and `appendix_a.contact_fem` with the true
boundaries and the deformed geometry. What remains once both are refined is the model-form error.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

import refimpl as rf
from appendix_a.contact_fem import ends
from appendix_a.contact_fem.scene import Material, WavyPair
from appendix_a.contact_fem.sequence import Estimate, Sequence, slide_on_three_meshes
from verification.cases import certified

Numbers = Mapping[str, Estimate]

STEEL, COPPER = Material(200e9, 0.3), Material(118e9, 0.3)
SOFT, STIFF = Material(1e9, 0.0), Material(1e12, 0.0)  # nu = 0 against all but rigid: the strongest coupling
TAU_SHARE = 0.02  # tau / p*: 50 MPa for steel on copper at 2.5 degrees; scaled so that slope alone changes
SLOPES = (0.1, 2.5, 6.5, 15.0)
LOADS = (0.1, 0.3)  # mean pressure / p*: 20 % and 37 % of the length in contact
GRIDS = {0.1: (96, 192, 384), 0.3: (64, 128, 256)}  # by load: about 80 elements in contact on the finest
TOLERANCE = 1e-6  # limit of the model's certificate: a hundredth of the grids' errors
CLIMBING, CREST, DESCENDING = -0.25, 0.0, 0.25  # shift of the upper crest, in wavelengths
VANISHING = 0.02  # degrees
QUANTITIES = ("approach", "friction", "friction_coefficient", "length")
VARIANTS = ("as printed", "slope correction", "flat coefficients, exact interface")


def pair_of(
    lower: Material, upper: Material, beta: float, slope_deg: float, shift: float = CLIMBING
) -> WavyPair:
    """Return the pair at a maximum slope, tau scaled with p*."""
    plain = WavyPair(slope_deg, shift, lower, upper)
    return replace(plain, tau=TAU_SHARE * plain.full_contact_pressure, beta=beta)


@dataclass(frozen=True)
class Modelled:
    """The model's answer on one grid, per unit thickness and wavelength, as `Contact` names it."""

    approach: float
    normal: float
    friction: float
    friction_coefficient: float
    length: float


def scene_of(pair: WavyPair, load: float, M: int) -> rf.Scene:
    """Return the pair on M x M elements, constant along y; `load` per wavelength and thickness."""
    x = (np.arange(M) + 0.5) / M - 0.5
    above, below = (
        rf.Body(rf.Material(body.E, body.nu), np.outer(z, np.ones(M)))
        for body, z in ((pair.upper, pair.upper_height(x)), (pair.lower, pair.lower_height(x)))
    )
    return rf.Scene(above, below, rf.Friction(pair.tau, pair.beta), load, side=1.0, periodic=True)


def modelled(
    pair: WavyPair, load: float, M: int, *, correction: bool, approach: float | None = None
) -> Modelled:
    """Return `refimpl.solve` on the pair; `approach` from first contact replaces the load.

    Whole elements leave the length uncertain by one of them, which tau carries into the friction. Both are
    taken with the ends found between elements (`contact_fem.ends`), which is the limit of fine grids.
    """
    scene, touch = scene_of(pair, load, M), pair.gap_amplitude
    x = (np.arange(M) + 0.5) / M - 0.5
    depth = None if approach is None else approach - touch
    solved = rf.solve(scene, grid=M, slope_correction=correction, approach=depth, tolerance=TOLERANCE)
    solved = certified(solved)
    left, right = ends.contact_ends(x, solved.pressure[:, 0], pair.coupling * pair.beta, 2)
    friction = solved.friction_force + pair.tau * (right - left - solved.contact_area)
    return Modelled(
        solved.approach + touch, solved.normal_force, friction, friction / solved.normal_force, right - left
    )


def by_model(pair: WavyPair, share: float, *, correction: bool) -> Numbers:
    """Return the model's quantities under a load from three grids."""
    load = share * pair.full_contact_pressure
    found = [modelled(pair, load, M, correction=correction) for M in GRIDS[share]]
    return {q: Estimate.of(*(float(getattr(one, q)) for one in found)) for q in QUANTITIES}


def load_at(pair: WavyPair, share: float, approach: float, *, correction: bool) -> Estimate:
    """Return the model's N at a prescribed approach (from first contact)."""
    load = share * pair.full_contact_pressure
    grids = GRIDS[share]
    found = (modelled(pair, load, M, correction=correction, approach=approach).normal for M in grids)
    return Estimate.of(*found)


def by_fem(sequence: Sequence) -> Numbers:
    return {q: sequence.estimate(q) for q in QUANTITIES}


def percent(other: Estimate, fem: Estimate) -> tuple[float, float]:
    """Return the difference to the finite elements and its uncertainty, in percent of their value."""
    return 100 * (other.value / fem.value - 1), 100 * (other.error + fem.error) / abs(fem.value)


def compared(pair: WavyPair, share: float) -> dict[str, tuple[float, float]]:
    """Return percent and uncertainty by 'quantity, variant' for one scene."""
    load = share * pair.full_contact_pressure
    fem = by_fem(slide_on_three_meshes(pair, load))
    found: dict[str, tuple[float, float]] = {}
    for variant in VARIANTS:
        if variant == VARIANTS[2]:
            other = by_fem(slide_on_three_meshes(pair, load, straight=True))
        else:
            correction = variant == VARIANTS[1]
            other = by_model(pair, share, correction=correction)
            given = Estimate(load, 0.0, None)
            at = load_at(pair, share, fem["approach"].value, correction=correction)
            # an error of the approach moves N by the contact's stiffness: d ln N / d ln approach <= 2
            moved = 2.0 * load * fem["approach"].error / fem["approach"].value
            found[f"normal, {variant}"] = percent(replace(at, error=at.error + moved), given)
        found |= {f"{q}, {variant}": percent(other[q], fem[q]) for q in QUANTITIES}
    found |= {f"{q}, FEM": (fem[q].value, fem[q].error) for q in QUANTITIES}
    return found


def over_slopes(
    lower: Material, upper: Material, beta: float, share: float, *, shift: float = CLIMBING
) -> dict[str, object]:
    """Return the series over SLOPES for figures: percent and uncertainty of every quantity and variant."""
    found = [compared(pair_of(lower, upper, beta, slope, shift), share) for slope in SLOPES]
    data: dict[str, object] = {"maximum slope (degrees)": list(SLOPES)}
    for label in found[0]:
        data[label] = [one[label][0] for one in found]
        data[f"{label}, uncertainty"] = [one[label][1] for one in found]
    return data


def worst(data: Mapping[str, object], variant: str, slope: float) -> tuple[float, str]:
    """Return the largest unsigned difference (percent) of a variant at a slope, and its quantity."""
    at = SLOPES.index(slope)
    labels = [label for label in data if label.endswith(variant)]
    values = {label: abs(np.asarray(data[label], dtype=float)[at]) for label in labels}
    label = max(values, key=lambda one: values[one])
    return float(values[label]), label


def verdict(data: Mapping[str, object]) -> str:
    """State in words the worst quantity at each slope, as printed and corrected."""
    parts = []
    for slope in SLOPES[1:]:
        by = (f"{worst(data, v, slope)[0]:.2f} % ({worst(data, v, slope)[1]})" for v in VARIANTS)
        parts.append(f"{slope} degrees: " + ", ".join(by))
    return "; ".join(parts)
