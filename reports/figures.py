"""Which case has which figures.

`DECLARED` goes by the case's id: where its data are missing, the report says so. `OFFERED` goes by the names
of the recorded series alone, so that a new case gets a figure by recording its series under these names.
"""

from __future__ import annotations

from collections.abc import Mapping
from fnmatch import fnmatchcase
from itertools import pairwise
from typing import Any

from reports.drawing import Figure, dots, lines, maps, order


def _order(cases: str, what: str, expected: float) -> Figure:
    draw = order({"error": what}, ylabel="relative error", expected=(expected,))
    return Figure(
        cases, ("M", "error"), draw, f"Error of the {what} over the grid, and the order expected."
    )


DECLARED = (
    Figure(
        "kernels/textbook-*-fails",
        ("offset", "textbook", "production"),
        lines(
            "offset",
            {"textbook": "textbook form, median", "production": "this code, largest"},
            xlabel="distance (elements)",
            ylabel="relative error",
            log="xy",
            marker=True,
        ),
        "Relative error of the textbook form and of this code, over the distance from the loaded element.",
    ),
    Figure(
        "kernels/*-50-digits",
        ("worst",),
        dots("worst", xlabel="largest relative error", limit=1e-14),
        "Largest relative error by group of points.",
    ),
    Figure(
        "surfaces/ensemble",
        ("lag / l", "estimate", "eq9", "standard error"),
        lines(
            "lag / l",
            {"estimate": "ensemble"},
            exact={"eq9": "Eq. (9)"},
            band=("standard error", "one standard error"),
            xlabel="lag / correlation length",
            ylabel="autocorrelation",
        ),
        "Autocorrelation of an ensemble of rough surfaces and of Eq. (9).",
    ),
    Figure(
        "surfaces/spectrum",
        ("k l", "power / eq9", "standard error"),
        lines(
            "k l",
            {"power / eq9": "ensemble"},
            band=("standard error", "one standard error"),
            xlabel="wavenumber x correlation length",
            ylabel="power / that of Eq. (9)",
        ),
        "Power of the periodic rough surface by wavenumber, over the Fourier transform of Eq. (9).",
    ),
    _order("reference/square-punch-order", "stiffness", 1.0),
    _order("reference/*-approach-order", "approach", 2.0),
    Figure(
        "reference/sliding-wave-shift",
        ("x", "p/p*", "exact p/p*"),
        lines(
            "x",
            {"p/p*": "this code"},
            exact={"exact p/p*": "exact, singular exponent"},
            xlabel="x (m)",
            ylabel="pressure / that of full contact",
        ),
        "Pressure of a sliding wave of dissimilar materials and its exact solution.",
    ),
    Figure(
        "reference/greenwood-tripp-*",
        ("r/a0", "p/p0", "Greenwood-Tripp p/p0", "standard error"),
        lines(
            "r/a0",
            {"p/p0": "rough spheres, mean"},
            exact={"Greenwood-Tripp p/p0": "Greenwood and Tripp 1967"},
            band=("standard error", "one standard error"),
            xlabel="distance from the axis / Hertz radius",
            ylabel="pressure / Hertz peak",
        ),
        "Mean pressure of rough spheres and of the asperity model of Greenwood and Tripp.",
    ),
    Figure(
        "reference/rough-plane-slope",
        ("p/(E* h')", "A/A0", "Persson"),
        lines(
            "p/(E* h')",
            {"A/A0": "this code, mean"},
            exact={"Persson": "Persson"},
            xlabel="mean pressure / (E* rms slope)",
            ylabel="contact fraction",
            marker=True,
        ),
        "Contact fraction of a rough plane over the load.",
    ),
    Figure(
        "appendix-strip/crest-small",
        ("x over a", "flat", "15 degrees, superposition", "15 degrees, first order"),
        lines(
            "x over a",
            {
                "15 degrees, superposition": "wavy, superposition",
                "15 degrees, first order": "wavy, first order",
            },
            exact={"flat": "flat boundary"},
            xlabel="distance from the centre / half-width of the strip",
            ylabel="displacement, units of p a / E",
        ),
        "Surface displacement of a strip on a crest of 15 degrees and on a flat boundary (Fig. 12).",
    ),
    Figure(
        "reproduction/table3-*",
        ("sigma_e (um)", "printed", "ours", "half width 95 %"),
        lines(
            "sigma_e (um)",
            {"ours": "this code, mean", "printed": "as printed"},
            band=("half width 95 %", "95 % of the mean"),
            xlabel="rms height (um)",
            ylabel="value of Table 3",
            marker=True,
        ),
        "Table 3 as printed and as computed.",
    ),
    Figure(
        "reference/jgh-area",
        ("load/p*", "area", "table", "light asymptote", "nearly full asymptote"),
        lines(
            "load/p*",
            {"area": "this code, perimeter-corrected"},
            exact={
                "table": "extrapolated",
                "light asymptote": "light",
                "nearly full asymptote": "nearly full",
            },
            xlabel="load / that of full contact",
            ylabel="contact fraction",
            marker=True,
        ),
        "Contact fraction of a two-dimensional wave between its asymptotes.",
    ),
)

