"""Figures of Appendix A in three dimensions and of the slope correction's effect."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, MARKERS, Data, Figure, label_ticks, look

PLACES = ("crest", "flank", "valley")
COEFFICIENTS = {
    "self": "self",
    "+x 1": "next, downhill (+x)",
    "-x 1": "next, uphill (-x)",
    "across 1": "next, across",
}
QUANTITIES = {"mu": "$\\mu$", "A": "A", "f_max": "$f_{max}$", "Q": "Q (of F)"}
TREATMENTS = ("correction", "near-field remedy")
READINGS = "reading of the slope (degrees)"
GROUPS = ("self", "in line", "across")


def _error_map(canvas: Canvas, data: Data) -> None:
    """Error over the slope on crest, flank and valley: one body, and dashed the pair."""
    panels = canvas.subplots(1, 3, squeeze=False, sharey=True)[0]
    for axes, place in zip(panels, PLACES, strict=True):
        for k, (key, label) in enumerate(COEFFICIENTS.items()):
            for name, style in (("one body", "-"), ("pair", "--")):
                shown = {"color": COLOURS[k], "label": label if name == "one body" else None}
                axes.plot(data["slope (degrees)"], data[f"{name}, {place}, {key} (%)"], style, **shown)
        for limit in (-2, 2):
            axes.axhline(limit, color=INK, linestyle=":")
        axes.set(title=place, xlabel="maximum slope (degrees)", ylim=(-12, 8))
    panels[0].set_ylabel("error of the flat coefficient (%)")
    panels[0].legend(loc="lower left")


def _effect(canvas: Canvas, data: Data) -> None:
    """Change of mu, A, f_max and Q over the rms slope, with 95 % intervals."""
    slope = np.array(data["rms slope (degrees)"], dtype=float)
    for axes, (key, label) in zip(
        canvas.subplots(2, 2, sharex=True).ravel(), QUANTITIES.items(), strict=True
    ):
        for k, treatment in enumerate(TREATMENTS):
            mean, half = data[f"{key}, {treatment}"], data[f"{key}, {treatment}, half width"]
            axes.errorbar(slope * (1 + 0.03 * k), mean, half, capsize=2, label=treatment, **look(k))
        axes.axhline(0.0, color=INK, linewidth=0.8)
        axes.axvline(2.5, color=INK, linestyle=":")
        axes.set_xscale("log")
        label_ticks(axes, slope)
        axes.set(ylabel=f"change of {label} (%)")
        if key in ("f_max", "Q"):
            axes.set_xlabel("rms slope of the roughness (degrees)")
        if key == "mu":
            axes.legend(loc="upper left")


def _reach(canvas: Canvas, data: Data) -> None:
    """Change of mu and f_max over the remedy's reach; dashed: the correction."""
    reach = data["reach (elements)"]
    for axes, key in zip(canvas.subplots(1, 2), ("mu", "f_max"), strict=True):
        # Without friction mu is nearly zero, and a percentage of mu is meaningless
        for k, name in enumerate(("with friction", "without friction")[: 1 if key == "mu" else 2]):
            axes.plot(reach, data[f"{key}, {name}, remedy"], label=name, **look(k))
            axes.plot(reach, data[f"{key}, {name}, correction"], "--", color=COLOURS[k])
        axes.set_xscale("symlog", base=2, linthresh=1)
        label_ticks(axes, reach)
        label = f"change of {QUANTITIES[key]} (%)"
        axes.set(xlabel="reach of the coefficients on the slope (elements)", ylabel=label)
    axes.legend()


def _readings(canvas: Canvas, data: Data) -> None:
    """Largest error by body, coefficient and reading of the slope, beside 2 %."""
    names = [name for name in data if name.endswith(GROUPS)]
    axes = canvas.add_subplot()
    for k, reading in enumerate(data[READINGS]):
        errors = [data[name][k] for name in names]
        axes.plot(errors, np.arange(len(names)), MARKERS[k], color=COLOURS[k], label=f"{reading} degrees")
    axes.axvline(2.0, color=INK, linestyle=":")
    axes.set_xscale("log")
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    label_ticks(axes, (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10))
    axes.set_xlabel("largest error of the flat coefficient (%)")
    axes.legend(title="slope is")


APPENDIX = (
    Figure(
        "fem3d/error-map",
        tuple(f"pair, {place}, self (%)" for place in PLACES),
        _error_map,
        "Error of flat influence coefficients under one square element on a wave of 20 half-widths, nu 0.3: "
        "one body, and dashed copper under steel; dotted: 2 %.",
        (10.5, 4.4),
    ),
    Figure(
        "fem3d/less-than-two-percent",
        (READINGS,),
        _readings,
        "Largest error on crest, flank or valley, by what 'less than 2 %' may mean; dotted: 2 %.",
        (7.6, 5.0),
    ),
    *(
        Figure(
            f"appendix-correction/{pair}",
            tuple(f"{q}, {t}" for q in QUANTITIES for t in TREATMENTS),
            _effect,
            "{title}: what exact facet tractions and the paper's near-field remedy change; means over eight "
            "surfaces, 95 % intervals; dotted: the paper's largest rms slope.",
            (8.6, 6.0),
        )
        for pair in ("paper-pair", "rigid-rough-ball")
    ),
    Figure(
        "appendix-correction/paper-remedy",
        ("reach (elements)", "mu, with friction, remedy"),
        _reach,
        "The paper's remedy over how far coefficients are computed on the slope; dashed: the correction.",
        (8.6, 3.8),
    ),
)
