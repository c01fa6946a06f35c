"""Predictions of published experiments: the committed comparison, computed again."""

from __future__ import annotations

from verification.cases import Measured, family
from verification.experiments.comparison import Point
from verification.experiments.predictions import points
from verification.framework.case import Disproved
from verification.output.result_files import committed

SAME = 1e-3
"""Largest change of a committed number over U_val: a prediction of the same inputs, not of others."""


@family(
    "name, title, claim, tolerance, tolerance_reason",
    {
        "validation/tungsten": (
            "tungsten", "Diamond tip on tungsten: approach before the first yield",
            "Increments of the approach of five indentations, with the radius fitted to six others, lie "
            "within U_val",
            1.0, "largest |E| / U_val"),
        "validation/rubber": (
            "rubber", "Glass tip on silicone rubber: approach, with nothing fitted",
            "Increments of the approach lie within U_val, their ratio does not: the model, which has no "
            "adhesion, misses it by 18 %",
            5.6, "recorded: largest |E| / U_val, that of the ratio, rounded up"),
        "validation/film": (
            "film", "Balls on films of molybdenum disulphide: friction over load",
            "The exponent of mu over the load lies within U_val",
            1.0, "largest |E| / U_val: inputs anywhere in the stated ranges"),
        "validation/mica": (
            "mica", "Gold asperity on mica: friction stress, with nothing fitted",
            "A smooth asperity, for want of the roughness, predicts seven times the measured friction stress",
            12.3, "recorded: largest |E| / U_val, rounded up"),
    },
    metric="at_most",
    tier="full",
    source="verification/experiments/measured: published measurements with their sources; ASME V&V 20 (2009)",
)  # fmt: skip
def experiment(name: str) -> Measured:
    """Judge the largest |E| / U_val of the points, which are those of the committed comparison."""
    found = points(name)
    kept = next(one for one in committed("experiments")["experiments"] if one["name"] == name)["points"]
    for point, row in zip(found, kept, strict=True):
        _compare(point, row)
    within = sum(point.within for point in found)
    return Measured(
        max(abs(point.error) / point.uncertainty for point in found),
        note=f"{within} of {len(found)} points within U_val",
    )


def _compare(point: Point, row: dict[str, float]) -> None:
    for key, value in point.row().items():
        same = (
            value == row[key]
            if isinstance(value, str | bool)
            else abs(value - row[key]) <= SAME * point.uncertainty
        )
        if not same:
            raise Disproved(f"{key} at {point.at} is {value}, {row[key]} in the committed comparison")
