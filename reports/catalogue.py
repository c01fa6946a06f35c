"""The figures of known cases, by id: one entry a figure, each with the series it needs."""

from __future__ import annotations

from reports.appendix_figures import APPENDIX
from reports.contestant_figures import CONTESTANTS
from reports.drawing import Data, Figure, dots, lines, maps, order
from reports.reproduction_figures import REPRODUCTION
from reports.yield_figures import BEYOND_YIELD


def _order(cases: str, what: str, expected: float) -> Figure:
    draw = order({"error": what}, ylabel="relative error", expected=(expected,))
    return Figure(
        cases, ("M", "error"), draw, f"{{title}}: error of the {what} over the grid, and the order expected."
    )


TIMED = ("paper", "production", "NNLS", "L-BFGS-B")


def _table2_seconds(data: Data) -> Data:
    """Seconds of each method over the grids of the paper's scheme; none where a method ends earlier."""
    seconds = {name: dict(zip(data[f"{name}: M"], data[f"{name}: s"], strict=True)) for name in TIMED}
    grids = data["paper: M"]
    return {"M": grids, **{name: [by_grid.get(M) for M in grids] for name, by_grid in seconds.items()}}


FIG12 = {
    "crest: finite elements (%)": "crest, finite elements",
    "crest: first order (%)": "crest, first order",
    "crest: the paper's superposition (%)": "crest, the paper's superposition",
    "flank: finite elements (%)": "flank, finite elements",
    "flank: first order (%)": "flank, first order",
}
FIG13 = {
    f"{slope} degrees: {what} (%)": f"{slope} degrees, {what}"
    for slope in ("2.5", "6.5", "15")
    for what in ("wedge theory", "finite elements")
}

