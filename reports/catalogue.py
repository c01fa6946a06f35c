"""The figures of cases, by id: an entry a figure. A case has those whose pattern its id matches."""

from __future__ import annotations

from dataclasses import replace
from fnmatch import fnmatchcase

from reports.appendix_figures import APPENDIX
from reports.drawing import Data, Figure, curves, dots, maps, order
from reports.reproduction_figures import REPRODUCTION
from reports.yield_figures import BEYOND_YIELD

FIG12 = {
    "crest: first order (%)": "crest, first order",
    "flank: first order (%)": "flank, first order",
    "crest: the paper's superposition (%)": "crest, the paper's superposition",
}
FIG13 = {
    f"{slope} degrees: wedge theory (%)": f"{slope} degrees, wedge theory" for slope in ("2.5", "6.5", "15")
}
FINITE_ELEMENTS = {  # as points beside the theories that they nearly coincide with
    "fig12": {f"{place}: finite elements (%)": f"{place}, finite elements" for place in ("crest", "flank")},
    "fig13": {
        key.replace("wedge theory", "finite elements"): f"{text.partition(',')[0]}, finite elements"
        for key, text in FIG13.items()
    },
}
WITH_DIFFERENCE = (6.4, 4.8)  # inches: a second panel for the difference from the exact curve

APPENDIX_A = (
    *(
        curves(
            f"appendix-figures/{name}",
            caption,
            "x over a",
            series,
            xlabel="x / a",
            ylabel="change of the coefficient (%)",
            points=FINITE_ELEMENTS[name],
        )
        for name, series, caption in (
            ("fig12", FIG12, "Strip theory and finite elements at 6.5 degrees, from the strip's centre."),
            ("fig13", FIG13, "Wedge theory and finite elements, from the apex."),
        )
    ),
    curves(
        "appendix-strip/crest-small",
        "Surface displacement of a strip on a crest of 15 degrees and on a flat boundary (Fig. 12).",
        "x over a",
        {"15 degrees, superposition": "wavy, superposition", "15 degrees, first order": "wavy, first order"},
        exact={"flat": "flat boundary"},
        xlabel="distance from the centre / half-width of the strip",
        ylabel="displacement, units of p a / E",
    ),
)

SMOOTH = (
    curves(
        "kernels/textbook-*-fails",
        "{title}: relative error of its textbook form and of this code, over the distance from the load.",
        "offset",
        {"textbook": "textbook form, median", "production": "this code, largest"},
        xlabel="distance (elements)",
        ylabel="relative error",
        log="xy",
        marker=True,
    ),
    curves(
        "hertz/peak-pressure",
        "Pressure through the centre of a smooth ball, and its difference from Hertz.",
        "x",
        {"computed": "this code"},
        exact={"hertz": "Hertz"},
        xlabel="x from the centre (mm)",
        ylabel="pressure (MPa)",
        difference="difference (MPa)",
        size=WITH_DIFFERENCE,
    ),
    Figure(
        "hertz/peak-pressure",
        ("pressure", "side"),
        maps({"pressure": "Pressure"}, side="side", unit="MPa"),
        "Map of the contact pressure.",
        (4.8, 3.8),
    ),
    curves(
        "sliding/trailing-edge",
        "Profiles along the sliding direction, against the contact without friction.",
        "x",
        {"pressure along": "pressure", "traction along": "traction"},
        exact={"hertz pressure": "Hertz", "hertz traction": "beta times Hertz"},
        xlabel="x from the centre, along sliding (mm)",
        ylabel="stress (MPa)",
    ),
    curves(
        "sliding/trailing-edge",
        "What friction changes: the pressure moves to the trailing edge, at negative x.",
        "x",
        {"change by friction": "with friction less without"},
        xlabel="x from the centre, along sliding (mm)",
        ylabel="pressure (MPa)",
    ),
    Figure(
        "sliding/trailing-edge",
        ("pressure", "traction", "side"),
        maps({"pressure": "Pressure", "traction": "Traction"}, side="side", unit="MPa"),
        "Maps of contact pressure and traction.",
        (8.6, 3.8),
    ),
    curves(
        "reference/sliding-wave-shift",
        "Pressure of a sliding wave of dissimilar materials, and its difference from the exact solution.",
        "x",
        {"p/p*": "this code"},
        exact={"exact p/p*": "exact, singular exponent"},
        xlabel="x / wavelength",
        ylabel="pressure / that of full contact",
        difference="difference",
        size=WITH_DIFFERENCE,
    ),
    curves(
        "reference/jgh-area",
        "Contact fraction of a two-dimensional wave between its asymptotes.",
        "load/p*",
        {"area": "this code, perimeter-corrected"},
        exact={"table": "extrapolated", "light asymptote": "light", "nearly full asymptote": "nearly full"},
        xlabel="load / that of full contact",
        ylabel="contact fraction",
        marker=True,
    ),
)