OFFERED = (
    Figure(
        "*",
        ("pressure map", "traction map", "side (mm)"),
        maps({"pressure map": "Pressure", "traction map": "Traction"}, side="side (mm)", unit="MPa"),
        "Maps of contact pressure and traction.",
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
        ),
        "Profile of the pressure through the centre, against Hertz.",
    ),
    Figure(
        "*", ("M", "error"), order({"error": "error"}), "Error over the grid, with the fitted order."
    ),
    Figure(
        "*",
        ("difference by scene",),
        dots("difference by scene", xlabel="largest difference between the solvers"),
        "Agreement of the solvers, scene by scene.",
    ),
)


def figures_of(case_id: str, data: Mapping[str, Any]) -> list[Figure]:
    """The figures declared for the case, else those offered for its series, else a plain plot of them."""
    declared = [figure for figure in DECLARED if fnmatchcase(case_id, figure.cases)]
    return declared or [figure for figure in OFFERED if figure.available(data)] or _plain(data)


def _plain(data: Mapping[str, Any], most: int = 6) -> list[Figure]:
    """All lists over the first one, where that reads as one picture.

    That is: it rises or falls, and the others are few, as long, and of comparable size or on a logarithmic
    axis.
    """
    x, *others = [name for name, values in data.items() if isinstance(values, list)] or [""]
    if not (0 < len(others) <= most and all(_is_series(data[name]) for name in (x, *others))):
        return []
    if not (_rises(data[x]) or _rises(data[x][::-1])) or {len(data[name]) for name in others} != {
        len(data[x])
    }:
        return []
    log = ("x" if _wide(data[x]) else "") + ("y" if all(_wide(data[name]) for name in others) else "")
    sizes = [max(abs(value) for value in data[name] if value is not None) for name in others]
    if "y" not in log and not max(sizes) <= 100 * min(sizes):
        return []
    draw = lines(x, dict(zip(others, others, strict=True)), xlabel=x, ylabel="", log=log, marker=True)
    return [Figure("*", (x, *others), draw, "The series that the case recorded.")]


def _is_series(values: object) -> bool:
    """A list of three numbers or more, of which some may be unknown."""
    if not isinstance(values, list) or len(values) < 3 or all(value is None for value in values):
        return False
    return all(isinstance(value, int | float | None) for value in values)


def _rises(values: list[float | None]) -> bool:
    return all(a is not None and b is not None and a < b for a, b in pairwise(values))


def _wide(values: list[float | None]) -> bool:
    """Whether the known values are positive and span more than a factor of thirty."""
    known = [value for value in values if value is not None]
    return bool(known) and min(known) > 0 and max(known) > 30 * min(known)
