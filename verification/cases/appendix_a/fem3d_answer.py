"""The three-dimensional answer: from which slope each coefficient is 2 % wrong, and what 'less than 2 %' is.

Read from the shipped table, whose points are in steps of the slope; every row's stated error is below 0.2
percentage points.
"""

from __future__ import annotations

import numpy as np

from appendix_a.fem3d.leading_order import first_order
from appendix_a.fem3d.patch import normal_coefficient
from appendix_a.fem3d.surface import X, Y
from appendix_a.fem3d.table import Series, equivalent_slope, slope_of
from appendix_a.fem3d.wavy import Waviness
from refimpl.grid import Array
from verification.cases import Measured, Verdict, case, judged
from verification.cases.appendix_a.fem3d import FLANK, NU, SOURCE, WAVELENGTH, shipped

COPPER, STEEL = (118e9, 0.3), (200e9, 0.3)
PLACES = {"crest": 0.0, "flank": FLANK, "valley": 0.5}
RATIOS = (0.0, 0.3, 0.45)
FINE = np.arange(0.0, 30.001, 0.05)
GROUPS = {"self": [0], "in line": [1, 2, 3, 4, 5, 6], "across": [7, 8, 9]}
RMS, MAXIMUM = 2.5, 6.5  # degrees: what the paper says of its surfaces
STEEPEST = 8.42  # degrees: the mean of 75 of them, reproduction/largest-slope-full


def errors(place: str, nu: float, slopes: Array, *, pair: bool) -> Array:
    """Return (slopes, 10) at a wavelength of 20 a: one body, or Table 1's copper (lower) under steel."""
    series = Series(WAVELENGTH, PLACES[place], nu)
    return shipped().pair_error(series, slopes, COPPER, STEEL) if pair else shipped().error(series, slopes)


def worst(slope: float, nu: float, group: str, *, pair: bool) -> float:
    """Return the largest unsigned error (percent) of a group of coefficients over crest, flank, valley."""
    found = [errors(place, nu, np.array([slope]), pair=pair)[0, GROUPS[group]] for place in PLACES]
    return 100 * float(np.abs(found).max())


@case("fem3d/less-than-two-percent", metric="at_most", tolerance=2.0, source=SOURCE)
def less_than_two_percent() -> Measured:
    """'The maximum error is less than 2 %': true of what?

    Claim: for Table 1's pair every coefficient is within 2 % up to the paper's largest slope, 6.5 degrees
    Tolerance: percent of the flat coefficient: the paper's own number
    """
    slopes = {
        "max 2.5": RMS,
        "rms 2.5": equivalent_slope(RMS),
        "max 6.5": MAXIMUM,
        "rms 6.5": equivalent_slope(MAXIMUM),
    }
    bodies = {f"one body, nu {nu:g}": (nu, False) for nu in RATIOS} | {"steel on copper": (NU, True)}
    data: dict[str, object] = {"reading of the slope (degrees)": {k: round(v, 2) for k, v in slopes.items()}}
    true: list[str] = []
    false: list[str] = []
    for body, (nu, pair) in bodies.items():
        for group in GROUPS:
            found = [worst(slope, nu, group, pair=pair) for slope in slopes.values()]
            data[f"{body}, {group}"] = found
            for reading, value in zip(slopes, found, strict=True):
                (true if value < 2.0 else false).append(f"{body}, {group}, {reading} ({value:.1f} %)")
    value, steep = (max(worst(s, NU, group, pair=True) for group in GROUPS) for s in (MAXIMUM, STEEPEST))
    data["at the slope that surfaces reach"] = steep
    sentence = (
        f"{value:.2f} % for the paper's pair at its 6.5 degrees, {steep:.2f} % at {STEEPEST:g} degrees, "
        "which surfaces like its roughest one reach (reproduction/largest-slope-full); true of "
        f"{len(true)} of {len(true) + len(false)} readings of slope, bodies and coefficients; false of: "
    )
    return judged(Verdict.CONDITIONAL, sentence + "; ".join(false), value, data=data, unit="%")


@case("fem3d/two-percent", metric="absolute", tolerance=0.5, source=SOURCE)
def two_percent() -> Measured:
    """The slope at which each coefficient is 2 % wrong, in three dimensions.

    Claim: for the next element downhill on a flank, nu 0.3, first-order theory gives that slope
    Tolerance: degrees: second order adds 0.2 of the first at 4 degrees to one neighbour and takes it from the
    other; here the mean of both
    """
    both = slope_of(errors("flank", NU, FINE, pair=False), FINE)
    unit = Waviness(1.0, WAVELENGTH, FLANK)
    error = abs(float((first_order(unit, X, Y, NU) / normal_coefficient(X, Y, NU))[1]))
    expected = float(np.degrees(np.arctan(0.02 / error * np.tan(np.radians(1.0)))))
    mean = 0.5 * (float(both[1] or np.inf) + float(both[4] or np.inf))
    return Measured(mean, expected, unit="degrees", data={"both neighbours (degrees)": [both[1], both[4]]})


@case("fem3d/error-map", metric="at_most", tolerance=0.2)
def error_map() -> Measured:
    """Errors of self and neighbour coefficients over the slope.

    Claim: every tabulated point is known to 0.2 percentage points of the flat coefficient
    Source: three meshes and three outer boundaries each; appendix_a.fem3d.study
    Tolerance: percentage points, as required in three dimensions, a tenth of the paper's 2 %
    """
    slopes = np.arange(0.0, 30.1, 1.0)
    data: dict[str, object] = {"slope (degrees)": slopes}
    shown = {"self": 0, "+x 1": 1, "-x 1": 4, "across 1": 7}
    for place in PLACES:
        for name, pair in (("one body", False), ("pair", True)):
            found = 100 * errors(place, NU, slopes, pair=pair)
            data |= {f"{name}, {place}, {label} (%)": found[:, column] for label, column in shown.items()}
    stated = [value for rows in shipped().uncertainty.values() for value in rows.values()]
    return Measured(100 * max(stated), unit="percentage points", data=data)