ROUGH = (
    curves(
        "surfaces/ensemble",
        "Autocorrelation of an ensemble of rough surfaces, and its difference from Eq. (9).",
        "lag / l",
        {"estimate": "ensemble"},
        exact={"eq9": "Eq. (9)"},
        band=("standard error", "one standard error"),
        xlabel="lag / correlation length",
        ylabel="autocorrelation",
        difference="difference",
        size=WITH_DIFFERENCE,
    ),
    curves(
        "surfaces/spectrum",
        "Power of the periodic rough surface by wavenumber, over the Fourier transform of Eq. (9).",
        "k l",
        {"power / eq9": "ensemble"},
        band=("standard error", "one standard error"),
        xlabel="wavenumber x correlation length",
        ylabel="power / that of Eq. (9)",
    ),
    curves(
        "surfaces/self-affine-psd",
        "Power of a self-affine surface in bands of a third of an octave, over the specified one.",
        "q",
        {"power / specified": "eight realisations"},
        band=("standard error", "standard error"),
        xlabel="wave number (rad/mm)",
        per_x=1e-3,
        ylabel="power / specified power",
        log="x",
        marker=True,
    ),
    curves(
        "reference/greenwood-tripp-*",
        "Mean pressure of rough spheres and of the asperity model of Greenwood and Tripp.",
        "r/a0",
        {"p/p0": "rough spheres, mean"},
        exact={"Greenwood-Tripp p/p0": "Greenwood and Tripp 1967"},
        band=("standard error", "one standard error"),
        xlabel="distance from the axis / Hertz radius",
        ylabel="pressure / Hertz peak",
    ),
    curves(
        "reference/rough-plane-slope",
        "Contact fraction of a rough plane over the load.",
        "p/(E* h')",
        {"A/A0": "this code, mean"},
        exact={"Persson": "Persson"},
        xlabel="mean pressure / (E* rms gradient)",
        ylabel="contact fraction",
        marker=True,
    ),
    curves(
        "reference/self-affine-[ks]*",
        "Slope of the area-load line of self-affine surfaces over Nayak's parameter, by Hurst exponent.",
        "alpha",
        {"kappa": "mean of eight realisations", "kappa, H = 0.3": "H = 0.3", "kappa, H = 0.8": "H = 0.8"},
        exact={
            "Bush, Gibson and Thomas": "Bush, Gibson and Thomas 1975",
            "simulations, low": "lowest of published simulations",
            "Persson": "Persson 2001",
        },
        band=("standard error", "standard error"),
        xlabel="Nayak's parameter",
        ylabel="A E* rms gradient / P",
        log="x",
        marker=True,
    ),
    curves(
        "identification/effects",
        "Residuals of a fit of tau and beta: one outlier stands apart, a wrong surface bends all of them.",
        "load (N)",
        {
            "right": "right input",
            "modulus +10 %": "modulus 10 % too high",
            "another surface": "another realisation of the surface",
            "outlier": "fifth row 10 % too high",
        },
        xlabel="load (N)",
        ylabel="residual / standard uncertainty",
        log="x",
        marker=True,
    ),
)

