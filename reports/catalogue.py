"""The figures of checks, by id: an entry a figure. A case has those whose pattern its id matches."""

from __future__ import annotations

from fnmatch import fnmatchcase

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, Data, Figure, below, curves, label_ticks, look
from reports.reproduction_figures import REPRODUCTION

PLACES = ("crest", "flank", "valley")
NEXT = {"+x 1": "downhill (+x)", "-x 1": "uphill (-x)", "across 1": "across"}
QUANTITIES = {"mu": "$\\mu$", "A": "A", "f_max": "$p_{max}$", "Q": "Q (of F)"}
TREATMENTS = ("correction", "near-field remedy")


def _error_map(canvas: Canvas, data: Data) -> None:
    """Draw the error over the slope: the element itself by place, and the next ones on a flank; dashed: the
    pair."""
    own, following = canvas.subplots(2, 1, sharex=True)
    lines = [(own, place, "self", place) for place in PLACES]
    lines += [(following, "flank", key, label) for key, label in NEXT.items()]
    for k, (axes, place, key, label) in enumerate(lines):
        for name, style in (("one body", "-"), ("pair", "--")):
            shown = {"color": COLOURS[k % 3], "label": label if name == "one body" else None}
            axes.plot(data["slope (degrees)"], data[f"{name}, {place}, {key} (%)"], style, **shown)
    for axes, ylabel in ((own, "element itself (%)"), (following, "next ones, flank (%)")):
        axes.axhline(-2, color=INK, linestyle=":")
        axes.axhline(2, color=INK, linestyle=":")
        axes.set_ylabel(ylabel)
        axes.legend()
    following.set_xlabel("maximum slope (degrees)")


def _effect(canvas: Canvas, data: Data) -> None:
    """Change of mu, A, f_max and Q over the rms slope, with 95 % intervals."""
    slope = np.array(data["rms slope (degrees)"], dtype=float)
    for axes, (key, label) in zip(canvas.subplots(4, 1, sharex=True), QUANTITIES.items(), strict=True):
        for k, treatment in enumerate(TREATMENTS):
            mean, half = data[f"{key}, {treatment}"], data[f"{key}, {treatment}, half width"]
            axes.errorbar(slope * (1 + 0.03 * k), mean, half, capsize=2, label=treatment, **look(k))
        axes.axhline(0.0, color=INK, linewidth=0.8)
        axes.axvline(2.5, color=INK, linestyle=":")
        axes.set_xscale("log")
        label_ticks(axes, slope)
        axes.set(ylabel=f"change of {label} (%)")
    canvas.axes[-1].set_xlabel("rms slope of the roughness (degrees)")
    below(canvas, canvas.axes[0])


WITH_DIFFERENCE = 5.0  # inches: a second panel for the difference from the exact curve

APPENDIX = (
    Figure(
        "fem3d/error-map",
        tuple(f"pair, {place}, self (%)" for place in PLACES),
        _error_map,
        "Error of flat influence coefficients under one square element on a wave of 20 half-widths, nu 0.3, "
        "of the element itself and of the next ones: one body, and dashed copper under steel; dotted: 2 %.",
        6.4,
    ),
    Figure(
        "appendix-correction/paper-pair",
        tuple(f"{q}, {t}" for q in QUANTITIES for t in TREATMENTS),
        _effect,
        "{title}: what exact facet tractions and the paper's near-field remedy change; means over eight "
        "surfaces, 95 % intervals; dotted: the paper's largest rms slope.",
        9.0,
    ),
    curves(
        "appendix-figures/fig12",
        "Strip theory and finite elements on a crest of 6.5 degrees, from the strip's centre.",
        "x over a",
        {
            "crest: first order (%)": "first order",
            "crest: the paper's superposition (%)": "the paper's superposition",
        },
        exact={"crest: finite elements (%)": "finite elements"},
        xlabel="x / a",
        ylabel="change of the coefficient (%)",
    ),
    curves(
        "appendix-figures/fig13",
        "Wedge theory and finite elements (open markers), from the apex.",
        "x over a",
        {f"{slope} degrees: wedge theory (%)": f"{slope} degrees" for slope in ("2.5", "6.5", "15")},
        points={f"{slope} degrees: finite elements (%)": "" for slope in ("2.5", "6.5", "15")},
        xlabel="x / a",
        ylabel="change of the coefficient (%)",
    ),
)

SMOOTH = (
    curves(
        "kernels/textbook-normal-fails",
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
        height=WITH_DIFFERENCE,
    ),
    curves(
        "sliding/trailing-edge",
        "What friction changes: the pressure moves to the trailing edge, at negative x.",
        "x",
        {"change by friction": "with friction less without"},
        xlabel="x from the centre, along sliding (mm)",
        ylabel="pressure (MPa)",
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
        height=WITH_DIFFERENCE,
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
        "capped/sphere-k*",
        "{title}: mean pressure of the capped model, and the published law.",
        "load / load of first yield",
        {"mean pressure / H, cap": "pressure cap", "mean pressure / H, law": "finite-element law"},
        xlabel="load / load of first yield",
        ylabel="mean contact pressure / H",
        log="x",
        marker=True,
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
        ylabel="residual / standard u",
        height=4.0,
        log="x",
        marker=True,
    ),
)

DECLARED = (*REPRODUCTION, *APPENDIX, *SMOOTH, *ROUGH)


def figures_of(case_id: str) -> list[Figure]:
    """Return the figures of a case, in their order here."""
    return [figure for figure in DECLARED if fnmatchcase(case_id, figure.cases)]
