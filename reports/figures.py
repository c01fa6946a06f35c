"""Which case has which figures.

The catalogue goes by the case's id: where its data are missing, the report says so. `OFFERED` goes by names
of recorded series alone, so that a new case gets a figure by recording its series under these names.
"""

from __future__ import annotations

from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import Any

from reports.catalogue import DECLARED
from reports.drawing import Figure, dots, lines, maps, order

OFFERED = (
    Figure(
        "*",
        ("pressure map", "traction map", "side (mm)"),
        maps({"pressure map": "Pressure", "traction map": "Traction"}, side="side (mm)", unit="MPa"),
        "{title}: maps of contact pressure and traction.",
        (8.6, 3.8),
    ),
    Figure(
        "*",
        ("x (mm)", "pressure (MPa)", "hertz (MPa)"),
        lines(
            "x (mm)",
            {"pressure (MPa)": "this code"},
            exact={"hertz (MPa)": "Hertz"},
            xlabel="x from the centre (mm)",
            ylabel="pressure (MPa)",
            difference="difference (MPa)",
        ),
        "{title}: pressure through the centre, and its difference from Hertz.",
    ),
    Figure(
        "*", ("M", "error"), order({"error": "error"}), "{title}: error over the grid, with the fitted order."
    ),
    Figure(
        "*",
        ("difference by scene",),
        dots("difference by scene", xlabel="largest difference between the solvers"),
        "{title}: difference of the solvers, scene by scene.",
    ),
)


def figures_of(case_id: str, data: Mapping[str, Any]) -> list[Figure]:
    """The figures declared for the case, else those offered for its series; each has a caption of its own."""
    declared = [figure for figure in DECLARED if fnmatchcase(case_id, figure.cases)]
    return declared or [figure for figure in OFFERED if figure.available(data)]