TIMED = ("paper", "production", "NNLS", "L-BFGS-B")


def _table2_seconds(data: Data) -> Data:
    """Seconds of each method over the grids of the paper's scheme; none where a method ends earlier."""
    seconds = {name: dict(zip(data[f"{name}: M"], data[f"{name}: s"], strict=True)) for name in TIMED}
    grids = data["paper: M"]
    return {"M": grids, **{name: [by_grid.get(M) for M in grids] for name, by_grid in seconds.items()}}


BY_GRID = (
    replace(
        curves(
            "variational/table2-growth",
            "Processor time on the same scene; the methods took turns on every grid.",
            "M",
            {name: name for name in TIMED},
            xlabel="elements per side",
            ylabel="processor time (s)",
            log="xy",
            marker=True,
        ),
        needs=tuple(f"{name}: {column}" for name in TIMED for column in ("M", "s")),
        derived=_table2_seconds,
    ),
    *(
        Figure(
            f"hertz/{case}",
            ("spacing", *series),
            order(series, spacing="spacing", ylabel="relative error", expected=(expected,)),
            f"Error of the {quantity} over the grid, with fitted and expected order.",
        )
        for case, series, expected, quantity in (
            ("peak-order", {"peak pressure": "peak pressure"}, 2.0, "peak pressure"),
            ("approach-order", {"approach": "approach"}, 2.0, "approach"),
            ("profile", {"profile": "pressure within 0.8 radii"}, 2.0, "pressure"),
            ("radius-corrected", {"raw": "raw area", "corrected": "corrected area"}, 1.0, "contact radius"),
        )
    ),
    *(
        Figure(
            f"reference/{cases}",
            ("M", "error"),
            order({"error": quantity}, ylabel="relative error", expected=(expected,)),
            f"{{title}}: error of the {quantity} over the grid, and the order expected.",
        )
        for cases, quantity, expected in (
            ("square-punch-order", "stiffness", 1.0),
            ("*-approach-order", "approach", 2.0),
        )
    ),
)

SCENE_BY_SCENE = (
    *(
        Figure(cases, ("worst",), dots("worst", xlabel=xlabel, limit=limit), caption, (6.4, height))
        for cases, xlabel, limit, caption, height in (
            ("kernels/*al-50-digits", "largest relative error", 1e-14,
             "{title}: largest relative error by group of points.", 3.8),
            ("cross-check/[!c]*", "difference of the solvers", 1e-9,
             "{title}: difference scene by scene.", 5.0),
            ("manufactured/*", "error", 1e-12, "{title}: error of both solvers.", 5.0),
            ("balance/normal-force", "misfit of the load", 1e-8,
             "Normal force against the load, by scene.", 5.0),
            ("balance/prescribed-approach", "difference", 1e-9,
             "Approach and load prescribed, by scene.", 5.0),
        )
    ),
    *(
        Figure(
            f"accuracy/{name}",
            ("difference / bar",),
            dots("difference / bar", xlabel="difference of mu / bar of tau's active set", limit=1.0),
            "{title}: difference from the rule that excludes elements from tau, over its bar.",
            (6.4, height),
        )
        for name, height in (("tau-shares", 3.4), ("tau-shares-128", 6.8))
    ),
    Figure(
        "kernels/tables-50-digits",
        ("normal, dy/dx = 1",),
        dots(None, xlabel="largest relative error", limit=1e-14),
        "Largest relative error of the convolution's tables, by kernel and shape of the elements.",
    ),
)  # fmt: skip

DECLARED = (
    *BEYOND_YIELD, *REPRODUCTION, *APPENDIX, *APPENDIX_A, *SMOOTH, *ROUGH, *BY_GRID,
    *SCENE_BY_SCENE,
)  # fmt: skip


def figures_of(case_id: str) -> list[Figure]:
    """Return the figures of a case, in their order here."""
    return [figure for figure in DECLARED if fnmatchcase(case_id, figure.cases)]