DECLARED = (
    *BEYOND_YIELD,
    *REPRODUCTION,
    *APPENDIX,
    *CONTESTANTS,
    *(
        Figure(
            f"appendix-figures/{name}",
            ("x over a", *series),
            lines("x over a", series, xlabel="x / a", ylabel="change of the coefficient (%)", marker=True),
            caption,
        )
        for name, series, caption in (
            ("fig12", FIG12, "Strip theory and finite elements at 6.5 degrees, from the strip's centre."),
            ("fig13", FIG13, "Wedge theory and finite elements, from the apex."),
        )
    ),
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
        "{title}: relative error of its textbook form and of this code, over the distance from the load.",
    ),
    Figure(
        "kernels/tables-50-digits",
        ("normal, dy/dx = 1",),
        dots(None, xlabel="largest relative error", limit=1e-14),
        "Largest relative error of the convolution's tables, by kernel and shape of the elements.",
    ),
    Figure(
        "kernels/*al-50-digits",
        ("worst",),
        dots("worst", xlabel="largest relative error", limit=1e-14),
        "{title}: largest relative error by group of points.",
    ),
    *(
        Figure(cases, ("worst",), dots("worst", xlabel=what, limit=limit), caption, (6.4, 5.0))
        for cases, what, limit, caption in (
            (
                "cross-check/[!c]*",
                "difference of the solvers",
                1e-9,
                "{title}: difference scene by scene.",
            ),
            (
                "manufactured/*",
                "error",
                1e-12,
                "{title}: error of both solvers.",
            ),
            (
                "balance/normal-force",
                "misfit of the load",
                1e-8,
                "Normal force against the load, by scene.",
            ),
            (
                "balance/prescribed-approach",
                "difference",
                1e-9,
                "Approach and load prescribed, by scene.",
            ),
        )
    ),
    Figure(
        "variational/table2-growth",
        tuple(f"{name}: {what}" for name in TIMED for what in ("M", "s")),
        lines(
            "M",
            {name: name for name in TIMED},
            xlabel="elements per side",
            ylabel="processor time (s)",
            log="xy",
            marker=True,
        ),
        "Processor time on the same scene; the methods took turns on every grid.",
        derived=_table2_seconds,
    ),
    Figure(
        "hertz/peak-pressure",
        ("x", "computed", "hertz"),
        lines(
            "x",
            {"computed": "this code"},
            exact={"hertz": "Hertz"},
            xlabel="x from the centre (mm)",
            ylabel="pressure (MPa)",
            difference="difference (MPa)",
        ),
        "Pressure through the centre of a smooth ball, and its difference from Hertz.",
        (6.4, 4.8),
    ),
    Figure(
        "hertz/peak-pressure",
        ("pressure", "side"),
        maps({"pressure": "Pressure"}, side="side", unit="MPa"),
        "Map of the contact pressure.",
        (4.8, 3.8),
    ),
    *(
        Figure(
            f"hertz/{case}",
            ("spacing", *series),
            order(series, spacing="spacing", ylabel="relative error", expected=expected),
            f"Error of the {what} over the grid, with fitted and expected order.",
        )
        for case, series, expected, what in (
            ("peak-order", {"peak pressure": "peak pressure"}, (2.0,), "peak pressure"),
            ("approach-order", {"approach": "approach"}, (2.0,), "approach"),
            ("profile", {"profile": "pressure within 0.8 radii"}, (2.0,), "pressure"),
            (
                "radius-corrected",
                {"raw": "raw area", "corrected": "corrected area"},
                (1.0,),
                "contact radius",
            ),
        )
    ),
    Figure(
        "sliding/trailing-edge",
        ("x", "pressure along", "traction along", "hertz pressure", "hertz traction"),
        lines(
            "x",
            {"pressure along": "pressure", "traction along": "traction"},
            exact={"hertz pressure": "Hertz", "hertz traction": "beta times Hertz"},
            xlabel="x from the centre, along sliding (mm)",
            ylabel="stress (MPa)",
        ),
        "Profiles along the sliding direction, against the contact without friction.",
    ),
    Figure(
        "sliding/trailing-edge",
        ("x", "change by friction"),
        lines(
            "x",
            {"change by friction": "with friction less without"},
            xlabel="x from the centre, along sliding (mm)",
            ylabel="pressure (MPa)",
        ),
        "What friction changes: the pressure moves to the trailing edge, at negative x.",
    ),
    Figure(
        "sliding/trailing-edge",
        ("pressure", "traction", "side"),
        maps({"pressure": "Pressure", "traction": "Traction"}, side="side", unit="MPa"),
        "Maps of contact pressure and traction.",
        (8.6, 3.8),
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
        "identification/effects",
        ("load (N)", "right", "modulus +10 %", "another surface", "outlier"),
        lines(
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
        "Residuals of a fit of tau and beta: one outlier stands apart, a wrong surface bends all of them.",
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
            difference="difference",
        ),
        "Autocorrelation of an ensemble of rough surfaces, and its difference from Eq. (9).",
        (6.4, 4.8),
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
            xlabel="x / wavelength",
            ylabel="pressure / that of full contact",
            difference="difference",
        ),
        "Pressure of a sliding wave of dissimilar materials, and its difference from the exact solution.",
        (6.4, 4.8),
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
            xlabel="mean pressure / (E* rms gradient)",
            ylabel="contact fraction",
            marker=True,
        ),
        "Contact fraction of a rough plane over the load.",
    ),
    *(
        Figure(
            f"reference/self-affine-{case}",
            ("alpha", "kappa", "kappa, H = 0.3", "kappa, H = 0.8", "Persson", "Bush, Gibson and Thomas"),
            lines(
                "alpha",
                {
                    "kappa": "mean of eight realisations",
                    "kappa, H = 0.3": "H = 0.3",
                    "kappa, H = 0.8": "H = 0.8",
                },
                exact={
                    "Bush, Gibson and Thomas": "Bush, Gibson and Thomas 1975",
                    "simulations, low": "simulations, from",
                    "Persson": "Persson 2001",
                },
                band=("standard error", "standard error"),
                xlabel="Nayak's parameter",
                ylabel="A E* rms gradient / P",
                log="x",
                marker=True,
            ),
            "Slope of the area-load line of self-affine surfaces over Nayak's parameter, by Hurst exponent.",
        )
        for case in ("kappa", "spectral-breadth")
    ),
    *(
        Figure(
            "reference/lay-friction",
            tuple(f"{what}, {name}" for name in ("isotropic", "lay along x")),
            lines(
                "direction (deg)",
                {f"{what}, {name}": name for name in ("isotropic", "lay along x")},
                xlabel="direction of sliding (degrees)",
                ylabel=ylabel,
                marker=True,
            ),
            caption,
        )
        for what, ylabel, caption in (
            (
                "mu",
                "friction coefficient",
                "Friction over the direction of sliding, mean of 24 realisations.",
            ),
            (
                "rms elastic part of mu",
                "rms elastic part of the friction coefficient",
                "Elastic part of friction over the direction of sliding, rms of 24 realisations.",
            ),
            (
                "A over its mean",
                "real contact area / mean",
                "Real contact area over the direction of sliding, mean of 24 realisations.",
            ),
        )
    ),
    Figure(
        "surfaces/self-affine-psd",
        ("q", "power / specified", "standard error"),
        lines(
            "q",
            {"power / specified": "eight realisations"},
            band=("standard error", "standard error"),
            xlabel="wave number (rad/mm)",
            per_x=1e-3,
            ylabel="power / specified power",
            log="x",
            marker=True,
        ),
        "Power of a self-affine surface in bands of a third of an octave, over the specified one.",
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
