"""The figures of checks, by id: an entry a figure. A case has those whose pattern its id matches."""

from __future__ import annotations

from dataclasses import replace
from fnmatch import fnmatchcase

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, MARKERS, Data, Figure, below, curves, label_ticks, look
from reports.reproduction_figures import REPRODUCTION

PLACES = ("crest", "flank", "valley")
NEXT = {"+x 1": "downhill (+x)", "-x 1": "uphill (-x)", "across 1": "across"}
QUANTITIES = {"mu": "$\\mu$", "A": "A", "f_max": "$p_{max}$", "Q": "Q (of F)"}
TREATMENTS = ("correction", "near-field remedy")
READINGS = "reading of the slope (degrees)"
GROUPS = ("self", "in line", "across")


def _error_map(canvas: Canvas, data: Data) -> None:
    """Draw the error over the slope: the element itself by place, next ones on a flank; dashed: pair."""
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


def _reach(canvas: Canvas, data: Data) -> None:
    """Change of mu and f_max over the remedy's reach; dashed: the correction."""
    reach = data["reach (elements)"]
    for axes, key in zip(canvas.subplots(2, 1), ("mu", "f_max"), strict=True):
        # Without friction mu is nearly zero, and a percentage of mu is meaningless
        for k, name in enumerate(("with friction", "without friction")[: 1 if key == "mu" else 2]):
            axes.plot(reach, data[f"{key}, {name}, remedy"], label=name, **look(k))
            axes.plot(reach, data[f"{key}, {name}, correction"], "--", color=COLOURS[k])
        axes.set_xscale("symlog", base=2, linthresh=1)
        label_ticks(axes, reach)
        label = f"change of {QUANTITIES[key]} (%)"
        axes.set(xlabel="reach on the slope (elements)", ylabel=label)
    below(canvas, axes)


def _readings(canvas: Canvas, data: Data) -> None:
    """Draw the largest error by body, coefficient and reading of the slope, beside 2 %."""
    names = [name for name in data if name.endswith(GROUPS)]
    axes = canvas.add_subplot()
    for k, reading in enumerate(data[READINGS]):
        errors = [data[name][k] for name in names]
        axes.plot(errors, np.arange(len(names)), MARKERS[k], color=COLOURS[k], label=f"{reading} degrees")
    axes.axvline(2.0, color=INK, linestyle=":")
    axes.set_xscale("log")
    axes.set_yticks(range(len(names)), [name.replace(", ", ",\n", 1) for name in names])
    axes.invert_yaxis()
    label_ticks(axes, (0.1, 0.5, 2, 10))
    axes.set_xlabel("largest error (%)")
    below(canvas, axes)


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
        "fem3d/less-than-two-percent",
        (READINGS,),
        _readings,
        "Largest error on crest, flank or valley, by what 'less than 2 %' may mean; dotted: 2 %.",
        5.6,
    ),
    Figure(
        "appendix-correction/paper-pair",
        tuple(f"{q}, {t}" for q in QUANTITIES for t in TREATMENTS),
        _effect,
        "{title}: what exact facet tractions and the paper's near-field remedy change; means over eight "
        "surfaces, 95 % intervals; dotted: the paper's largest rms slope.",
        9.0,
    ),
    Figure(
        "appendix-correction/paper-remedy",
        ("reach (elements)", "mu, with friction, remedy"),
        _reach,
        "The paper's remedy over how far coefficients are computed on the slope; dashed: the correction.",
        5.6,
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
        "capped/sphere-[kj]*",
        "{title}: mean pressure of the capped model, and the published law.",
        "load / load of first yield",
        {"mean pressure / H, cap": "pressure cap", "mean pressure / H, law": "finite-element law"},
        xlabel="load / load of first yield",
        ylabel="mean contact pressure / H",
        log="x",
        marker=True,
    ),
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
        height=WITH_DIFFERENCE,
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
            "simulations, low": "lowest published simulation",
            "Persson": "Persson 2001",
        },
        band=("standard error", "standard error"),
        xlabel="Nayak's parameter",
        ylabel="A E* rms gradient / P",
        height=4.6,
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

TIMED = ("paper", "production", "NNLS", "L-BFGS-B")


def _table2_seconds(data: Data) -> Data:
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
)

DECLARED = (*REPRODUCTION, *APPENDIX, *SMOOTH, *ROUGH, *BY_GRID)


def figures_of(case_id: str) -> list[Figure]:
    """Return the figures of a case, in their order here."""
    return [figure for figure in DECLARED if fnmatchcase(case_id, figure.cases)]
